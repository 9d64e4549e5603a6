"""Syntax failures as diagnostics, with the probable mistake and a fix.

The recogniser finds the first token that no program can have there, and all tokens that could come
instead. This module turns that into a sentence. Frequent mistakes are recognised by their tokens:
``=`` in a condition, END IF, ELSEIF, a missing THEN, operators of C, a block that is not closed.
For any other failure the expected tokens are reported.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from grammar.blocks import BRANCHES, CLOSERS, OUTERMOST
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region, diagnose
from grammar.diagnostics.did_you_mean import nearest, one_of
from grammar.diagnostics.error_site import ErrorSite
from grammar.diagnostics.expected_tokens import (
    in_words,
    is_in_place_of_name,
    is_reserved,
    names,
    statements,
)
from grammar.diagnostics.line_edits import BRACKETS, LineEdit, bracket, doubled, keyword, left_out
from grammar.diagnostics.open_blocks import OpenBlock, innermost, lead, most_likely, open_blocks
from grammar.motion_kinds import CIRCLES, MOTIONS
from grammar.syntax.build import SyntaxFailure
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

#: A file with more failing lines is probably no KRL; only so many are listed.
MOST_LISTED = 1_000
_LONGEST_TOKEN = 60
# Beyond this column a failure is not examined: that takes long, and real lines are shorter.
_FARTHEST = 20_000
# A line that begins with this many words, none of them KRL, is taken for prose.
_PROSE = 3
_TYPES = frozenset("INT REAL BOOL CHAR AXIS E6AXIS FRAME POS E6POS".split())
_BEGINNING = re.compile(r"[$A-Z_]")
_WORD = re.compile(r"[A-Za-z_]\w*", re.ASCII)


def syntax_findings(failures: Sequence[SyntaxFailure], source: Source) -> list[Diagnostic]:
    """Return the findings for the failures of a text, without those that follow from others."""
    reported = [failure for failure in failures if not failure.follows] or list(failures)
    reported = [
        failure
        for before, failure in zip([None, *reported], reported, strict=False)
        if before is None or not _is_same_gap(before, failure, source)
    ]
    shown = reported[:MOST_LISTED]
    blocks = open_blocks(source, (failure.line for failure in shown))
    found = [_finding(ErrorSite(failure, source, blocks[failure.line])) for failure in shown]
    if len(reported) > len(shown):
        message = f"{len(reported) - len(shown):,} more unreadable lines are not listed"
        found.append(diagnose("too-large", source.path, found[-1].region, message))
    return found


def _is_same_gap(before: SyntaxFailure, failure: SyntaxFailure, source: Source) -> bool:
    """Return whether two lines are outside all routines because of the same missing first line."""
    lines = source.lines[before.line - 1 : failure.line]
    is_outside = before.rule == failure.rule == "module"
    return is_outside and not any(lead(line) in OUTERMOST for line in lines)


@dataclass(frozen=True, slots=True)
class _Mistake:
    """A recognised mistake: its message, and its region if that is not the offending token.

    ``is_unconfirmed`` marks code that occurs in real programs; that proves neither that it is KRL
    nor that it is not.
    """

    message: str
    fix: Fix | None = None
    reason: str = ""
    slug: str = "syntax"
    region: Region | None = None
    is_unconfirmed: bool = False


def _finding(site: ErrorSite) -> Diagnostic:
    failure = site.failure
    region = _offending(site)
    if failure.reason is not None:
        message = f"this line is {failure.reason}, so the file was not checked"
        return diagnose("too-large", site.source.path, region, message)
    mistake = None
    if failure.column <= _FARTHEST:
        mistake = next(filter(None, (known(site) for known in _KNOWN)), None)
    mistake = mistake or _unexpected(site)
    return diagnose(
        mistake.slug,
        site.source.path,
        mistake.region or region,
        mistake.message,
        reason=mistake.reason,
        is_unconfirmed=mistake.is_unconfirmed,
        fix=mistake.fix,
    )


def _offending(site: ErrorSite) -> Region:
    """Return the region of the offending token, or the end of the last line that is not blank."""
    failure, source = site.failure, site.source
    if failure.text:
        shown = source.line(failure.line)[failure.column - 1 :]
        width = min(len(failure.text.splitlines()[0]), len(shown)) if failure.text.strip() else 0
        end = failure.column + width
        return Region(failure.line, failure.column, failure.line, end)
    line = min(failure.line, len(source.lines))
    while line > 1 and not source.line(line).strip():
        line -= 1
    column = len(source.line(line).rstrip()) + 1
    return Region(line, column, line, column)


def _unexpected(site: ErrorSite) -> _Mistake:
    words = in_words(site.failure.expected)
    is_one = bool(words) and "," not in words and " or " not in words
    if not site.failure.text.strip():
        before = site.word(len(site.words) - 1) if site.failure.text else ""
        if before and is_one and not words.startswith('"'):
            return _Mistake(f"{words} is missing behind {site.tokens[-1][0]}")
        what = "the line ends too early" if site.failure.text else "the file ends too early"
        return _Mistake(what, reason=f"expected: {words}" if words else "")
    if words in ("a name", "a value", "a constant", "a position"):
        return _Mistake(f"{words} is missing before {_shown(site)}")
    if (
        site.expects("*", "==")
        and _ENDS_VALUE.search(site.word(site.place - 1))
        and (site.text[0].isalnum() or site.text[0] in "$#_")
    ):
        missing = [one for one in _JOINING if site.expects(one) and one not in site.words]
        if missing:
            return _Mistake(f"{missing[0]} is missing before {_shown(site)}")
        before = site.tokens[site.place - 1][0]
        return _Mistake(f"an operator is missing between {before} and {_shown(site)}")
    if words == "the end of the line" and site.place > 0:
        return _Mistake(f"{_shown(site)} is too much on this line")
    return _misplaced(site, words)


def _misplaced(site: ErrorSite, words: str) -> _Mistake:
    """Return the mistake of a token in the wrong place; ``words`` are the expected tokens."""
    shown, text, reason = _shown(site), site.text, f"expected: {words}" if words else ""
    before = site.tokens[site.place - 1][0] if site.place else ""
    ahead = site.words[: site.place]
    if not before:
        if not _BEGINNING.match(text):
            return _Mistake(f"no line begins with {shown}", reason=reason)
    elif text in BRACKETS and ahead.count(BRACKETS[text]) <= ahead.count(text):
        return _Mistake(f"{shown} closes nothing", site.swap("", site.place), reason)
    elif text in statements() and site.expects("="):
        return _Mistake(f"{shown} stands at the beginning of its line", reason=reason)
    elif text in (",", "}") and site.expects("INTEGER", "ENUM_CONSTANT"):
        return _Mistake(f"{before} has no value", reason=reason)
    elif "THEN" in site.words and site.expects("="):
        return _Mistake(f"THEN belongs to IF, and this line begins with {site.tokens[0][0]}")
    elif site.expects("(", "="):
        return _Mistake(f"= is missing before {shown}", reason=reason)
    if near := nearest(site.failure.text, filter(str.isalpha, site.failure.expected[:_FEW]), 1):
        return _Mistake(f"{shown} is not a word of KRL", one_of(near), reason)
    if before and site.expects("NEWLINE"):
        return _Mistake(f"{shown} is too much on this line", reason=reason)
    if words and len(site.failure.expected) <= _FEW:
        return _Mistake(f"{words} is missing before {shown}")
    return _Mistake(f"{shown} cannot stand here", reason=reason)


# If more tokens are expected, the message names none of them.
_FEW = 12
_ENDS_VALUE = re.compile(r"[\w\])]$")


def _shown(site: ErrorSite) -> str:
    """Return the offending token as a message shows it, cut if it is long."""
    text = site.failure.text.strip()
    cut = f"{text[:_LONGEST_TOKEN]}…" if len(text) > _LONGEST_TOKEN else text
    return cut if cut[:1].isalnum() or cut[:1] in '"$#_' else f'"{cut}"'


# ----------------------------------------------------------------------------------------- blocks


def _blocks(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a block that is not closed, or closed without being open."""
    if not site.failure.text:
        return None if site.block is None else _not_closed(site, site.block)
    word = lead(site.code)
    if site.place > (1 if site.word(0) == "GLOBAL" else 0) or word != site.text:
        return None
    if word == "END" and (two := _end_in_two_words(site)):
        return two
    if word in OUTERMOST and site.block is not None:
        return _not_closed(site, site.block)
    openers = CLOSERS.get(word, (BRANCHES[word],) if word in BRANCHES else ())
    if not openers or site.block is None:
        return None
    if site.block.word in openers:
        if word not in ("ELSE", "DEFAULT"):
            return None
        line = site.failure.line
        is_inside = most_likely(site.source, site.block, line + 1)[1] > line
        return _Mistake(f"a second {word}") if is_inside else _not_closed(site, site.block)
    if innermost(site.block, openers) is not None:
        return _not_closed(site, site.block)
    if word in ("END", "ENDFCT", "ENDDAT"):
        meant = _outermost(site.block)
        if site.block is not meant:
            return _not_closed(site, site.block)
        message = f"{meant.word} on line {meant.line} is closed by {meant.closer}"
        return _Mistake(message, site.swap(meant.closer, site.place))
    reason = ""
    if site.block.outer is not None:
        reason = f"{site.block.word} on line {site.block.line} is open, with {site.block.closer}"
    return _Mistake(f"{word} without {openers[0]}", reason=reason)


def _outermost(block: OpenBlock) -> OpenBlock:
    while block.outer is not None:
        block = block.outer
    return block


def _not_closed(site: ErrorSite, block: OpenBlock) -> _Mistake:
    end, region = site.failure.line, None
    before = site.text.split()[0] if site.text else "the end"
    if block.word not in OUTERMOST:
        block, line = most_likely(site.source, block, end)
        if line != end:
            shown = site.source.line(line)
            begin, before = len(shown) - len(shown.lstrip()), f"line {line}"
            region = Region(line, 1 + begin, line, 1 + len(shown.rstrip()))
    return _Mistake(
        f"{block.word} on line {block.line} is not closed",
        Fix(f"write {block.closer} before {before}"),
        reason=f"{block.closer} is missing",
        slug="endloop-missing" if block.word == "LOOP" else "syntax",
        region=region,
    )


def _end_in_two_words(site: ErrorSite) -> _Mistake | None:
    closer = f"END{site.word(1)}"
    if not site.word(1) or not (closer in CLOSERS or closer in _FOREIGN):
        return None
    closer = _FOREIGN.get(closer, closer)
    message = f"{site.word(0)} {site.word(1)} is written as one word"
    return _Mistake(message, site.swap(closer, 0, 1))


#: Words of other languages at the beginning of a line.
_FOREIGN = {
    "END_IF": "ENDIF", "FI": "ENDIF", "END_FOR": "ENDFOR", "NEXT": "ENDFOR", "ENDDO": "ENDWHILE",
    "END_WHILE": "ENDWHILE", "WEND": "ENDWHILE", "END_LOOP": "ENDLOOP", "ENDREPEAT": "UNTIL",
    "END_CASE": "ENDSWITCH", "ENDCASE": "ENDSWITCH", "ENDSELECT": "ENDSWITCH", "ENDDEF": "END",
    "ENDPROC": "END", "ENDSUB": "END", "ENDFUNCTION": "ENDFCT", "ENDFUNC": "ENDFCT",
    "ENDDEFFCT": "ENDFCT", "ENDDEFDAT": "ENDDAT", "END_DAT": "ENDDAT", "BREAK": "EXIT",
}  # fmt: skip


def _foreign(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a keyword from another language."""
    word = site.word(0)
    if site.place > 1 or site.expects("INTEGER"):
        return None
    if word in ("ELSEIF", "ELSIF", "ELIF") and site.place == 1:
        message = f"KRL has no {word}"
        fix = Fix("write ELSE, and on the next line an IF with its own ENDIF")
        return _Mistake(message, fix, region=site.region(0))
    if word in _FOREIGN and site.is_at_end:
        meant = _FOREIGN[word]
        fix = Fix("write UNTIL and when to end") if meant == "UNTIL" else site.swap(meant, 0)
        return _Mistake(f"KRL has no {word}", fix, region=site.region(0))
    if word == "ELSE" and site.text == "IF":
        fix = Fix("write IF on the next line, and add an ENDIF for it")
        return _Mistake("IF stands on the line of ELSE", fix)
    return None


# ------------------------------------------------------------------------------- signs and words


def _signs(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a sign that means something else in KRL, or nothing."""
    text, place = site.text, site.place
    if text == "=" and site.expects("=="):
        last = place + 1 if site.word(place + 1) == "=" else None
        return _Mistake("a comparison is written ==", site.swap("==", place, last))
    if text == "==" and site.expects("="):
        return _Mistake("an assignment is written =", site.swap("=", place))
    if text == ":=":
        fix = site.swap("=", place)
        return _Mistake("an assignment is written =", fix, region=site.region(place))
    if text == "=" and site.word(place - 1) in ("STEP", "CA"):
        return _Mistake(f"{site.word(place - 1)} has no =", site.swap("", place))
    if text in _OF_C and (site.expects("INTEGER") or site.expects("*")):
        meant = _OF_C[text]
        return _Mistake(f"KRL has no {text}", site.swap(meant, place))
    if text in ("%", "MOD") and site.expects("*"):
        return _Mistake(f"KRL has no {text}", Fix("A - (A / B) * B is the rest of integers"))
    if site.word(0) == "//" and place <= 1:
        return _Mistake("a comment begins with a semicolon", site.swap(";", 0))
    if text == '"':
        return _Mistake("the text is not closed", Fix('write " behind it'))
    if text == "'":
        fix = Fix("write 'B101' or 'H1F'; texts stand in double quotation marks")
        return _Mistake("' begins a binary or hexadecimal number, and none follows", fix)
    if text == "#" and place > 0 and site.word(place + 1)[:1].isalpha():
        fix = site.swap(f"#{site.tokens[place + 1][0]}", place, place + 1)
        return _Mistake("no blank may stand between # and the constant", fix, is_unconfirmed=True)
    if text in ("@", "`", "\\", "?", "~", "!", "§"):
        return _Mistake(f"{text} is not a sign of KRL")
    return None


def _decimal_points(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a decimal comma, or of a number that begins or ends with a point."""
    at = site.place if site.text == "," else site.place - 1
    if site.word(at) == "," and site.word(at - 1).isdigit() and site.word(at + 1).isdigit():
        number = f"{site.word(at - 1)}.{site.word(at + 1)}"
        if number.replace(".", ",") in site.code:
            return _Mistake(
                "a number has a decimal point and no comma", site.swap(number, at - 1, at + 1)
            )
    if site.text != ".":
        return None
    if site.word(site.place + 1)[:1].isdigit() and site.expects("INTEGER"):
        fix = site.swap("0.", site.place)
        return _Mistake("a number needs a digit before its point", fix, is_unconfirmed=True)
    if site.word(site.place - 1).isdigit():
        return _Mistake("a number needs a digit behind its point", site.swap(".0", site.place))
    return None


# Words between the parts of a statement.
_JOINING = ("WHEN", "TO", "DO", "THEN")
_OF_C = {
    "!=": "<>", "!": "NOT ", "&&": "AND", "||": "OR", "&": "B_AND", "|": "B_OR", "^": "B_EXOR",
    "~": "B_NOT ", "XOR": "EXOR",
}  # fmt: skip


def _words(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a keyword that is missing, superfluous or in the wrong order."""
    text, place = site.text, site.place
    if site.failure.rule == "ifStatement" and site.expects("THEN"):
        if site.is_at_end:
            return _Mistake("THEN is missing", site.append(" THEN"))
        if text == "DO":
            return _Mistake("IF has THEN and no DO", site.swap("THEN", place))
    if place > 0 and text in ("DO", "THEN", "OF") and site.expects("NEWLINE"):
        return _Mistake(f"{lead(site.code)} has no {text}", site.swap("", place))
    if text == "BY" and site.expects("STEP"):
        return _Mistake("KRL has no BY", site.swap("STEP", place))
    if text == "DECL" and site.word(place - 1) == "GLOBAL":
        fix = site.swap("DECL GLOBAL", place - 1, place)
        return _Mistake("GLOBAL stands behind DECL", fix, reason="DECL GLOBAL is right [SCO-04]")
    if site.failure.rule == "interrupt" and place == 1 and site.expects("OFF"):
        switch = site.word(2)
        if switch in ("ON", "OFF", "ENABLE", "DISABLE"):
            fix = site.swap(f"{switch} {site.tokens[1][0]}", 1, 2)
            return _Mistake(f"the number stands behind {switch}", fix)
    if site.failure.rule in ("procedure", "function") and site.failure.expected == ("(",):
        return _Mistake("the parentheses are missing", site.append("( )"))
    return None


def _ends(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a line that ends too early."""
    if not site.is_at_end:
        return None
    if len(site.words) == 1 and site.expects("(", "="):
        name = site.tokens[0][0]
        message = f"{name[:_LONGEST_TOKEN]} alone is not a statement"
        return _Mistake(message, Fix("parentheses behind it would make it a call"))
    closer = next((one for one in ")]}" if site.expects(one)), "")
    return _Mistake(f"{closer} is missing", site.append(closer)) if closer else None


# -------------------------------------------------------------------------- names, declarations


def _declarations(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a declaration with something misplaced or missing."""
    text, rule, is_data = site.text, site.failure.rule, _is_data(site)
    if not is_data and text == "=" and rule == "declaration":
        message = "a routine has no initial values"
        fix = Fix("assign behind the declarations, or declare it in the data list")
        return _Mistake(message, fix, slug="initial-outside-data-list")
    if not is_data and text == "CONST" and site.expects("REAL"):
        return _Mistake("CONST in a routine", slug="constant-outside-data-list")
    if site.place == 1 and _is_name(site, 0) and _is_name(site, 1) and site.expects("="):
        following = site.word(2)
        if following in ("", ",", "[") or (is_data and following == "="):
            first = site.region(0)
            here = Region(first.line, first.column, first.line, first.column)
            message = f"DECL is missing before {site.tokens[0][0]}"
            fix = Fix("write DECL before it", here, "DECL ")
            return _Mistake(message, fix, slug="decl-missing")
    if site.place == 1 and _is_name(site, 0) and text in _TYPES:
        fix = site.swap(f"{site.tokens[1][0]} {site.tokens[0][0]}", 0, 1)
        return _Mistake(f"the type {_shown(site)} stands before the name", fix)
    is_instruction = lead(site.code) in statements() or text == "("
    if is_data and is_instruction and rule in ("dataList", "initialisation"):
        message = f"{site.tokens[0][0]} is an instruction, and a data list has none"
        return _Mistake(message, slug="misplaced-instruction", region=site.region(0))
    return None


def _constants(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a value in a data list that is not a constant."""
    if not _is_data(site) or "=" not in site.words[: site.place]:
        return None
    if _is_name(site, site.place) and site.expects("INTEGER"):
        message = f"{_shown(site)} is no constant"
    elif site.text in ("+", "-", "*", "/"):
        message = f"a data list cannot calculate: {_shown(site)}"
    else:
        return None
    reason = "the values in a data list are numbers, texts, TRUE, FALSE, #… and {…} of these"
    slug = "misplaced-instruction" if _is_name(site, 0) and site.word(1) in "=[." else "syntax"
    return _Mistake(message, reason=reason, slug=slug)


def _names(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of an invalid name, or of a statement where none can be."""
    text, place = site.text, site.place
    if is_in_place_of_name(text, site.failure.expected):
        return _Mistake(f"{_shown(site)} is a keyword and cannot be a name")
    is_name = site.expects("NAME") and not site.expects("INTEGER") and not site.expects("HALT")
    if is_name and text[:1].isdigit() and _WORD.search(text):
        return _Mistake("a name does not begin with a digit")
    if site.failure.rule == "module" and text:
        if lead(site.code) in CLOSERS and place > 0:
            return _Mistake(f"nothing can follow {site.word(0)}")
        is_data = site.source.path.lower().endswith(".dat")
        fix = Fix(f"a {'data list begins with DEFDAT' if is_data else 'routine begins with DEF'}")
        return _Mistake(f"{_shown(site)} stands outside all routines", fix)
    if place > 0 and site.expects("NEWLINE") and _opens_statement(site):
        fix = Fix("write it on a separate line")
        return _Mistake("a second statement on this line", fix)
    return None


def _opens_statement(site: ErrorSite) -> bool:
    if site.text in statements():
        return True
    if not _BEGINNING.match(site.text) or is_reserved(site.text):
        return False
    return site.text not in names() and "=" in site.words[site.place :]


def _is_name(site: ErrorSite, place: int) -> bool:
    word = site.word(place)
    return bool(_WORD.fullmatch(word)) and not is_reserved(word)


def _is_data(site: ErrorSite) -> bool:
    return innermost(site.block, ("DEFDAT",)) is not None


# ------------------------------------------------------------------------------ edits that help


def _motions(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a motion without its points."""
    word = lead(site.code)
    need = _POINTS.get(word)
    if need is None or site.expects("HALT"):
        return None
    rest = site.words[1 : site.place]
    if word in CIRCLES and site.expects(",") and _commas(rest) == 0:
        fix = Fix(f"write {word} and both points, with a comma between")
        reason = "an auxiliary point on the way, and the point where the circle ends"
        return _Mistake(f"{word} needs two points", fix, reason)
    is_gone = site.place == 1 or (word in CIRCLES and site.word(site.place - 1) == ",")
    if is_gone and site.expects("NAME", "{"):
        return _Mistake(f"{word} needs {need}")
    return None


_POINTS = {
    kind: "two points" if kind in CIRCLES else "a point" for kind in MOTIONS if kind != "ASYPTP"
}


def _commas(words: Sequence[str]) -> int:
    """Return the number of commas outside brackets."""
    depth = found = 0
    for word in words:
        depth += (word in "([{") - (word in ")]}") if len(word) == 1 else 0
        found += word == "," and depth == 0
    return found


def _edits(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of one token that is misspelt, repeated, or a missing bracket."""
    edit = keyword(site)
    if edit is not None:
        wrong = site.tokens[edit.first][0]
        fix = Fix(f"did you mean {edit.text}?", site.region(edit.first), edit.text)
        return _Mistake(f"{wrong} is not a word of KRL", fix, region=site.region(edit.first))
    edit = doubled(site)
    if edit is not None:
        wrong = site.tokens[edit.first][0]
        region = site.region(edit.first)
        return _Mistake(f"{wrong} stands twice", site.swap("", edit.first), region=region)
    edit = bracket(site)
    if edit is not None:
        return _written(site, edit)
    return None


def _gaps(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a missing sign between two tokens."""
    edit = left_out(site)
    return None if edit is None else _written(site, edit)


def _written(site: ErrorSite, edit: LineEdit) -> _Mistake:
    """Return the mistake of a missing sign, inserted before a token or at the end of the line."""
    if edit.first >= len(site.tokens):
        return _Mistake(f"{edit.text} is missing", site.append(edit.text))
    if edit.first > 0:
        end = site.region(edit.first - 1)
        place = Region(end.line, end.end_column, end.line, end.end_column)
    else:
        start = site.region(0)
        place = Region(start.line, start.column, start.line, start.column)
    following = site.tokens[edit.first][0]
    text = edit.text if edit.text in _CLOSING else f" {edit.text} "
    fix = Fix(f"write {edit.text} before {following}", place, text)
    return _Mistake(f"{edit.text} is missing", fix, region=place)


_CLOSING = ")]}.,([{"


def _folds(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of FOLD or ENDFOLD without its semicolon."""
    if site.word(0) not in ("FOLD", "ENDFOLD"):
        return None
    word = site.tokens[0][0]
    return _Mistake(f"; is missing before {word}", site.swap(f";{word}", 0), region=site.region(0))


def _prose(site: ErrorSite) -> _Mistake | None:
    """Return the mistake of a comment without its semicolon: a line of words unknown to KRL."""
    words = [token[0] for token in site.tokens]
    begin = words[:_PROSE]
    if len(begin) < _PROSE or not all(word.isalpha() and not is_reserved(word) for word in begin):
        return None
    fix = Fix("write ; ahead of it if it is one")
    return _Mistake("a comment begins with a semicolon", fix, region=site.region(0))


#: The detectors in order; the first that returns a mistake decides.
_KNOWN: tuple[Callable[[ErrorSite], _Mistake | None], ...] = (
    _blocks,
    _folds,
    _foreign,
    _edits,
    _motions,
    _decimal_points,
    _signs,
    _words,
    _ends,
    _declarations,
    _constants,
    _gaps,
    _names,
    _prose,
)
