"""The assembler: reads the text form of a program, which ``docs/bytecode.md`` describes.

Text written by hand may omit what can be derived: array types need no line of their own if an
operand names them, ``stack`` needs no number, and texts, requests and predefined functions may have
any label. `interp.bytecode.assembly.disassembler` writes all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from grammar.semantics.types import Enumeration, Member, Structure, Type
from interp.bytecode.assembly.operands import Operands
from interp.bytecode.assembly.symbols import Symbols, constant_word
from interp.bytecode.assembly.syntax import AssemblyError, Line, key, labels, split
from interp.bytecode.cell_layout import kind_at, real_of, size
from interp.bytecode.instruction_set.table import FORMAT
from interp.bytecode.program import (
    Argument,
    Ask,
    Builtin,
    Changed,
    Choice,
    Code,
    CodeKind,
    Constant,
    Data,
    Handle,
    Import,
    Input,
    Instruction,
    Items,
    Local,
    Mode,
    Parameter,
    Program,
    Record,
    variables,
)
from interp.bytecode.verifier.verify import stacks_needed
from interp.values.faults import LinkError

__all__ = ["AssemblyError", "assemble"]

_T = TypeVar("_T")
_MODES = {mode.value: mode for mode in Mode}
#: The words among the parts of a request that are constants.
_WORDS = {"nil": Constant(None), "TRUE": Constant(True), "FALSE": Constant(False)}
_KINDS = {kind.value: kind for kind in CodeKind}


def assemble(text: str) -> Program:
    """Return the program that a text describes; raises `AssemblyError`.

    The program is not verified; see `interp.bytecode.verifier.verify`.
    """
    return _Assembler(split(text)).program()


class _Assembler:
    """Assembles one text."""

    def __init__(self, lines: Sequence[Line]) -> None:
        self._lines = lines
        self._next = 0
        self._symbols = Symbols(lines)
        self._texts: list[str] = []
        self._asks: list[Ask] = []
        self._builtins: list[Builtin] = []
        self._data: list[Data] = []
        self._initial: list[tuple[int, int]] = []
        self._imports: list[Import] = []
        self._address = 0
        self._codes: list[Code] = []

    def program(self) -> Program:
        """Return the program."""
        symbols = self._symbols
        sections: Mapping[str, Callable[[Line], object]] = {
            "struct": self._structure,
            "enum": self._enumeration,
            "array": lambda line: symbols.number_of(symbols.type_named(line)),
            "text": self._labelled("text", self._texts, Line.string),
            "ask": self._labelled("ask", self._asks, lambda line: Ask(*self._entry(line))),
            "builtin": self._labelled(
                "builtin", self._builtins, lambda line: Builtin(*self._entry(line))
            ),
            "data": lambda line: self._variable(line, is_global=False),
            "global": lambda line: self._variable(line, is_global=True),
            "import": self._import,
            "code": self._code,
        }
        self._head()
        while self._next < len(self._lines):
            line = self._line()
            word = line.take("word", "a section")
            if word not in sections:
                raise line.error(f"{word} begins no section")
            try:
                sections[word](line)
            except LinkError as error:
                raise line.error(str(error)) from None
            line.done()
        return self._with_stacks(self._so_far())

    def _so_far(self) -> Program:
        return Program(
            tuple(self._symbols.types),
            tuple(self._texts),
            tuple(self._asks),
            tuple(self._builtins),
            tuple(self._data),
            tuple(self._initial),
            tuple(self._codes),
            tuple(self._imports),
        )

    def _with_stacks(self, program: Program) -> Program:
        """Return the program with the stack sizes that the text omits."""
        if all(code.stack >= 0 for code in program.codes):
            return program
        pairs = zip(program.codes, stacks_needed(program), strict=True)
        codes = (replace(code, stack=needed) if code.stack < 0 else code for code, needed in pairs)
        return replace(program, codes=tuple(codes))

    def _line(self) -> Line:
        if self._next == len(self._lines):
            raise AssemblyError(self._lines[-1].number if self._lines else 1, "the text ends early")
        self._next += 1
        return self._lines[self._next - 1]

    def _head(self) -> None:
        line = self._line()
        line.expect("bytecode")
        version = line.integer()
        if version != FORMAT:
            raise line.error(f"format {version} is not known, only {FORMAT}")
        line.done()

    # ------------------------------------------------------------------------------ types

    def _structure(self, line: Line) -> None:
        own, members = line.name(), []
        while not line.is_done:
            name = line.name()
            line.expect(":")
            members.append(Member(name, self._symbols.type_named(line)))
        self._symbols.add_type(line, Structure(own, tuple(members)))

    def _enumeration(self, line: Line) -> None:
        own, constants = line.name(), []
        while not line.is_done:
            constants.append(line.name())
        self._symbols.add_type(line, Enumeration(own, tuple(constants)))

    # --------------------------------------------------------------------------- requests

    def _labelled(
        self, section: str, found: list[_T], read: Callable[[Line], _T]
    ) -> Callable[[Line], None]:
        """Return what reads an entry that has a label, and adds it to those found so far."""

        def add(line: Line) -> None:
            self._symbols.add_label(line, section, len(found))
            found.append(read(line))

        return add

    def _entry(self, line: Line) -> tuple[str, tuple[Argument, ...], int | None]:
        name, parts = line.name(), []
        while not line.is_done and not line.has("arrow"):
            parts.append(self._part(line))
        result = self._symbols.type_number(line) if line.found("->") else None
        return name, tuple(parts), result

    def _part(self, line: Line, depth: int = 0) -> Argument:
        if depth > 8:
            raise line.error("parts are nested too deeply")
        token = line.peek()
        if token is not None and token.kind in ("string", "real", "int"):
            return _constant(line, token.kind)
        if line.found("!"):
            type_ = self._symbols.type_number(line)
            line.expect(".")
            return Choice(type_, self._symbols.constant(line, type_))
        if line.found("&"):
            return Handle(self._symbols.code_number(line))
        if line.found("("):
            return Items(self._parts(line, ")", depth))
        if line.found("{"):
            name = line.name()
            token = line.peek()
            has_place = token is not None and token.kind == "int" and token.text.startswith("+")
            place = line.integer(1) if has_place else 0
            return Record(name, place, self._parts(line, "}", depth))
        word = line.take("word", "a part")
        if word in _WORDS:
            return _WORDS[word]
        if word not in _MODES:
            raise line.error(f"{word} is no part of a request")
        return self._input(line, word, depth)

    def _input(self, line: Line, word: str, depth: int) -> Argument:
        line.expect(":")
        mode = _MODES[word]
        type_, dimensions = self._symbols.handed_over(line, mode)
        given = Input(mode, type_, dimensions)
        if not line.found("="):
            return given
        through = line.integer(0) if line.found("@") else None
        path = Items(self._parts(line, ")", depth)) if line.found("(") else None
        return Changed(given, through, path)

    def _parts(self, line: Line, end: str, depth: int) -> tuple[Argument, ...]:
        parts = []
        while not line.found(end):
            parts.append(self._part(line, depth + 1))
        return tuple(parts)

    # -------------------------------------------------------------------------------- data

    def _variable(self, line: Line, *, is_global: bool) -> None:
        module = line.name()
        line.expect(".")
        label = line.label()
        type_ = self._symbols.type_named(line)
        self._symbols.add_variable(line, module, label, self._address, type_)
        self._data.append(Data(module, label[0], self._symbols.number_of(type_), is_global))
        if line.found("="):
            offset = 0
            while not line.is_done:
                offset = self._initial_value(line, type_, offset)
        self._address += size(type_)

    def _import(self, line: Line) -> None:
        module = line.name()
        line.expect(".")
        routine, name = "", line.name()
        if line.found("."):
            routine, name = name, line.name()
        self._imports.append(Import(module, routine, name, self._symbols.data_number(line)))

    def _initial_value(self, line: Line, type_: Type, offset: int) -> int:
        """Read one initial value, or a text; return the offset after it."""
        if line.found("@"):
            return line.integer(offset)
        letters = [ord(one) for one in line.string()] if line.has("string") else [None]
        for letter in letters:
            if offset >= size(type_):
                raise line.error("there are more values than cells")
            kind = kind_at(type_, offset)
            found = constant_word(line, kind) if letter is None else letter
            self._initial.append((self._address + offset, found))
            offset += 1
        return offset

    # -------------------------------------------------------------------------------- code

    def _code(self, line: Line) -> None:
        symbols = self._symbols
        name = line.label()[0]
        kind = _KINDS.get(line.take("word", "a kind of code"))
        if kind is None:
            raise line.error("a code object is a routine, an action or a condition")
        owner = symbols.code_number(line) if line.found("of") else None
        file, start = line.string(), line.integer(0)
        line.done()
        parameters: list[Parameter] = []
        captures: list[int] = []
        locals_: list[Local] = []
        result, stack = None, -1
        while not (line := self._line()).found("begin"):
            word = line.take("word", "begin")
            if word in _MODES:
                if locals_:
                    raise line.error("parameters come before locals")
                label = line.label()
                type_, dimensions = symbols.handed_over(line, _MODES[word])
                if type_ >= len(symbols.types):
                    raise line.error(f"there is no type #{type_}")
                parameters.append(Parameter(label[0], _MODES[word], type_, dimensions))
                if line.found("from"):
                    captures.append(line.integer(0))
            elif word == "local":
                locals_.append(Local(line.label()[0], symbols.number_of(symbols.type_named(line))))
            elif word == "result":
                result = symbols.type_number(line)
            elif word == "stack":
                stack = line.integer(0)
            else:
                raise line.error(f"{word} is not a part of a code object")
            line.done()
        line.done()
        code = Code(
            *(name, kind, file, start, owner, tuple(parameters), tuple(captures)),
            *(tuple(locals_), result, stack, ()),
        )
        self._codes.append(code)
        self._codes[-1] = replace(code, instructions=self._body(code))

    def _body(self, code: Code) -> tuple[Instruction, ...]:
        """Return the instructions of a code object, up to ``end``."""
        targets: dict[str, int] = {}
        written: list[Line] = []
        while not (line := self._line()).found("end"):
            name = line.take("word", "an instruction")
            if line.found(":"):
                if name in targets:
                    raise line.error(f"there is a label {name} already")
                targets[name] = len(written)
                line.done()
            else:
                line.restart()
                written.append(line)
        line.done()
        program = self._so_far()
        frame = {
            key(label): slot
            for label, slot in zip(
                labels(one.name for one in variables(code)), program.slots(code), strict=True
            )
        }
        operands = Operands(self._symbols, targets, frame)
        return tuple(operands.instruction(line) for line in written)


def _constant(line: Line, kind: str) -> Constant:
    if kind == "real":
        return Constant(real_of(line.real()))
    return Constant(line.string() if kind == "string" else line.integer())
