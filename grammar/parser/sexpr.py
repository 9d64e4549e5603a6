"""Parse trees as S-expressions, the expected results of the syntax cases.

A rule is ``(rule child …)``, a token its text. Whatever a reader can infer is left out: tokens that
the rule always has, brackets, separators between two children, line ends, and rules that read
nothing. A rule that then has a single child is replaced by it, unless a token other than a line end
was left out. So ``X = 1 + A[2]`` is ``(assignment X (sum 1 + (variable A (index 2))))``, however
many levels of precedence lie between.

The functions recurse over the depth of a tree: they are made for trees that people read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from grammar.notation.model import Alternative, Element, Grammar, Group, Literal, Reference, Repeat
from grammar.parser.tree import ParseNode, Token, Tree

#: A token's text, or the name of a rule and what it consists of.
Expression = str | tuple["Expression", ...]

_BRACKETS = frozenset("()[]{}")
_SEPARATORS = frozenset(",.")
_LINE_END = "NEWLINE"
# an atom with blanks or parentheses is put in backquotes, which KRL does not have
_PLAIN = re.compile(r"\"[^\"\n]*\"|[^\s()`\"]+")
_WIDTH = 88


class Shortener:
    """Makes S-expressions from the parse trees of one grammar."""

    def __init__(self, grammar: Grammar) -> None:
        fixed = frozenset(grammar.literal_tokens.values())
        self._needed = {
            rule.name: fixed.intersection(
                *(frozenset(_needed(grammar, a.elements)) for a in rule.alternatives)
            )
            for rule in grammar.parser_rules
        }

    def expression(self, tree: Tree) -> Expression:
        """Return the S-expression of a tree."""
        return self._of(tree.root)

    def _of(self, node: ParseNode) -> Expression:
        children = [child for child in node.children if not _says_nothing(child)]
        only = children[0] if len(children) == 1 else None
        if isinstance(only, ParseNode):
            return self._of(only)
        if isinstance(only, Token) and not self._is_known(node.rule, only):
            return only.text
        shown: list[Expression] = [node.rule]
        for before, child, after in _with_neighbours(children):
            if isinstance(child, ParseNode):
                shown.append(self._of(child))
            elif not self._is_known(node.rule, child) and not (
                child.text in _SEPARATORS and _are_items(before, after)
            ):
                shown.append(child.text)
        return tuple(shown)

    def _is_known(self, rule: str, token: Token) -> bool:
        return token.kind in self._needed[rule] or token.text in _BRACKETS


def _needed(grammar: Grammar, elements: Iterable[Element]) -> Iterator[str]:
    """Yield the names of the tokens that a sequence of elements always has itself."""
    for element in elements:
        match element:
            case Reference() if not element.is_token:
                pass
            case Reference() | Literal():
                yield grammar.token_of(element)
            case Group(alternatives=(Alternative(elements=inner),)):
                yield from _needed(grammar, inner)
            case Repeat(item=item, operator="+"):
                yield from _needed(grammar, [item])


def _says_nothing(child: ParseNode | Token) -> bool:
    """Return whether a child consists only of line ends or the end of the file, or is empty."""
    if isinstance(child, Token):
        return child.kind in (_LINE_END, "EOF")
    names, kinds = child.tree.lexer.names, child.tree.kinds[child.first : child.stop]
    return all(names[kind] == _LINE_END for kind in kinds)


def _with_neighbours(
    children: Sequence[ParseNode | Token],
) -> Iterator[tuple[ParseNode | Token | None, ParseNode | Token, ParseNode | Token | None]]:
    return zip([None, *children], children, [*children[1:], None], strict=False)


def _are_items(*children: ParseNode | Token | None) -> bool:
    """Return whether all children exist and none is a bracket or separator."""
    return all(
        isinstance(child, ParseNode)
        or (child is not None and child.text not in _BRACKETS | _SEPARATORS)
        for child in children
    )


# ------------------------------------------------------------------------------------ as text


def write(expression: Expression, width: int = _WIDTH) -> str:
    """Return the expression as text, broken into lines if it is longer than ``width``."""
    return "\n".join(_lines(expression, width))


def _lines(expression: Expression, width: int) -> Iterator[str]:
    flat = _flat(expression)
    inner = (i for i, e in enumerate(expression) if not isinstance(e, str))
    # the name of the rule and the tokens it begins with stay on the first line
    lead = next(inner, None)
    if len(flat) <= width or lead is None:
        yield flat
        return
    rest = [f"  {line}" for line in _inner_lines(expression[lead:], width - 2)]
    yield from [f"({' '.join(map(_flat, expression[:lead]))}", *rest[:-1]]
    yield f"{rest[-1]})"


def _inner_lines(children: Iterable[Expression], width: int) -> Iterator[str]:
    """Yield each rule on lines of its own; the tokens between two rules share one."""
    for are_tokens, run in groupby(children, lambda child: isinstance(child, str)):
        if are_tokens:
            yield " ".join(map(_flat, run))
        else:
            for child in run:
                yield from _lines(child, width)


def _flat(expression: Expression) -> str:
    if isinstance(expression, str):
        return expression if _PLAIN.fullmatch(expression) else f"`{expression}`"
    return f"({' '.join(map(_flat, expression))})"
