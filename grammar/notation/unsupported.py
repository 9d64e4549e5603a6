"""Features of ANTLR 4 that are not supported, each by its name in ANTLR."""

from __future__ import annotations

import re
from collections.abc import Iterator

# What has other rules inside comes first; an action may have braces in braces, twice over.
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
    """Lines, from 1, and what on them is not understood; each kind once, where it comes first."""
    found: dict[str, int] = {}
    for part in _PARTS.finditer(text):
        what = _WHAT.get(str(part.lastgroup))
        if part["set"] and re.search(r"\\[pP]\{", part["set"]):
            what = "a Unicode property in a set"
        if what:
            found.setdefault(what, text.count("\n", 0, part.start()) + 1)
    yield from ((line, what) for what, line in found.items())


def without_decoration(text: str) -> str:
    """A grammar with blanks for what changes nothing of what is read: actions, labels, options.

    A loop that ends as soon as it can, up to one character, is one over all others.
    """

    def blank(part: re.Match[str]) -> str:
        if part["lazy"]:
            first = ". " if part["often"] == "+" else ""
            return f"{first}~{part['stop']}*{part['gap']}{part['stop']}"
        is_left_out = part.lastgroup in ("named", "action", "label", "element")
        return re.sub(r"[^\r\n]", " ", part[0]) if is_left_out else part[0]

    return _PARTS.sub(blank, text)
