"""All failures of a file, not only the first.

KRL is a language of lines, so reading continues with the next line after a failure. The question is
in which state. Three guesses, the first that lets the next line be read wins:

1. the line was meant as the grammar has it, but for some tokens: the state after the line without
   the shortest run of tokens at the failure (``FOR I=1 TO 9 STEP 2`` still opens its loop);
2. the line is dropped: the state before it;
3. the place is another than it seems, because something before it was not understood: a state in
   which some line of some program begins (`LineStates`).

Lines that can only be read because of guess 3, and the closers of openers that were dropped,
*follow* from an earlier failure and are marked so.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import accumulate, islice

from grammar.blocks import BLOCKS, PREFIXES, Block
from grammar.parser.lazy_automaton import Core, Tail
from grammar.parser.lexer import SKIPPED, Lexer
from grammar.parser.line_reader import LineReader, Spot
from grammar.parser.recognizer import Frames, Recognizer, State
from grammar.parser.sentences import Sentences
from support.lazy_dataclass import dataclass

# A failing line is tried again without 1, 2, 3 … tokens; on enormous lines only so far.
_LONGEST_GAP = 64
# How many lines that say something decide where reading continues.
_LINES_AHEAD = 4
_MOST_REMEMBERED = 50_000
_LINE_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True)
class Form:
    """What failures of the same form share: the state a line begins in and its token kinds.

    ``index`` is the place of the offending token in ``kinds``.
    """

    before: Frames
    kinds: tuple[int, ...]
    index: int


@dataclass(frozen=True, slots=True)
class FailureContext:
    """What the grammar was doing at a failure.

    ``rule`` is the innermost rule that cannot end there, ``rules`` the way to it from the start
    rule, ``expected`` what could have come, as people read it, sorted.
    """

    rule: str
    rules: tuple[str, ...]
    expected: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Failure:
    """One line that cannot be read.

    ``line`` and ``column`` count from 1 (columns in characters), ``offset`` from 0. ``lexemes`` are
    the texts of the line's tokens, ``form.index`` the offending one among them, ``state`` the state
    before it. ``follows`` marks what only fails because an earlier line was not understood.
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
    """How a line with these tokens fails in a given state, whatever file it is in."""

    form: Form
    state: State
    mended: Spot | None  # guess 1


class LineStates:
    """States in which a line can begin, from the shortest programs through every rule."""

    def __init__(self, recognizer: Recognizer) -> None:
        sentences = Sentences(recognizer.grammar)
        kind_of = recognizer.lexer.kind_of
        found: dict[tuple[Core, Tail], State] = {}
        for rule in sentences.reachable:
            for sentence in sentences.through(rule):
                state = recognizer.start
                for name in sentence:
                    following = recognizer.step(state, kind_of[name])
                    if following is None:  # a rule that only fits with more around it
                        break
                    state = following
                    if kind_of[name] == recognizer.line_kind:
                        found.setdefault((state.core, state.tail), state)
        self.states = tuple(found.values())


class FailureFinder:
    """Finds the failures of files under one grammar; remembers lines it has seen."""

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
    def _anchors(self) -> LineStates:
        return LineStates(self.recognizer)

    def find(self, text: str) -> list[Failure]:
        """Failures in the order of the file; empty where the text is a program."""
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
        """Rule, rule stack and expected set in the state before an offending token."""
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
        opened: list[Block] = []  # the blocks whose first lines were dropped
        lost = False  # whether some dropped line may have changed the place we are at
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
            ahead = lines[number + 1 : number + 1 + _LINES_AHEAD * 4]
            spot = self._resume(guesses, ahead, lost=lost)

    def _break(self, spot: Spot, line: int) -> _Broken:
        found = self._broken.get((spot, line))
        if found is None:
            kinds = self._reader.kinds[line]
            state, index = self.recognizer.run(spot.state, kinds)
            assert index is not None
            mended = None
            # something of the line has to stay: an empty line can be read nearly anywhere
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
        """Where else this very line could be read."""
        try:
            return self._elsewhere[line]
        except KeyError:
            spots = map(self._reader.spot, self._anchors.states)
            reached = (self._reader.after(spot, line) for spot in spots)
            found = next((spot for spot in reached if spot is not None), None)
            self._elsewhere[line] = found
            return found

    def _resume(self, guesses: Sequence[Spot | None], ahead: list[int], *, lost: bool) -> Spot:
        """The guess under which most of the next lines can be read, the first of equals."""
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
            known += map(self._reader.spot, self._anchors.states)
        return max(known, key=lambda spot: self._readable(spot, lines))

    def _readable(self, spot: Spot, lines: list[int]) -> int:
        """How many of the lines can be read from ``spot``, those that cannot left out."""
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
    """The word that says what a line is, in upper case."""
    words = [w.upper() for w in lexemes[:2]]
    if len(words) > 1 and words[0] in PREFIXES:
        return words[1]
    return words[0] if words else ""


class _Places:
    """Line, column and offset of a token, given by the number of its line and its index in it.

    ``starts`` are the indices of the first token of each line and of what follows the last, and
    ``ends`` is how many tokens are line ends. Only failing tokens are asked for: their offsets are
    worked out from where their line begins in the text.
    """

    def __init__(self, text: str, lexer: Lexer, starts: Sequence[int], ends: int) -> None:
        self._text = text
        self._lexer = lexer
        self._starts = starts
        self._lines = [0, *(found.end() for found in _LINE_END.finditer(text))]
        # where tokens hold line ends, or line ends are no tokens, all offsets have to be known
        self._offsets: list[int] | None = None
        if ends != len(self._lines) - 1 or not lexer.leaves_out_skipped:
            self._offsets = lexer.offsets_of_tokens(text)

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
