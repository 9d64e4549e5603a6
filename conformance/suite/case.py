"""Cases: programs that state one fact each, and where they are found.

A case is a ``.src``, ``.sub`` or ``.dat`` file that begins with front matter, comments ``;@ key:
value``. What it expects stands beside the lines that cause it, in comments ``;> …``. CASES.md is
the format in full. `read_case` is strict: a case that says something unknown is none.
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

#: The cases of this project.
CASES: Final = Path(__file__).parents[1] / "cases"
#: Ends of files that a program consists of.
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
#: The code of a line, and what stands behind the first ``;>`` that is in no text.
_EXPECTING: Final = re.compile(r'((?:[^";]|"[^"]*"|;(?!>))*);>(.*)$')


class CaseError(ValueError):
    """A case that cannot be read; the text says where and why, in one line."""


@dataclass(frozen=True)
class Case:
    """A case.

    ``name`` is ``suite/stem``. ``sources`` are its files, the one it begins with first; their paths
    are names without folders. ``rules`` are IDs, the first is the one it states; ``basis`` is that
    or the clause of it on which all expectations rest that name no other. ``seconds`` is how
    much virtual time it has. ``unconfirmed`` is why its reading is ours although its rule is sure.
    ``machine`` is the file beside it that is among its sources as ``$machine.dat``.
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
        """The folder it lies in."""
        return self.name.rpartition("/")[0]

    @property
    def main(self) -> str:
        """The name of the file that it begins with."""
        return self.sources[0].path

    @property
    def may_fail(self) -> bool:
        """Whether anything it states is sure enough that not to do so is a fault."""
        return any(self.is_sure(one) for one in self.expectations)

    def is_sure(self, one: Expectation) -> bool:
        """Whether what an expectation rests on is sure enough to fail the case."""
        return basis(one.basis or self.basis or self.rules[0]).may_fail and not self.unconfirmed

    @property
    def expects_syntax_error(self) -> bool:
        """Whether some line of it is no KRL."""
        return any(one.kind == "syntax" for one in self.expectations)

    @property
    def is_negative(self) -> bool:
        """Whether it is about what has to be refused: by the front end, or by a running program."""
        kinds = {one.kind for one in self.expectations}
        if kinds & {"syntax", "error", "warning", "fault"}:
            return True
        return any(
            one.kind == "message" and "never" not in one.arguments for one in self.expectations
        )

    @cached_property
    def digest(self) -> str:
        """SHA-256 over its files: what a recording of it was made of."""
        found = hashlib.sha256()
        for source in self.sources:
            found.update(f"{source.path}\n{source.text}\n".encode())
        return found.hexdigest()

    def line(self, file: str, number: int) -> str:
        """A line of one of its files, without what is expected there; empty where there is none."""
        for source in self.sources:
            if source.path == file:
                lines = source.text.splitlines()
                return lines[number - 1].partition(";>")[0].strip() if number <= len(lines) else ""
        return ""


def find_cases(
    root: Path = CASES, on_error: Callable[[CaseError], None] | None = None
) -> list[Case]:
    """All cases below a folder, by name; raises the first `CaseError`, or hands over all."""
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
    """The cases that one of the words names; all where there is none.

    A word is a suite, a case (``suite/stem``), a rule, a topic of rules, a phase, a path, or
    ``corner``, alone or with a kind (``corner:zero``).
    Raises `CaseError` for a word that names nothing.
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
    """The case that a file holds. Raises `CaseError`."""
    source = _read(path)
    front = _front_matter(source)
    rules = tuple(word.strip() for word in front.get("rule", [""])[0].split(","))
    for rule in rules:
        _known(rule, path)
    wanted = front.get("phase", [""])[0]
    phase = next((one for one in PHASES if one == wanted), None)
    if phase is None:
        raise CaseError(f"{path}: the phase is parse, check or run, not {wanted!r}")
    machine = front.get("machine", [""])[0]
    sources = (source, *_companions(path, front.get("with", [""])[0]))
    if machine:
        sources = (*sources, Source(_beside(path, machine).text, "$machine.dat"))
    expectations = tuple(one for each in sources for one in _expectations(each, path))
    for one in expectations:
        _known(one.basis or rules[0], path)
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


def _known(rule: str, path: Path) -> None:
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
    """The other files: those of the same stem, and those that ``with`` names."""
    names = [path.stem + ending for ending in ENDINGS if ending != path.suffix.lower()]
    wanted = [path.with_name(name) for name in names]
    yield from (_read(one) for one in wanted if one.is_file() and not _is_case(one))
    for name in filter(None, (word.strip() for word in named.split(","))):
        yield _beside(path, name)


def _beside(path: Path, name: str) -> Source:
    """A file of the folder of a case, by its name; raises `CaseError` where it is not there."""
    if not re.fullmatch(r"[$\w][\w.-]*", name) or not path.with_name(name).is_file():
        raise CaseError(f"{path}: {name!r} is not beside it")
    return _read(path.with_name(name))


def _expectations(source: Source, path: Path) -> Iterator[Expectation]:
    """Those beside the lines of a file; one on a line of its own belongs to the line before it."""
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
