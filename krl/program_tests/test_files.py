"""Reading tests of robot programs: ``test_*.toml`` beside programs, and ``test_*.src`` in KRL.

docs/tutorial-test.md describes the format. Both forms have the same content: the set-up of a test,
the call, and the expectations, in the language of conformance cases.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, takewhile
from pathlib import Path
from typing import Any, Final, TypeVar

from conformance.suite.expectations import Expectation, ExpectationError, read_expectation
from interp.controller.inputs.input_script import Script, ScriptError
from interp.testing.drivers import RESULT
from support.files.untrusted import DocumentError, read_text, toml_of

#: First words of expectations that name their subject; all others are about a line.
_NAMED: Final = frozenset(
    "value out anout message interrupt fault passes avoids speed pose axes limits smooth halt ends"
    " calls brake resume tracks".split()
)
_PLACE: Final = re.compile(r"([$\w./-]+\.(?:src|sub)):(\d+):?\s+(.*)", re.IGNORECASE)
_NAME: Final = re.compile(
    r"\b(passes|near|pose|axes) (?!at |before |after |between )([A-Za-z_$][\w.$]*(?:\[\d+\])?)"
)
_ZONE_WORDS: Final = ("box", "sphere")


class TestFileError(ValueError):
    """A test file is invalid; the message is one line with file and line."""

    __test__ = False  # pytest must not collect it because of its name


@dataclass(frozen=True, slots=True)
class Expected:
    """An expectation as written, with its line in the test file.

    ``about`` is the file and line of the program that it is about, empty for the whole program.
    ``names`` are variables in it that stand for points.
    """

    text: str
    line: int
    about: tuple[str, int]
    names: tuple[str, ...]

    def read(self, values: Mapping[str, Any]) -> Expectation:
        """Return the expectation with the values of points in place of their names.

        Raises `ExpectationError`, also for a point that lacks the needed values.
        """

        def numbers(found: re.Match[str]) -> str:
            return f"{found[1]} {_numbers(found[2], found[1], values)}"

        read = read_expectation(_resolved(self.text, numbers), *self.about)
        return replace(read, text=self.text)


@dataclass(frozen=True, slots=True)
class ProgramTest:
    """A test: the set-up of controller and cell, the call, and the expectations.

    ``program`` is the file whose routines it sees. ``call`` is the call with which it begins, empty
    for the first routine of the file. ``before`` are KRL statements before the call, ``stand_ins``
    statements by routine and call. ``line`` is the line of the test in its file.
    """

    name: str
    path: Path
    line: int
    program: Path
    call: str
    expected: tuple[Expected, ...]
    io: tuple[str, ...] = ()
    before: tuple[str, ...] = ()
    stand_ins: tuple[tuple[str, tuple[tuple[str, ...], ...]], ...] = ()
    submit: str | None = None
    profile: str | None = None
    scene: Path | None = None
    seconds: float = 60.0
    is_recorded: bool = False

    @property
    def script(self) -> Script:
        """The script of inputs; raises `ScriptError`."""
        return Script.read("\n".join(self.io), f"io of {self.name}")


def is_test_file(path: Path) -> bool:
    """Return whether a file has tests of robot programs, by its name and first lines."""
    if not path.name.lower().startswith("test_") or not path.is_file():
        return False
    match path.suffix.lower():
        case ".toml":
            text = path.read_bytes()[:1_000_000]
            return re.search(rb"^\s*\[\[?\s*test", text, re.MULTILINE) is not None
        case ".src":
            with path.open("rb") as file:
                return file.read(6).removeprefix(b"\xef\xbb\xbf").lower().startswith(b";@")
    return False


def read_tests(path: Path) -> tuple[ProgramTest, ...]:
    """Return the tests of a file. Raises `TestFileError`."""
    try:
        text = read_text(path, "utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise TestFileError(f"{path}: cannot be read as UTF-8: {error}") from None
    tests = tuple(_Reader(path, text).tests())
    if not tests:
        raise TestFileError(f"{path}:1: no test in it")
    return tests


# ---------------------------------------------------------------------------------- expectations


def _resolved(text: str, numbers: Callable[[re.Match[str]], str]) -> str:
    """Return the text with names of points replaced by numbers, except in quoted texts."""
    parts = re.split(r'("[^"]*")', text)
    return "".join(part if part.startswith('"') else _NAME.sub(numbers, part) for part in parts)


def _numbers(name: str, word: str, values: Mapping[str, Any]) -> str:
    """Return X, Y and Z of a point, its angles too for ``pose``; or its axes for ``axes``."""
    point = values.get(name.upper())
    if not isinstance(point, Mapping):
        raise ExpectationError(f"{name} is not a point with a value")
    members = "X Y Z A B C" if word == "pose" else "X Y Z"
    if word == "axes":
        members = "A1 A2 A3 A4 A5 A6"
    found = [point.get(member) for member in members.split()]
    if any(not isinstance(number, int | float) or not math.isfinite(number) for number in found):
        raise ExpectationError(f"{name} has not all of {members}")
    return " ".join(f"{number:.9f}" for number in found)


def _expected(
    text: str, line: int, about: tuple[str, int] | None, zones: Mapping[str, str]
) -> Expected:
    """Return an expectation; ``about`` is the line beside which it stands.

    Raises `ExpectationError`.
    """
    place = _PLACE.fullmatch(text)
    if place is not None:
        text, about = place[3], (place[1], int(place[2]))
    text = re.sub(r"^result\b", f"value {RESULT}", text.strip())
    word = text.partition(" ")[0]
    if text.startswith("avoids "):
        zone = text.split()[1]
        if zone not in _ZONE_WORDS:
            if zone not in zones:
                raise ExpectationError(f"there is no zone {zone}")
            text = f"avoids {zones[zone]}{text.partition(zone)[2]}"
    names: list[str] = []

    def zeros(found: re.Match[str]) -> str:
        names.append(found[2])
        return f"{found[1]} {' '.join('0' * (6 if found[1] in ('pose', 'axes') else 3))}"

    dry = _resolved(text, zeros)
    is_named = word in _NAMED or text == "runs on"
    if about is None and not is_named:
        raise ExpectationError(f"{word} is about a line: write FILE:LINE in front of it")
    if place is None and is_named:
        about = ("", 0)
    assert about is not None, "one of the two"
    read_expectation(dry, *about)
    return Expected(text, line, about, tuple(names))


# ---------------------------------------------------------------------------------- the two forms

_KEYS: Final[Mapping[str, tuple[type, ...]]] = {
    "name": (str,),
    "call": (str,),
    "expect": (list,),
    "program": (str,),
    "io": (str, list),
    "set": (dict,),
    "before": (str, list),
    "stand_ins": (dict,),
    "zones": (dict,),
    "submit": (str,),
    "profile": (str,),
    "scene": (str,),
    "seconds": (int, float),
    "recorded": (bool,),
}
#: Keys that only a test can have; all others can also be shared, before the first test.
_OWN: Final = ("name", "call", "expect")
_SAID: Final[Mapping[type, str]] = {
    str: "a text",
    list: "a list",
    dict: "a table",
    int: "a number",
    float: "a number",
    bool: "true or false",
}
_HEAD: Final = re.compile(r"\s*\[\[\s*test\s*\]\]")
_BESIDE: Final = re.compile(r'((?:[^";]|"[^"]*"|;(?!>))*);>(.*)$')
_ROUTINE: Final = re.compile(r"(?:GLOBAL\s+)?DEF\s+(TEST\w*)\s*\(\s*\)", re.IGNORECASE)
_END: Final = re.compile(r"END\s*(?:;.*)?", re.IGNORECASE)


class _Reader:
    """Reads a test file; in a KRL file the first lines with ``;@`` are its TOML."""

    def __init__(self, path: Path, text: str) -> None:
        self._path = path
        self._lines = text.splitlines()
        self._is_krl = path.suffix.lower() != ".toml"
        if self._is_krl:
            fronts = takewhile(lambda line: line.startswith(";@"), self._lines)
            text = "\n".join(line[2:] for line in fronts)
        self._text = text

    def tests(self) -> Iterator[ProgramTest]:
        try:
            shared = toml_of(self._text)
        except DocumentError as error:
            found = re.search(r"line (\d+)", str(error))
            line = int(found[1]) if found else self._text.count("\n") + 1
            raise self.error(line, re.sub(r" \(at .*\)", "", str(error))) from None
        entries = shared.pop("test", [])
        if not isinstance(entries, list) or not all(isinstance(one, dict) for one in entries):
            raise self.error(1, "tests are tables [[test]]")
        heads = [number for number, line in enumerate(self._lines, 1) if _HEAD.match(line)]
        self._check(_Span(1, heads[0] if heads else len(self._lines) + 1), shared, is_shared=True)
        taken: set[str] = set()
        for span, entry, expected in (
            self._routines() if self._is_krl else self._tables(entries, heads)
        ):
            name = entry["name"]
            if name in taken:
                raise self.error(span.start, f"a second test is named {name!r}")
            taken.add(name)
            yield self._test(span, _merged(shared, entry), expected)

    def _tables(self, entries: Sequence[dict[str, Any]], heads: Sequence[int]) -> Iterator[_Entry]:
        """Yield each table with its lines and its expectations."""
        for place, entry in enumerate(entries):
            start = heads[place] if place < len(heads) else 1
            behind = place + 1 < len(heads)
            span = _Span(start, heads[place + 1] if behind else len(self._lines) + 1)
            self._check(span, entry, is_shared=False)
            if not entry.get("name", "").strip():
                raise self.error(start, "name is missing")
            stated: list[_Stated] = []
            for text in map(str, entry.get("expect", [])):
                start = self._line(text, span, since=start)
                stated.append((text, start, None))
            yield span, entry, stated

    def _routines(self) -> Iterator[_Entry]:
        """Yield each routine TEST… with its lines and the expectations beside them.

        The first routine has the name of the file; without an expectation it is no test.
        """
        name, start, about, is_first = "", 0, 0, True
        expected: list[tuple[str, int, tuple[str, int] | None]] = []
        for number, line in enumerate(self._lines, start=1):
            found = _BESIDE.match(line)
            code = (found[1] if found else line).strip()
            if head := _ROUTINE.match(code):
                name, start, expected = head[1], number, []
            about = number if code and not code.startswith(";") else about
            for text in found[2].split(";>") if found else ():
                if not name:
                    raise self.error(number, "an expectation outside of a routine TEST…")
                expected.append((text.strip(), number, (self._path.name, about)))
            if name and _END.fullmatch(code):
                if expected or not is_first:
                    yield _Span(start, number + 1), {"name": name, "call": name}, expected
                name, is_first = "", False

    def _test(
        self, span: _Span, entry: Mapping[str, Any], expected: Sequence[_Stated]
    ) -> ProgramTest:
        made = ProgramTest(
            name=entry["name"],
            path=self._path,
            line=span.start,
            program=self._program(entry, span),
            call=entry.get("call", ""),
            expected=tuple(self._expected(one, entry.get("zones", {})) for one in expected),
            io=_texts(entry.get("io", ())),
            before=(
                *(
                    self._made(span, key, _statement, value)
                    for key, value in entry.get("set", {}).items()
                ),
                *_texts(entry.get("before", ())),
            ),
            stand_ins=tuple(
                (key, self._made(span, key, _bodies, value))
                for key, value in entry.get("stand_ins", {}).items()
            ),
            submit=entry.get("submit"),
            profile=entry.get("profile"),
            scene=self._file("scene", entry, span) if "scene" in entry else None,
            seconds=float(entry.get("seconds", 60.0)),
            is_recorded=entry.get("recorded", False),
        )
        if not made.expected and not made.is_recorded:
            raise self.error(span.start, f"{made.name} expects nothing")
        try:
            _ = made.script
        except ScriptError as error:
            raise self.error(self._line("io", span), str(error)) from None
        return made

    def _expected(self, stated: _Stated, zones: Mapping[str, str]) -> Expected:
        text, line, about = stated
        try:
            return _expected(text, line, about, zones)
        except ExpectationError as error:
            raise self.error(line, f"{text}: {error}") from None

    def _made(self, span: _Span, key: str, make: Callable[[str, Any], _T], value: Any) -> _T:
        try:
            return make(key, value)
        except ValueError as error:
            raise self.error(self._line(key, span), str(error)) from None

    def _program(self, entry: Mapping[str, Any], span: _Span) -> Path:
        """Return the tested file; it may be omitted if only one file is possible."""
        if "program" in entry or self._is_krl:
            return self._file("program", entry, span) if "program" in entry else self._path
        stem = self._path.stem.lower().removeprefix("test_")
        beside = [
            one
            for one in sorted(self._path.parent.iterdir())
            if one.suffix.lower() == ".src" and not is_test_file(one)
        ]
        named = [one for one in beside if one.stem.lower() == stem] or beside
        if len(named) != 1:
            raise self.error(span.start, "program is missing: the file of KRL that is tested")
        return named[0]

    def _file(self, key: str, entry: Mapping[str, Any], span: _Span) -> Path:
        path = self._path.parent / str(entry[key])
        if not path.is_file():
            raise self.error(self._line(key, span), f"{entry[key]}: no such file")
        return path

    def _check(self, span: _Span, table: Mapping[str, Any], *, is_shared: bool) -> None:
        """Check the keys and the types of their values."""
        known = [key for key in _KEYS if not (is_shared and key in _OWN)]
        for key, value in table.items():
            line = self._line(key, span)
            if key not in known:
                raise self.error(line, f"{key} is not a key here; there are {', '.join(known)}")
            wanted = _KEYS[key]
            if not isinstance(value, wanted) or (isinstance(value, bool) and wanted != (bool,)):
                said = " or ".join(dict.fromkeys(_SAID[one] for one in wanted))
                raise self.error(line, f"{key} is not {said}")
            self._check_value(span, key, value, line)

    def _check_value(self, span: _Span, key: str, value: Any, line: int) -> None:
        texts = (
            value.values() if key == "zones" else value if key in ("io", "before", "expect") else ()
        )
        if not all(isinstance(one, str) for one in texts):
            raise self.error(line, f"{key} has something else than texts")
        if key == "seconds" and not 0 < value <= 86_400:
            raise self.error(line, f"seconds are {value}, which cannot be")
        for zone, text in value.items() if key == "zones" else ():
            self._made(span, zone, lambda _, it: read_expectation(f"avoids {it}", "", 0), text)

    def _line(self, words: str, span: _Span, since: int | None = None) -> int:
        """Return the line of a key or text, in a table (first ``since``) or among the shared keys.

        Where it is in none, return the line with which the search began.
        """
        pattern = re.compile(rf"(?<![\w-]){re.escape(words)}(?![\w-])")
        first = since or span.start
        for number in chain(range(first, span.end), range(span.start, first), range(1, span.start)):
            if pattern.search(self._lines[number - 1].replace('\\"', '"')):
                return number
        return first

    def error(self, line: int, what: str) -> TestFileError:
        return TestFileError(f"{self._path}:{line}: {' '.join(what.split())}")


@dataclass(frozen=True, slots=True)
class _Span:
    """The lines of a test; ``end`` is the line after the last one."""

    start: int
    end: int


_T = TypeVar("_T")
#: An expectation, its line, and file and line of the code beside it.
_Stated = tuple[str, int, tuple[str, int] | None]
_Entry = tuple[_Span, Mapping[str, Any], Sequence[_Stated]]


def _statement(name: str, value: object) -> str:
    """Return ``NAME = VALUE`` as KRL; a text is taken as KRL. Raises `ValueError`."""
    match value:
        case bool():
            return f"{name} = {str(value).upper()}"
        case int() | float() if math.isfinite(value):
            return f"{name} = {value}"
        case str() if "\n" not in value:
            return f"{name} = {value}"
    raise ValueError(f"{name} must be a number, true, false, or KRL as a text")


def _bodies(name: str, value: object) -> tuple[tuple[str, ...], ...]:
    """Return the statements of a stand-in, for one call after another."""
    is_by_call = isinstance(value, list) and bool(value) and isinstance(value[0], list)
    calls: Any = value if is_by_call else [value]
    bodies = [[body] if isinstance(body, str) else body for body in calls]
    if all(isinstance(body, list) and all(isinstance(one, str) for one in body) for body in bodies):
        return tuple(tuple(body) for body in bodies)
    raise ValueError(
        f"{name} must be a statement of KRL, a list of them, or such a list for each call"
    )


def _merged(shared: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """Return shared and own values of a test; inputs and tables are combined, others replaced."""
    made = {**shared, **own}
    for key in shared.keys() & own.keys():
        if isinstance(shared[key], dict):
            made[key] = {**shared[key], **own[key]}
        elif key in ("io", "before"):
            made[key] = [*_texts(shared[key]), *_texts(own[key])]
    return made


def _texts(value: str | Sequence[str]) -> tuple[str, ...]:
    """Return one text or several as a tuple."""
    return (value,) if isinstance(value, str) else tuple(value)
