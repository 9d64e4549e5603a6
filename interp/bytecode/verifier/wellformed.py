"""Well-formedness: every number refers to something, and every constant has the right type.

This checks types, texts, data, tables, the heads of code objects and the operands of instructions,
each on its own. What instructions do to the stack is checked by
`interp.bytecode.verifier.operand_stack`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from grammar.semantics.types import (
    BOOL,
    INT_MAX,
    INT_MIN,
    SCALARS,
    Array,
    Enumeration,
    Structure,
    Type,
)
from interp.bytecode.cell_layout import Plain, is_word_of, kind_at, path_to, real_of, size
from interp.bytecode.instruction_set.table import MAX_CELLS, OPERAND_KINDS, shape
from interp.bytecode.program import (
    BASIC_TYPES,
    DEEPEST,
    Argument,
    Ask,
    Changed,
    Choice,
    Code,
    CodeKind,
    Constant,
    Handle,
    Input,
    Items,
    Mode,
    Program,
    Record,
    Variable,
    printable,
    slot_at,
)
from interp.bytecode.verifier.signatures import call_mismatch, request_mismatch
from interp.values.faults import LinkError
from interp.values.values import single

_MOST_DIMENSIONS = 3


_Entry = TypeVar("_Entry", bound=Ask)


class VerificationError(Exception):
    """A program violates a rule of the format; the message says where and why, on one line."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


def error_at(code: Code, place: int, reason: str) -> VerificationError:
    """Return the error that an instruction causes."""
    op = code.instructions[place].op
    return VerificationError(f"{code.name}, instruction {place} ({op.name}): {reason}")


def check_form(program: Program) -> None:
    """Check everything in a program except stack effects; raises `VerificationError`."""
    _Tables(program).check()


class _Tables:
    """Checks one program."""

    def __init__(self, program: Program) -> None:
        self._program = program

    def check(self) -> None:
        """Raise `VerificationError` at the first violation."""
        self._types()
        for text in self._program.texts:
            if any(ord(letter) > 255 for letter in text):
                raise VerificationError("a text has letters that no CHAR holds")
        self._data()
        if not self._program.codes:
            raise VerificationError("there is no code object")
        for code in self._program.codes:
            self._head(code)
        for ask in self._program.asks:
            self._entry(ask, "request", request_mismatch, may_change=ask.name == "Invoke")
            self._result(ask.name, ask.result)
        for builtin in self._program.builtins:
            self._entry(builtin, "function", call_mismatch, may_change=True)
        for code in self._program.codes:
            self._operands(code)

    def _types(self) -> None:
        types = self._program.types
        if types[: len(BASIC_TYPES)] != BASIC_TYPES:
            raise VerificationError("a program begins with the four scalar types")
        depths: dict[Type, int] = dict.fromkeys(BASIC_TYPES, 0)
        names = set(SCALARS)
        for type_ in types[len(BASIC_TYPES) :]:
            name = type_.name.upper() if isinstance(type_, Structure | Enumeration) else None
            if name in names or type_ in depths:
                raise VerificationError(f"{type_} is defined twice")
            if name is not None:
                names.add(name)
            parts = list(_parts(type_))
            if any(part not in depths for part in parts):
                raise VerificationError(f"{type_} uses types that are not defined before it")
            depths[type_] = 1 + max((depths[part] for part in parts), default=0)
            if depths[type_] > DEEPEST:
                raise VerificationError(f"{type_} is nested too deeply")
            try:
                size(type_)
            except LinkError as error:
                raise VerificationError(str(error)) from None

    def _data(self) -> None:
        program = self._program
        for variable in program.data:
            self._type(variable.type, f"{variable.module}.{variable.name}")
        if sum(size(program.types[variable.type]) for variable in program.data) > MAX_CELLS:
            raise VerificationError(f"the data lists have more than {MAX_CELLS:,} cells")
        for one in program.imports:
            if not 0 <= one.number < len(program.data):
                raise VerificationError(f"the import {one.module}.{one.name} refers to no variable")
        last = -1
        for address, word in program.initial:
            number = program.data_at(address)
            if number is None or address <= last:
                raise VerificationError("initial values must be in the order of their cells")
            last = address
            variable = program.data[number]
            kind = kind_at(program.types[variable.type], address - program.addresses[number])
            if not is_word_of(word, kind):
                raise VerificationError(f"an initial value of {variable.name} is not a {kind}")

    def _type(self, number: int | None, where: str) -> Type:
        if number is None or not 0 <= number < len(self._program.types):
            raise VerificationError(f"{where}: there is no such type")
        return self._program.types[number]

    # --------------------------------------------------------------------------- requests

    def _entry(
        self,
        entry: _Entry,
        what: str,
        mismatch: Callable[[Program, _Entry], str | None],
        *,
        may_change: bool,
    ) -> None:
        name = entry.name
        for part in _all_parts(entry.parts, 0):
            match part:
                case Input():
                    self._input(part, name)
                case Changed() if part.given.mode is Mode.IN or not may_change:
                    raise VerificationError(f"{name} cannot change this argument")
                case Choice():
                    self._choice(part, name)
                case Constant():
                    self._constant(part, name)
                case Record() if not 0 <= part.line <= INT_MAX:
                    raise VerificationError(f"{name}: there is no such line")
                case Handle() if not 0 <= part.code < len(self._program.codes):
                    raise VerificationError(f"{name}: there is no such code object")
        if entry.result is not None:
            self._type(entry.result, name)
        reason = mismatch(self._program, entry)
        if reason is not None:
            raise VerificationError(f"{what} {name}: {reason}")

    def _input(self, part: Input, name: str) -> None:
        self._handed_over(part, name)
        if part.mode is Mode.IN and not isinstance(self._program.types[part.type], Plain):
            raise VerificationError(f"{name}: a structure must be passed by reference")

    def _choice(self, part: Choice, name: str) -> None:
        type_ = self._type(part.type, name)
        if not isinstance(type_, Enumeration) or not 0 <= part.place < len(type_.constants):
            raise VerificationError(f"{name}: there is no such constant")

    def _constant(self, part: Constant, name: str) -> None:
        value = part.value
        if isinstance(value, float):
            if not math.isfinite(value) or single(value) != value:
                raise VerificationError(f"{name}: {value} is not a REAL")
        elif isinstance(value, int) and not INT_MIN <= value <= INT_MAX:
            raise VerificationError(f"{name}: {value} is not an INT")

    def _result(self, request: str, result: int | None) -> None:
        if (result is not None) != (request == "Read") and request != "Invoke":
            raise VerificationError(
                f"{request}: only Read and Invoke have results, and Read has one"
            )

    # -------------------------------------------------------------------------------- code

    def _handed_over(self, given: Input | Variable, where: str) -> None:
        type_ = self._type(given.type, where)
        if given.mode is Mode.VIEW:
            if isinstance(type_, Array) or not 1 <= given.dimensions <= _MOST_DIMENSIONS:
                raise VerificationError(f"{where}: a view has 1 to {_MOST_DIMENSIONS} dimensions")
        elif given.dimensions:
            raise VerificationError(f"{where}: only a view has dimensions")

    def _head(self, code: Code) -> None:
        program = self._program
        for parameter in code.parameters:
            self._handed_over(parameter, f"{code.name}, {parameter.name}")
        for local in code.locals:
            self._type(local.type, f"{code.name}, {local.name}")
        if code.result is not None and not isinstance(self._type(code.result, code.name), Plain):
            raise VerificationError(f"{code.name}: a result must have one cell")
        if program.addresses[-1] + program.frame_size(code) > MAX_CELLS:
            raise VerificationError(
                f"{code.name}: data lists and a frame have more than {MAX_CELLS:,} cells"
            )
        if not code.instructions:
            raise VerificationError(f"{code.name}: there are no instructions")
        if not 0 <= code.line <= INT_MAX:
            raise VerificationError(f"{code.name}: there is no such line")
        self._ownership(code)

    def _ownership(self, code: Code) -> None:
        if code.kind is CodeKind.ROUTINE:
            if code.owner is not None or code.captures:
                raise VerificationError(f"{code.name}: a routine cannot have an owner or captures")
            return
        codes = self._program.codes
        if code.owner is None or not 0 <= code.owner < len(codes):
            raise VerificationError(f"{code.name}: there is no owner")
        owner = codes[code.owner]
        if owner.kind is not CodeKind.ROUTINE:
            raise VerificationError(f"{code.name}: the owner must be a routine")
        if code.kind is CodeKind.CONDITION and (
            code.result is None or self._program.types[code.result] != BOOL
        ):
            raise VerificationError(f"{code.name}: the result of a condition must be BOOL")
        if code.kind is CodeKind.ACTION and code.result is not None:
            raise VerificationError(f"{code.name}: an action cannot have a result")
        if len(code.captures) != len(code.parameters):
            raise VerificationError(
                f"{code.name}: each parameter must capture a variable of the owner"
            )
        for parameter, place in zip(code.parameters, code.captures, strict=True):
            if not self._can_capture(owner, parameter, place):
                raise VerificationError(f"{code.name}: the owner has no {parameter.name} there")

    def _can_capture(self, owner: Code, wanted: Variable, place: int) -> bool:
        slot = slot_at(self._program.slots(owner), place)
        if slot is None:
            return False
        found, types = slot.variable, self._program.types
        if found.mode is not Mode.IN:
            return place == slot.offset and (found.mode, found.type, found.dimensions) == (
                *(wanted.mode, wanted.type, wanted.dimensions),
            )
        path = path_to(types[found.type], place - slot.offset, types[wanted.type])
        return wanted.mode is Mode.REF and path is not None

    def _operands(self, code: Code) -> None:
        ranges = self._ranges(code)
        for place, instruction in enumerate(code.instructions):
            kinds = shape(instruction.op.name).operands
            if len(kinds) != len(instruction.operands):
                raise error_at(code, place, "operands are missing")
            for kind, operand in zip(kinds, instruction.operands, strict=True):
                low, high = ranges[kind]
                if not low <= operand <= high or (
                    kind == "real" and not math.isfinite(real_of(operand))
                ):
                    reason = f"an operand is out of range: {operand} is not a {kind}"
                    raise error_at(code, place, reason)

    def _ranges(self, code: Code) -> dict[str, tuple[int, int]]:
        """Return the minimum and maximum operand of each kind."""
        program = self._program
        limits: dict[int | str | None, int] = {
            "length": len(code.instructions),
            "frame": program.frame_size(code),
            "data_cells": program.addresses[-1],
            "type_count": len(program.types),
            "text_count": len(program.texts),
            "code_count": len(program.codes),
            "ask_count": len(program.asks),
            "builtin_count": len(program.builtins),
            None: INT_MAX + 1,
        }
        return {
            name: (
                INT_MIN if kind.least is None else kind.least,
                (kind.limit if isinstance(kind.limit, int) else limits[kind.limit]) - 1,
            )
            for name, kind in OPERAND_KINDS.items()
        }


def _parts(type_: Type) -> Iterator[Type]:
    """Yield the types of which a type is composed."""
    match type_:
        case Structure():
            yield from (member.type for member in type_.members)
        case Array():
            yield type_.element


def _all_parts(parts: Sequence[Argument], depth: int) -> Iterator[Argument]:
    for part in parts:
        yield part
        inner: Sequence[Argument] = ()
        if isinstance(part, Items | Record):
            inner = part.parts
        elif isinstance(part, Changed):
            inner = (part.given, *([part.path] if part.path else []))
        if inner:
            if depth == DEEPEST:
                raise VerificationError("parts of a request are nested too deeply")
            yield from _all_parts(inner, depth + 1)
