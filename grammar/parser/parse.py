"""Parse trees under any grammar: files are put together from the cached effects of their lines.

`grammar.parser.derivation` finds which rules begin and end before each token. The effect of a line
is the same for every line with the same actions, so it is computed once: the outlines of all rules
that begin and end on the line, and the rules that it opens or closes. A line costs a few look-ups
and appends, a megabyte less than a second. Nothing here recurses over the text, so the depth of
nesting has no limit.

If a text has two readings, the tree is the one ANTLR builds (see `grammar.parser.derivation`). A
grammar in which a loop can repeat without reading, which ANTLR rejects, has trees too; how many
empty rounds such a loop has in the tree is not specified.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.parser.derivation import Action, Begin, Deriver, Steps
from grammar.parser.recognizer import Recognizer, State
from grammar.parser.tree import Outline, Tree
from support.lazy_dataclass import dataclass

# The caches of lines and outlines are bounded, and enormous lines are not cached at all; so is the
# automaton, of which a state with its back pointers takes a kilobyte.
_MOST_STATES = 20_000
_MOST_REMEMBERED = 20_000
_LONGEST_REMEMBERED = 1_000


@dataclass(frozen=True, slots=True)
class Stop:
    """The first token at which no program can continue, and the recogniser's state before it.

    ``line`` and ``column`` count from 1, ``offset`` from 0; ``text`` is the token as written, empty
    at the end of the file. `grammar.parser.failures` finds all failures of a file.
    """

    line: int
    column: int
    offset: int
    text: str
    state: State


#: One effect of a line on the stack of open rules: end the innermost rule and the rules that end
#: with it (``None``), begin a rule that stays open, or add a complete child to the innermost one.
_Change = None | Begin | Outline | int


class Parser:
    """Parses texts under the grammar of a recogniser; caches the effects of lines."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self._deriver = Deriver(recognizer.grammar, recognizer.lexer)
        self._ends: list[int] = []  # rules that end before a token, by the number of its action
        self._changes: dict[tuple[int, ...], tuple[_Change, ...]] = {}
        self._outlines: dict[tuple[str, tuple[Outline | int, ...]], Outline] = {}

    def parse(self, text: str) -> Tree | Stop:
        """Return the tree of a text, or the first token at which it is no program."""
        lexer = self.recognizer.lexer
        lexemes, offsets = lexer.located(text)
        kinds = self.recognizer.kinds_of(lexemes)
        lexemes.append("")
        offsets.append(len(text))
        if self._deriver.size > _MOST_STATES:
            self._deriver.release()
            self._deriver = Deriver(self.recognizer.grammar, lexer)
            self._ends.clear()  # the numbers of its actions begin anew
            self._changes.clear()
        derivation = self._deriver.derive(kinds)
        if derivation is None:
            state, index = self.recognizer.run(self.recognizer.start, kinds)
            assert index is not None, "the recogniser accepts what cannot be derived"
            nothing = Tree(text, lexer, kinds, lexemes, offsets, Outline("", ()), True)
            offset = offsets[index]
            return Stop(*nothing.place(offset), offset, lexemes[index], state)
        outline = self._assembled(kinds, derivation.actions)
        return Tree(text, lexer, kinds, lexemes, offsets, outline, derivation.is_unique)

    # --------------------------------------------------------------------------- outlines

    def _assembled(self, kinds: Sequence[int], actions: Sequence[int]) -> Outline:
        """Return the outline of a text; rules that are still open at its end are closed there."""
        children: list[Outline | int] = []
        rules = [Begin(self.recognizer.grammar.start, False)]
        outer: list[list[Outline | int]] = []
        for line in self._lines(kinds, actions):
            for change in self._changes_of(line):
                if change is None:
                    is_last = True
                    while is_last:
                        rule, is_last = rules.pop()
                        outline = Outline(rule, tuple(children))
                        children = outer.pop()
                        children.append(outline)
                elif isinstance(change, Begin):
                    rules.append(change)
                    outer.append(children)
                    children = []
                else:
                    children.append(change)
        while outer:
            outline = Outline(rules.pop().rule, tuple(children))
            children = outer.pop()
            children.append(outline)
        return Outline(rules.pop().rule, tuple(children))

    def _lines(self, kinds: Sequence[int], actions: Sequence[int]) -> Iterator[tuple[int, ...]]:
        """Yield the actions of each line with the blank lines behind it, then the rules that end.

        These end before the next token, so that what is complete with its line ends on it.
        """
        ends = self._ends
        ends += [_ending(steps) for steps, _ in self._deriver.actions[len(ends) :]]
        start, count, line_kind = 0, len(kinds), self.recognizer.line_kind
        while start < count:
            try:
                end = kinds.index(line_kind, start) + 1
                while kinds[end] == line_kind:  # the end of the file is the last token
                    end += 1
            except ValueError:
                end = count
            yield (*actions[start:end], ends[actions[end]] if end < count else 0)
            start = end

    def _changes_of(self, line: tuple[int, ...]) -> tuple[_Change, ...]:
        found = self._changes.get(line)
        if found is None:
            if max(len(self._changes), len(self._outlines)) >= _MOST_REMEMBERED:
                self._changes.clear()
                self._outlines.clear()
            numbered = self._deriver.actions
            actions = [numbered[number] for number in line[:-1]]
            found = tuple(self._effects_of(actions, line[-1]))
            if len(line) <= _LONGEST_REMEMBERED:
                self._changes[line] = found
        return found

    def _effects_of(self, actions: Sequence[Action], ends: int) -> Iterator[_Change]:
        """Yield the effects of a line on the stack of open rules; ``ends`` rules end behind it."""
        changes: list[_Change] = []
        begun: list[tuple[Begin, list[Outline | int]]] = []
        events = [event for steps, kind in actions for event in (*steps, kind)]
        ended = _ending(actions[0].steps)  # with the line before
        for event in (*events[ended:], *[None] * ends):
            if isinstance(event, int):  # the kind of a token
                (begun[-1][1] if begun else changes).append(event)
                continue
            if event is not None:
                begun.append((event, []))
                continue
            while begun:
                (rule, is_last), inside = begun.pop()
                (begun[-1][1] if begun else changes).append(self._shared(rule, tuple(inside)))
                if not is_last:
                    break
            else:  # the rule that ends began on an earlier line
                changes.append(None)
        yield from changes
        for begin, inside in begun:
            yield begin
            yield from inside

    def _shared(self, rule: str, children: tuple[Outline | int, ...]) -> Outline:
        """Return the interned outline with this rule and these children."""
        found = self._outlines.get((rule, children))
        if found is None:
            found = self._outlines[rule, children] = Outline(rule, children)
        return found


def _ending(steps: Steps) -> int:
    """Return how many rules end before another one begins."""
    return next((at for at, step in enumerate(steps) if step is not None), len(steps))
