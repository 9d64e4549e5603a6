"""Features of ANTLR 4 that the reader of grammars does not support, by their names in ANTLR."""

from __future__ import annotations

import re
from collections.abc import Iterator

# Patterns that may contain others come first; an action may nest braces two levels deep.
_ACTION = r"\{(?>[^{}]++|\{(?>[^{}]++|\{[^{}]*+\})*+\})*+\}"
_PARTS = re.compile(
    rf"""(?P<comment>//[^\r\n]*|/\*(?>[^*]++|\*(?!/))*+(?:\*/|\Z))
    |(?P<options>\boptions\s*\{{[^{{}}]*\}})
    |(?P<named>@\s*[\w:]+\s*{_ACTION})
    |(?P<tokens>\b(?:tokens|channels)\s*\{{[^{{}}]*\}})
    |(?P<predicate>{_ACTION}\s*\?)
    |(?P<action>{_ACTION})
    |(?P<lazy>\.(?P<often>[*+])\?(?P<gap>\s*)(?P<stop>'(?>\\.|[^'\\])'))
    |(?P<set>\[(?>\\.|[^\]\\\r\n])*+\]?)
    |(?P<literal>'(?>\\.|[^'\\\r\n])*+'?)
    |(?P<kind>\b(?:lexer|parser)\s+grammar\b)
    |(?P<import>\bimport\s+\w[^;:]{{0,200}};)
    |(?P<mode>\bmode\s+\w+\s*;)
    |(?P<command>->\s*(?:pushMode|popMode|mode|type|more)\b[^;|]*)
    |(?P<clause>\b(?:returns|locals|throws|catch|finally)\b)
    |(?P<label>\b\w+\s*\+?=)
    |(?P<element><[^<>'\r\n]*>)
    """,
    re.VERBOSE | re.DOTALL,
)
_WHAT = {
    "named": "an action",
    "tokens": "a list of tokens or channels",
    "predicate": "a semantic predicate",
    "action": "an action",
    "kind": "a grammar of the lexer or the parser alone",
    "import": "an import",
    "mode": "a mode of the lexer",
    "command": "a command of the lexer but skip and channel(HIDDEN)",
    "clause": "a clause of a rule",
    "label": "a label of an element",
    "element": "an option of an element",
}


def unsupported(text: str) -> Iterator[tuple[int, str]]:
    """Yield the line, from 1, and the name of each unsupported feature, at its first occurrence."""
    found: dict[str, int] = {}
    for part in _PARTS.finditer(text):
        what = _WHAT.get(str(part.lastgroup))
        if part["set"] and re.search(r"\\[pP]\{", part["set"]):
            what = "a Unicode property in a set"
        if what:
            found.setdefault(what, text.count("\n", 0, part.start()) + 1)
    yield from ((line, what) for what, line in found.items())


def without_decoration(text: str) -> str:
    """Return a grammar with actions, labels and element options replaced by blanks.

    They do not change what is accepted. A non-greedy loop that ends at one character (``.*? 'x'``)
    becomes a greedy one over all other characters.
    """

    def blank(part: re.Match[str]) -> str:
        if part["lazy"]:
            first = ". " if part["often"] == "+" else ""
            return f"{first}~{part['stop']}*{part['gap']}{part['stop']}"
        is_left_out = part.lastgroup in ("named", "action", "label", "element")
        return re.sub(r"[^\r\n]", " ", part[0]) if is_left_out else part[0]

    return _PARTS.sub(blank, text)
