"""From the text form to a program; the form is described in ``docs/bytecode.md``.

What is written by hand may leave out what can be worked out: array types need no line of their own
where an operand names them, ``stack`` no number, and texts, requests and predefined functions may
have any label. `interp.bytecode.disassembler` writes the text with all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from grammar.types import BOOL, SCALARS, Array, Enumeration, Member, Structure, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cells import kind_at, offset_of, real_of, size
from interp.bytecode.isa import FORMAT, shape
from interp.bytecode.program import (
    BASIC_TYPES,
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
    Input,
    Instruction,
    Items,
    Local,
    Mode,
    Parameter,
    Program,
    Record,
    Slot,
    variables,
)
from interp.bytecode.syntax import AssemblyError, Key, Line, key, labels, path_text, split
from interp.bytecode.verify import stacks_needed
from interp.faults import FAULTS, LinkError

__all__ = ["AssemblyError", "assemble"]

_MODES = {mode.value: mode for mode in Mode}
_FAULTS = {slug: kind.code for slug, kind in FAULTS.items()}
#: What a word stands for among the parts of a request.
_WORDS = {"nil": Constant(None), "TRUE": Constant(True), "FALSE": Constant(False)}
_KINDS = {kind.value: kind for kind in CodeKind}


def assemble(text: str) -> Program:
    """The program that a text describes; raises `AssemblyError`.

    It is not verified: that is the affair of `interp.bytecode.verify`.
    """
    return _Assembler(split(text)).program()


class _Assembler:
    """Assembles one text."""

    def __init__(self, lines: Sequence[Line]) -> None:
        self._lines = lines
        self._next = 0
        self._types: list[Type] = list(BASIC_TYPES)
        self._numbers = {type_: number for number, type_ in enumerate(BASIC_TYPES)}
        self._named: dict[str, Type] = dict(SCALARS)
        self._texts: list[str] = []
        self._asks: list[Ask] = []
        self._builtins: list[Builtin] = []
        self._labels: dict[str, dict[str, int]] = {"text": {}, "ask": {}, "builtin": {}}
        self._data: list[Data] = []
        self._places: dict[tuple[str, Key], tuple[int, Type]] = {}
        self._initial: list[tuple[int, int]] = []
        self._address = 0
        self._codes: list[Code] = []
        self._code_labels = self._announced()

    def program(self) -> Program:
        """All of the text."""
        sections: Mapping[str, Callable[[Line], None]] = {
            "struct": self._structure,
            "enum": self._enumeration,
            "array": self._array,
            "text": self._text,
            "ask": self._ask,
            "builtin": self._builtin,
            "data": lambda line: self._variable(line, is_global=False),
            "global": lambda line: self._variable(line, is_global=True),
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
            tuple(self._types),
            tuple(self._texts),
            tuple(self._asks),
            tuple(self._builtins),
            tuple(self._data),
            tuple(self._initial),
            tuple(self._codes),
        )

    def _with_stacks(self, program: Program) -> Program:
        """The program with the sizes of stacks that the text leaves out."""
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

    def _announced(self) -> dict[Key, int]:
        """The code objects, which can be named before they come."""
        found: dict[Key, int] = {}
        for line in self._lines:
            if line.found("code"):
                label = key(line.label())
                if label in found:
                    raise line.error("there is such a code object already")
                found[label] = len(found)
            line.restart()
        return found

    # ------------------------------------------------------------------------------ types

    def _structure(self, line: Line) -> None:
        own, members = line.name(), []
        while not line.is_done:
            name = line.name()
            line.expect(":")
            members.append(Member(name, self._type(line)))
        self._add(line, Structure(own, tuple(members)))

    def _enumeration(self, line: Line) -> None:
        own, constants = line.name(), []
        while not line.is_done:
            constants.append(line.name())
        self._add(line, Enumeration(own, tuple(constants)))

    def _array(self, line: Line) -> None:
        self._number(self._type(line))

    def _add(self, line: Line, type_: Structure | Enumeration) -> None:
        if type_.name.upper() in self._named:
            raise line.error(f"there is a type {type_.name} already")
        size(type_)
        self._named[type_.name.upper()] = type_
        self._number(type_)

    def _number(self, type_: Type) -> int:
        """The number of a type; an array type that is not there yet gets one."""
        number = self._numbers.get(type_)
        if number is None:
            number = self._numbers[type_] = len(self._types)
            self._types.append(type_)
        return number

    def _type(self, line: Line, is_element: bool = False) -> Type:
        """A type; with ``is_element`` one whose brackets, if any follow, belong to a view."""
        name = line.name()
        found = self._named.get(name.upper())
        if found is None:
            raise line.error(f"there is no type {name}")
        if not is_element and line.found("["):
            sizes = [line.integer(1)]
            while line.found(","):
                sizes.append(line.integer(1))
            line.expect("]")
            found = Array(found, tuple(sizes))
            size(found)
            self._number(found)
        return found

    def _type_number(self, line: Line) -> int:
        return line.integer(0) if line.found("#") else self._number(self._type(line))

    def _handed_over(self, line: Line, mode: Mode) -> tuple[int, int]:
        """The type of an argument, and how many dimensions it has as a view."""
        if line.found("#"):
            type_ = line.integer(0)
        else:
            type_ = self._number(self._type(line, is_element=mode is Mode.VIEW))
        dimensions = 0
        if mode is Mode.VIEW:
            line.expect("[")
            dimensions = 1
            while line.found(","):
                dimensions += 1
            line.expect("]")
        return type_, dimensions

    # --------------------------------------------------------------------------- requests

    def _text(self, line: Line) -> None:
        self._label(line, "text", len(self._texts))
        self._texts.append(line.string())

    def _ask(self, line: Line) -> None:
        self._label(line, "ask", len(self._asks))
        self._asks.append(Ask(line.name(), *self._entry(line)))

    def _builtin(self, line: Line) -> None:
        self._label(line, "builtin", len(self._builtins))
        self._builtins.append(Builtin(line.name(), *self._entry(line)))

    def _label(self, line: Line, section: str, number: int) -> None:
        name = line.name()
        if name in self._labels[section]:
            raise line.error(f"there is a {section} {name} already")
        self._labels[section][name] = number

    def _entry(self, line: Line) -> tuple[tuple[Argument, ...], int | None]:
        parts = []
        while not line.is_done and not line.has("arrow"):
            parts.append(self._part(line))
        return tuple(parts), self._type_number(line) if line.found("->") else None

    def _part(self, line: Line, depth: int = 0) -> Argument:
        if depth > 8:
            raise line.error("parts lie too deep")
        token = line.peek()
        if token is not None and token.kind in ("string", "real", "int"):
            return _constant(line, token.kind)
        if line.found("!"):
            type_ = self._type_number(line)
            line.expect(".")
            return Choice(type_, self._constant(line, type_))
        if line.found("&"):
            return Handle(self._code_number(line))
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
        type_, dimensions = self._handed_over(line, mode)
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

    def _constant(self, line: Line, type_: int) -> int:
        """A constant of an enumeration, by its name or its place."""
        if line.found("#"):
            return line.integer()
        enumeration = self._types[type_] if type_ < len(self._types) else None
        return _place_of(line, enumeration)

    # -------------------------------------------------------------------------------- data

    def _variable(self, line: Line, *, is_global: bool) -> None:
        module = line.name()
        line.expect(".")
        label = line.label()
        type_ = self._type(line)
        if (module.upper(), key(label)) in self._places:
            raise line.error(f"there is a variable {module}.{label[0]} already")
        self._places[module.upper(), key(label)] = self._address, type_
        self._data.append(Data(module, label[0], self._number(type_), is_global))
        if line.found("="):
            offset = 0
            while not line.is_done:
                offset = self._initial_value(line, type_, offset)
        self._address += size(type_)

    def _initial_value(self, line: Line, type_: Type, offset: int) -> int:
        """Reads one initial value, or a text; gives the offset behind it."""
        if line.found("@"):
            return line.integer(offset)
        words = [ord(letter) for letter in line.string()] if line.has("string") else [None]
        for word in words:
            if offset >= size(type_):
                raise line.error("there are more values than cells")
            kind = kind_at(type_, offset)
            found = self._word(line, kind) if word is None else word
            self._initial.append((self._address + offset, found))
            offset += 1
        return offset

    def _word(self, line: Line, kind: Type) -> int:
        if line.has("real"):
            return line.real()
        if line.found("!"):
            return _place_of(line, kind)
        if line.found("TRUE"):
            return 1
        return 0 if line.found("FALSE") else line.integer()

    # -------------------------------------------------------------------------------- code

    def _code(self, line: Line) -> None:
        name = line.label()[0]
        kind = _KINDS.get(line.take("word", "a kind of code"))
        if kind is None:
            raise line.error("a code object is a routine, an action or a condition")
        owner = self._code_number(line) if line.found("of") else None
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
                parameters.append(
                    Parameter(label[0], _MODES[word], *self._handed_over(line, _MODES[word]))
                )
                if line.found("from"):
                    captures.append(line.integer(0))
            elif word == "local":
                locals_.append(Local(line.label()[0], self._number(self._type(line))))
            elif word == "result":
                result = self._type_number(line)
            elif word == "stack":
                stack = line.integer(0)
            else:
                raise line.error(f"{word} is nothing that a code object has")
            line.done()
        line.done()
        code = Code(
            *(name, kind, file, start, owner, tuple(parameters), tuple(captures)),
            *(tuple(locals_), result, stack, ()),
        )
        self._codes.append(code)
        self._codes[-1] = replace(code, instructions=self._body(code))

    def _body(self, code: Code) -> tuple[Instruction, ...]:
        """The instructions of a code object, up to ``end``."""
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
        return tuple(self._instruction(line, _Names(targets, frame)) for line in written)

    def _instruction(self, line: Line, names: _Names) -> Instruction:
        name = line.take("word", "an instruction")
        if name not in Op.__members__:
            raise line.error(f"there is no instruction {name}")
        operands: list[int] = []
        for kind in shape(name).operands:
            if name == "PUSH_ENUM" and kind == "count":
                operands.append(self._constant(line, operands[0]))
            else:
                operands.append(self._operand(line, kind, names))
        line.done()
        return Instruction(Op[name], tuple(operands))

    def _operand(self, line: Line, kind: str, names: _Names) -> int:
        """An operand by its name; any can be written as a number."""
        if line.found("#"):
            return line.integer()
        match kind:
            case "real":
                return line.real()
            case "target":
                return _looked_up(line, line.take("word", "a label"), names.targets, "label")
            case "type":
                return self._type_number(line)
            case "code":
                return self._code_number(line)
            case "text" | "ask" | "builtin":
                return _looked_up(line, line.name(), self._labels[kind], kind)
            case "fault":
                slug = line.take("word", "a fault")
                return _looked_up(line, slug, _FAULTS, "fault")
        return line.integer() if line.has("int") else self._named_place(line, kind, names)

    def _named_place(self, line: Line, kind: str, names: _Names) -> int:
        match kind:
            case "bool":
                return self._word(line, BOOL)
            case "char":
                return _letter(line)
            case "local":
                return self._local(line, names)
            case "data":
                return self._data_place(line)
        return line.integer()

    def _local(self, line: Line, names: _Names) -> int:
        label = line.label()
        slot = names.frame.get(key(label))
        if slot is None:
            raise line.error(f"there is no parameter or local {label[0]}")
        if isinstance(slot.variable, Parameter) and slot.variable.mode is not Mode.IN:
            return slot.offset
        return slot.offset + self._offset(line, self._types[slot.variable.type])

    def _data_place(self, line: Line) -> int:
        module = line.name()
        line.expect(".")
        label = line.label()
        place = self._places.get((module.upper(), key(label)))
        if place is None:
            raise line.error(f"there is no variable {module}.{label[0]}")
        return place[0] + self._offset(line, place[1])

    def _offset(self, line: Line, type_: Type) -> int:
        """What follows the name of a variable, ``.X[1,2]``, as an offset."""
        path: list[str | int] = []
        while True:
            if line.found("."):
                path.append(line.name())
            elif line.found("["):
                path.append(line.integer())
                while line.found(","):
                    path.append(line.integer())
                line.expect("]")
            else:
                break
        found = offset_of(type_, path)
        if found is None:
            raise line.error(f"{type_} has no part {path_text(tuple(path))}")
        return found[0]

    def _code_number(self, line: Line) -> int:
        if line.found("#"):
            return line.integer(0)
        label = line.label()
        number = self._code_labels.get(key(label))
        if number is None:
            raise line.error(f"there is no code object {label[0]}")
        return number


@dataclass(frozen=True, slots=True)
class _Names:
    """What the operands of a code object can name."""

    targets: Mapping[str, int]
    frame: Mapping[Key, Slot]


def _constant(line: Line, kind: str) -> Constant:
    if kind == "real":
        return Constant(real_of(line.real()))
    return Constant(line.string() if kind == "string" else line.integer())


def _looked_up(line: Line, name: str, known: Mapping[str, int], what: str) -> int:
    if name not in known:
        raise line.error(f"there is no {what} {name}")
    return known[name]


def _letter(line: Line) -> int:
    letter = line.string()
    if len(letter) != 1:
        raise line.error("one letter is needed")
    return ord(letter)


def _place_of(line: Line, type_: Type | None) -> int:
    """The place of the constant that is named next."""
    name = line.name().upper()
    if isinstance(type_, Enumeration):
        for place, constant in enumerate(type_.constants):
            if constant.upper() == name:
                return place
    raise line.error(f"{name} is no constant of {type_}")
