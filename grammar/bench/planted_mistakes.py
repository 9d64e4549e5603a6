"""Detection rate of the check: real programs damaged at random, in one place at a time.

Nothing is chosen by hand: a seed draws the kind of damage, the file, the line and the token, each
file with the same probability (`grammar.bench.slips`). A mistake is found if its project has an
error or a warning that it did not have before, and found in place if one of these is on the damaged
line. Files that cannot be read get no mistakes, but stay in their projects. A missing argument is
no mistake [SCO-13].
"""

from __future__ import annotations

import random
import re
import statistics
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from grammar.bench.slips import Token, cut, damaged, lines_of_tokens
from grammar.check.analysis.spelling import Spelling
from grammar.check.names.unresolved_name import Files
from grammar.check.project.dependencies import Contribution, contribution
from grammar.check.project.framework import Findings, check_module, check_project
from grammar.check.project.project_check import Reading, read_source
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.link import File, Project, link
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Resolution
from grammar.semantics.scopes import Module
from grammar.semantics.symbol_table import table_of
from grammar.syntax.source import Source
from support.files.discovery import IngestError, source_files

# A place is drawn again so often until a kind of damage is possible there.
_TRIES = 200
# Of the files that end early, the share.
_CUT = 0.3
# So many of the worst, of those not found and of those found elsewhere are in the record.
_LISTED = 100
# So many findings of one mistake are no cascade.
_USUAL = 2
# So many of the findings of each are in it, too.
_SHOWN = 10
_WORD = re.compile(r"[A-Z_$][A-Z0-9_$]*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class _Program:
    """A file as it is linked, as it was read, and its contribution to other files."""

    file: File
    source: Source
    reading: Reading
    given: Contribution


def _program(source: Source, origin: str) -> _Program:
    reading = read_source(source)
    table = None if reading.syntax is None else table_of(reading.syntax)
    file = File(source.path, reading.syntax, origin, table, reading.words)
    given = contribution(source.path, source.text, table, reading.words)
    return _Program(file, source, reading, given)


class _Checked:
    """A project with the findings of each of its files."""

    def __init__(self, programs: Mapping[str, _Program]) -> None:
        self.programs = dict(programs)
        self.findings: dict[str, Findings] = {}
        self.names: dict[str, dict[int, str]] = {}
        self._check(programs)
        self.found = frozenset(self._of_project())

    def _check(self, paths: Iterable[str]) -> None:
        wanted = set(paths)
        files = [program.file for program in self.programs.values()]
        for project in link(files, packages=frozenset()).projects:
            for module in project.modules:
                if module.path in wanted:
                    self.findings[module.path] = self._findings(project, module)

    def _of_project(self) -> list[Diagnostic]:
        programs = self.programs
        files = Files(
            lambda path: programs[path].file.table,
            lambda path: programs[path].source,
            Spelling(lambda: [(path, one.given.words) for path, one in programs.items()]),
        )
        return check_project(self.findings.values(), files)

    def _findings(self, project: Project, module: Module) -> Findings:
        program = self.programs[module.path]
        if module.syntax is None:
            return program.reading.alone()
        checked = check_module(project, module, program.source)
        if module.path not in self.names:
            self.names[module.path] = _names(checked.resolution)
        return program.reading.completed(checked.findings)

    def name_at(self, path: str, start: int) -> str:
        """Return what the name that begins there denotes."""
        program = self.programs[path]
        text = program.source.text
        key = _WORD.match(text, start)
        assert key is not None, "a name begins there"
        system = System.load()
        known = system.variables, system.functions, system.types
        if self._written[key[0].upper()] < 2 and not any(key[0].upper() in one for one in known):
            return "nowhere else"
        if text[start] == "$":
            return "system variable"
        if text[:start].rstrip().endswith("#"):
            return "constant"
        return self.names[path].get(start, "other")

    @cached_property
    def _written(self) -> Counter[str]:
        """Return how often each word occurs in the project, in upper case."""
        texts = (program.source.text for program in self.programs.values())
        return Counter(word.upper() for text in texts for word in _WORD.findall(text))

    def with_text(self, path: str, text: str) -> list[Diagnostic]:
        """Return the errors and warnings that are new if a file has another text."""
        before, findings = self.programs[path], dict(self.findings)
        self.programs[path] = after = _program(Source(text, path), before.file.origin)
        stem = path.rpartition(".")[0].casefold()
        names = {name for name, _ in before.given.facts.items() ^ after.given.facts.items()}
        try:
            self._check(
                other
                for other, one in self.programs.items()
                if other.rpartition(".")[0].casefold() == stem or names & one.given.words
            )
            found = self._of_project()
        finally:
            self.programs[path], self.findings = before, findings
        return [one for one in found if one not in self.found and one.severity != "note"]


def _names(resolution: Resolution) -> dict[int, str]:
    """Return what the names of a file denote, by their start; constants are left out."""
    components = dict.fromkeys((name.span[0] for name in resolution.unknown_members), "member")
    open_ = {
        use.name.span[0]: use.space.value if use.space else "member" for use in resolution.open_uses
    }
    known = {name: found for name in resolution.answers if (found := resolution.found(name))}
    return components | open_ | {n.span[0]: found.symbol.kind.value for n, found in known.items()}


# ------------------------------------------------------------------------------ the measure


def measure_planted(
    roots: Sequence[Path],
    count: int,
    seed: int,
    kinds: Sequence[str],
    *,
    missing: str = "0",
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Plant ``count`` mistakes of these ``kinds`` in programs below ``roots``, each by itself.

    ``missing`` says which files are left out before: a share of them, drawn by ``seed``, ``"dat"``
    for all data lists, ``"others"`` for each file alone; ``"cut"`` leaves all, but three of ten end
    early, at a character drawn by ``seed``. ``on_step`` is called once a mistake. The
    record has for all of them, by kind, and for misspelt names by what they are called for, or
    ``"nowhere else"`` for those that are written in no other place: ``planted``, the shares
    ``found`` and ``in_place``, and of the number of findings of a mistake that is found the
    ``median``, the 95th percentile ``p95``, the ``most``, and the mean in the ``median_file``.
    ``survivors`` are the first that were not found, ``elsewhere`` those that were found in another
    place, ``cascades`` those with the most findings, beyond two.
    ``unplanted`` counts the errors and warnings before, and those ``caused`` by what is missing.

    Raises `support.files.discovery.IngestError` where no line can be damaged.
    """
    chance = random.Random(seed)
    projects: list[_Checked] = []
    caused: Counter[str] = Counter()
    for whole in _projects(roots):
        left = [_Checked(some) for some in _left(whole, missing, chance)]
        if missing != "0":
            known = set(map(_place, _Checked(whole).found))
            caused.update(_codes(o for one in left for o in one.found if _place(o) not in known))
        projects += left
    places = [
        (project, path, lines)
        for project in projects
        for path, program in project.programs.items()
        if not program.reading.diagnostics and (lines := list(lines_of_tokens(program.source)))
    ]
    if not places:
        raise IngestError("no line of these files can be damaged")
    trials = []
    for number in range(count):
        trials.append(_trial(kinds[number % len(kinds)], places, chance))
        on_step()
    done = [trial for trial in trials if trial is not None]
    return {
        "seed": seed,
        "missing": missing,
        "files": len(places),
        **_figures(done),
        "kinds": [
            {"kind": kind, **_figures([one for one in done if one["kind"] == kind])}
            for kind in kinds
        ],
        "names": [
            {"kind": kind, **_figures([one for one in done if one["name"] == kind])}
            for kind in sorted({one["name"] for one in done} - {None})
        ],
        "unplanted": {**_unplanted(projects), "caused": dict(sorted(caused.items()))},
        "survivors": [one for one in done if not one["findings"]][:_LISTED],
        "elsewhere": [one for one in done if one["findings"] and not one["in_place"]][:_LISTED],
        "cascades": sorted(
            (one for one in done if one["findings"] > _USUAL), key=lambda one: -one["findings"]
        )[:_LISTED],
    }


def _left(
    whole: Mapping[str, _Program], missing: str, chance: random.Random
) -> Iterator[dict[str, _Program]]:
    """Yield the project without the missing files."""
    match missing:
        case "others":
            yield from ({path: program} for path, program in whole.items())
        case "dat":
            yield {path: one for path, one in whole.items() if not path.lower().endswith(".dat")}
        case "cut":
            yield {
                path: _cut(one, chance) if chance.random() < _CUT else one
                for path, one in whole.items()
            }
        case _:
            share = float(missing)
            kept = [path for path in whole if not share or chance.random() >= share]
            yield {path: whole[path] for path in kept}


def _cut(program: _Program, chance: random.Random) -> _Program:
    source = program.source
    return _program(Source(cut(source.text, chance), source.path), program.file.origin)


def _place(finding: Diagnostic) -> tuple[str, int, str]:
    return finding.path, finding.region.line, finding.code


def _codes(found: Iterable[Diagnostic]) -> Iterator[str]:
    return (f"{one.severity} {one.code}" for one in found if one.severity != "note")


def _unplanted(projects: Iterable[_Checked]) -> dict[str, Any]:
    """Return the errors and warnings before any mistake is planted, by code and line."""
    codes: Counter[str] = Counter()
    lines = 0
    for project in projects:
        codes.update(_codes(project.found))
        lines += sum(len(program.source.lines) for program in project.programs.values())
    return {"lines": lines, "codes": dict(sorted(codes.items()))}


def _trial(
    kind: str, places: Sequence[tuple[_Checked, str, list[list[Token]]]], chance: random.Random
) -> dict[str, Any] | None:
    for _ in range(_TRIES):
        project, path, lines = chance.choice(places)
        source = project.programs[path].source
        exchange = damaged(kind, source, lines, chance)
        if exchange is None:
            continue
        start, end, new = exchange
        text = source.text[:start] + new + source.text[end:]
        found = project.with_text(path, text)
        line, last = source.place(start)[0], source.place(end)[0]
        likely = {*range(line, last + 1)}
        if not new.strip():
            likely.add(_next_code(source, last))
        return {
            "kind": kind,
            "name": project.name_at(path, start) if kind == "name misspelt" else None,
            "path": path,
            "line": line,
            "was": source.text[start:end],
            "is": new,
            "findings": len(found),
            "told": [
                (one.path, one.region.line, one.code, one.message)
                for one in sorted(found, key=lambda one: (one.path, one.region))[:_SHOWN]
            ],
            "in_place": any(one.path == path and one.region.line in likely for one in found),
        }
    return None


def _median_file(trials: Sequence[Mapping[str, Any]]) -> float | None:
    """Return the mean number of findings of a found mistake, in the median file."""
    files: dict[str, list[int]] = {}
    for one in trials:
        if one["findings"]:
            files.setdefault(one["path"], []).append(one["findings"])
    means = [statistics.mean(counts) for counts in files.values()]
    return round(statistics.median(means), 2) if means else None


def _next_code(source: Source, line: int) -> int:
    """Return the next line that is neither blank nor a comment: a missing line is noticed there.

    After the last line, it is noticed at the end of the remaining text.
    """
    later = (n for n in range(line + 1, len(source.lines) + 1) if _has_code(source, n))
    before = (n for n in range(line - 1, 0, -1) if source.line(n).strip())
    return next(later, next(before, line))


def _has_code(source: Source, line: int) -> bool:
    return bool(source.line(line).split(";")[0].strip())


def _figures(trials: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    counts = sorted(one["findings"] for one in trials if one["findings"])
    found = len(counts)
    return {
        "planted": len(trials),
        "found": round(found / len(trials), 4) if trials else None,
        "in_place": round(sum(one["in_place"] for one in trials) / found, 4) if found else None,
        "median": statistics.median(counts) if counts else None,
        "p95": counts[min(found - 1, int(0.95 * found))] if counts else None,
        "most": counts[-1] if counts else None,
        "median_file": _median_file(trials),
    }


def _projects(roots: Sequence[Path]) -> Iterator[dict[str, _Program]]:
    programs: dict[str, _Program] = {}
    for one in source_files(roots):
        programs[one.path] = _program(Source(one.text, one.path), one.found.origin)
    bare = [replace(program.file, syntax=None) for program in programs.values()]
    for project in link(bare).projects:
        yield {module.path: programs[module.path] for module in project.modules}
