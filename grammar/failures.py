"""All failures of a file, not only the first.

KRL is a language of lines, so reading goes on with the next line after a failure. The question is
in which state. Three guesses, the first that lets the next line be read wins:

1. the line was meant as the grammar has it, but for some tokens: the state after the line without
   the shortest run of tokens at the failure (``FOR I=1 TO 9 STEP 2`` still opens its loop);
2. the line is dropped: the state before it;
3. the place is another than it seems, because something before it was not understood: a state in
   which some line of some program begins (`Anchors`).

Lines that can only be read because of guess 3, and the closers of openers that were dropped,
*follow* from an earlier failure and are marked so.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from grammar.lexer import EOF
from grammar.recognizer import Core, Frames, Recognizer, State, Tail
from grammar.sentences import Sentences

__all__ = ["BLOCKS", "Context", "Failure", "FailureFinder", "Form"]

#: What opens a block of KRL, and the lines that only make sense inside it or end it. Knowledge of
#: the language, needed where the grammar has no rule for the block yet.
BLOCKS: Mapping[str, frozenset[str]] = {
    "DEF": frozenset({"END"}),
    "DEFFCT": frozenset({"ENDFCT"}),
    "DEFDAT": frozenset({"ENDDAT"}),
    "IF": frozenset({"ELSE", "ENDIF"}),
    "FOR": frozenset({"ENDFOR"}),
    "WHILE": frozenset({"ENDWHILE"}),
    "REPEAT": frozenset({"UNTIL"}),
    "LOOP": frozenset({"ENDLOOP"}),
    "SWITCH": frozenset({"CASE", "DEFAULT", "ENDSWITCH"}),
    "SPLINE": frozenset({"ENDSPLINE", "SPL", "SLIN", "SCIRC"}),
    "PTP_SPLINE": frozenset({"ENDSPLINE", "SPTP"}),
}
_PREFIXES = frozenset({"GLOBAL"})
# A failing line is tried again without 1, 2, 3 … tokens; on enormous lines only so far.
_LONGEST_GAP = 64
# How many lines that say something decide where reading goes on.
_LINES_AHEAD = 4
_MOST_REMEMBERED = 50_000


@dataclass(frozen=True, slots=True)
class Form:
    """What failures of the same form share: the state a line begins in and its token kinds.

    ``index`` is the place of the offending token in ``kinds``.
    """

    before: Frames
    kinds: tuple[int, ...]
    index: int


@dataclass(frozen=True, slots=True)
class Context:
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
    mended: State | None  # guess 1


class Anchors:
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
        self._broken: dict[tuple[Core, Tail, tuple[int, ...]], _Broken] = {}
        self._contexts: dict[tuple[Core, Tail], Context] = {}
        self._framed: dict[tuple[Core, Tail], Frames] = {}

    @cached_property
    def _anchors(self) -> Anchors:
        return Anchors(self.recognizer)

    def find(self, text: str) -> list[Failure]:
        """Failures in the order of the file; empty where the text is a program."""
        kinds = self.recognizer.kinds(text)
        _, index = self.recognizer.run(self.recognizer.start, kinds)
        if index is None:
            return []
        return list(self._failures(text, kinds, index))

    def context(self, state: State) -> Context:
        """Rule, rule stack and expected set in the state before an offending token."""
        key = (state.core, state.tail)
        found = self._contexts.get(key)
        if found is None:
            found = self._contexts[key] = self._context(state)
        return found

    # ------------------------------------------------------------------------ reading on

    def _failures(self, text: str, kinds: list[int], first: int) -> Iterator[Failure]:
        lexer = self.recognizer.lexer
        lexemes, offsets = lexer.lexemes(text), list(lexer.offsets(text))
        if len(lexemes) >= len(kinds):  # what is skipped came as lexemes too
            kept = [i for i, lexeme in enumerate(lexemes) if lexer.kinds[lexeme] != -1]
            lexemes, offsets = [lexemes[i] for i in kept], [offsets[i] for i in kept]
        place = _Places(text, offsets)
        lines = list(_lines(kinds, self.recognizer.line_kind))
        current = next(i for i, (start, end) in enumerate(lines) if start <= first < end)
        state, _ = self.recognizer.run(self.recognizer.start, kinds[: lines[current][0]])
        opened: list[frozenset[str]] = []  # what closes the blocks that were dropped
        lost = False  # whether some dropped line may have changed the place we are at
        for number in range(current, len(lines)):
            start, end = lines[number]
            line = tuple(kinds[start:end])
            after, index = self.recognizer.run(state, line)
            if index is None:
                state = after
                continue
            broken = self._break(state, line)
            lead = _lead(lexemes[start:end])
            anchor = self._anchor(line) if lost or opened else None
            closes = next((b for b in reversed(opened) if lead in b), None)
            follows = closes is not None or anchor is not None or (line == (EOF,) and lost)
            yield Failure(
                *place(start + broken.form.index),
                lexemes=tuple(lexemes[start:end]),
                form=broken.form,
                state=broken.state,
                follows=follows,
            )
            if closes is not None and (lead.startswith("END") or lead == "UNTIL"):
                opened.remove(closes)
            elif closes is None and lead in BLOCKS and broken.mended is None:
                opened.append(BLOCKS[lead])
                lost = True
            guesses = [broken.mended, state] if anchor is None else [anchor]
            state = self._resume(guesses, kinds, lines[number + 1 :], lost=lost)

    def _break(self, before: State, line: tuple[int, ...]) -> _Broken:
        key = (before.core, before.tail, line)
        found = self._broken.get(key)
        if found is None:
            if len(self._broken) >= _MOST_REMEMBERED:
                self._broken.clear()
            state, index = self.recognizer.run(before, line)
            assert index is not None
            mended = None
            # something of the line has to stay: an empty line can be read nearly anywhere
            widest = len(line) - index if index else len(line) - 2
            for gap in range(1, min(widest, _LONGEST_GAP + 1)):
                after, failed = self.recognizer.run(state, line[index + gap :])
                if failed is None:
                    mended = after
                    break
            form = Form(self._frames(before), line, index)
            found = self._broken[key] = _Broken(form, state, mended)
        return found

    def _frames(self, state: State) -> Frames:
        key = (state.core, state.tail)
        found = self._framed.get(key)
        if found is None:
            found = self._framed[key] = self.recognizer.frames(state)
        return found

    def _anchor(self, line: tuple[int, ...]) -> State | None:
        """Where else this very line could be read."""
        for anchor in self._anchors.states:
            after, index = self.recognizer.run(anchor, line)
            if index is None:
                return after
        return None

    def _resume(
        self,
        guesses: Sequence[State | None],
        kinds: list[int],
        following: list[tuple[int, int]],
        *,
        lost: bool,
    ) -> State:
        """The guess under which most of the next lines can be read, the first of equals."""
        known = [g for g in guesses if g is not None]
        lines = [kinds[s:e] for s, e in following[: _LINES_AHEAD * 4]]
        lines = [line for line in lines if line[0] != self.recognizer.line_kind][:_LINES_AHEAD]
        if lost:
            known.reverse()
        if (len(known) == 1 and not lost) or self._readable(known[0], lines[:1]):
            return known[0]
        if lost:
            known += self._anchors.states
        return max(known, key=lambda state: self._readable(state, lines))

    def _readable(self, state: State, lines: list[list[int]]) -> int:
        """How many of the lines can be read from ``state``, those that cannot left out."""
        count = 0
        for line in lines:
            after, index = self.recognizer.run(state, line)
            if index is None:
                state = after
                count += 1
        return count

    # -------------------------------------------------------------------------- context

    def _context(self, state: State) -> Context:
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
        return Context(rules[-1], rules, expected)


def _lines(kinds: list[int], line_kind: int) -> Iterator[tuple[int, int]]:
    """Start and end of each line in ``kinds``; the end of file is a line of its own."""
    start, last = 0, len(kinds) - 1
    while start < last:
        try:
            end = kinds.index(line_kind, start, last) + 1
        except ValueError:
            end = last
        yield start, end
        start = end
    yield last, last + 1


def _lead(lexemes: Sequence[str]) -> str:
    """The word that says what a line is, in upper case."""
    words = [w.upper() for w in lexemes[:2]]
    if len(words) > 1 and words[0] in _PREFIXES:
        return words[1]
    return words[0] if words else ""


class _Places:
    """Line and column by token index; asked in ascending order."""

    def __init__(self, text: str, offsets: list[int]) -> None:
        self._end = len(text)
        self._offsets = offsets
        self._line = 1
        self._start = 0  # offset of the current line
        self._starts = (found.end() for found in re.finditer(r"\r\n|\r|\n", text))
        self._next = next(self._starts, self._end + 1)

    def __call__(self, index: int) -> tuple[int, int, int]:
        offset = self._offsets[index] if index < len(self._offsets) else self._end
        while self._next <= offset:
            self._line += 1
            self._start, self._next = self._next, next(self._starts, self._end + 1)
        return self._line, offset - self._start + 1, offset
