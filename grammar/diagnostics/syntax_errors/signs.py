"""Signs that mean something else in KRL, or nothing, and malformed numbers."""

from __future__ import annotations

from grammar.diagnostics.diagnostic import Fix
from grammar.diagnostics.syntax_errors.error_site import ErrorSite, Mistake

#: Operators of C and other languages, with those of KRL.
_FOREIGN_OPERATORS = {
    "!=": "<>", "!": "NOT ", "&&": "AND", "||": "OR", "&": "B_AND", "|": "B_OR", "^": "B_EXOR",
    "~": "B_NOT ", "XOR": "EXOR",
}  # fmt: skip


def foreign_sign(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a sign that means something else in KRL, or nothing."""
    text, place = site.text, site.place
    if text in _FOREIGN_OPERATORS and (site.expects("INTEGER") or site.expects("*")):
        return Mistake(f"KRL has no {text}", site.swap(_FOREIGN_OPERATORS[text], place))
    if site.word(0) == "//" and place <= 1:
        return Mistake("a comment begins with a semicolon", site.swap(";", 0))
    before, after = site.word(place - 1), site.word(place + 1)
    match text:
        case "=" if site.expects("=="):
            last = place + 1 if after == "=" else None
            return Mistake("a comparison is written ==", site.swap("==", place, last))
        case "=" if before in ("STEP", "CA"):
            return Mistake(f"{before} has no =", site.swap("", place))
        case "==" if site.expects("="):
            return Mistake("an assignment is written =", site.swap("=", place))
        case ":=":
            fix = site.swap("=", place)
            return Mistake("an assignment is written =", fix, region=site.region(place))
        case "%" | "MOD" if site.expects("*"):
            fix = Fix("A - (A / B) * B is the rest of integers")
            return Mistake(f"KRL has no {text}", fix)
        case '"':
            return Mistake("the text is not closed", Fix('write " behind it'))
        case "'":
            fix = Fix("write 'B101' or 'H1F'; texts stand in double quotation marks")
            return Mistake("' begins a binary or hexadecimal number, and none follows", fix)
        case "#" if place > 0 and after[:1].isalpha():
            fix = site.swap(f"#{site.tokens[place + 1][0]}", place, place + 1)
            message = "no blank may stand between # and the constant"
            return Mistake(message, fix, is_unconfirmed=True)
        case "@" | "`" | "\\" | "?" | "~" | "!" | "§":
            return Mistake(f"{text} is not a sign of KRL")
    return None


def malformed_number(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a decimal comma, or of a number that begins or ends with a point."""
    place = site.place
    comma = place if site.text == "," else place - 1
    before, after = site.word(comma - 1), site.word(comma + 1)
    is_one = before.isdigit() and after.isdigit() and f"{before},{after}" in site.code
    if site.word(comma) == "," and is_one:
        fix = site.swap(f"{before}.{after}", comma - 1, comma + 1)
        return Mistake("a number has a decimal point and no comma", fix)
    if site.text != ".":
        return None
    if site.word(place + 1)[:1].isdigit() and site.expects("INTEGER"):
        fix = site.swap("0.", place)
        return Mistake("a number needs a digit before its point", fix, is_unconfirmed=True)
    if site.word(place - 1).isdigit():
        return Mistake("a number needs a digit behind its point", site.swap(".0", place))
    return None
