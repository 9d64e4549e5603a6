"""Printing a syntax tree: one statement on each line, in the style of `krl format`.

How a node is written is declared beside it (`grammar.syntax.ast.template`). Parsing the text gives
an equal tree (`grammar.syntax.walk.same`). Comments, folds and blank lines are not in the tree and
therefore not in the text; `grammar.syntax.formatter` keeps them. In a tree that was not parsed,
operands may bind more weakly than their operator; they are put in parentheses.

Blocks are printed without recursion, expressions with it (`grammar.syntax.node_plans.MAX_DEPTH`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import Any, NamedTuple

from grammar.syntax import ast
from grammar.syntax.walk import BODIES, left_chain

_INDENT = "  "
# A file of a megabyte may have 100,000 nested blocks; fully indented it would need gigabytes.
_DEEPEST = 60
#: Text before, between and after the items of a list.
_LISTS = {"indices": ("[", ",", "]"), "path": ("/", "/", "")}
_FIELD = re.compile(r"<(\w+)(?:\|([^>]*))?>")


def unparse(module: ast.Module) -> str:
    """Return the text of a module, with line feeds as line ends."""
    lines = [header.text for header in module.headers]
    todo: list[tuple[int, str | ast.Node]] = [(0, module.content)]
    while todo:
        depth, node = todo.pop()
        if isinstance(node, str):
            lines.append(indent(depth) + node)
        elif type(node) in BODIES:
            inner = list(_lines(node))
            todo += [(depth + more, item) for more, item in reversed(inner)]
        else:
            lines.append(indent(0 if isinstance(node, ast.Label) else depth) + _text(node))
    return "".join(f"{line}\n" for line in lines)


def indent(depth: int) -> str:
    """Return the indentation of a line that lies in ``depth`` blocks."""
    return _INDENT * min(depth, _DEEPEST)


def expression(node: ast.Expression) -> str:
    """Return the text of an expression."""
    return _text(node)


def _text(node: ast.Node) -> str:
    """Return the text of a node that lies within a line."""
    printer = _PRINTERS.get(type(node))
    if printer is not None:
        return printer(node)
    (line,) = _TEMPLATES[type(node)]
    return line.text(node)


# -------------------------------------------------------------------------------------- templates


class _Field(NamedTuple):
    """A field in a template, and the text to write if it has a value."""

    name: str
    text: str | None

    def of(self, node: ast.Node) -> str:
        value = getattr(node, self.name)
        if self.text is None:
            return _value(self.name, value)
        if value is None or value is False:
            return ""
        if "*" not in self.text:
            return self.text
        written = _value(self.name, value)
        return self.text.replace("*", written) if written else ""


class _Line(NamedTuple):
    """A line of a template; ``body`` is the field whose nodes it stands for, if any."""

    depth: int
    body: str | None
    parts: tuple[str | _Field, ...]

    def text(self, node: ast.Node) -> str:
        return "".join([part if isinstance(part, str) else part.of(node) for part in self.parts])


def _line(line: str) -> _Line:
    text = line.lstrip()
    body = text[2:-2] if text.startswith("<<") else None
    depth = (len(line) - len(text)) // len(_INDENT)
    return _Line(depth, body, tuple(filter(None, _parts(text))))


def _parts(line: str) -> Iterator[str | _Field]:
    end = 0
    for found in _FIELD.finditer(line):
        yield line[end : found.start()]
        yield _Field(found[1], found[2])
        end = found.end()
    yield line[end:]


_TEMPLATES: Mapping[type[ast.Node], tuple[_Line, ...]] = {
    kind: tuple(map(_line, lines)) for kind, lines in ast.TEMPLATES.items()
}


def _value(name: str, value: Any) -> str:
    if isinstance(value, ast.Node):
        return _text(value)
    if isinstance(value, tuple):
        return _list(name, value)
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    return "" if value is None else str(value)


def _list(name: str, items: Sequence[ast.Node | str | None]) -> str:
    if name in _LISTS:
        before, between, after = _LISTS[name]
        return before + between.join(_value("", item) for item in items) + after
    if items and isinstance(items[0], str):
        return " ".join(map(str, items))
    texts = ["" if item is None else f" {_value('', item)}" for item in items]
    return ",".join(texts).removeprefix(" ")


# ----------------------------------------------------------------------------------------- blocks


def _lines(node: ast.Node) -> Iterator[tuple[int, str | ast.Node]]:
    """Yield the lines and nodes of a block, each with its additional indentation."""
    for line in _TEMPLATES[type(node)]:
        if line.body is None:
            text = line.text(node)
            if text:
                yield line.depth, text
            continue
        for number, item in enumerate(getattr(node, line.body) or ()):
            if isinstance(node, ast.Program) and number:
                yield line.depth, ""
            if isinstance(node, ast.DataList) and isinstance(item, ast.Assignment):
                yield line.depth, f"{_text(item.target)}={_text(item.value)}"  # as initial values
            else:
                yield line.depth, item


# -------------------------------------------------------------------------------------- operators

# From the weakest to the tightest, as in the grammar; other nodes are primary.
_RANKS = (
    ("==", "<>", "<", ">", "<=", ">="),
    ("OR", "B_OR"),
    ("EXOR", "B_EXOR"),
    ("AND", "B_AND"),
    ("+", "-"),
    ("*", "/"),
)
_RANK = {operator: rank for rank, operators in enumerate(_RANKS) for operator in operators}
_UNARY = len(_RANKS)
_RANK[":"] = _UNARY + 1


def _rank(node: ast.Expression) -> int:
    match node:
        case ast.Binary(operator=operator):
            return _RANK[operator]
        case ast.Unary():
            return _UNARY
        case _:
            return _UNARY + 2


def _operand(node: ast.Expression, least: int) -> str:
    return _text(node) if _rank(node) >= least else f"({_text(node)})"


def _binary(node: ast.Binary) -> str:
    chain = left_chain(node)
    opened, texts = 0, [_operand(chain[0].left, _RANK[chain[0].operator])]
    for each, outer in zip_longest(chain, chain[1:]):
        rank = _RANK[each.operator]
        sign = ":" if each.operator == ":" else f" {each.operator} "
        texts += (sign, _operand(each.right, rank + 1))
        if outer is not None and rank < _RANK[outer.operator]:
            opened += 1
            texts.append(")")
    return "(" * opened + "".join(texts)


def _unary(node: ast.Unary) -> str:
    blank = " " if node.operator.isalnum() or "_" in node.operator else ""
    return f"{node.operator}{blank}{_operand(node.operand, _UNARY)}"


#: Nodes whose operands may need parentheses.
_PRINTERS: Mapping[type[Any], Callable[[Any], str]] = {ast.Unary: _unary, ast.Binary: _binary}
