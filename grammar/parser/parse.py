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
from typing import Any

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
        self._changes: dict[tuple[tuple[int, ...], int], tuple[_Change, ...]] = {}
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
        outline = self._assembled(derivation.lines)
        return Tree(text, lexer, kinds, lexemes, offsets, outline, derivation.is_unique)

    # --------------------------------------------------------------------------- outlines

    def _assembled(self, lines: Sequence[tuple[int, ...]]) -> Outline:
        """Return the outline of a text; rules that are still open at its end are closed there."""
        children: list[Outline | int] = []
        rules = [Begin(self.recognizer.grammar.start, False)]
        outer: list[list[Outline | int]] = []
        ends = self._ends
        ends += [_ending(steps) for steps, _ in self._deriver.actions[len(ends) :]]
        # what is complete with its line ends on it, though only the next token shows it
        behind = [*(ends[line[0]] for line in lines[1:]), 0]
        for line in zip(lines, behind, strict=True):
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

    def _changes_of(self, line: tuple[tuple[int, ...], int]) -> tuple[_Change, ...]:
        """Return the effects of a line, given by its actions and how many rules end behind it."""
        found = self._changes.get(line)
        if found is None:
            if max(len(self._changes), len(self._outlines)) >= _MOST_REMEMBERED:
                self._changes.clear()
                self._outlines.clear()
            numbers, ends = line
            actions = [self._deriver.actions[number] for number in numbers]
            found = tuple(self._effects_of(actions, ends))
            if len(numbers) < _LONGEST_REMEMBERED:
                self._changes[line] = found
        return found

    def _effects_of(self, actions: Sequence[Action], ends: int) -> Iterator[_Change]:
        """Yield the effects of a line on the stack of open rules; ``ends`` rules end behind it."""
        changes: list[Any] = []
        begun: list[tuple[Begin, list[Outline | int]]] = []
        inner = changes  # of the innermost rule that began on the line
        events = [event for steps, kind in actions for event in (*steps, kind)]
        ended = _ending(actions[0].steps)  # with the line before
        for event in (*events[ended:], *[None] * ends):
            if isinstance(event, int):  # the kind of a token
                inner.append(event)
                continue
            if event is not None:
                inner = []
                begun.append((event, inner))
                continue
            while begun:
                (rule, is_last), inside = begun.pop()
                inner = begun[-1][1] if begun else changes
                inner.append(self._shared(rule, tuple(inside)))
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
