"""The register code of the machine in C: which registers a step reads and writes, and a listing."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final, NamedTuple

from interp.bytecode.verifier.verify import Verified
from interp.native._core import Core

CALLS: Final = ("CALL", "CALL_COPY")
#: Steps that are not followed by the next one.
ENDS: Final = ("JUMP", "RETURN", "RETURN_VALUE", "END_ACTION", "FAIL")
#: The register operands that steps read, and those that they write. ``e`` is a third index or the
#: register after ``c``, ``f`` the second one after ``c``. Steps that are not listed work on ranges
#: of cells.
_ROLES: Final = {
    ("", ""): "JUMP NOP FAIL PUT_DATA_K REMEMBER_LOCAL REMEMBER_DATA CHECK_CALL",
    ("", "a"): "SET_K GET_DATA REFER",
    ("a", ""): "STORE_K CLEAR",
    (
        "b",
        "",
    ): "JUMP_IF JUMP_UNLESS SWITCH CASE FOR_DATA_UP FOR_DATA_DOWN PUT_DATA RETURN_VALUE "
    "PUT_LOCAL_K PUT_ELEMENT_DATA_K",
    ("b", "a"): "MOVE PASS OFFSET LOAD INDEX_LOCAL INDEX_DATA GET_LOCAL GET_ELEMENT_DATA "
    "INDEX_WIDE_LOCAL INDEX_WIDE_DATA GET_WIDE_LOCAL GET_WIDE_DATA NEG_INT NEG_REAL NOT_BITS "
    "NOT_BOOL INT_TO_REAL REAL_TO_INT INT_TO_CHAR",
    ("bc", "a"): "FUNCTION",
    ("bd", "a"): "INDEX_TWO_LOCAL INDEX_TWO_DATA GET_TWO_LOCAL GET_TWO_DATA",
    ("bce", "a"): "INDEX_VIEW GET_VIEW",
    ("bcdef", "a"): "INDEX_VIEW_TWO GET_VIEW_TWO",
    (
        "ab",
        "",
    ): "STORE COPY FILL_POSE INVERT PUT_LOCAL PUT_ELEMENT_DATA PUT_WIDE_LOCAL PUT_WIDE_DATA",
    ("ab", "a"): "FOR_UP FOR_DOWN",
    ("bde", "a"): "INDEX_THREE_LOCAL INDEX_THREE_DATA GET_THREE_LOCAL GET_THREE_DATA",
    ("abde", ""): "PUT_THREE_LOCAL PUT_THREE_DATA",
    ("abc", ""): "COMPOSE",
    ("abd", ""): "PUT_TWO_LOCAL PUT_TWO_DATA",
}
_ROLE_OF: Final = {name: role for role, names in _ROLES.items() for name in names.split()}
_BINARY: Final = re.compile(
    r"(UNLESS_)?(?:(?:EQ|NE|LT|GT|LE|GE|ADD|SUB|MUL|DIV)_(?:INT|REAL)"
    r"|(?:AND|OR|EXOR)_(?:BITS|BOOL))(_K)?"
)


def roles_of(name: str) -> tuple[str, str] | None:
    """Return the letters of the operands that a step reads and writes, or ``None``."""
    match = _BINARY.fullmatch(name)
    if match is None:
        return _ROLE_OF.get(name)
    return "b" if match[2] else "bc", "" if match[1] else "a"


class Step(NamedTuple):
    """A step as returned by `Core.steps`; ``line`` is the index of the LINE that it begins, or -1.

    ``e`` is the register of a third index, otherwise the one after ``c``.
    """

    name: str
    a: int
    b: int
    c: int
    d: int
    tag: int
    line: int
    e: int

    @property
    def is_jump(self) -> bool:
        """Whether ``d`` is a jump target."""
        return self.name.startswith(("JUMP", "UNLESS_", "CASE", "FOR_", "TEXT"))

    def named(self, operands: str) -> set[int]:
        """Return the registers for operand letters; ``f`` is the second register after ``c``."""
        values = {"a": self.a, "b": self.b, "c": self.c, "d": self.d, "e": self.e, "f": self.c + 2}
        return {values[one] for one in operands}

    def registers(self) -> set[int]:
        """Return all registers that the step accesses individually."""
        if self.name in CALLS:
            return {self.a}
        return self.named("".join(roles_of(self.name) or ""))


def listing(verified: Verified) -> Iterator[str]:
    """Yield the steps that a program without a trace executes, one line each, by code object.

    The source line that begins with a step precedes its name.
    """
    core = Core(verified.image, verified.depths, 0, 0, None)
    steps = [Step(*one) for one in core.steps()]
    firsts = {core.step(number, 0): code for number, code in enumerate(verified.program.codes)}
    for number, array in enumerate(core.arrays()):
        base, width, dimensions, *sizes = array
        shape = ",".join(map(str, sizes[:dimensions]))
        yield f"array {number}: from {base}, {width} cells each, [{shape}]"
    for number, step in enumerate(steps):
        if number in firsts:
            code = firsts[number]
            yield f"{code.kind.value} {code.name} {code.file}"
        line = code.instructions[step.line].operands[0] if step.line >= 0 else ""
        operands = f"a={step.a} b={step.b} c={step.c} d={step.d} tag={step.tag}"
        yield f"{number:6} {line:>5}  {step.name:22} {operands}"
