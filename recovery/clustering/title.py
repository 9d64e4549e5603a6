"""Titles of clusters: what is wrong with a failing line, in the words of a maintainer."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence

from grammar.notation.addresses import element_at
from grammar.notation.edits import MakeOptional
from grammar.parser.failures import FailureContext
from grammar.parser.lexer import EOF, ERROR
from grammar.parser.recognizer import Recognizer
from recovery.brackets import BRACKETS
from recovery.clustering.cause import Proposal
from recovery.proposals.edit_site import LinePattern
from recovery.tuning import MOST_DISTINCT, MOST_EXPECTED, MOST_LISTED


class TitleWriter:
    """Writes what could not be read in a line, and what the grammar expected."""

    def __init__(self, recognizer: Recognizer) -> None:
        self._recognizer = recognizer
        self._lexer = recognizer.lexer
        self._ends = (EOF, self._lexer.line_kind)
        self._line_end = recognizer.lexer.line_end and self._lexer.display[recognizer.line_kind]
        self._kind_of = {text: kind for kind, text in enumerate(self._lexer.display)}

    def title(
        self,
        line: LinePattern,
        context: FailureContext,
        bracket: str,
        others: Sequence[LinePattern] = (),
        best: Proposal | None = None,
    ) -> str:
        """Return a sentence without full stop: ``INT without DECL`` or ``FOR with STEP``.

        ``bracket`` is the innermost open one before the failing token, ``others`` are all lines of
        the cause, and ``best`` is the proposal that repairs the line, if there is one.
        """
        kinds, index = line.form.kinds, line.form.index
        meant = dict(line.keywords)
        lead = self._keyword(line, 0)
        came = meant.get(index) or self._phrase(kinds[index])
        missing = self._omitted_keyword(line, context)
        rule, left_out = ("", [""]) if missing or meant else self._left_out(best)
        at_end = kinds[index] in self._ends
        early = next((word for place, word in line.keywords if 0 < place < index), "")
        if missing or self._is_keyword(left_out[0]):
            subject = context.rule if index or at_end else came
            said = f"{lead or _spoken(subject)} without {missing or ' '.join(left_out)}"
        elif len(left_out) > 1:  # a part with a sign or word of its own
            said = f"{_spoken(rule)} without {' and '.join(map(self._named, left_out))}"
        elif early:  # read as a name, so the line failed later
            said = f"{lead} with {early}" if lead else f"unknown keyword {early}"
        elif 0 in meant and index <= 1:
            followers = {self._keyword(other, 1) for other in others or (line,)}
            follower = followers.pop() if len(followers) == 1 else ""
            said = f"unknown keyword {lead}" + (f" before {follower}" if follower else "")
        elif at_end and index == 1 and not lead:
            said = f"{self._phrase(kinds[0])} alone on a line"
        elif at_end:
            what = f"{lead} line" if lead else came.removeprefix("the end of ")
            said = f"{what} ends{self._instead(context) or ' too early'}"
        elif index == 0:
            said = f"{came} begins a line{self._instead(context)}"
        else:
            said = self._behind(line, context, bracket, lead, came)
            said += "" if context.expected == (self._line_end,) else self._instead(context)
        return said[:1].upper() + said[1:]

    def title_of_names(self, lines: Iterable[LinePattern]) -> str:
        """Return the title for lines that fail at a keyword: ``DELAY and SEC as names``."""
        words = sorted({self._phrase(line.form.kinds[line.form.index]) for line in lines})
        if len(words) == 1:
            return f"{words[0]} as a name"
        some = [*words[:MOST_LISTED], f"{len(words) - MOST_LISTED} more"]
        *ahead, last = some if len(words) > MOST_LISTED + 1 else words
        return f"{', '.join(ahead)} and {last} as names"

    def distinguished(
        self, titles: Sequence[str], lines: Sequence[LinePattern], rules: Sequence[str]
    ) -> list[str]:
        """Return the titles made unique: by the next words of the line, its rule, or a number."""
        out = list(titles)
        alike: dict[str, list[int]] = defaultdict(list)
        for number, title in enumerate(titles):
            alike[title].append(number)
        for same in (numbers for numbers in alike.values() if len(numbers) > 1):
            shapes = [(*self._shape(lines[n]), "") for n in same]  # the end tells apart too
            begun = Counter(s[:n] for s in shapes for n in range(2, min(MOST_DISTINCT, len(s)) + 1))
            for number, shape in zip(same, shapes, strict=True):
                end = next((n for n in range(2, MOST_DISTINCT + 1) if begun[shape[:n]] == 1), None)
                if end is None:
                    out[number] += f" in {_spoken(rules[number])}"
                else:
                    dots = " …" if len(shape) - 1 > end else ""
                    out[number] += f": {' '.join(filter(None, shape[:end]))}{dots}"
        again: Counter[str] = Counter()
        for number, title in enumerate(out):
            again[title] += 1
            out[number] += f" ({again[title]})" if again[title] > 1 else ""
        return out

    def _shape(self, line: LinePattern) -> tuple[str, ...]:
        """Return the words and signs of a line, with kinds in place of names and values."""
        display, names = self._lexer.display, self._lexer.names
        return tuple(
            meant
            or (
                "?"
                if kind < 0
                else _spoken(names[kind])
                if display[kind] == names[kind] and not self._lexer.is_keyword(kind)
                else display[kind]
            )
            for kind, meant in line.words()
            if kind not in self._ends
        )

    def _behind(
        self, line: LinePattern, context: FailureContext, bracket: str, lead: str, came: str
    ) -> str:
        """Return what was found where, for a line whose beginning was read."""
        before = line.form.kinds[line.form.index - 1]
        if bracket:
            is_first = before == self._kind_of.get(bracket)
            if not is_first and self._lexer.is_sign(before) and self._lexer.display[before] != ",":
                came = f"{self._phrase(before)} followed by {came}"
            where = (
                f"right behind '{bracket}'" if is_first else f"in '{bracket}{BRACKETS[bracket]}'"
            )
            return f"{lead} with {came} {where}" if lead else f"{came} {where}"
        if line.form.index == 1:
            return f"{lead or self._phrase(before)} followed by {came}"
        if lead:
            return f"{lead} with {came}"
        if self._line_end in context.expected:
            return f"line goes on with {came}"
        return f"{self._phrase(before)} followed by {came}"

    def _instead(self, context: FailureContext) -> str:
        """Return what was expected, if that is short enough."""
        wanted = [t for t in context.expected if t != self._line_end] or [self._line_end]
        if len(wanted) > MOST_EXPECTED:
            return ""
        phrases = [self._phrase(self._kind_of[text]) for text in wanted]
        return f" where {' or '.join(phrases)} is expected"

    def _left_out(self, best: Proposal | None) -> tuple[str, list[str]]:
        """Return the rule and the parts that a proposal makes optional, if it does nothing else."""
        match best.edits if best else ():
            case [MakeOptional(rule=name, at=at, count=count)]:
                rule = self._recognizer.grammar.by_name[name]
                places = [(*at[:-1], at[-1] + n) for n in range(count)]
                return name, [rule.source_of(element_at(rule, one)) for one in places]
        return "", [""]

    def _named(self, text: str) -> str:
        """Return a part of a rule as part of a sentence: a token, a rule, or as it is written."""
        kind = self._kind_of.get(text, ERROR)
        if kind != ERROR:
            return self._phrase(kind)
        return _with_article(text) if text in self._recognizer.network.entry else text

    def _is_keyword(self, text: str) -> bool:
        return self._lexer.is_keyword(self._kind_of.get(text, ERROR))

    def _omitted_keyword(self, line: LinePattern, context: FailureContext) -> str:
        """Return the only keyword that would make the line readable before the failing token."""
        kinds, index = line.form.kinds, line.form.index
        if line.is_enormous or dict(line.keywords).keys() & {0, index}:
            return ""
        state, _ = self._recognizer.run(self._recognizer.restore(line.form.before), kinds[:index])
        found = [
            word
            for word in context.expected
            if self._lexer.is_keyword(kind := self._kind_of[word])
            and self._recognizer.run(state, (kind, *kinds[index:]))[1] is None
        ]
        return found[0] if len(found) == 1 else ""

    def _keyword(self, line: LinePattern, place: int) -> str:
        """Return the keyword or suspected keyword at a place of a line; empty if there is none."""
        kind = line.form.kinds[place] if place < len(line.form.kinds) else ERROR
        known = self._lexer.display[kind] if self._lexer.is_keyword(kind) else ""
        return dict(line.keywords).get(place, known)

    def _phrase(self, kind: int) -> str:
        """Return a token kind as part of a sentence: ``DECL``, ``','``, ``an enum constant``."""
        if kind == ERROR:
            return "an unknown character"
        name, text = self._lexer.names[kind], self._lexer.display[kind]
        if kind in self._ends:
            return f"the end of the {'file' if kind == EOF else 'line'}"
        if self._lexer.is_keyword(kind):
            return text
        if text != name:
            return f"'{text}'"
        return _with_article(name)


def _with_article(name: str) -> str:
    words = _spoken(name)
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


def _spoken(name: str) -> str:
    """Return the name of a rule or token as words: ``simple statement``, ``enum constant``."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|_", " ", name).lower()
