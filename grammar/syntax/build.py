"""Building the abstract syntax tree: from text to a module, or to all its syntax failures.

The entry point is `read_module`. The nodes of a line come from plans (`grammar.syntax.node_plans`,
`grammar.syntax.statement_rules`), each computed once. Nodes that span lines are built here, from
the innermost block outwards and without recursion, so the depth of nesting has no limit.

A span never includes the line end after a statement.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from operator import add
from typing import Any

from grammar.notation.krl_grammar import krl_grammar
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Outline, Tree
from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.node_plans import MAX_DEPTH, Drafter, Plan, TooDeep
from grammar.syntax.parts import Field, Part, at, each, has, one, value_of, values_of
from grammar.syntax.statement_rules import CHAINS, RULES
from support.lazy_dataclass import dataclass

# The cache of plans is bounded; a plan takes some kilobytes.
_MOST_REMEMBERED = 4_000
_WIDEST_REMEMBERED = 1_000


@dataclass(frozen=True, slots=True)
class SyntaxFailure:
    """Why a text is no module of KRL: one line that cannot be read.

    ``line`` and ``column`` count from 1, ``offset`` from 0. ``text`` is the offending token as
    written, empty at the end of the file. ``expected`` are all tokens that could have come, sorted,
    and ``rule`` is the innermost rule of the grammar that cannot end there. ``follows`` marks a
    failure that is only a consequence of an earlier one. ``reason`` is set if the grammar accepts
    the text but a limit of this builder does not; then nothing is expected.
    """

    path: str
    line: int
    column: int
    offset: int
    text: str
    expected: tuple[str, ...]
    rule: str
    follows: bool
    reason: str | None = None


def read_module(text: str, path: str = "") -> ast.Module | list[SyntaxFailure]:
    """Return the tree of a text under the current grammar, or its failures in order.

    ``path`` is the file, as failures show it.
    """
    return builder().read(text, path)


@cache
def builder() -> Builder:
    """Return the builder for the current grammar; created once in each process."""
    return Builder(Recognizer(krl_grammar()))


class Builder:
    """Builds modules under one version of the grammar; caches the plans of lines."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.parser = Parser(recognizer)
        self.failures = FailureFinder(recognizer)
        self._names = recognizer.lexer.names
        self._drafter = Drafter(self._names, RULES, CHAINS)
        self._plans: dict[Outline | int, Plan] = {}

    def read(self, text: str, path: str = "") -> ast.Module | list[SyntaxFailure]:
        """Return the tree of a text, or its failures in order; see `read_module`."""
        tree = self.parser.parse(text)
        if not isinstance(tree, Tree):
            return [self._failure(found, path) for found in self.failures.find(text)]
        try:
            return self.module(tree)
        except TooDeep as error:
            offset = tree.offsets[error.first]
            lexeme = tree.lexemes[error.first]
            reason = f"nested more than {MAX_DEPTH} deep"
            return [SyntaxFailure(path, *tree.place(offset), offset, lexeme, (), "", False, reason)]

    def module(self, tree: Tree) -> ast.Module:
        """Return the module of a parse tree; raises `TooDeep`."""
        lexemes, starts = tree.lexemes, tree.offsets
        ends = list(map(add, starts, map(len, lexemes)))
        names, plans = self._names, self._plans
        frame = _Frame(tree.outline, 0)
        outer: list[_Frame] = []
        called: set[str] = set()
        at = end = 0  # index of the next token; end offset of the last one that was no line end
        while True:
            pieces = frame.pieces
            for child in frame.children:  # an iterator: continues where it stopped
                if not isinstance(child, Outline):
                    end = ends[at]
                    pieces.append(Part(names[child], lexemes[at], starts[at], end))
                    at += 1
                    continue
                if child.rule == "eol":
                    at += child.width
                    continue
                inner = child.children[0] if child.rule == "statement" else child
                plan = plans.get(inner) or self._plan(inner, at)
                if plan is not None:
                    value = plan.run(lexemes, starts, ends, at)
                    start, end = starts[at], ends[at + plan.width - 1]
                    pieces.append(Part(child.rule, value, start, end))
                    if plan.calls:
                        called.update(lexemes[at + token].upper() for token in plan.calls)
                    at += child.width
                else:
                    outer.append(frame)
                    frame = _Frame(child, starts[at])
                    break
            else:
                value = _BLOCKS[frame.rule]((frame.start, end), pieces)
                if not outer:
                    assert isinstance(value, ast.Module)
                    return replace(value, called=frozenset(called))
                piece = Part(frame.rule, value, frame.start, end)
                frame = outer.pop()
                frame.pieces.append(piece)

    def _plan(self, outline: Outline | int, first: int) -> Plan | None:
        """Return the plan of a rule within a line; ``None`` if the rule can span lines."""
        if not isinstance(outline, Outline) or outline.rule in _BLOCKS:
            return None
        try:
            plan = self._drafter.plan(_without_end(outline))
        except TooDeep as error:
            raise TooDeep(first + error.first) from None
        if outline.width <= _WIDEST_REMEMBERED:
            if len(self._plans) >= _MOST_REMEMBERED:
                self._plans.clear()
            self._plans[outline] = plan
        return plan

    def _failure(self, failure: Failure, path: str) -> SyntaxFailure:
        context = self.failures.context(failure.state)
        return SyntaxFailure(
            path,
            failure.line,
            failure.column,
            failure.offset,
            failure.text,
            context.expected,
            context.rule,
            failure.follows,
        )


def _without_end(outline: Outline) -> Outline:
    """Return a rule without its line end, which no node includes."""
    *before, last = outline.children or (0,)
    is_end = isinstance(last, Outline) and last.rule == "eol"
    return Outline(outline.rule, tuple(before)) if is_end else outline


class _Frame:
    """A block whose children are being built; ``children`` iterates over the remaining ones."""

    __slots__ = ("children", "pieces", "rule", "start")

    def __init__(self, outline: Outline, start: int) -> None:
        self.children = iter(outline.children)
        self.pieces: list[Part[Any]] = []
        self.rule = outline.rule
        self.start = start


# ------------------------------------------------------------------------ rules that span lines
#: Builds the node of a rule from its span and its children.
_Block = Callable[[Span, Sequence[Part[Any]]], Any]


def _node(kind: Callable[..., ast.Node], *of: Field) -> _Block:
    """Return a function for a rule whose node has these fields."""
    return lambda span, pieces: kind(span, *(field(pieces) for field in of))


def _only(_span: Span, pieces: Sequence[Part[Any]]) -> Any:
    return pieces[0].value


def _module(span: Span, pieces: Sequence[Part[Any]]) -> ast.Module:
    headers = tuple(
        ast.Header((piece.first, piece.stop), piece.value)
        for piece in pieces
        if piece.symbol == "HEADER"
    )
    content: Any = value_of(pieces, "program") or value_of(pieces, "dataList")
    return ast.Module(span, headers, content)


def _routine(span: Span, pieces: Sequence[Part[Any]]) -> ast.Routine:
    name: Any = value_of(pieces, "name")
    parameters = value_of(pieces, "parameters") or ()
    body = values_of(pieces, "statement")
    is_global = pieces[0].symbol == "GLOBAL"
    return ast.Routine(span, is_global, _result(pieces), name, parameters, body)


def _result(pieces: Sequence[Part[Any]]) -> ast.TypeName | None:
    """Return the result type of a function, or ``None`` for a procedure."""
    chosen = [piece for piece in pieces if piece.symbol in ("type", "index")]
    if not chosen:
        return None
    span = chosen[0].first, chosen[-1].stop
    return ast.TypeName(span, chosen[0].value, value_of(chosen, "index"))


def _data_list(span: Span, pieces: Sequence[Part[Any]]) -> ast.DataList:
    is_public = has(pieces[:3], "PUBLIC")
    return ast.DataList(span, pieces[1].value, is_public, values_of(pieces, "initialisation"))


def _if(span: Span, pieces: Sequence[Part[Any]]) -> ast.If:
    condition, otherwise = pieces[1].value, None
    for place, piece in enumerate(pieces):
        if piece.symbol == "ELSE":
            otherwise = values_of(pieces[place:], "statement")
            pieces = pieces[:place]
            break
    return ast.If(span, condition, values_of(pieces, "statement"), otherwise)


def _for(span: Span, pieces: Sequence[Part[Any]]) -> ast.For:
    first, last, *step = values_of(pieces, "expression")
    body = values_of(pieces, "statement")
    return ast.For(span, pieces[1].value, first, last, step[0] if step else None, body)


def _default(_span: Span, pieces: Sequence[Part[Any]]) -> tuple[ast.Statement, ...]:
    return values_of(pieces, "statement")


def _spline_block(span: Span, pieces: Sequence[Part[Any]]) -> ast.SplineBlock:
    values, items = value_of(pieces, "with") or (), values_of(pieces, "splineItem")
    is_approximated = pieces[-1].symbol == "C_SPL"
    return ast.SplineBlock(span, pieces[0].symbol, values, items, is_approximated)


_BLOCKS: Mapping[str, _Block] = {
    "module": _module,
    "program": _node(ast.Program, each("routine")),
    "routine": _only,
    "procedure": _routine,
    "function": _routine,
    "dataList": _data_list,
    "statement": _only,
    "ifStatement": _if,
    "forStatement": _for,
    "whileStatement": _node(ast.While, at(1), each("statement")),
    "repeatStatement": _node(ast.Repeat, each("statement"), at(-1)),
    "loopStatement": _node(ast.Loop, each("statement")),
    "switchStatement": _node(ast.Switch, at(1), each("caseBranch"), one("defaultBranch")),
    "caseBranch": _node(ast.CaseBranch, each("caseValue"), each("statement")),
    "defaultBranch": _default,
    "splineBlock": _spline_block,
}
#: Rules that span lines; any other rule ends on its line, except ``eol``.
BLOCK_RULES = frozenset(_BLOCKS)
