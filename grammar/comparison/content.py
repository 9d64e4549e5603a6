"""The content of a file that is compared: without headers, comments, folds and layout.

Code is compared by lines, so that a file with syntax errors can be compared too; data by names.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from grammar.check.project.project_check import read_source
from grammar.diagnostics.open_blocks import lead
from grammar.syntax import ast
from grammar.syntax.source import Source
from grammar.syntax.unparse import expression

_TOKEN = re.compile(r'"[^"]*"|[$#]?[A-Za-z_]\w*|\d+\.?\d*(?:E[-+]?\d+)?|\.\d+|[<>=]=|<>|\S', re.I)
_OPENERS = frozenset({"DEF", "DEFFCT"})
_CLOSERS = frozenset({"END", "ENDFCT"})
_LISTS = frozenset({"DEFDAT", "ENDDAT"})


@dataclass(frozen=True, slots=True)
class CodeLine:
    """A line of code: its number from 1, its text, and a ``key`` that is equal for equal lines.

    Letter case, blanks and trailing zeros of numbers do not change the key.
    """

    number: int
    text: str
    key: str


@dataclass(frozen=True, slots=True)
class RoutineText:
    """A routine: its first line and the lines up to its end.

    ``signature`` is the key of the first line without the name. The lines outside all routines form
    one routine without a name.
    """

    name: str
    head: CodeLine
    signature: str
    body: tuple[CodeLine, ...]

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of the lines in the body."""
        return tuple(line.key for line in self.body)


@dataclass(frozen=True, slots=True)
class Datum:
    """An item of a data list: a variable with its type and initial value, or another declaration.

    ``key`` is equal for equal items; ``value`` is the tree of the initial value.
    """

    name: str
    type: str
    line: int
    text: str
    key: str
    value: ast.Expression | None


@dataclass(frozen=True, slots=True)
class Content:
    """A file by its path: its routines in order, and the items of its data list by name."""

    path: str
    routines: tuple[RoutineText, ...]
    data: Mapping[str, Datum]

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of everything in the file."""
        lines = [key for routine in self.routines for key in (routine.signature, *routine.keys)]
        return (*lines, *(datum.key for datum in self.data.values()))


def content_of(source: Source) -> Content:
    """Return the content of a file; parts of a data list with syntax errors are kept as lines."""
    syntax = read_source(source).syntax if source.path.lower().endswith(".dat") else None
    data = {}
    lines = list(_code(source))
    if syntax is not None and isinstance(syntax.content, ast.DataList):
        data = {datum.name.upper(): datum for datum in _data(source, syntax.content)}
        known = {n for item in syntax.content.items for n in _lines_of(source, item)}
        lines = [
            line for line in lines if line.number not in known and lead(line.text) not in _LISTS
        ]
    return Content(source.path, tuple(_routines(lines)), data)


def _code(source: Source) -> Iterator[CodeLine]:
    for number, line in enumerate(source.lines, 1):
        comment = source.comment(number)
        text = line if comment is None else line[: comment.column - 1]
        text = text.strip()
        if text and not text.startswith("&"):
            yield CodeLine(number, text, _key(text))


def _key(text: str) -> str:
    return " ".join(map(_normal, _TOKEN.findall(text)))


def _normal(token: str) -> str:
    if token[0] == '"':
        return token
    if token[0].isdigit() or (token[0] == "." and len(token) > 1):
        return f"{float(token):.12g}" if not token.isdigit() else token.lstrip("0") or "0"
    return token.upper()


def _routines(lines: list[CodeLine]) -> Iterator[RoutineText]:
    head: CodeLine | None = None
    body: list[CodeLine] = []
    loose: list[CodeLine] = []
    for line in lines:
        word = lead(line.text)
        if word in _OPENERS:
            if head is not None:
                yield _routine(head, body)
            head, body = line, []
        elif head is None:
            loose.append(line)
        elif word in _CLOSERS and line.key in _CLOSERS:
            yield _routine(head, body)
            head = None
        else:
            body.append(line)
    if head is not None:
        yield _routine(head, body)
    if loose:
        yield RoutineText("", loose[0], "", tuple(loose))


def _routine(head: CodeLine, body: list[CodeLine]) -> RoutineText:
    name = re.search(r"([$\w]+)\s*\(", head.text)
    if name is None:
        return RoutineText(head.text.split()[-1], head, head.key, tuple(body))
    signature = _key(head.text[: name.start(1)] + head.text[name.end(1) :])
    return RoutineText(name[1], head, signature, tuple(body))


# -------------------------------------------------------------------------------------------- data


def _data(source: Source, content: ast.DataList) -> Iterator[Datum]:
    for item in content.items:
        line = source.place(item.span[0])[0]
        if isinstance(item, ast.VariableDeclaration):
            for one in item.declarators:
                sizes = "" if one.indices is None else f"[{len(one.indices)}]"
                yield _datum(one.name.text, item.type.text + sizes, line, source, one.value, one)
        elif isinstance(item, ast.Assignment):
            yield _datum(expression(item.target), "", line, source, item.value, item)
        else:
            name = getattr(item, "name", None)
            said = name.text if isinstance(name, ast.Name) else _text(source, item)
            kind = type(item).__name__.upper()
            yield _datum(said, kind, line, source, None, item)


def _datum(
    name: str, type_: str, line: int, source: Source, value: ast.Expression | None, item: ast.Node
) -> Datum:
    text = _text(source, item if value is None else value)
    return Datum(name, type_, line, text, f"{type_.upper()} {_key(text)}", value)


def _text(source: Source, node: ast.Node) -> str:
    return " ".join(source.text[node.span[0] : node.span[1]].split())


def _lines_of(source: Source, item: ast.Node) -> range:
    return range(source.place(item.span[0])[0], source.place(item.span[1])[0] + 1)
