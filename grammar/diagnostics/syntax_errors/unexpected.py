"""A token that cannot stand where it does, or a missing one, in terms of the expected tokens."""

from __future__ import annotations

import re

from grammar.diagnostics.did_you_mean import nearest, one_of
from grammar.diagnostics.expected_tokens import in_words, statements
from grammar.diagnostics.syntax_errors.corrections import BRACKETS
from grammar.diagnostics.syntax_errors.error_site import ErrorSite, Mistake

# If more tokens are expected, the message names none of them.
_FEW = 12
_ENDS_VALUE = re.compile(r"[\w\])]$")
_BEGINS_VALUE = re.compile(r"[\w$#]")
#: Words between the parts of a statement.
_JOINING = ("WHEN", "DELAY", "TO", "DO", "THEN")


def unexpected(site: ErrorSite) -> Mistake:
    """Return the mistake of a failure of which no more is known."""
    expected = in_words(site.failure.expected)
    if not site.failure.text.strip():
        return _too_early(site, expected)
    if expected in ("a name", "a value", "a constant", "a position"):
        return Mistake(f"{expected} is missing before {site.shown}")
    if (
        site.expects("*", "==")
        and _ENDS_VALUE.search(site.word(site.place - 1))
        and _BEGINS_VALUE.match(site.text)
    ):
        return _unjoined(site)
    if expected == "the end of the line" and site.place > 0:
        return Mistake(f"{site.shown} is too much on this line")
    return _misplaced(site, expected)


def _too_early(site: ErrorSite, expected: str) -> Mistake:
    what = "line" if site.failure.text else "file"
    is_one = bool(expected) and "," not in expected and " or " not in expected
    if what == "line" and site.tokens and is_one and not expected.startswith('"'):
        return Mistake(f"{expected} is missing behind {site.tokens[-1][0]}")
    reason = f"expected: {expected}" if expected else ""
    return Mistake(f"the {what} ends too early", reason=reason)


def _unjoined(site: ErrorSite) -> Mistake:
    """Return the mistake of two values side by side."""
    for word in _JOINING:
        if site.expects(word) and word not in site.words:
            return Mistake(f"{word} is missing before {site.shown}")
    before = site.tokens[site.place - 1][0]
    return Mistake(f"an operator is missing between {before} and {site.shown}")


def _misplaced(site: ErrorSite, expected: str) -> Mistake:
    """Return the mistake of a token in the wrong place."""
    token, text, reason = site.shown, site.text, f"expected: {expected}" if expected else ""
    before = site.tokens[site.place - 1][0] if site.place else ""
    ahead = site.words[: site.place]
    if not before:
        if not site.is_word:
            return Mistake(f"no line begins with {token}", reason=reason)
    elif text in BRACKETS and ahead.count(BRACKETS[text]) <= ahead.count(text):
        return Mistake(f"{token} closes nothing", site.swap("", site.place), reason)
    elif text in statements() and site.expects("="):
        return Mistake(f"{token} stands at the beginning of its line", reason=reason)
    elif text in (",", "}") and site.expects("INTEGER", "ENUM_CONSTANT"):
        return Mistake(f"{before} has no value", reason=reason)
    elif "THEN" in site.words and site.expects("="):
        return Mistake(f"THEN belongs to IF, and this line begins with {site.tokens[0][0]}")
    elif site.expects("(", "="):
        return Mistake(f"= is missing before {token}", reason=reason)
    if near := nearest(site.failure.text, filter(str.isalpha, site.failure.expected[:_FEW]), 1):
        return Mistake(f"{token} is not a word of KRL", one_of(near), reason)
    if before and site.expects("NEWLINE"):
        return Mistake(f"{token} is too much on this line", reason=reason)
    if expected and len(site.failure.expected) <= _FEW:
        return Mistake(f"{expected} is missing before {token}")
    return Mistake(f"{token} cannot stand here", reason=reason)
