"""The assembler: reads the text form of a program, which ``docs/bytecode.md`` describes.

Text written by hand may omit what can be derived: array types need no line of their own if an
operand names them, ``stack`` needs no number, and texts, requests and predefined functions may have
any label. `interp.bytecode.assembly.disassembler` writes all of it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import Any

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.forms import LINES, operands
from interp.bytecode.assembly.names import Names
from interp.bytecode.assembly.syntax import AssemblyError, Label, Line, split
from interp.bytecode.instruction_set.table import FORMAT
from interp.bytecode.program import (
    Code,
    CodeKind,
    Data,
    Import,
    Instruction,
    Mode,
    Program,
    Variable,
)
from interp.bytecode.verifier.verify import stacks_needed
from interp.values.faults import LinkError

__all__ = ["AssemblyError", "assemble"]

_IN_CODE = frozenset({*(mode.value for mode in Mode), "local", "result", "stack", "begin"})
_SECTIONS = LINES.keys() - _IN_CODE - {"bytecode"}


def assemble(text: str) -> Program:
    """Return the program that a text describes; raises `AssemblyError`.

    The program is not verified; see `interp.bytecode.verifier.verify`.
    """
    assembler = _Assembler(split(text))
    try:
        return assembler.program()
    except LinkError as error:
        raise assembler.line.error(str(error)) from None


class _Assembler:
    """Assembles one text; ``line`` is the one that it is at."""

    def __init__(self, lines: list[Line]) -> None:
        self.line = Line(1, ())
        self._left = lines[::-1]
        self._names = Names()
        self._tables: dict[str, list[Any]] = {kind: [] for kind in ("text", "ask", "builtin")}
        self._data: list[Data] = []
        self._initial: list[tuple[int, int]] = []
        self._imports: list[Import] = []
        self._codes: list[Code] = []

    def program(self) -> Program:
        """Return the program."""
        for line in reversed(self._left):  # code objects are named before they come
            if line.found("code"):
                self.line = line
                self._names.tables["code"].add(line.label())
            line.place = 0
        _, version = self._next({"bytecode"}, "is needed")
        if version != FORMAT:
            raise self.line.error(f"format {version} is not known, only {FORMAT}")
        while self._left:
            self._section(*self._next(_SECTIONS, "begins no section"))
        tables = (self._names.types, *self._tables.values(), self._data, self._initial)
        program = Program(*map(tuple, (*tables, self._codes, self._imports)))
        if any(code.stack < 0 for code in program.codes):
            pairs = zip(program.codes, stacks_needed(program), strict=True)
            codes = (
                replace(code, stack=needed) if code.stack < 0 else code for code, needed in pairs
            )
            program = replace(program, codes=tuple(codes))
        return program

    def _take(self) -> Line:
        if not self._left:
            raise self.line.error("the text ends early")
        self.line = self._left.pop()
        return self.line

    def _next(self, words: Collection[str], otherwise: str) -> tuple[str, Any]:
        """Read the next line, which begins with one of some words; return the word and the rest."""
        line = self._take()
        word = line.take("word", "a word")
        if word not in words:
            raise line.error(f"{word} {otherwise}")
        found = LINES[word].read(self._names, line)
        line.done()
        return word, found

    def _section(self, word: str, found: Any) -> None:
        names = self._names
        match word:
            case "struct" | "enum":
                names.add_type(found)
            case "text" | "ask" | "builtin":
                label, entry = found
                names.tables[word].add(label)
                self._tables[word].append(entry)
            case "data" | "global":
                label, type_, values = found
                module, name = label.names
                variable = Data(module, name, type_, word == "global")
                start = names.data.end
                names.place(names.data, label, variable)
                self._data.append(variable)
                self._initial += ((start + offset, word) for offset, word in values or ())
            case "import":
                (module, *routine, name), number = found
                self._imports.append(Import(module, "".join(routine), name, number))
            case "code":
                self._codes.append(self._code(*found))

    def _code(self, label: Label, kind: CodeKind, owner: int | None, file: str, start: int) -> Code:
        self._names.open_code()
        parameters: list[Variable] = []
        captures: list[int] = []
        locals_: list[Variable] = []
        result, stack = None, -1
        while (line := self._next(_IN_CODE, "is not a part of a code object"))[0] != "begin":
            match line:
                case "result", found:
                    result = found
                case "stack", found:
                    stack = found
                case "local", (own, type_):
                    locals_.append(Variable(own.names[0], Mode.IN, type_))
                    self._names.place(self._names.frame, own, locals_[-1])
                case mode, (own, type_, dimensions, captured):
                    if locals_:
                        raise self.line.error("parameters come before locals")
                    parameters.append(Variable(own.names[0], Mode(mode), type_, dimensions))
                    captures += () if captured is None else (captured,)
                    self._names.place(self._names.frame, own, parameters[-1])
        return Code(
            *(label.names[0], kind, file, start, owner, tuple(parameters), tuple(captures)),
            *(tuple(locals_), result, stack, tuple(self._body())),
        )

    def _body(self) -> Iterator[Instruction]:
        """Yield the instructions of a code object, up to ``end``."""
        written: list[tuple[Line, str]] = []
        while not self._take().found("end"):
            name = self.line.take("word", "an instruction")
            if self.line.found(":"):
                self._names.tables["target"].add(Label((name,)), len(written))
                self.line.done()
            else:
                written.append((self.line, name))
        self.line.done()
        for self.line, name in written:
            if name not in Op.__members__:
                raise self.line.error(f"there is no instruction {name}")
            yield Instruction(Op[name], operands(name).read(self._names, self.line))
            self.line.done()
