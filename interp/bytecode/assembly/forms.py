"""How lines of the text form are written: one description, for reading and for writing.

`LINES` has what follows the first word of a line, `operands` what follows the name of an
instruction. In place of any name or constant there may be its number, as ``#5``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import groupby
from typing import Any, NamedTuple

from grammar.semantics.types import BOOL, CHAR, REAL, Enumeration, Member, Structure, Type
from interp.bytecode.assembly.names import Area, Names, type_text
from interp.bytecode.assembly.syntax import Line, name_text, real_text, string_text
from interp.bytecode.cell_layout import bits_of, kind_at, real_of, size
from interp.bytecode.instruction_set.table import shape
from interp.bytecode.program import (
    DEEPEST,
    Argument,
    Ask,
    Builtin,
    Changed,
    Choice,
    CodeKind,
    Constant,
    Handle,
    Input,
    Items,
    Mode,
    Record,
    part_kind,
)
from interp.values.faults import FAULTS


class Form(NamedTuple):
    """How something is read from a line, and how it is written."""

    read: Callable[[Names, Line], Any]
    text: Callable[[Names, Any], str]


#: A part of a row: marks and words, a form, or a form that depends on the values before it.
_Piece = str | Form | Callable[[Names, Sequence[Any]], Form]


def row(*pieces: _Piece) -> Form:
    """Return the form of a tuple, the values of the forms among these pieces."""

    def read(names: Names, line: Line) -> tuple[Any, ...]:
        found: list[Any] = []
        for piece in pieces:
            if not isinstance(piece, str):
                form = piece if isinstance(piece, Form) else piece(names, found)
                found.append(form.read(names, line))
            elif piece.strip():
                line.expect(piece.strip())
        return tuple(found)

    def text(names: Names, values: Sequence[Any]) -> str:
        left = iter(values)
        written = ""
        for piece in pieces:
            if isinstance(piece, str):
                written += piece
            else:
                form = piece if isinstance(piece, Form) else piece(names, values)
                written += form.text(names, next(left))
        return written

    return Form(read, text)


def _record(make: Any, *pieces: _Piece) -> Form:
    """Return the form of a dataclass whose first fields are those of a row."""
    fields = make.__match_args__[: sum(not isinstance(piece, str) for piece in pieces)]
    form = row(*pieces)
    return Form(
        lambda names, line: make(*form.read(names, line)),
        lambda names, value: form.text(names, [getattr(value, field) for field in fields]),
    )


def _simple(read: Callable[[Line], Any], text: Callable[[Any], str]) -> Form:
    """Return a form that depends on no names."""
    return Form(lambda _, line: read(line), lambda _, value: text(value))


def _many(item: Form) -> Form:
    """Return the form of a tuple of any length, each item after a blank."""

    def read(names: Names, line: Line) -> tuple[Any, ...]:
        found = []
        while line.peek() is not None and not line.at("->", ")", "}"):
            found.append(item.read(names, line))
        return tuple(found)

    return Form(
        read, lambda names, items: "".join(f" {item.text(names, value)}" for value in items)
    )


def _marked(mark: str, form: Form) -> Form:
    """Return the form of something that follows a mark."""
    both = row(mark, form)
    return Form(
        lambda names, line: both.read(names, line)[0],
        lambda names, value: both.text(names, (value,)),
    )


def _maybe(mark: str, form: Form) -> Form:
    """Return the form of something that follows a mark, or is ``None``."""
    return Form(
        lambda names, line: form.read(names, line) if line.found(mark.strip()) else None,
        lambda names, value: "" if value is None else mark + form.text(names, value),
    )


def _one_of(words: Mapping[str, Any], otherwise: str) -> Form:
    """Return the form of the values of some words; ``otherwise`` says that it is none of them."""
    back = {value: word for word, value in words.items()}

    def read(line: Line) -> Any:
        word = line.take("word", "a word")
        if word not in words:
            raise line.error(otherwise.format(word))
        return words[word]

    return _simple(read, back.__getitem__)


def _numbered(form: Form) -> Form:
    """Return a form that may also be read as a number, ``#5``."""
    return Form(
        lambda names, line: line.integer() if line.found("#") else form.read(names, line),
        form.text,
    )


def _bare(form: Form) -> Form:
    """Return a form that may also be read as a number, ``#5`` or ``5``."""
    return _numbered(
        Form(
            lambda names, line: line.integer() if line.has("int") else form.read(names, line),
            form.text,
        )
    )


# -------------------------------------------------------------------------------- words

_COUNT = _simple(lambda line: line.integer(0), str)
_INTEGER = _numbered(_simple(Line.integer, str))
_REAL = _numbered(_simple(Line.real, real_text))
_NAME = _simple(Line.name, name_text)
_STRING = _simple(Line.string, string_text)
_FLAG = _bare(_one_of({"FALSE": 0, "TRUE": 1}, "{} is neither TRUE nor FALSE"))
_MODE = _one_of({mode.value: mode for mode in Mode}, "{} is no part of a request")
_FAULT = _numbered(
    _one_of({slug: kind.code for slug, kind in FAULTS.items()}, "there is no fault {}")
)
_KIND = _one_of(
    {kind.value: kind for kind in CodeKind},
    "a code object is a routine, an action or a condition",
)
_LABEL = _simple(Line.label, str)
_DATA_LABEL = _simple(lambda line: line.label(2), str)
_WHOLE_TYPE = Form(Names.read_type, lambda _, type_: type_text(type_))
_TYPE = _numbered(
    Form(
        lambda names, line: names.number_of(names.read_type(line)),
        lambda names, number: type_text(names.types[number]),
    )
)


def _letter(line: Line) -> int:
    letter = line.string()
    if len(letter) != 1:
        raise line.error("one letter is needed")
    return ord(letter)


_LETTER = _bare(_simple(_letter, lambda letter: string_text(chr(letter))))


def _dimensions(line: Line) -> int:
    if not line.found("["):
        return 0
    count = 1
    while line.found(","):
        count += 1
    line.expect("]")
    return count


#: The dimensions of a view, ``[,]``.
_DIMENSIONS = _simple(_dimensions, lambda count: f"[{',' * (count - 1)}]" if count else "")


def _named(kind: str) -> Form:
    """Return the form of the number of something that is named by operands of a kind."""
    return _numbered(
        Form(
            lambda names, line: names.tables[kind].read(line),
            lambda names, number: str(names.tables[kind].labels[number]),
        )
    )


_CODE, _DATA = _named("code"), _named("data")


def _constant(type_: Type) -> Form:
    """Return the form of a constant of an enumeration, given by its index."""
    constants = type_.constants if isinstance(type_, Enumeration) else ()

    def read(line: Line) -> int:
        name = line.name().upper()
        for place, constant in enumerate(constants):
            if constant.upper() == name:
                return place
        raise line.error(f"{name} is no constant of {type_}")

    return _numbered(_simple(read, lambda place: name_text(constants[place])))


def _constant_of_first(names: Names, values: Sequence[Any]) -> Form:
    return _constant(names.type_at(values[0]))


# ----------------------------------------------------------------------------- requests


def _read_part(names: Names, line: Line) -> Argument:
    token = line.peek()
    if token is None:
        raise line.error("a part is missing")
    start = token.text if token.kind in ("word", "mark") else token.kind
    if start not in _STARTS:
        raise line.error(f"{token.text} is no part of a request")
    if line.depth > DEEPEST:
        raise line.error("parts are nested too deeply")
    line.depth += 1
    found: Argument = _PARTS[_STARTS[start]].read(names, line)
    line.depth -= 1
    return found


def _read_passed(names: Names, line: Line) -> Input | Changed:
    start = line.place
    found: Input | Changed = _INPUT.read(names, line)
    if line.at("="):
        line.place = start
        found = _CHANGED.read(names, line)
    return found


def _read_place(line: Line) -> int:
    token = line.peek()
    has_place = token is not None and token.kind == "int" and token.text.startswith("+")
    return line.integer(1) if has_place else 0


_PART = Form(_read_part, lambda names, part: _PARTS[part_kind(part)].text(names, part))
_LIST = _many(_PART)
_PATH = _record(Items, Form(_LIST.read, lambda names, parts: _LIST.text(names, parts)[1:]), ")")
_INPUT = _record(Input, _MODE, ":", _TYPE, _DIMENSIONS)
_CHANGED = _record(Changed, _INPUT, "=", _maybe("@", _COUNT), _maybe("(", _PATH))
_FIXED = {"nil": Constant(None), "FALSE": Constant(False), "TRUE": Constant(True)}
_PARTS: Mapping[object, Form] = {
    **dict.fromkeys((None, False, True), _one_of(_FIXED, "")),
    int: _record(Constant, _simple(Line.integer, str)),
    float: _record(
        Constant,
        _simple(lambda line: real_of(line.real()), lambda number: real_text(bits_of(number))),
    ),
    str: _record(Constant, _STRING),
    Choice: _record(Choice, "!", _TYPE, ".", _constant_of_first),
    Input: Form(_read_passed, _INPUT.text),
    Changed: _CHANGED,
    Handle: _record(Handle, "&", _CODE),
    Items: _marked("(", _PATH),
    Record: _record(
        *(Record, "{", _NAME),
        _simple(_read_place, lambda line: f" +{line}" if line else ""),
        *(_LIST, "}"),
    ),
}
#: How each kind begins; what can be changed begins as an input.
_STARTS: Mapping[str, object] = {
    **{word: constant.value for word, constant in _FIXED.items()},
    **dict(zip(("int", "real", "string"), (int, float, str), strict=True)),
    **dict(zip("!&({", (Choice, Handle, Items, Record), strict=True)),
    **{mode.value: Input for mode in Mode},
}

# --------------------------------------------------------------------------------- data


def _word(kind: Type) -> Form:
    """Return the form of the contents of a cell."""
    if isinstance(kind, Enumeration):
        return _bare(_marked("!", _constant(kind)))
    return _bare(_REAL) if kind == REAL else _FLAG if kind == BOOL else _INTEGER


def _values(type_: Type) -> Form:
    """Return the form of initial values, pairs of offset and word: ``1 2 @10 "text" 3.0``."""

    def read(names: Names, line: Line) -> list[tuple[int, int]]:
        found: list[tuple[int, int]] = []
        offset, end = 0, size(type_)
        while line.peek() is not None:
            if line.found("@"):
                offset = line.integer(offset)
                continue
            if line.has("string"):
                words = [ord(letter) for letter in line.string()]
            else:
                words = [_word(kind_at(type_, min(offset, end - 1))).read(names, line)]
            found += enumerate(words, offset)
            offset += len(words)
            if offset > end:
                raise line.error("there are more values than cells")
        return found

    def text(names: Names, pairs: Sequence[tuple[int, int]]) -> str:
        written, end = [], 0
        kinds = [kind_at(type_, offset) for offset, _ in pairs]
        for (_, is_text), run in groupby(
            enumerate(pairs), lambda one: (one[1][0] - one[0], kinds[one[0]] == CHAR)
        ):
            numbers, values = zip(*run, strict=True)
            start, words = values[0][0], [word for _, word in values]
            if start != end:
                written.append(f"@{start}")
            end = start + len(words)
            if is_text:
                written.append(string_text("".join(map(chr, words))))
            else:
                of = zip(numbers, words, strict=True)
                written += (_word(kinds[number]).text(names, word) for number, word in of)
        return " ".join(written)

    return Form(read, text)


def _imported(line: Line) -> tuple[str, ...]:
    names = [line.name()]
    line.expect(".")
    names.append(line.name())
    return (*names, line.name()) if line.found(".") else tuple(names)


# -------------------------------------------------------------------------------- lines

#: Entries of the tables of requests and of predefined functions.
ENTRIES: Mapping[str, Form] = {
    kind: _record(make, _NAME, _LIST, _maybe(" -> ", _TYPE))
    for kind, make in {"ask": Ask, "builtin": Builtin}.items()
}
_VARIABLE = row(
    *(_DATA_LABEL, " ", _TYPE),
    lambda names, values: _maybe(" = ", _values(names.type_at(values[1]))),
)
_PASSED = row(_LABEL, " ", _TYPE, _DIMENSIONS, _maybe(" from ", _COUNT))
#: What follows the first word of a line.
LINES: Mapping[str, Form] = {
    "bytecode": _COUNT,
    "struct": _record(Structure, _NAME, _many(_record(Member, _NAME, ":", _WHOLE_TYPE))),
    "enum": _record(Enumeration, _NAME, _many(_NAME)),
    "array": _WHOLE_TYPE,
    "text": row(_LABEL, " ", _STRING),
    **{kind: row(_LABEL, " ", entry) for kind, entry in ENTRIES.items()},
    "data": _VARIABLE,
    "global": _VARIABLE,
    "import": row(_simple(_imported, lambda names: ".".join(map(name_text, names))), " ", _DATA),
    "code": row(*(_LABEL, " ", _KIND, _maybe(" of ", _CODE), " ", _STRING, " ", _COUNT)),
    **{mode.value: _PASSED for mode in Mode},
    "local": row(_LABEL, " ", _TYPE),
    "result": _TYPE,
    "stack": _COUNT,
    "begin": row(),
}

_OPERANDS: Mapping[str, Form] = {
    **dict.fromkeys(("int", "count", "line"), _INTEGER),
    **dict(zip(("real", "bool", "char", "type"), (_REAL, _FLAG, _LETTER, _TYPE), strict=True)),
    "fault": _FAULT,
    **{kind: _named(kind) for kind in ("target", "text", "code", "ask", "builtin")},
}


@cache
def operands(name: str) -> Form:
    """Return the form of the operands of an instruction."""
    kinds = shape(name).operands
    pieces: list[_Piece] = []
    for kind in kinds:
        if kind in ("local", "data"):
            pieces += " ", _cell(kind, is_typed=kinds[1:2] == ("type",))
        elif name == "PUSH_ENUM" and kind == "count":
            pieces += " ", _constant_of_first
        else:
            pieces += " ", _OPERANDS[kind]
    return row(*pieces)


def _cell(kind: str, *, is_typed: bool) -> _Piece:
    """Return the form of a cell, or of a part whose type is the next operand."""

    def form(names: Names, values: Sequence[Any]) -> Form:
        area = names.tables[kind]
        assert isinstance(area, Area), "both kinds are of cells"
        wanted = names.types[values[1]] if is_typed and len(values) > 1 else None
        return _bare(
            Form(lambda _, line: area.address(line), lambda _, cell: area.text(cell, wanted))
        )

    return form
