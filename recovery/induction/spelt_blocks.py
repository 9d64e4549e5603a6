"""Blocks whose closing word is spelt like those of other blocks: ``ENDSWITCH`` closes ``SWITCH``.

Where a lexer reserves several words together with the same letters ahead of them (``FOR`` and
``ENDFOR``, ``IF`` and ``ENDIF``), words of a corpus that differ so are a pair too. A single block
then shows as much as several of others do.
"""

from __future__ import annotations

from collections import Counter

from grammar.parser.lexer import Lexer
from recovery.induction.corpus_lines import CorpusLines
from recovery.tuning import BALANCED_SHARE, SEVERAL


def spelt_blocks(corpus: CorpusLines, lexer: Lexer) -> frozenset[tuple[str, str]]:
    """Return names that lead as many lines as others close, as openers and closers.

    The letters of a closer are those ahead, and the end of its opener: ``DEFFCT``, ``ENDFCT``.
    """
    reserved = {w for w, kind in lexer.kind_of.items() if lexer.is_keyword(kind)}
    ahead = Counter(
        c.removesuffix(o) for c in reserved for o in reserved if c.endswith(o) and c != o
    )
    beginnings = tuple(a for a, count in ahead.items() if count >= SEVERAL)
    leads = [{w for w in line[:2] if lexer.kinds[w] == lexer.name_kind} for line in corpus.lines]
    words = frozenset[str]().union(*leads)
    pairs = {
        (opener, closer)
        for beginning in beginnings
        for closer in words
        for end in [closer.removeprefix(beginning)]
        for opener in words
        if 1 < len(end) < len(closer) and opener.endswith(end) and opener != closer
    }
    if not pairs:
        return frozenset()
    counts = [Counter(w for n in numbers for w in leads[n]) for numbers in corpus.of_file]
    return frozenset(
        (opener, closer)
        for opener, closer in pairs
        for having in [[c for c in counts if c[opener] or c[closer]]]
        if sum(c[opener] == c[closer] for c in having) >= BALANCED_SHARE * len(having)
    )
