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
from typing import Any, NamedTuple

from grammar.notation.krl_grammar import krl_grammar
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Outline, Tree
from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.node_plans import MAX_DEPTH, Plan, TooDeep, draft
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
                    pieces.append(_Piece(names[child], lexemes[at], starts[at], end))
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
                    pieces.append(_Piece(child.rule, value, start, end))
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
                piece = _Piece(frame.rule, value, frame.start, end)
                frame = outer.pop()
                frame.pieces.append(piece)

    def _plan(self, outline: Outline | int, first: int) -> Plan | None:
        """Return the plan of a rule within a line; ``None`` if the rule can span lines."""
        if not isinstance(outline, Outline) or outline.rule in _BLOCKS:
            return None
        try:
            plan = draft(_without_end(outline), self._names, RULES, CHAINS)
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


class _Piece(NamedTuple):
    """A child of a block: a token with its text, or a rule with its node. No line ends.

    ``start`` and ``end`` are offsets.
    """

    symbol: str
    value: Any
    start: int
    end: int


class _Frame:
    """A block whose children are being built; ``children`` iterates over the remaining ones."""

    __slots__ = ("children", "pieces", "rule", "start")

    def __init__(self, outline: Outline, start: int) -> None:
        self.children = iter(outline.children)
        self.pieces: list[_Piece] = []
        self.rule = outline.rule
        self.start = start


# ------------------------------------------------------------------------ rules that span lines


def _value(pieces: Sequence[_Piece], symbol: str) -> Any:
    """Return the value of the first piece of this kind, or ``None`` if there is none."""
    return next((piece.value for piece in pieces if piece.symbol == symbol), None)


def _values(pieces: Sequence[_Piece], symbol: str) -> tuple[Any, ...]:
    return tuple([piece.value for piece in pieces if piece.symbol == symbol])


def _has(pieces: Sequence[_Piece], symbol: str) -> bool:
    return any(piece.symbol == symbol for piece in pieces)


def _only(_span: Span, pieces: Sequence[_Piece]) -> Any:
    return pieces[0].value


def _module(span: Span, pieces: Sequence[_Piece]) -> ast.Module:
    headers = tuple(
        ast.Header((piece.start, piece.end), piece.value)
        for piece in pieces
        if piece.symbol == "HEADER"
    )
    content = _value(pieces, "program") or _value(pieces, "dataList")
    return ast.Module(span, headers, content)


def _program(span: Span, pieces: Sequence[_Piece]) -> ast.Program:
    return ast.Program(span, _values(pieces, "routine"))


def _routine(span: Span, pieces: Sequence[_Piece]) -> ast.Routine:
    name = _value(pieces, "name")
    parameters = _value(pieces, "parameters") or ()
    body = _values(pieces, "statement")
    is_global = pieces[0].symbol == "GLOBAL"
    return ast.Routine(span, is_global, _result(pieces), name, parameters, body)


def _result(pieces: Sequence[_Piece]) -> ast.TypeName | None:
    """Return the result type of a function, or ``None`` for a procedure."""
    chosen = [piece for piece in pieces if piece.symbol in ("type", "index")]
    if not chosen:
        return None
    span = chosen[0].start, chosen[-1].end
    return ast.TypeName(span, chosen[0].value, _value(chosen, "index"))


def _data_list(span: Span, pieces: Sequence[_Piece]) -> ast.DataList:
    is_public = _has(pieces[:3], "PUBLIC")
    return ast.DataList(span, pieces[1].value, is_public, _values(pieces, "initialisation"))


def _if(span: Span, pieces: Sequence[_Piece]) -> ast.If:
    condition = pieces[1].value
    for place, piece in enumerate(pieces):
        if piece.symbol == "ELSE":
            body, otherwise = pieces[:place], pieces[place:]
            return ast.If(
                span, condition, _values(body, "statement"), _values(otherwise, "statement")
            )
    return ast.If(span, condition, _values(pieces, "statement"), None)


def _for(span: Span, pieces: Sequence[_Piece]) -> ast.For:
    first, last, *step = _values(pieces, "expression")
    body = _values(pieces, "statement")
    return ast.For(span, pieces[1].value, first, last, step[0] if step else None, body)


def _while(span: Span, pieces: Sequence[_Piece]) -> ast.While:
    return ast.While(span, pieces[1].value, _values(pieces, "statement"))


def _repeat(span: Span, pieces: Sequence[_Piece]) -> ast.Repeat:
    return ast.Repeat(span, _values(pieces, "statement"), pieces[-1].value)


def _loop(span: Span, pieces: Sequence[_Piece]) -> ast.Loop:
    return ast.Loop(span, _values(pieces, "statement"))


def _switch(span: Span, pieces: Sequence[_Piece]) -> ast.Switch:
    branches = _values(pieces, "caseBranch")
    return ast.Switch(span, pieces[1].value, branches, _value(pieces, "defaultBranch"))


def _case(span: Span, pieces: Sequence[_Piece]) -> ast.CaseBranch:
    return ast.CaseBranch(span, _values(pieces, "caseValue"), _values(pieces, "statement"))


def _default(_span: Span, pieces: Sequence[_Piece]) -> tuple[ast.Statement, ...]:
    return _values(pieces, "statement")


def _spline_block(span: Span, pieces: Sequence[_Piece]) -> ast.SplineBlock:
    values, items = _value(pieces, "with") or (), _values(pieces, "splineItem")
    is_approximated = pieces[-1].symbol == "C_SPL"
    return ast.SplineBlock(span, pieces[0].symbol, values, items, is_approximated)


_BLOCKS: Mapping[str, Callable[[Span, Sequence[_Piece]], Any]] = {
    "module": _module,
    "program": _program,
    "routine": _only,
    "procedure": _routine,
    "function": _routine,
    "dataList": _data_list,
    "statement": _only,
    "ifStatement": _if,
    "forStatement": _for,
    "whileStatement": _while,
    "repeatStatement": _repeat,
    "loopStatement": _loop,
    "switchStatement": _switch,
    "caseBranch": _case,
    "defaultBranch": _default,
    "splineBlock": _spline_block,
}

#: Rules that span lines; any other rule ends on its line, except ``eol``.
BLOCK_RULES = frozenset(_BLOCKS)
