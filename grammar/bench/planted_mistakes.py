"""How many mistakes the check finds: lines of real programs damaged by chance, one at a time.

Nobody picks what is damaged or how: a seed draws the kind of mistake, the file, the line and the
token, each file alike however long. A mistake is found when its project has an error or a warning
that it did not have before, and found in its place when one of these is on the damaged line. Files
that cannot be read as they are get no mistakes, but stay in their projects. To leave an argument
out is no mistake [SCO-13].
"""

from __future__ import annotations

import itertools
import random
import re
import statistics
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from grammar.check.dependencies import Contribution, contribution
from grammar.check.framework import Findings, check_module, check_project
from grammar.check.project_check import Reading, read_source
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.parser.lexer import Lexer
from grammar.semantics.link import File, Project, link
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Resolution
from grammar.semantics.scopes import Module
from grammar.semantics.symbol_table import table_of
from grammar.syntax.build import builder
from grammar.syntax.source import Source
from support.files.decode import decode
from support.files.discovery import Found, IngestError, discover, read

#: What a slip can be.
KINDS = (
    "name misspelt",
    "keyword misspelt",
    "token dropped",
    "token doubled",
    "argument added",
    "literal of another type",
    "words swapped",
    "number out of range",
    "end of a block dropped",
)
_DECLARING = frozenset("DECL GLOBAL CONST STRUC ENUM CHAR INT REAL BOOL SIGNAL".split())
_CLOSERS = frozenset("ENDIF ENDFOR ENDWHILE ENDLOOP UNTIL ENDSWITCH ENDSPLINE END ENDFCT".split())
# A line is drawn again so often until a kind of mistake can be made in it.
_TRIES = 200
# Of the files that end early, the share.
_CUT = 0.3
_LETTERS = "abcdefghijklmnopqrstuvwxyz"
_WORD = re.compile(r"[A-Z_$][A-Z0-9_$]*", re.IGNORECASE)
_LITERALS = {"INT": ("TRUE", '"x"'), "REAL": ("TRUE", '"x"'), "BOOL": ("1.5", '"x"')}


@dataclass(frozen=True, slots=True)
class Token:
    """A token of a line: its kind in the grammar, its place in the text, and the text itself."""

    kind: str
    start: int
    text: str
    is_keyword: bool

    @property
    def end(self) -> int:
        """Where it ends in the text of the file."""
        return self.start + len(self.text)


def damaged(
    kind: str, tokens: Sequence[Token], chance: random.Random
) -> tuple[int, int, str] | None:
    """What to exchange for a mistake of a kind in a line: start, end, new text; or ``None``."""
    match kind:
        case "name misspelt":
            return _misspelt([t for t in tokens if t.kind == "NAME" and len(t.text) > 3], chance)
        case "keyword misspelt":
            return _misspelt([t for t in tokens if t.is_keyword and len(t.text) > 1], chance)
        case "token dropped" | "token doubled":
            token = chance.choice(tokens)
            return token.start, token.end, "" if kind == "token dropped" else f"{token.text} " * 2
        case "argument added":
            return _more_arguments(tokens, chance)
        case "words swapped":
            return _swapped(tokens, chance)
        case "number out of range":
            return _too_large(tokens, chance)
        case "end of a block dropped":
            is_closer = tokens[0].text.upper() in _CLOSERS
            return (tokens[0].start, tokens[-1].end, "") if is_closer else None
        case _:
            literals = [t for t in tokens if _type_of(t)]
            if not literals:
                return None
            token = chance.choice(literals)
            return token.start, token.end, chance.choice(_LITERALS[_type_of(token)])


def _type_of(token: Token) -> str:
    """The type of a plain literal; ``""`` for all else."""
    if token.text.upper() in ("TRUE", "FALSE"):
        return "BOOL"
    if token.text.isdecimal():
        return "INT"
    return "REAL" if token.text.replace(".", "", 1).isdecimal() else ""


def _misspelt(words: Sequence[Token], chance: random.Random) -> tuple[int, int, str] | None:
    """One slip of the finger in one of some words."""
    if not words:
        return None
    token = chance.choice(words)
    text, at = token.text, chance.randrange(len(token.text))
    slips = [text[:at] + text[at + 1 :], text[:at] + text[at] + text[at:]]
    slips.append(text[:at] + chance.choice(_LETTERS) + text[at + 1 :])
    if at + 1 < len(text):
        slips.append(text[:at] + text[at + 1] + text[at] + text[at + 2 :])
    wrong = chance.choice([slip for slip in slips if slip.upper() != text.upper()] or [text + "x"])
    return token.start, token.end, wrong


def _more_arguments(tokens: Sequence[Token], chance: random.Random) -> tuple[int, int, str] | None:
    """One more argument at the end of a call."""
    ends = []
    for index, token in enumerate(tokens[:-1]):
        if token.kind == "NAME" and tokens[index + 1].text == "(":
            depth = 0
            for other in tokens[index + 1 :]:
                depth += (other.text == "(") - (other.text == ")")
                if depth == 0:
                    ends.append((other.start, tokens[index + 1].end == other.start))
                    break
    if not ends:
        return None
    at, is_empty = chance.choice(ends)
    return at, at, "0" if is_empty else ", 0"


def _swapped(tokens: Sequence[Token], chance: random.Random) -> tuple[int, int, str] | None:
    """Two words or signs beside one another change places; of operands, the operator stays."""
    places = [
        (left, right)
        for left, right in itertools.pairwise(tokens)
        if left.text.upper() != right.text.upper()
    ]
    if not places:
        return None
    left, right = chance.choice(places)
    return left.start, right.end, f"{right.text} {left.text}"


def _too_large(tokens: Sequence[Token], chance: random.Random) -> tuple[int, int, str] | None:
    """An index, or the number of an interrupt, far beyond all limits."""
    numbers = [
        token
        for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False)
        if token.text.isdecimal()
        and (before.text == "[" or after.text == "]" or before.text.upper() == "DECL")
    ]
    is_declared = tokens[0].text.upper() in _DECLARING
    if (
        not numbers
        or is_declared
        or tokens[1].kind == "NAME"
        or any(token.text == "{" for token in tokens)
    ):
        return None
    token = chance.choice(numbers)
    return token.start, token.end, chance.choice(("99999", "0"))


# ------------------------------------------------------------------------------ projects


@dataclass(frozen=True, slots=True)
class _Program:
    """A file as it is linked, as it was read, and what it gives other files."""

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
        self.found = frozenset(check_project(self.findings.values()))

    def _check(self, paths: Iterable[str]) -> None:
        wanted = set(paths)
        files = [program.file for program in self.programs.values()]
        for project in link(files, packages=frozenset()).projects:
            for module in project.modules:
                if module.path in wanted:
                    self.findings[module.path] = self._findings(project, module)

    def _findings(self, project: Project, module: Module) -> Findings:
        program = self.programs[module.path]
        if module.syntax is None:
            return program.reading.alone()
        checked = check_module(project, module, program.source)
        if module.path not in self.names:
            self.names[module.path] = _names(checked.resolution)
        return program.reading.completed(checked.findings)

    def name_at(self, path: str, start: int) -> str:
        """What the name is called for that begins there."""
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
        """How often each word is written in the project, in upper case."""
        texts = (program.source.text for program in self.programs.values())
        return Counter(word.upper() for text in texts for word in _WORD.findall(text))

    def with_text(self, path: str, text: str) -> list[Diagnostic]:
        """The errors and warnings that are new once a file has another text."""
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
            found = check_project(self.findings.values())
        finally:
            self.programs[path], self.findings = before, findings
        return [one for one in found if one not in self.found and one.severity != "note"]


def _names(resolution: Resolution) -> dict[int, str]:
    """What the names of a file are, by where they begin; constants are left out."""
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
    *,
    missing: str = "0",
    kinds: Sequence[str] = KINDS,
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Plant ``count`` mistakes in programs below ``roots``, each by itself.

    ``missing`` says which files are left out before: a share of them, drawn by ``seed``, ``"dat"``
    for all data lists, ``"others"`` for each file alone; ``"cut"`` leaves all, but three of ten end
    early, at a character drawn by ``seed``. ``on_step`` is called once a mistake. The
    record has for all of them, by kind, and for misspelt names by what they are called for, or
    ``"nowhere else"`` for those that are written in no other place: ``planted``, the shares
    ``found`` and ``in_place``, and of the number of findings of a mistake that is found the
    ``median``, the 95th percentile ``p95``, and the mean in the ``median_file``. ``survivors`` are
    the first that were not found, ``elsewhere`` those that were found in another place.
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
        "survivors": [one for one in done if not one["findings"]][:100],
        "elsewhere": [one for one in done if one["findings"] and not one["in_place"]][:100],
    }


def _left(
    whole: Mapping[str, _Program], missing: str, chance: random.Random
) -> Iterator[dict[str, _Program]]:
    """What is left of a project when files are missing."""
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


def cut(text: str, chance: random.Random) -> str:
    """A text that ends early, as that of a file that was not copied to its end does."""
    return text[: chance.randrange(len(text) // 4, len(text))] if text else ""


def _place(finding: Diagnostic) -> tuple[str, int, str]:
    return finding.path, finding.region.line, finding.code


def _codes(found: Iterable[Diagnostic]) -> Iterator[str]:
    return (f"{one.severity} {one.code}" for one in found if one.severity != "note")


def _unplanted(projects: Iterable[_Checked]) -> dict[str, Any]:
    """The errors and warnings before anything is planted, by code, and the lines they are in."""
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
        exchange = damaged(kind, chance.choice(lines), chance)
        if exchange is None:
            continue
        start, end, new = exchange
        source = project.programs[path].source
        text = source.text[:start] + new + source.text[end:]
        found = project.with_text(path, text)
        line = source.text.count("\n", 0, start) + 1
        likely = {line} if new else {line, _next_code(source, line)}
        return {
            "kind": kind,
            "name": project.name_at(path, start) if kind == KINDS[0] else None,
            "path": path,
            "line": line,
            "was": source.text[start:end],
            "is": new,
            "findings": len(found),
            "first": min(((one.path, one.region.line, one.code) for one in found), default=None),
            "in_place": any(one.path == path and one.region.line in likely for one in found),
        }
    return None


def _median_file(trials: Sequence[Mapping[str, Any]]) -> float | None:
    """The mean number of findings of a mistake that is found, in the median file."""
    files: dict[str, list[int]] = {}
    for one in trials:
        if one["findings"]:
            files.setdefault(one["path"], []).append(one["findings"])
    means = [statistics.mean(counts) for counts in files.values()]
    return round(statistics.median(means), 2) if means else None


def _next_code(source: Source, line: int) -> int:
    """The next line that is neither blank nor a comment: what is missing is missed there.

    Behind the last one it is missed at the end of the text that is left.
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
        "median_file": _median_file(trials),
    }


def _projects(roots: Sequence[Path]) -> Iterator[dict[str, _Program]]:
    programs: dict[str, _Program] = {}
    for found in discover(roots):
        data = read(found) if isinstance(found, Found) else b""
        decoded = decode(data) if isinstance(data, bytes) else ""
        if not isinstance(decoded, str) and isinstance(found, Found):
            programs[found.path] = _program(Source(decoded.text, found.path), found.origin)
    bare = [replace(program.file, syntax=None) for program in programs.values()]
    for project in link(bare).projects:
        yield {module.path: programs[module.path] for module in project.modules}


def lines_of_tokens(source: Source) -> Iterator[list[Token]]:
    """The tokens of each line that has some."""
    lexer: Lexer = builder().failures.recognizer.lexer
    line: list[Token] = []
    for lexeme, start in zip(lexer.lexemes(source.text), lexer.offsets(source.text), strict=True):
        kind = lexer.kinds[lexeme]
        if kind < 0:
            continue
        if "\n" in lexeme or "\r" in lexeme:
            if line and line[0].text[0] != "&":  # header lines are for KUKA's tools
                yield line
            line = []
        else:
            line.append(Token(lexer.names[kind], start, lexeme, lexer.is_keyword(kind)))
    if line:
        yield line
