"""Forms of blocks that the grammar lacks: an opening line, a body, a closing line.

A block cannot be inferred from one line: its opening line looks like a statement, and its closing
line fails only because the opening line did. So files that fail at an opening line are read to
their end (`recovery.proposals.blocks`). From the lines of the block, and from the bodies of other
blocks, one alternative is built: ``WHILE expression eol statement* ENDWHILE``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from recovery.forms.symbols import Token
from recovery.proposals.alignment import Aligner
from recovery.proposals.blocks import BlockLines, SourceFile, find_blocks, lines_of
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.tuning import MOST_BLOCK_FORMS, MOST_BODIES


@dataclass(frozen=True, slots=True)
class Block:
    """A form of a block as it would be written into a rule, and the words it reserves."""

    symbols: tuple[str, ...]
    keywords: tuple[str, ...]


class BlockFinder:
    """Finds blocks in texts, for one grammar."""

    def __init__(self, profile: GrammarProfile, aligner: Aligner) -> None:
        self.recognizer = profile.recognizer
        self.profile = profile
        self.vocabulary = profile.vocabulary
        self.aligner = aligner

    def find(self, opener: str, texts: Sequence[str], meant: frozenset[str]) -> list[Block]:
        """Return the forms of the block that a word opens, the most restrictive first.

        Returns none if it opens no block. ``meant`` are the names that are meant as keywords.
        """
        read = [tuple(self._lines(text, meant)) for text in texts]
        having = [lines for lines in read if any(lead == opener for lead, _ in lines)]
        files = [SourceFile(lines, frozenset({str(n)})) for n, lines in enumerate(having)]
        leads = {lead for file in files for lead, _ in file.lines}
        free = {lead for lead in leads if lead and not self.vocabulary.is_written(lead)}
        found = find_blocks(files, {opener, *free}, (1, 1))
        block = next((block for block in found if block.opener == opener), None)
        if block is None:
            return []
        words = [
            w for lines in (block.headers, block.closers, *block.middles.values()) for w in lines
        ]
        keywords = tuple(sorted({k for line in words for _, k in line if k}))
        return [Block(form, keywords) for form in self._forms(block)]

    def _lines(self, text: str, meant: frozenset[str]) -> Iterator[tuple[str, tuple[Token, ...]]]:
        """Yield the lines of a text: the keyword that begins it, or none, and its tokens.

        A name that is alone on its line is meant as a keyword too.
        """
        lexer = self.recognizer.lexer
        for line in lines_of(text, lexer):
            kinds = map(lexer.kinds.__getitem__, line)
            words = tuple(
                (kind, w if kind == lexer.name_kind and (w in meant or len(line) == 1) else None)
                for kind, w in zip(kinds, map(str.upper, line), strict=True)
            )
            is_word = words[0][1] or lexer.is_keyword(words[0][0])
            yield line[0].upper() if is_word else "", words

    def _forms(self, block: BlockLines) -> Iterator[tuple[str, ...]]:
        end = self.profile.line_end
        headers, closers = self._phrases(block.headers), self._phrases(block.closers)
        middles = {word: self._phrases(lines) for word, lines in block.middles.items()}
        if not closers or not all(middles.values()):
            return
        for body in self.profile.bodies[:MOST_BODIES]:
            for level in range(min(MOST_BLOCK_FORMS, len(headers))):
                symbols = [*headers[level], end, *(body if block.has_body else ())]
                for word, phrases in middles.items():
                    phrase = phrases[min(level, len(phrases) - 1)]
                    # that every block has it once may be chance
                    often = block.often[word] or "?"
                    symbols.append(f"({' '.join((*phrase, end, *body))}){often}")
                yield (*symbols, *closers[min(level, len(closers) - 1)])

    def _phrases(self, lines: Iterable[tuple[Token, ...]]) -> list[tuple[str, ...]]:
        return self.aligner.common_phrases(list(lines))
