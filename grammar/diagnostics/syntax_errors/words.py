"""Words of other languages, words in the wrong place, and comments without their semicolon."""

from __future__ import annotations

from grammar.diagnostics.diagnostic import Fix
from grammar.diagnostics.expected_tokens import is_reserved
from grammar.diagnostics.open_blocks import lead
from grammar.diagnostics.syntax_errors.error_site import ErrorSite, Mistake

#: Words of other languages that begin a line, with those of KRL.
FOREIGN_WORDS = {
    "END_IF": "ENDIF", "FI": "ENDIF", "END_FOR": "ENDFOR", "NEXT": "ENDFOR", "ENDDO": "ENDWHILE",
    "END_WHILE": "ENDWHILE", "WEND": "ENDWHILE", "END_LOOP": "ENDLOOP", "ENDREPEAT": "UNTIL",
    "END_CASE": "ENDSWITCH", "ENDCASE": "ENDSWITCH", "ENDSELECT": "ENDSWITCH", "ENDDEF": "END",
    "ENDPROC": "END", "ENDSUB": "END", "ENDFUNCTION": "ENDFCT", "ENDFUNC": "ENDFCT",
    "ENDDEFFCT": "ENDFCT", "ENDDEFDAT": "ENDDAT", "END_DAT": "ENDDAT", "BREAK": "EXIT",
}  # fmt: skip
# A line that begins with this many words, none of them KRL, is taken for prose.
_PROSE = 3


def foreign_word(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a keyword from another language."""
    word = site.word(0)
    if site.place > 1 or site.expects("INTEGER"):
        return None
    if word in ("ELSEIF", "ELSIF", "ELIF") and site.place == 1:
        fix = Fix("write ELSE, and on the next line an IF with its own ENDIF")
        return Mistake(f"KRL has no {word}", fix, region=site.region(0))
    if word in FOREIGN_WORDS and site.is_at_end:
        meant = FOREIGN_WORDS[word]
        fix = Fix("write UNTIL and when to end") if meant == "UNTIL" else site.swap(meant, 0)
        return Mistake(f"KRL has no {word}", fix, region=site.region(0))
    if word == "ELSE" and site.text == "IF":
        fix = Fix("write IF on the next line, and add an ENDIF for it")
        return Mistake("IF stands on the line of ELSE", fix)
    return None


def misplaced_word(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a keyword that is missing, superfluous or in the wrong order."""
    text, place, rule = site.text, site.place, site.failure.rule
    if rule == "ifStatement" and site.expects("THEN"):
        if site.is_at_end:
            return Mistake("THEN is missing", site.append(" THEN"))
        if text == "DO":
            return Mistake("IF has THEN and no DO", site.swap("THEN", place))
    if place > 0 and text in ("DO", "THEN", "OF") and site.expects("NEWLINE"):
        return Mistake(f"{lead(site.code)} has no {text}", site.swap("", place))
    if text == "BY" and site.expects("STEP"):
        return Mistake("KRL has no BY", site.swap("STEP", place))
    if text == "DECL" and site.word(place - 1) == "GLOBAL":
        fix = site.swap("DECL GLOBAL", place - 1, place)
        return Mistake("GLOBAL stands behind DECL", fix, reason="DECL GLOBAL is right [SCO-04]")
    is_number = rule == "interrupt" and place == 1 and site.expects("OFF")
    if is_number and (switch := site.word(2)) in ("ON", "OFF", "ENABLE", "DISABLE"):
        fix = site.swap(f"{switch} {site.tokens[1][0]}", 1, 2)
        return Mistake(f"the number stands behind {switch}", fix)
    if rule in ("procedure", "function") and site.failure.expected == ("(",):
        return Mistake("the parentheses are missing", site.append("( )"))
    return None


def fold_without_semicolon(site: ErrorSite) -> Mistake | None:
    """Return the mistake of FOLD or ENDFOLD without its semicolon."""
    if site.word(0) not in ("FOLD", "ENDFOLD"):
        return None
    word = site.tokens[0][0]
    return Mistake(f"; is missing before {word}", site.swap(f";{word}", 0), region=site.region(0))


def prose(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a comment without its semicolon: a line of words unknown to KRL."""
    begin = [token[0] for token in site.tokens[:_PROSE]]
    if len(begin) < _PROSE or not all(word.isalpha() and not is_reserved(word) for word in begin):
        return None
    fix = Fix("write ; ahead of it if it is one")
    return Mistake("a comment begins with a semicolon", fix, region=site.region(0))


def foreign_letter(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a letter that no name has, unless the line is prose."""
    letter = site.failure.text[:1]
    if letter.isascii() or not letter.isalpha():
        return None
    reason = "names consist of the letters A to Z, digits, _ and $"
    return prose(site) or Mistake(f"{letter} is not allowed in a name", reason=reason)
