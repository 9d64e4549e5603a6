"""Blocks of several lines: an opening word, lines inside, a closing word.

One line does not show a block. So whole files are counted through: two words that lead lines open
and close a block if they are in balance in nearly every file that has one of them. Words whose
lines are only found right inside of such a block divide it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from grammar.parser.lexer import SKIPPED, Lexer
from recovery import tuning
from recovery.forms.symbols import Token

#: A line as its leading word, empty where it has none, and its tokens.
_Line = tuple[str, tuple[Token, ...]]
#: Distinct lines with the origins that have them.
_Having = dict[tuple[Token, ...], set[str]]


@dataclass(frozen=True, slots=True)
class SourceFile:
    """The lines of a file that say something, and the origins it comes from."""

    lines: tuple[_Line, ...]
    origins: frozenset[str]


@dataclass(slots=True)
class BlockLines:
    """The lines of all blocks with the same words.

    ``middles`` are those that divide it, in their order, with how often they come: ``?``, ``+`` or
    ``*``; ``has_body`` says whether other lines come before the first of them, ``is_spelt`` whether
    its words are spelt as those of other blocks.
    """

    opener: str
    closer: str
    headers: _Having = field(default_factory=lambda: defaultdict(set))
    closers: _Having = field(default_factory=lambda: defaultdict(set))
    middles: dict[str, _Having] = field(default_factory=dict)
    often: dict[str, str] = field(default_factory=dict)
    has_body: bool = False
    is_spelt: bool = False

    @property
    def words(self) -> frozenset[str]:
        """The words that lead lines which only such a block has."""
        return frozenset({self.opener, self.closer, *self.middles})


def lines_of(text: str, lexer: Lexer) -> Iterator[tuple[str, ...]]:
    """Yield the lines of a text that say something, as lexemes without blanks and comments."""
    line: list[str] = []
    for lexeme in (*lexer.lexemes(text), "\n"):
        kind = lexer.kinds[lexeme]
        if kind == lexer.line_kind:
            if line:
                yield tuple(line)
            line = []
        elif kind != SKIPPED:
            line.append(lexeme)


def find_blocks(
    files: Sequence[SourceFile],
    free: Iterable[str],
    least: tuple[int, int] = (tuning.BALANCED_ORIGINS, tuning.BALANCED_FILES),
    spelt: Collection[tuple[str, str]] = (),
) -> list[BlockLines]:
    """The blocks that words open which the grammar has no use for, ``free``; the most found first.

    The ``least`` are the origins and the files that have to have one; one file is enough for those
    whose words are ``spelt`` alike.

    Of two words that might open or close a block the one wins that does in more files, then the
    one with more lines between.
    """
    words = sorted(set(free))
    having: Mapping[str, list[int]] = {w: [] for w in words}
    counts = [Counter(lead for lead, _ in file.lines) for file in files]
    for number, count in enumerate(counts):
        for word in having.keys() & count.keys():
            having[word].append(number)
    pairs = []
    for opener in words:
        for closer in words:
            needed = (1, 1) if (opener, closer) in spelt else least
            if opener == closer or not _is_pair(opener, closer, files, counts, having, needed):
                continue
            places = {*having[opener], *having[closer]}
            inside = sum(_inside(opener, closer, files[n].lines) for n in places)
            is_spelt = (opener, closer) in spelt
            pairs.append((not is_spelt, -len(places), -inside, opener, closer))
    found: list[BlockLines] = []
    taken: set[str] = set()
    for *_, opener, closer in sorted(pairs):
        if not taken.intersection((opener, closer)):
            block = _gathered(opener, closer, files, set(words) - taken)
            if block is not None:
                block.is_spelt = (opener, closer) in spelt
                taken |= block.words
                found.append(block)
    return found


def _is_pair(
    opener: str,
    closer: str,
    files: Sequence[SourceFile],
    counts: Sequence[Counter[str]],
    having: Mapping[str, list[int]],
    least: tuple[int, int],
) -> bool:
    places = sorted({*having[opener], *having[closer]})
    equal = [n for n in places if counts[n][opener] == counts[n][closer]]
    damaged = len(places) >= tuning.FILES_WITH_ONE_DAMAGED
    needed = max(least[1], min(tuning.BALANCED_SHARE * len(places), len(places) - damaged))
    if len(equal) < needed:
        return False
    good = [n for n in equal if _is_balanced(opener, closer, files[n].lines)]
    having_it = frozenset[str]().union(*(files[n].origins for n in good))
    return len(good) >= needed and len(having_it) >= least[0]


def _inside(opener: str, closer: str, lines: Sequence[_Line]) -> int:
    """How many lines are between an opener and its closer: of two openers the outer one counts."""
    depth = found = 0
    for lead, _ in lines:
        depth += (lead == opener) - (lead == closer)
        found += depth > 0
    return found


def _gathered(
    opener: str, closer: str, files: Sequence[SourceFile], free: set[str]
) -> BlockLines | None:
    block = BlockLines(opener, closer)
    outside: set[str] = set()
    inside: dict[str, _Having] = defaultdict(lambda: defaultdict(set))
    bodies: list[list[str]] = []  # the leading words of the lines in each block
    for file in files:
        open_: list[list[str]] = []
        for lead, tokens in file.lines:
            if lead == opener:
                open_.append([])
                block.headers[tokens] |= file.origins
            elif lead == closer and open_:
                bodies.append(open_.pop())
                block.closers[tokens] |= file.origins
            elif not open_:
                outside.add(lead)
            else:
                open_[-1].append(lead)
                if lead in free:
                    inside[lead][tokens] |= file.origins
    if not any(bodies):  # nothing is ever between: two statements that come in pairs
        return None
    # a middle divides: it recurs in many of the blocks, or in several origins in nothing else
    middles = [
        word
        for word in inside
        if word not in outside
        and (
            sum(word in body for body in bodies) * tuning.MIDDLE_PART >= len(bodies)
            or len(frozenset[str]().union(*inside[word].values())) >= tuning.MIDDLE_ORIGINS
        )
    ]
    if len(middles) > tuning.BLOCK_MIDDLES:
        middles = []
    for word in middles:
        block.middles[word] = inside[word]
        counts = [body.count(word) for body in bodies]
        missing = 0 in counts
        block.often[word] = ("*" if missing else "+") if max(counts) > 1 else "?" * missing
    first = [body[0] for body in bodies if body]
    others = sum(word not in middles for word in first)
    block.has_body = not middles or others * tuning.BODY_PART > len(first)
    return block


def _is_balanced(opener: str, closer: str, lines: Sequence[tuple[str, object]]) -> bool:
    """Return whether opening and closing words are balanced."""
    depth = 0
    for lead, _ in lines:
        depth += (lead == opener) - (lead == closer)
        if depth < 0:
            return False
    return not depth
