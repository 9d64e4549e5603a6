"""Inference of blocks that the grammar lacks: an opening line, a body, a closing line.

A block cannot be inferred from one line: its opening line looks like a statement, and its closing
line fails only because the opening line did. So files that fail at an opening line are read to
their end. Which first word closes the block, so that both are balanced in every file? Which first
words occur only between the two? The grammar must have no other use for these words. From the
lines, and from the bodies of other blocks, one alternative is built: ``WHILE expression eol
statement* ENDWHILE``.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from grammar.blocks import BLOCKS
from grammar.parser.lexer import SKIPPED
from grammar.parser.recognizer import Recognizer
from recovery.proposals.alignment import Aligner
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.segmentation import Word
from recovery.tuning import MOST_BLOCK_FORMS, MOST_BODIES, MOST_MIDDLES

_Line = tuple[str, tuple[Word, ...]]  # its leading word, its tokens without the line end


@dataclass(frozen=True, slots=True)
class Block:
    """A form of a block as it would be written into a rule, and the words it reserves."""

    symbols: tuple[str, ...]
    keywords: tuple[str, ...]


@dataclass(slots=True)
class _BlockLines:
    """The lines of one kind of block in all files."""

    headers: list[tuple[Word, ...]] = field(default_factory=list)
    closers: list[tuple[Word, ...]] = field(default_factory=list)
    middles: dict[str, list[tuple[Word, ...]]] = field(default_factory=lambda: defaultdict(list))
    repeated: set[str] = field(default_factory=set)  # middles that occur twice in one block
    missing: set[str] = field(default_factory=set)  # middles that some block lacks
    body_first: bool = False  # whether the opener has lines before the first middle


class BlockFinder:
    """Finds blocks in texts, for one grammar."""

    def __init__(self, recognizer: Recognizer, profile: GrammarProfile, aligner: Aligner) -> None:
        self.recognizer = recognizer
        self.profile = profile
        self.vocabulary = profile.vocabulary
        self.aligner = aligner

    def find(self, opener: str, texts: Sequence[str], meant: frozenset[str]) -> list[Block]:
        """Return the forms of the block that a word opens, the most restrictive first.

        Returns none if it opens no block. ``meant`` are the names that are meant as keywords.
        """
        files = [self._lines(text, meant) for text in texts]
        files = [lines for lines in files if any(lead == opener for lead, _ in lines)]
        closer = self._closer(opener, files)
        if closer is None:
            return []
        seen = self._gathered(opener, closer, files)
        forms = list(self._forms(seen))
        words = [w for lines in (seen.headers, seen.closers, *seen.middles.values()) for w in lines]
        keywords = tuple(sorted({k for line in words for _, k in line if k}))
        return [Block(form, keywords) for form in forms]

    def _lines(self, text: str, meant: frozenset[str]) -> list[_Line]:
        lexer, end = self.recognizer.lexer, self.recognizer.line_kind
        name = lexer.name_kind
        out: list[_Line] = []
        words: list[Word] = []
        lead = ""
        for lexeme in lexer.lexemes(text):
            kind = lexer.kinds[lexeme]
            if kind == SKIPPED:
                continue
            if kind == end:
                if words:
                    out.append((lead, tuple(words)))
                words, lead = [], ""
                continue
            word = lexeme.upper()
            if not words:
                lead = word
            would_be = kind == name and (word in meant or (not words and self._closes(word)))
            words.append((kind, word if would_be else None))
        return out

    def _closes(self, word: str) -> bool:
        return word in _BLOCK_WORDS or word.startswith("END")

    def _closer(self, opener: str, files: Sequence[Sequence[_Line]]) -> str | None:
        """Return the first word that closes the block, balanced with ``opener`` in every file."""
        known = BLOCKS[opener].words if opener in BLOCKS else frozenset()
        leads = {lead for lines in files for lead, _ in lines} - {opener, ""}
        free = [
            w
            for w in leads
            if w in known or (not self.vocabulary.is_written(w) and self._is_word(w, files))
        ]
        good = [w for w in free if _is_end(w) and all(is_balanced(opener, w, f) for f in files)]
        return min(good, key=lambda w: (w not in known, w != f"END{opener}", w), default=None)

    def _is_word(self, word: str, files: Sequence[Sequence[_Line]]) -> bool:
        """Return whether a first word is a keyword in its lines."""
        lexer = self.recognizer.lexer
        first = next(words[0] for lines in files for lead, words in lines if lead == word)
        return first[1] is not None or lexer.is_keyword(first[0])

    def _gathered(self, opener: str, closer: str, files: Sequence[Sequence[_Line]]) -> _BlockLines:
        seen = _BlockLines()
        outside = {
            lead
            for lines in files
            for (lead, _), depth in zip(lines, _depths(opener, closer, lines), strict=True)
            if not depth
        }
        known = BLOCKS[opener].words if opener in BLOCKS else frozenset()
        blocks: list[Counter[str]] = []
        for lines in files:
            open_: list[Counter[str]] = []
            for lead, words in lines:
                if lead == opener:
                    if open_ and not open_[-1]:
                        seen.body_first = True
                    open_.append(Counter())
                    seen.headers.append(words)
                elif lead == closer and open_:
                    seen.closers.append(words)
                    blocks.append(open_.pop())
                elif open_:
                    free = not self.vocabulary.is_written(lead) and self._is_word(lead, files)
                    if lead not in outside and (lead in known or free) and not _is_end(lead):
                        open_[-1][lead] += 1
                        seen.middles[lead].append(words)
                    elif not open_[-1]:
                        seen.body_first = True
        seen.repeated = {lead for block in blocks for lead, count in block.items() if count > 1}
        seen.missing = {lead for lead in seen.middles if not all(block[lead] for block in blocks)}
        if known & seen.middles.keys():  # other words occur in such blocks by chance
            for lead in seen.middles.keys() - known:
                del seen.middles[lead]
        return seen

    def _forms(self, seen: _BlockLines) -> Iterator[tuple[str, ...]]:
        if len(seen.middles) > MOST_MIDDLES:
            return
        end = self.profile.line_end
        for body in self.profile.bodies[:MOST_BODIES]:
            headers = self._phrases(seen.headers)
            closers = self._phrases(seen.closers)
            for level in range(min(MOST_BLOCK_FORMS, len(headers))):
                if not closers:
                    return
                symbols = [*headers[level], end]
                if seen.body_first or not seen.middles:
                    symbols += body
                for lead, lines in seen.middles.items():
                    phrases = self._phrases(lines)
                    if not phrases:
                        return
                    phrase = phrases[min(level, len(phrases) - 1)]
                    often = "?"
                    if lead in seen.repeated:
                        often = "*" if lead in seen.missing else "+"
                    symbols.append(f"({' '.join((*phrase, end, *body))}){often}")
                yield (*symbols, *closers[min(level, len(closers) - 1)])

    def _phrases(self, lines: Sequence[tuple[Word, ...]]) -> list[tuple[str, ...]]:
        return self.aligner.common_phrases(list(dict.fromkeys(lines)))


_BLOCK_WORDS = frozenset(BLOCKS).union(*(block.words for block in BLOCKS.values()))


def _is_end(word: str) -> bool:
    return word.startswith("END") or word == "UNTIL"


def _depths(opener: str, closer: str, lines: Sequence[_Line]) -> list[int]:
    """Return the number of open blocks at each line, opening and closing lines included."""
    out = []
    depth = 0
    for lead, _ in lines:
        depth += lead == opener
        out.append(depth)
        depth -= lead == closer and depth > 0
    return out


def is_balanced(opener: str, closer: str, lines: Sequence[tuple[str, object]]) -> bool:
    """Return whether opening and closing words are balanced."""
    depth = 0
    for lead, _ in lines:
        depth += (lead == opener) - (lead == closer)
        if depth < 0:
            return False
    return not depth
