"""All failures of a file, each with the rule it is in and the tokens expected there.

KRL is a language of lines, so after a failure reading continues with the next line. The state in
which it continues is a guess. There are three, and the first in which the next line can be read is
taken:

1. The line was meant as the grammar has it, except for some tokens: the state after the line
   without the shortest run of tokens at the failure. ``FOR I=1 TO 9 STEP 2`` still opens its loop
   under a grammar without ``STEP``.
2. The line is dropped: the state before it.
3. The context is another one, because an earlier line was not understood: any state in which a line
   of some program can begin (`line_states`).

A line that can only be read because of guess 3, and a line that closes a block whose opening line
was dropped, *follow* from an earlier failure and are marked so.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import accumulate, islice

from grammar.blocks import BLOCKS, PREFIXES, Block
from grammar.parser.lazy_automaton import Core, Tail
from grammar.parser.lexer import SKIPPED, Lexer
from grammar.parser.line_reader import LineReader, Spot
from grammar.parser.recognizer import Frames, Recognizer, State
from grammar.parser.sentences import Sentences
from support.lazy_dataclass import dataclass

# A failing line is tried again without 1, 2, 3 … tokens, up to this number.
_LONGEST_GAP = 64
# How many of the next lines, blank ones left out, decide where reading continues.
_LINES_AHEAD = 4
# Among how many they are sought.
_LINES_LOOKED_AT = 4 * _LINES_AHEAD
_MOST_REMEMBERED = 50_000
_LINE_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True)
class Form:
    """What similar failures share: the state in which the line begins, and its token kinds.

    ``index`` is the index of the offending token in ``kinds``.
    """

    before: Frames
    kinds: tuple[int, ...]
    index: int


@dataclass(frozen=True, slots=True)
class FailureContext:
    """The rules that were being read at a failure.

    ``rule`` is the innermost rule that cannot end there, ``rules`` the call chain to it from the
    start rule, and ``expected`` the expected tokens as people read them, sorted.
    """

    rule: str
    rules: tuple[str, ...]
    expected: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Failure:
    """One line that cannot be read.

    ``line`` and ``column`` count from 1 (columns in characters), ``offset`` from 0. ``lexemes`` are
    the texts of the line's tokens, ``form.index`` is the index of the offending one, and ``state``
    is the state before it. ``follows`` means that the line only fails because an earlier one was
    not understood.
    """

    line: int
    column: int
    offset: int
    lexemes: tuple[str, ...]
    form: Form
    state: State
    follows: bool

    @property
    def text(self) -> str:
        """The offending token as written; empty at the end of the file."""
        index = self.form.index
        return self.lexemes[index] if index < len(self.lexemes) else ""


@dataclass(frozen=True, slots=True)
class _Broken:
    """How a line with these tokens fails in a given state, in any file."""

    form: Form
    state: State
    mended: Spot | None  # guess 1


def line_states(recognizer: Recognizer) -> Mapping[State, Sequence[int]]:
    """Return states in which a line can begin, each with the shortest tokens found to lead to it.

    They are those of the shortest programs through every rule, the first line left out.
    """
    sentences = Sentences(recognizer.grammar)
    kind_of = recognizer.lexer.kind_of
    found: dict[State, list[int]] = {}
    for rule in sentences.reachable:
        for sentence in sentences.through(rule):
            kinds = [kind_of[name] for name in sentence]
            state = recognizer.start
            for end, kind in enumerate(kinds, 1):
                following = recognizer.step(state, kind)
                if following is None:  # the shortest context does not fit this alternative
                    break
                state = following
                is_shorter = state not in found or end < len(found[state])
                if kind == recognizer.line_kind and is_shorter:
                    found[state] = kinds[:end]
    return found


def beginning(text: str, line: int) -> str:
    """Return as much of a text as decides how its lines up to ``line`` are read.

    How reading continues after a failing line depends on the lines behind it. No token but a line
    end may contain one.
    """
    ends = (found.end() for found in _LINE_END.finditer(text))
    return text[: next(islice(ends, line + _LINES_LOOKED_AT, None), len(text))]


class FailureFinder:
    """Finds the failures of files under one grammar; caches the lines it has seen."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self._reader = LineReader(recognizer)
        self._contexts: dict[tuple[Core, Tail], FailureContext] = {}
        self._forget()

    def _forget(self) -> None:
        self._reader.forget()
        self._framed: dict[Spot, Frames] = {}
        self._broken: dict[tuple[Spot, int], _Broken] = {}
        self._elsewhere: dict[int, Spot | None] = {}
        self._resumed: dict[tuple[object, ...], Spot] = {}

    @cached_property
    def _anchors(self) -> Sequence[State]:
        return list(line_states(self.recognizer))

    def find(self, text: str) -> list[Failure]:
        """Return the failures of a text in order; empty if the text is a program."""
        lexer = self.recognizer.lexer
        lexemes = lexer.lexemes(text)
        kinds = self.recognizer.kinds_of(lexemes)
        if self.recognizer.run(self.recognizer.start, kinds)[1] is None:
            return []
        if not lexer.leaves_out_skipped:
            lexemes = [lexeme for lexeme in lexemes if lexer.kinds[lexeme] != SKIPPED]
        if len(self._reader) > _MOST_REMEMBERED:
            self._forget()
        return list(self._failures(text, lexemes, kinds))

    def context(self, state: State) -> FailureContext:
        """Return the rules being read, and the expected tokens, in the state before a failure."""
        key = (state.core, state.tail)
        found = self._contexts.get(key)
        if found is None:
            found = self._contexts[key] = self._context(state)
        return found

    # ------------------------------------------------------------------------ reading on

    def _failures(self, text: str, lexemes: list[str], kinds: list[int]) -> Iterator[Failure]:
        reader = self._reader
        lines = reader.numbers(kinds)
        starts = [0, *accumulate(len(reader.kinds[line]) for line in lines)]
        ends = kinds.count(self.recognizer.line_kind)
        place = _Places(text, self.recognizer.lexer, starts, ends)
        spot = reader.spot(self.recognizer.start)
        opened: list[Block] = []  # the blocks whose opening lines were dropped
        lost = False  # whether a dropped line may have opened a block
        for number, line in enumerate(lines):
            after = reader.after(spot, line)
            if after is not None:
                spot = after
                continue
            broken = self._break(spot, line)
            written = tuple(lexemes[starts[number] : starts[number + 1]])
            lead = _lead(written)
            anchor = self._anchor(line) if lost or opened else None
            closes = next((b for b in reversed(opened) if lead in b.words), None)
            is_end = number == len(lines) - 1
            yield Failure(
                *place(number, broken.form.index),
                lexemes=written,
                form=broken.form,
                state=broken.state,
                follows=closes is not None or anchor is not None or (is_end and lost),
            )
            if closes is not None and lead == closes.closer:
                opened.remove(closes)
            elif closes is None and lead in BLOCKS and broken.mended is None:
                opened.append(BLOCKS[lead])
                lost = True
            guesses = (broken.mended, spot) if anchor is None else (anchor,)
            ahead = lines[number + 1 : number + 1 + _LINES_LOOKED_AT]
            spot = self._resume(guesses, ahead, lost=lost)

    def _break(self, spot: Spot, line: int) -> _Broken:
        found = self._broken.get((spot, line))
        if found is None:
            kinds = self._reader.kinds[line]
            state, index = self.recognizer.run(spot.state, kinds)
            assert index is not None
            mended = None
            # some tokens have to remain: an empty line can be read nearly anywhere
            widest = len(kinds) - index if index else len(kinds) - 2
            for gap in range(1, min(widest, _LONGEST_GAP + 1)):
                after, failed = self.recognizer.run(state, kinds[index + gap :])
                if failed is None:
                    mended = self._reader.spot(after)
                    break
            if spot not in self._framed:
                self._framed[spot] = self.recognizer.frames(spot.state)
            form = Form(self._framed[spot], kinds, index)
            found = self._broken[spot, line] = _Broken(form, state, mended)
        return found

    def _anchor(self, line: int) -> Spot | None:
        """Return the spot after this line in the first of the `line_states` that can read it."""
        try:
            return self._elsewhere[line]
        except KeyError:
            spots = map(self._reader.spot, self._anchors)
            reached = (self._reader.after(spot, line) for spot in spots)
            found = next((spot for spot in reached if spot is not None), None)
            self._elsewhere[line] = found
            return found

    def _resume(self, guesses: Sequence[Spot | None], ahead: list[int], *, lost: bool) -> Spot:
        """Return the guess that lets most of the next lines be read; the first one on a tie."""
        key = (lost, *guesses, *ahead)
        found = self._resumed.get(key)
        if found is None:
            found = self._resumed[key] = self._best(guesses, ahead, lost=lost)
        return found

    def _best(self, guesses: Sequence[Spot | None], ahead: list[int], *, lost: bool) -> Spot:
        known = [g for g in guesses if g is not None]
        kinds, blank = self._reader.kinds, self.recognizer.line_kind
        lines = [line for line in ahead if kinds[line][0] != blank][:_LINES_AHEAD]
        if (len(known) == 1 and not lost) or self._readable(known[0], lines[:1]):
            return known[0]
        if lost:
            known += map(self._reader.spot, self._anchors)
        return max(known, key=lambda spot: self._readable(spot, lines))

    def _readable(self, spot: Spot, lines: list[int]) -> int:
        """Return how many of the lines can be read in order from ``spot``, skipping the others."""
        count = 0
        for line in lines:
            after = self._reader.after(spot, line)
            if after is not None:
                spot = after
                count += 1
        return count

    # -------------------------------------------------------------------------- context

    def _context(self, state: State) -> FailureContext:
        recognizer = self.recognizer
        final, rule_of = recognizer.network.final, recognizer.network.rule
        ways: list[tuple[int, ...]] = []
        for frames in recognizer.frames(state):
            unfinished = next((i for i, p in enumerate(frames) if not final[p]), len(frames) - 1)
            ways.append(frames[unfinished:][::-1])
        shared: list[int] = []
        for level in zip(*ways, strict=False):
            if len(set(level)) > 1:
                break
            shared.append(level[0])
        rules = tuple(rule_of[p] for p in shared) or (recognizer.grammar.start,)
        display = recognizer.lexer.display
        expected = tuple(sorted(display[k] for k in recognizer.expected(state)))
        return FailureContext(rules[-1], rules, expected)


def _lead(lexemes: Sequence[str]) -> str:
    """Return the word that tells the kind of a line, in upper case."""
    words = [w.upper() for w in lexemes[:2]]
    if len(words) > 1 and words[0] in PREFIXES:
        return words[1]
    return words[0] if words else ""


class _Places:
    """Line, column and offset of a token, given by its line number and its index in the line.

    ``starts`` are the indices of the first token of each line and of the token after the last line;
    ``ends`` is the number of tokens that are line ends. Only the positions of failing tokens are
    needed, so they are computed on demand from where their line begins in the text.
    """

    def __init__(self, text: str, lexer: Lexer, starts: Sequence[int], ends: int) -> None:
        self._text = text
        self._lexer = lexer
        self._starts = starts
        self._lines = [0, *(found.end() for found in _LINE_END.finditer(text))]
        # if tokens contain line ends, or line ends are no tokens, offsets are computed for all
        self._offsets: list[int] | None = None
        if ends != len(self._lines) - 1 or not lexer.leaves_out_skipped:
            self._offsets = lexer.located(text)[1]

    def __call__(self, number: int, index: int) -> tuple[int, int, int]:
        offset = self._offset(number, index)
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1, offset

    def _offset(self, number: int, index: int) -> int:
        if number == len(self._starts) - 2:  # the end of the file
            return len(self._text)
        if self._offsets is not None:
            return self._offsets[self._starts[number] + index]
        return next(islice(self._lexer.offsets(self._text, self._lines[number]), index, None))
