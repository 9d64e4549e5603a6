"""Cases: programs that each state one fact about KRL, and their discovery and parsing.

A case is a ``.src``, ``.sub`` or ``.dat`` file that begins with front matter, comments ``;@ key:
value``. Its expectations are comments ``;> …`` beside the lines that cause them. CASES.md defines
the format. `read_case` is strict: it rejects a case with any unknown key or word.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

from conformance.suite.expectations import (
    PHASES,
    Expectation,
    ExpectationError,
    Phase,
    read_expectation,
)
from conformance.suite.registry import basis, corners
from grammar.syntax.source import Source
from support.files.untrusted import read_text

#: The folder of the cases of this project.
CASES: Final = Path(__file__).parents[1] / "cases"
#: The suites, in the order in which they are shown.
SUITES: Final = (
    "syntax",
    "types",
    "control",
    "data",
    "advance",
    "blending",
    "motion",
    "posture",
    "spline",
    "trigger",
    "interrupt",
    "io",
    "submit",
    "message",
    "interaction",
    "program",
)
#: The suffixes of program files.
ENDINGS: Final = (".src", ".sub", ".dat")
_KEYS: Final = (
    "rule",
    "title",
    "phase",
    "profile",
    "io",
    "robot",
    "with",
    "machine",
    "seconds",
    "unconfirmed",
)
_MANY: Final = ("io",)
_FRONT: Final = re.compile(r";@\s*([a-z]+):\s*(.*?)\s*$")
#: The code of a line, and what follows the first ``;>`` outside a text.
_EXPECTING: Final = re.compile(r'((?:[^";]|"[^"]*"|;(?!>))*);>(.*)$')


class CaseError(ValueError):
    """A case cannot be read; the text is one line with the place and the reason."""


@dataclass(frozen=True)
class Case:
    """A case.

    ``name`` is ``suite/stem``. ``sources`` are its files, the main file first; their paths are file
    names without folders. ``rules`` are rule IDs; the first is the rule that the case states.
    ``basis`` is that rule, or the clause of it, for all expectations that name no other.
    ``seconds`` limits the virtual time of the run. ``unconfirmed`` is the reason if our
    interpretation is uncertain although the rule is certain. ``machine`` is the file in its folder
    that is among its sources as ``$machine.dat``.
    """

    name: str
    path: Path
    title: str
    rules: tuple[str, ...]
    phase: Phase
    profile: str
    sources: tuple[Source, ...]
    expectations: tuple[Expectation, ...]
    io: tuple[str, ...] = ()
    robot: str = "none"
    seconds: float = 60.0
    unconfirmed: str = ""
    machine: str = ""
    basis: str = ""

    @property
    def suite(self) -> str:
        """The folder of the case, relative to the root of the cases."""
        return self.name.rpartition("/")[0]

    @property
    def main(self) -> str:
        """The name of the main file."""
        return self.sources[0].path

    @property
    def may_fail(self) -> bool:
        """Whether any of its expectations is certain enough that breaking it fails the case."""
        return any(self.is_sure(one) for one in self.expectations)

    def is_sure(self, one: Expectation) -> bool:
        """Return whether the basis of an expectation is certain enough to fail the case."""
        return basis(one.basis or self.basis or self.rules[0]).may_fail and not self.unconfirmed

    def said_of(self, file: str, line: int, *, behind: bool) -> list[Expectation]:
        """Return what is expected at a line, or ``behind``: at the next line that says something.

        A line about which nothing is said prepares that: nothing else says that it is possible.
        """
        there = {one.line for one in self.expectations if one.file == file and one.line >= line}
        at = min(there, default=line) if behind else line
        return [one for one in self.expectations if (one.file, one.line) == (file, at)]

    @property
    def expects_syntax_error(self) -> bool:
        """Whether it expects a syntax error."""
        return any(one.kind == "syntax" for one in self.expectations)

    @property
    def is_negative(self) -> bool:
        """Whether it is about something that the front end or the running program must reject."""
        kinds = {one.kind for one in self.expectations}
        if kinds & {"syntax", "error", "warning", "fault"}:
            return True
        return any(
            one.kind == "message" and "never" not in one.arguments for one in self.expectations
        )

    @cached_property
    def digest(self) -> str:
        """SHA-256 of its files, to detect that a recording was made of another version."""
        found = hashlib.sha256()
        for source in self.sources:
            found.update(f"{source.path}\n{source.text}\n".encode())
        return found.hexdigest()

    def line(self, file: str, number: int) -> str:
        """Return a line of one of its files without expectations; "" if there is no such line."""
        for source in self.sources:
            if source.path == file:
                lines = source.text.splitlines()
                return lines[number - 1].partition(";>")[0].strip() if number <= len(lines) else ""
        return ""


def find_cases(
    root: Path = CASES, on_error: Callable[[CaseError], None] | None = None
) -> list[Case]:
    """Return all cases below a folder, by name.

    Raises the first `CaseError`, or passes each to ``on_error`` if that is given.
    """
    found = []
    for path in sorted(root.rglob("*")):
        if path.suffix.lower() in ENDINGS and path.is_file() and _is_case(path):
            try:
                found.append(read_case(path, root))
            except CaseError as error:
                if on_error is None:
                    raise
                on_error(error)
    return sorted(found, key=lambda case: case.name)


def selected(cases: Iterable[Case], selection: Sequence[str]) -> list[Case]:
    """Return the cases that any of the words names; without words, all cases.

    A word is a suite, a case (``suite/stem``), a rule, a topic of rules, a phase, a path, or
    ``corner``, alone or with a kind (``corner:zero``). Raises `CaseError` for a word that names
    nothing.
    """
    every = list(cases)
    if not selection:
        return every
    kept: dict[str, Case] = {}
    for word in selection:
        matching = [case for case in every if _is_named(case, word)]
        if not matching:
            raise CaseError(f"{word}: no case, suite, rule or phase has this name")
        kept |= {case.name: case for case in matching}
    return [kept[name] for name in sorted(kept)]


def _is_named(case: Case, word: str) -> bool:
    if word in (case.name, case.suite, case.phase, case.name.rpartition("/")[2]):
        return True
    if any(word.upper() in (rule, rule.partition("-")[0]) for rule in case.rules):
        return True
    if word == "corner":
        return any(case.name in names for names in corners().values())
    if word.startswith("corner:"):
        return case.name in corners().get(word.removeprefix("corner:"), ())
    path = Path(word)
    if not path.exists():
        return False
    where = path.resolve()
    return where == case.path.resolve() or where in case.path.resolve().parents


def _is_case(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(2) == b";@"


def read_case(path: Path, root: Path = CASES) -> Case:
    """Return the case in a file. Raises `CaseError`."""
    source = _read(path)
    front = _front_matter(source)
    rules = tuple(word.strip() for word in front.get("rule", [""])[0].split(","))
    for rule in rules:
        _check_rule(rule, path)
    wanted = front.get("phase", [""])[0]
    phase = next((one for one in PHASES if one == wanted), None)
    if phase is None:
        raise CaseError(f"{path}: the phase is parse, check or run, not {wanted!r}")
    machine = front.get("machine", [""])[0]
    sources = (source, *_companions(path, front.get("with", [""])[0]))
    if machine:
        sources = (*sources, Source(_companion(path, machine).text, "$machine.dat"))
    expectations = tuple(one for each in sources for one in _expectations(each, path))
    for one in expectations:
        _check_rule(one.basis or rules[0], path)
    if not expectations:
        raise CaseError(f"{path}: it expects nothing")
    try:
        seconds = float(front.get("seconds", ["60"])[0])
    except ValueError as error:
        raise CaseError(f"{path}: seconds are a number") from error
    folder = path.parent.relative_to(root) if path.is_relative_to(root) else Path(path.parent.name)
    return Case(
        name=(folder / path.stem).as_posix(),
        path=path,
        title=front.get("title", [""])[0],
        rules=tuple(dict.fromkeys(rule.partition(".")[0] for rule in rules)),
        basis=rules[0],
        phase=phase,
        profile=front.get("profile", ["kss8"])[0],
        sources=sources,
        expectations=expectations,
        io=tuple(front.get("io", ())),
        robot=front.get("robot", ["none"])[0],
        seconds=seconds,
        unconfirmed=front.get("unconfirmed", [""])[0],
        machine=machine,
    )


def _check_rule(rule: str, path: Path) -> None:
    try:
        basis(rule)
    except KeyError:
        raise CaseError(f"{path}: there is no rule {rule!r}") from None


def _read(path: Path) -> Source:
    try:
        return Source(read_text(path), path.name)
    except (OSError, UnicodeDecodeError) as error:
        raise CaseError(f"{path}: cannot be read: {error}") from error


def _front_matter(source: Source) -> Mapping[str, list[str]]:
    found: dict[str, list[str]] = {}
    for line in source.text.splitlines():
        if not line.startswith(";@"):
            break
        match = _FRONT.match(line)
        if match is None or match[1] not in _KEYS:
            raise CaseError(f"{source.path}: {line!r} is not front matter")
        if match[1] in found and match[1] not in _MANY:
            raise CaseError(f"{source.path}: {match[1]} stands twice")
        found.setdefault(match[1], []).append(match[2])
    return found


def _companions(path: Path, named: str) -> Iterator[Source]:
    """Yield the other files of a case: those of the same stem, and those that ``with`` names."""
    names = [path.stem + ending for ending in ENDINGS if ending != path.suffix.lower()]
    wanted = [path.with_name(name) for name in names]
    yield from (_read(one) for one in wanted if one.is_file() and not _is_case(one))
    for name in filter(None, (word.strip() for word in named.split(","))):
        yield _companion(path, name)


def _companion(path: Path, name: str) -> Source:
    """Return a file in the folder of a case by its name; raise `CaseError` if it does not exist."""
    if not re.fullmatch(r"[$\w][\w.-]*", name) or not path.with_name(name).is_file():
        raise CaseError(f"{path}: {name!r} is not beside it")
    return _read(path.with_name(name))


def _expectations(source: Source, path: Path) -> Iterator[Expectation]:
    """Yield the expectations in a file; one on its own line belongs to the code line before it."""
    about = 0
    for number, line in enumerate(source.text.splitlines(), start=1):
        found = _EXPECTING.match(line)
        if found is None and ";>" in line:
            raise CaseError(f"{path.name}:{number}: a text is not closed before ;>")
        code = (found[1] if found else line).strip()
        if code and not code.startswith(";"):
            about = number
        for text in found[2].split(";>") if found else ():
            try:
                yield read_expectation(text.strip(), source.path, about)
            except ExpectationError as error:
                raise CaseError(f"{path.name}:{number}: {error}") from error
