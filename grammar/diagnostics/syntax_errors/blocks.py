"""Blocks that are not closed, or closed without being open."""

from __future__ import annotations

from grammar.blocks import BRANCHES, CLOSERS, OUTERMOST
from grammar.diagnostics.diagnostic import Fix, Region
from grammar.diagnostics.open_blocks import OpenBlock, innermost, lead, most_likely
from grammar.diagnostics.syntax_errors.error_site import ErrorSite, Mistake
from grammar.diagnostics.syntax_errors.words import FOREIGN_WORDS


def unbalanced_block(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a block that is not closed, or closed without being open."""
    block, word = site.block, lead(site.code)
    if not site.failure.text:
        return _not_closed(site, block) if block else None
    if site.place > (1 if site.word(0) == "GLOBAL" else 0) or word != site.text:
        return None
    if word == "END" and (two := _end_in_two_words(site)):
        return two
    if block is None:
        return None
    if word in OUTERMOST:
        return _not_closed(site, block)
    openers = CLOSERS.get(word) or ((BRANCHES[word],) if word in BRANCHES else ())
    if not openers:
        return None
    if block.word in openers:
        return _second_branch(site, block) if word in ("ELSE", "DEFAULT") else None
    if innermost(block, openers) is not None:
        return _not_closed(site, block)
    if word in ("END", "ENDFCT", "ENDDAT"):
        return _other_end(site, block)
    is_open = f"{block.word} on line {block.line} is open, with {block.closer}"
    return Mistake(f"{word} without {openers[0]}", reason=is_open if block.outer else "")


def _second_branch(site: ErrorSite, block: OpenBlock) -> Mistake:
    """Return the mistake of a second ELSE or DEFAULT, which may belong to the block around."""
    line = site.failure.line
    is_inside = most_likely(site.source, block, line + 1)[1] > line
    return Mistake(f"a second {site.text}") if is_inside else _not_closed(site, block)


def _other_end(site: ErrorSite, block: OpenBlock) -> Mistake:
    """Return the mistake of an END, ENDFCT or ENDDAT that closes a module of another kind."""
    if block.outer is not None:
        return _not_closed(site, block)
    message = f"{block.word} on line {block.line} is closed by {block.closer}"
    return Mistake(message, site.swap(block.closer, site.place))


def _not_closed(site: ErrorSite, block: OpenBlock) -> Mistake:
    """Return the mistake of a block without its closing word, before the line that shows it."""
    end, region = site.failure.line, None
    before = site.text.split()[0] if site.text else "the end"
    if block.word not in OUTERMOST:
        block, line = most_likely(site.source, block, end)
        if line != end:
            text = site.source.line(line)
            begin, before = len(text) - len(text.lstrip()), f"line {line}"
            region = Region(line, 1 + begin, line, 1 + len(text.rstrip()))
    return Mistake(
        f"{block.word} on line {block.line} is not closed",
        Fix(f"write {block.closer} before {before}"),
        reason=f"{block.closer} is missing",
        slug="endloop-missing" if block.word == "LOOP" else "syntax",
        region=region,
    )


def _end_in_two_words(site: ErrorSite) -> Mistake | None:
    """Return the mistake of ``END IF``, where the second word makes it another closing word."""
    written = f"END{site.word(1)}"
    closer = FOREIGN_WORDS.get(written, written)
    if not site.word(1) or closer not in CLOSERS:
        return None
    message = f"END {site.word(1)} is written as one word"
    return Mistake(message, site.swap(closer, 0, 1))
