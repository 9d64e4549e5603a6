"""Lines that begin as a statement or declaration and do not go on as one."""

from __future__ import annotations

import re
from collections.abc import Sequence

from grammar.blocks import CLOSERS
from grammar.diagnostics.diagnostic import Fix
from grammar.diagnostics.expected_tokens import (
    is_in_place_of_name,
    is_reserved,
    names,
    statements,
)
from grammar.diagnostics.open_blocks import lead
from grammar.diagnostics.syntax_errors.error_site import LONGEST_TOKEN, ErrorSite, Mistake
from grammar.motion_kinds import CIRCLES, MOTIONS

_TYPES = frozenset("INT REAL BOOL CHAR AXIS E6AXIS FRAME POS E6POS".split())
_LETTER = re.compile(r"[A-Za-z_]", re.ASCII)
_POINTS = {
    kind: "two points" if kind in CIRCLES else "a point" for kind in MOTIONS if kind != "ASYPTP"
}


def incomplete_line(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a name alone, or of a bracket that is open at the end of the line."""
    if not site.is_at_end:
        return None
    if len(site.words) == 1 and site.expects("(", "="):
        name = site.tokens[0][0][:LONGEST_TOKEN]
        return Mistake(f"{name} alone is not a statement", Fix(f"write {name}() if it is a call"))
    closer = next((one for one in ")]}" if site.expects(one)), "")
    return Mistake(f"{closer} is missing", site.append(closer)) if closer else None


def misplaced_declaration(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a declaration with something misplaced or missing."""
    text, rule, is_data = site.text, site.failure.rule, site.is_in_data_list
    if not is_data and text == "=" and rule == "declaration":
        message = "a routine has no initial values"
        fix = Fix("assign behind the declarations, or declare it in the data list")
        return Mistake(message, fix, slug="initial-outside-data-list")
    if not is_data and text == "CONST" and site.expects("REAL"):
        return Mistake("CONST in a routine", slug="constant-outside-data-list")
    if site.place == 1 and site.is_name(0):
        first, following = site.tokens[0][0], site.word(2)
        is_end = following in ("", ",", "[") or (is_data and following == "=")
        if is_end and site.is_name(1) and site.expects("="):
            fix = Fix("write DECL before it", site.gap(0), "DECL ")
            return Mistake(f"DECL is missing before {first}", fix, slug="decl-missing")
        if text in _TYPES:
            fix = site.swap(f"{site.tokens[1][0]} {first}", 0, 1)
            return Mistake(f"the type {site.shown} stands before the name", fix)
    is_instruction = lead(site.code) in statements() or text == "("
    if is_data and is_instruction and rule in ("dataList", "initialisation"):
        message = f"{site.tokens[0][0]} is an instruction, and a data list has none"
        return Mistake(message, slug="misplaced-instruction", region=site.region(0))
    return None


def no_constant(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a value in a data list that is not a constant."""
    if not site.is_in_data_list or "=" not in site.words[: site.place]:
        return None
    if site.is_name(site.place) and site.expects("INTEGER"):
        message = f"{site.shown} is no constant"
    elif site.text in ("+", "-", "*", "/"):
        message = f"a data list cannot calculate: {site.shown}"
    else:
        return None
    reason = "the values in a data list are numbers, texts, TRUE, FALSE, #… and {…} of these"
    slug = "misplaced-instruction" if site.is_name(0) and site.word(1) in "=[." else "syntax"
    return Mistake(message, reason=reason, slug=slug)


def misplaced_name(site: ErrorSite) -> Mistake | None:
    """Return the mistake of an invalid name, or of a statement where none can be."""
    text, place = site.text, site.place
    if is_in_place_of_name(text, site.failure.expected):
        return Mistake(f"{site.shown} is a keyword and cannot be a name")
    is_name = site.expects("NAME") and not site.expects("INTEGER") and not site.expects("HALT")
    if is_name and text[:1].isdigit() and _LETTER.search(text):
        return Mistake("a name does not begin with a digit")
    if site.failure.rule == "module" and text:
        if lead(site.code) in CLOSERS and place > 0:
            return Mistake(f"nothing can follow {site.word(0)}")
        is_data = site.source.path.lower().endswith(".dat")
        fix = Fix(f"a {'data list begins with DEFDAT' if is_data else 'routine begins with DEF'}")
        return Mistake(f"{site.shown} stands outside all routines", fix)
    if place > 0 and site.expects("NEWLINE") and _begins_statement(site):
        fix = Fix("write it on a separate line")
        return Mistake("a second statement on this line", fix)
    return None


def _begins_statement(site: ErrorSite) -> bool:
    """Return whether the offending token is a keyword of a statement, or is assigned to."""
    if site.text in statements():
        return True
    if not site.is_word or is_reserved(site.text) or site.text in names():
        return False
    return "=" in site.words[site.place :]


def motion_without_points(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a motion without its points."""
    word = lead(site.code)
    need = _POINTS.get(word)
    if need is None or site.expects("HALT"):
        return None
    if word in CIRCLES and site.expects(",") and not _commas(site.words[1 : site.place]):
        fix = Fix(f"write {word} and both points, with a comma between")
        reason = "an auxiliary point on the way, and the point where the circle ends"
        return Mistake(f"{word} needs two points", fix, reason)
    is_first = site.place == 1 or (word in CIRCLES and site.word(site.place - 1) == ",")
    return Mistake(f"{word} needs {need}") if is_first and site.expects("NAME", "{") else None


def _commas(words: Sequence[str]) -> int:
    """Return the number of commas outside brackets."""
    depth = found = 0
    for word in words:
        depth += (word in ("(", "[", "{")) - (word in (")", "]", "}"))
        found += word == "," and not depth
    return found
