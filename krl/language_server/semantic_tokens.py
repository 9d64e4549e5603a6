"""Semantic tokens: the kind of each name in a file. Keywords are left to the editor's grammar."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from grammar.semantics.symbols import Kind
from krl.language_server.workspace import AnalysedFile

#: Types and modifiers of the protocol, in the order of their numbers there.
TYPES: Final = (
    "function", "variable", "parameter", "property", "enumMember", "type", "struct", "enum", "event"
)  # fmt: skip
MODIFIERS: Final = ("declaration", "readonly", "defaultLibrary")
_TYPE_OF: Final = {
    Kind.ROUTINE: "function",
    Kind.EXTERNAL: "function",
    Kind.PARAMETER: "parameter",
    Kind.MEMBER: "property",
    Kind.ENUM_CONSTANT: "enumMember",
    Kind.PLAIN_TYPE: "type",
    Kind.STRUCTURE: "struct",
    Kind.ENUMERATION: "enum",
    Kind.SIGNAL: "event",
}


def semantic_tokens(looked: AnalysedFile) -> Iterator[tuple[int, int, int, int]]:
    """Yield offset, length, token type and modifier bits of each known name, in order.

    Labels have no token.
    """
    for name, found in sorted(looked.names(), key=lambda one: one[0].span):
        symbol = found.symbol
        if symbol.kind is Kind.LABEL:
            continue
        is_declared_here = found.module is looked.module and symbol.span == name.span
        flags = (is_declared_here, symbol.kind is Kind.CONSTANT, found.module is None)
        start, end = name.span
        if end > start:
            type_ = TYPES.index(_TYPE_OF.get(symbol.kind, "variable"))
            yield start, end - start, type_, sum(flag << n for n, flag in enumerate(flags))
