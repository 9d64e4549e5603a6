"""The disassembler: writes a verified program as text.

The text contains everything in the program, and in one form only: the assembler returns the same
program, and disassembling that returns the same text. Comments only repeat what follows from the
rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.semantics.types import CHAR, INT, REAL, Array, Enumeration, Structure, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.syntax import (
    label_text,
    labels,
    name_text,
    part_text,
    real_text,
    string_text,
)
from interp.bytecode.cell_layout import Plain, bits_of, kind_at, path_to
from interp.bytecode.instruction_set.table import FORMAT, shape
from interp.bytecode.program import (
    BASIC_TYPES,
    Argument,
    Ask,
    Changed,
    Choice,
    Code,
    Constant,
    Handle,
    Input,
    Instruction,
    Items,
    Mode,
    Parameter,
    Program,
    Record,
    slot_at,
    targets,
    variables,
)
from interp.values.faults import FAULTS

_FAULTS = {kind.code: slug for slug, kind in FAULTS.items()}


def disassemble(program: Program) -> str:
    """Return the text form of a program."""
    return "".join(f"{line}\n" for line in _Writer(program).lines())


class _Writer:
    """Writes one program."""

    def __init__(self, program: Program) -> None:
        self._program = program
        data = zip(
            labels(f"{one.module}\0{one.name}" for one in program.data), program.data, strict=True
        )
        self._data = [
            f"{name_text(one.module)}.{label_text((one.name, number))}" for (_, number), one in data
        ]
        self._codes = [label_text(label) for label in labels(code.name for code in program.codes)]

    def lines(self) -> Iterator[str]:
        program = self._program
        yield f"bytecode {FORMAT}"
        yield from self._section(map(self._type_line, program.types[len(BASIC_TYPES) :]))
        texts = (f"text T{n} {string_text(text)}" for n, text in enumerate(program.texts))
        yield from self._section(texts)
        yield from self._section(
            f"builtin B{number} {self._entry(one)}" for number, one in enumerate(program.builtins)
        )
        yield from self._section(
            f"ask A{number} {self._entry(one)}" for number, one in enumerate(program.asks)
        )
        yield from self._section(self._data_lines())
        for number, code in enumerate(program.codes):
            yield ""
            yield from self._code_lines(number, code)

    def _section(self, lines: Iterator[str]) -> Iterator[str]:
        for number, line in enumerate(lines):
            if number == 0:
                yield ""
            yield line

    # ------------------------------------------------------------------------------ types

    def _type(self, number: int) -> str:
        return self._type_text(self._program.types[number])

    def _type_text(self, type_: Type) -> str:
        if isinstance(type_, Array):
            return f"{self._type_text(type_.element)}[{','.join(map(str, type_.sizes))}]"
        if isinstance(type_, Structure | Enumeration):
            return name_text(type_.name)
        return str(type_)

    def _type_line(self, type_: Type) -> str:
        if isinstance(type_, Structure):
            members = (
                f" {name_text(member.name)}:{self._type_text(member.type)}"
                for member in type_.members
            )
            return f"struct {self._type_text(type_)}{''.join(members)}"
        if isinstance(type_, Enumeration):
            return f"enum {self._type_text(type_)} {' '.join(map(name_text, type_.constants))}"
        return f"array {self._type_text(type_)}"

    # --------------------------------------------------------------------------- requests

    def _entry(self, entry: Ask) -> str:
        words = [name_text(entry.name), *map(self._part, entry.parts)]
        if entry.result is not None:
            words += ["->", self._type(entry.result)]
        return " ".join(words)

    def _part(self, part: Argument) -> str:
        match part:
            case Constant(str() as value):
                return string_text(value)
            case Constant(bool() as value):
                return "TRUE" if value else "FALSE"
            case Constant(float() as value):
                return real_text(bits_of(value))
            case Constant(value):
                return "nil" if value is None else str(value)
            case Choice(type_, place):
                return f"!{self._type(type_)}.{self._constant(type_, place)}"
            case Input():
                return self._input(part)
            case Changed(given, through, path):
                where = f"@{through}" if through is not None else ""
                return f"{self._input(given)}={where}{self._part(path) if path else ''}"
            case Handle(code):
                return f"&{self._code(code)}"
            case Items(parts):
                return f"({' '.join(map(self._part, parts))})"
            case Record(name, line, parts):
                head = [name_text(name), *([f"+{line}"] if line else [])]
                return "{" + " ".join([*head, *map(self._part, parts)]) + "}"

    def _input(self, given: Input | Parameter) -> str:
        mode = given.mode.value
        return f"{mode}:{self._type(given.type)}{_dimensions(given)}"

    def _constant(self, type_: int, place: int) -> str:
        enumeration = self._program.types[type_]
        assert isinstance(enumeration, Enumeration), "verified"
        return name_text(enumeration.constants[place])

    # -------------------------------------------------------------------------------- data

    def _data_lines(self) -> Iterator[str]:
        program = self._program
        addresses, initial, start = program.addresses, program.initial, 0
        for number, variable in enumerate(program.data):
            type_, line = program.types[variable.type], [self._data[number]]
            line.append(self._type(variable.type))
            end = start
            while end < len(initial) and initial[end][0] < addresses[number + 1]:
                end += 1
            if end > start:
                line += ["=", *_initial(type_, addresses[number], initial[start:end])]
            start = end
            yield f"{'global' if variable.is_global else 'data'} {' '.join(line)}"
        for one in program.imports:
            routine = (one.routine,) if one.routine else ()
            names = ".".join(map(name_text, (one.module, *routine, one.name)))
            yield f"import {names} {self._data[one.number]}"

    # -------------------------------------------------------------------------------- code

    def _code(self, number: int) -> str:
        return self._codes[number]

    def _code_lines(self, number: int, code: Code) -> Iterator[str]:
        owner = "" if code.owner is None else f" of {self._code(code.owner)}"
        head = f"{self._codes[number]} {code.kind.value}{owner}"
        yield f"code {head} {string_text(code.file)} {code.line}"
        names = [label_text(label) for label in labels(one.name for one in variables(code))]
        for place, parameter in enumerate(code.parameters):
            source = f" from {code.captures[place]}" if place < len(code.captures) else ""
            mode, type_ = parameter.mode.value, self._type(parameter.type)
            yield f"  {mode} {names[place]} {type_}{_dimensions(parameter)}{source}"
        for place, local in enumerate(code.locals, start=len(code.parameters)):
            yield f"  local {names[place]} {self._type(local.type)}"
        if code.result is not None:
            yield f"  result {self._type(code.result)}"
        yield f"  stack {code.stack}"
        yield "begin"
        frame = _Frame(self._program, code, names)
        jumped_to = {target for one in code.instructions for target in targets(one)}
        for place, instruction in enumerate(code.instructions):
            if place in jumped_to:
                yield f"L{place}:"
            operands = " ".join(self._operands(frame, instruction))
            line = f"  {instruction.op.name} {operands}".rstrip()
            comment = self._comment(instruction)
            yield f"{line:<40} ; {comment}" if comment else line
        yield "end"

    def _comment(self, instruction: Instruction) -> str:
        program, operands = self._program, instruction.operands
        match instruction.op:
            case Op.ASK:
                return self._entry(program.asks[operands[0]])
            case Op.BUILTIN:
                return self._entry(program.builtins[operands[0]])
            case Op.SET_TEXT:
                return string_text(program.texts[operands[0]])
        return ""

    def _operands(self, frame: _Frame, instruction: Instruction) -> Iterator[str]:
        kinds, operands = shape(instruction.op.name).operands, instruction.operands
        wanted = _wanted(self._program, instruction)
        for kind, operand in zip(kinds, operands, strict=True):
            match kind:
                case "target":
                    yield f"L{operand}"
                case "local":
                    yield frame.place(operand, wanted)
                case "data":
                    yield self._address(operand, wanted)
                case "type":
                    yield self._type(operand)
                case "code":
                    yield self._code(operand)
                case "text" | "ask" | "builtin":
                    yield f"{kind[0].upper()}{operand}"
                case "fault":
                    yield _FAULTS[operand]
                case "count" if instruction.op.name == "PUSH_ENUM":
                    yield self._constant(operands[0], operand)
                case _:
                    yield _constant_operand(kind, operand)

    def _address(self, address: int, wanted: Type | None) -> str:
        number = self._program.data_at(address)
        if number is not None:
            type_ = self._program.types[self._program.data[number].type]
            path = path_to(type_, address - self._program.addresses[number], wanted)
            if path is not None:
                return self._data[number] + part_text(path)
        return f"+{address}"


class _Frame:
    """The names of the cells of a frame."""

    def __init__(self, program: Program, code: Code, names: Sequence[str]) -> None:
        self._program = program
        self._slots = program.slots(code)
        self._names = dict(zip((slot.offset for slot in self._slots), names, strict=True))

    def place(self, offset: int, wanted: Type | None) -> str:
        slot = slot_at(self._slots, offset)
        if slot is not None:
            inside = offset - slot.offset
            if slot.variable.mode is not Mode.IN and inside == 0:
                return self._names[offset]
            if slot.variable.mode is Mode.IN:
                type_ = self._program.types[slot.variable.type]
                path = path_to(type_, inside, wanted)
                if path is not None:
                    return self._names[slot.offset] + part_text(path)
        return f"+{offset}"


def _constant_operand(kind: str, operand: int) -> str:
    match kind:
        case "real":
            return real_text(operand)
        case "bool":
            return "TRUE" if operand else "FALSE"
        case "char":
            return string_text(chr(operand))
    return str(operand)


def _wanted(program: Program, instruction: Instruction) -> Type | None:
    """Return the type at a place in the frame or the data lists; ``None`` for a single cell."""
    kinds = shape(instruction.op.name).operands
    is_typed = kinds[:2] in (("local", "type"), ("data", "type"))
    return program.types[instruction.operands[1]] if is_typed else None


def _dimensions(given: Input | Parameter) -> str:
    return f"[{',' * (given.dimensions - 1)}]" if given.mode is Mode.VIEW else ""


def _initial(type_: Type, base: int, words: Sequence[tuple[int, int]]) -> Iterator[str]:
    """Yield initial values in text form: ``1 2 @10 "text" 3.0``."""
    expected, letters = base, ""
    for address, word in words:
        kind = kind_at(type_, address - base)
        if letters and (kind != CHAR or address != expected):
            yield string_text(letters)
            letters = ""
        if address != expected:
            yield f"@{address - base}"
        expected = address + 1
        if kind == CHAR:
            letters += chr(word)
        else:
            yield _word_text(word, kind)
    if letters:
        yield string_text(letters)


def _word_text(word: int, kind: Plain) -> str:
    if isinstance(kind, Enumeration):
        return f"!{name_text(kind.constants[word])}"
    if kind == REAL:
        return real_text(word)
    return str(word) if kind == INT else ("TRUE" if word else "FALSE")
