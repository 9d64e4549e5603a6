"""Index of failing lines: how a program leads to each, and which edits could change its reading."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

from grammar.notation.edits import AddRule, AddToken, Edit
from grammar.parser.recognizer import Frames, Recognizer
from grammar.parser.shortest_paths import Paths
from recovery.proposals.edit_site import LinePattern


class LineIndex:
    """The index of lines that fail under one grammar; enormous ones are left out.

    ``prefix`` has the shortest tokens after which a line can begin in a state, by its frames.
    """

    def __init__(self, recognizer: Recognizer, lines: Sequence[LinePattern]) -> None:
        self._recognizer = recognizer
        self._all = range(len(lines))
        self.prefix: dict[Frames, list[int]] = {}
        self._by_rule: dict[str, list[int]] = defaultdict(list)
        self._by_keyword: dict[str, set[int]] = defaultdict(set)
        paths = Paths(recognizer.network)
        for number, line in enumerate(lines):
            if line.is_enormous:
                continue
            before = line.form.before
            if before not in self.prefix:
                self.prefix[before] = self._way_to(paths, before)
            for rule in self._rules_at_work(line):
                self._by_rule[rule].append(number)
            for _, keyword in line.keywords:
                self._by_keyword[keyword].add(number)

    def relevant(self, edits: Sequence[Edit], changed: Iterable[str]) -> list[int]:
        """Return the lines that edits might repair; ``changed`` are the rules they change."""
        keywords = [e.name for e in edits if isinstance(e, AddToken)]
        if keywords and not any("|" in getattr(e, "text", "") for e in edits):
            found = set.union(*(self._by_keyword.get(k, set()) for k in keywords))
            return sorted(found)
        if any(isinstance(e, AddRule) for e in edits):
            return list(self._all)
        found = {n for rule in changed for n in self._by_rule.get(rule, ())}
        return sorted(found.union(*(self._by_keyword.get(k, set()) for k in keywords)))

    def _way_to(self, paths: Paths, before: Frames) -> list[int]:
        """Return the shortest tokens after which a line can begin in this state, with a line end.

        A line that can begin in several configurations may do so only after some of the paths to
        one of them: a routine may follow a routine, but not a data list. So the path with most of
        the configurations is chosen.
        """
        ways = sorted(map(self._ended, map(paths.prefix, before)), key=lambda way: (len(way), way))
        wanted = frozenset(before)
        return max(ways, key=lambda way: len(wanted & self._after(way)))  # the first of equals

    def _ended(self, prefix: list[int]) -> list[int]:
        """Return the tokens with a line end appended, if one can follow."""
        line_kind = self._recognizer.line_kind
        if prefix and prefix[-1] != line_kind:
            ended = [*prefix, line_kind]
            if self._recognizer.run(self._recognizer.start, ended)[1] is None:
                return ended
        return prefix

    def _after(self, way: Sequence[int]) -> frozenset[tuple[int, ...]]:
        """Return the configurations after these tokens."""
        state, _ = self._recognizer.run(self._recognizer.start, way)
        return frozenset(self._recognizer.frames(state))

    def _rules_at_work(self, line: LinePattern) -> set[str]:
        """Return the rules in which an edit could change how this line is read."""
        recognizer, form = self._recognizer, line.form
        rule_of = recognizer.network.rule
        state = recognizer.restore(form.before)
        rules = {rule_of[p] for p, _ in recognizer.sites(state)}
        if not form.index:  # the preceding line end may be read differently
            rules |= {rule_of[p] for frames in form.before for p in frames}
        for kind in form.kinds[: form.index]:
            following = recognizer.step(state, kind)
            assert following is not None
            state = following
            rules |= {rule_of[p] for p, _ in recognizer.sites(state)}
        return rules
