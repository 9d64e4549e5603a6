"""Expectations: what a case says beside its lines, as in ``;> out 2 TRUE at end 1 - 0.1``.

`KINDS` lists the words with which an expectation can begin, and the syntax of their arguments.
CASES.md says what each means on a real controller; `conformance.evaluation.evaluator` decides
whether it is met.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Literal, cast

Phase = Literal["parse", "check", "run"]
PHASES: Final[tuple[Phase, ...]] = ("parse", "check", "run")


class ExpectationError(ValueError):
    """An expectation is malformed; the text is one line with the reason."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A word with which expectations begin.

    ``form`` is the syntax of its arguments, a regular expression over the words joined by blanks.
    ``timed`` allows a time after them, ``tolerant`` a tolerance. ``robot`` is the simplest robot
    that can evaluate the expectation. ``event`` is the kind of event in a trace that it is about;
    without one, that has the same word.
    """

    word: str
    phases: tuple[Phase, ...]
    form: str = ""
    timed: bool = False
    tolerant: bool = False
    robot: Literal["none", "kinematic", "mujoco"] = "none"
    event: str = ""


_NUMBER: Final = r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"
_NAME: Final = r"[$\w]+(?:\[\d+(?:,\d+)*\])?(?:\.\w+(?:\[\d+\])?)*"
_VALUE: Final = rf"(?:{_NUMBER}|TRUE|FALSE|#\w+|\"[^\"]*\"|none)"
_MANY: Final = rf"{_NUMBER}(?: {_NUMBER})*"
_POINT: Final = rf"{_NUMBER} {_NUMBER} {_NUMBER}"
_ZONE: Final = rf"(?:box {_POINT} to {_POINT}|sphere {_POINT} by {_NUMBER})"
_SHAPE: Final = (
    rf"(?:line {_POINT} to {_POINT}|(?:circle|blend) {_POINT} by {_POINT} to {_POINT}|joint)"
)

_RUN: Final[tuple[Phase, ...]] = ("run",)
_FRONT: Final[tuple[Phase, ...]] = ("parse", "check")


def _kinds() -> Mapping[str, Kind]:
    kinds = (
        # what a front end says
        Kind("accepted", _FRONT),
        Kind("syntax", ("parse",)),
        Kind("error", _FRONT, r"(?:KSS|KRL)\d+"),
        Kind("warning", ("check",), r"(?:KSS|KRL)\d+"),
        Kind("note", ("check",), r"(?:KSS|KRL)\d+"),
        Kind("silent", ("check",), r"(?:KSS|KRL)\d+"),
        # which way a program goes, and what it computes
        Kind("value", _RUN, rf"{_NAME} {_VALUE}", tolerant=True, event="assign"),
        Kind("values", _RUN, rf"{_NAME} {_VALUE}(?: {_VALUE})*", tolerant=True, event="assign"),
        Kind("runs", _RUN, r"(?:\d+|on)", event="line"),
        Kind("never", _RUN, event="line"),
        Kind("order", _RUN, r"\d+(?: \d+)*", event="line"),
        Kind("fault", _RUN, r"\w+"),
        Kind("mark", _RUN, r"[A-Z]\w*", event="line"),
        # the advance run
        Kind("stops", _RUN, "advance", event="advance_stop"),
        Kind("runs-ahead", _RUN, event="advance_stop"),
        # what happens in the cell, and when
        Kind("out", _RUN, r"\d+ (?:(?:TRUE|FALSE)(?: never)?|never)", timed=True),
        Kind("anout", _RUN, rf"\d+ {_NUMBER}", timed=True, tolerant=True),
        Kind("message", _RUN, r"(?:\d+|\"[^\"]*\")(?: never)?", timed=True),
        Kind("interrupt", _RUN, r"\d+(?: never| times \d+)?", timed=True, event="interrupt_enter"),
        Kind("trigger", _RUN, r"(?:never|times \d+)?", timed=True),
        Kind("brake", _RUN, timed=True),
        Kind("resume", _RUN, timed=True),
        Kind("halt", _RUN, timed=True),
        Kind("line", _RUN, timed=True),
        Kind("calls", _RUN, r"\w+(?: never| times \d+)?", timed=True, event="call"),
        Kind("ends", _RUN, timed=True, event="end"),
        # the motion of a line
        Kind("planned", _RUN, timed=True, event="motion_planned"),
        Kind("start", _RUN, timed=True, event="motion_start"),
        Kind("end", _RUN, timed=True, event="motion_end"),
        Kind("blend-start", _RUN, timed=True, event="blend_start"),
        Kind("apex", _RUN, timed=True, event="blend_apex"),
        Kind("blend-end", _RUN, timed=True, event="blend_end"),
        Kind("blends", _RUN, event="blend_start"),
        Kind("exact", _RUN, event="blend_start"),
        Kind("lasts", _RUN, _NUMBER, tolerant=True, event="motion_end"),
        # the path of a line's motion
        Kind("path", _RUN, _SHAPE, tolerant=True, robot="kinematic"),
        Kind("passes", _RUN, _POINT, tolerant=True, robot="kinematic"),
        Kind("misses", _RUN, rf"{_POINT} by {_NUMBER}", tolerant=True, robot="kinematic"),
        Kind("avoids", _RUN, rf"{_ZONE}(?: in {_POINT} {_POINT})?", robot="kinematic"),
        Kind("leaves", _RUN, rf"{_POINT} by {_NUMBER}", tolerant=True, robot="kinematic"),
        Kind("joins", _RUN, rf"{_POINT} by {_NUMBER}", tolerant=True, robot="kinematic"),
        Kind("pose", _RUN, _MANY, timed=True, tolerant=True, robot="kinematic"),
        Kind("axes", _RUN, _MANY, timed=True, tolerant=True, robot="kinematic"),
        Kind("speed", _RUN, rf"(?:most|reaches|drops below) {_NUMBER}", robot="kinematic"),
        Kind("smooth", _RUN, robot="kinematic"),
        Kind("limits", _RUN, robot="kinematic"),
        Kind("tracks", _RUN, tolerant=True, robot="mujoco"),
    )
    return MappingProxyType({kind.word: kind for kind in kinds})


#: All kinds of expectations, by their words.
KINDS: Final = _kinds()


@dataclass(frozen=True, slots=True)
class Anchor:
    """A moment: ``seconds`` after an event of a motion, a mark, an output, or the start.

    ``event`` is ``start``, ``end``, ``apex``, ``blend-start``, ``blend-end`` or ``planned`` of the
    motion with the number ``of``, counted from 1 in the order of planning; ``mark`` with a name;
    ``out`` or ``in`` with a number, for its first change; or "" for the start of the run.
    """

    event: str
    of: str
    seconds: float


@dataclass(frozen=True, slots=True)
class When:
    """The moment at, before or after which something must happen, or a period for it."""

    relation: Literal["at", "before", "after", "between"]
    first: Anchor
    last: Anchor | None = None
    exactly: bool = False


@dataclass(frozen=True, slots=True)
class Expectation:
    """One expectation ``;> …``; ``file`` and ``line`` are the place that it is about.

    With an empty ``file`` it is about the whole run. ``tolerance`` is in the unit of the compared
    quantity, in seconds for times; ``None`` means the usual tolerance. ``basis`` is the rule or
    clause on which it rests; if empty, that of the case. ``near`` is X, Y, Z and a radius in mm:
    the tool must be within that sphere when the event happens.
    """

    kind: str
    arguments: tuple[str, ...]
    file: str
    line: int
    text: str
    when: When | None = None
    tolerance: float | None = field(default=None)
    basis: str = ""
    near: tuple[float, ...] = ()

    @property
    def needs(self) -> Literal["none", "kinematic", "mujoco"]:
        """The simplest robot with which it can be evaluated."""
        return "kinematic" if self.near else KINDS[self.kind].robot

    def margin(self, usual: float) -> float:
        """Return its tolerance, or the usual one."""
        return usual if self.tolerance is None else self.tolerance

    @property
    def is_absence(self) -> bool:
        """Whether it says that something does not happen, so that silence meets it."""
        words = (self.kind, *self.arguments)
        return (
            self.kind == "silent"
            or words[-1] == "never"
            or words[-2:] in (("runs", "0"), ("times", "0"))
        )


def expected_ending(
    expectations: Sequence[Expectation],
) -> tuple[tuple[str, ...], tuple[Expectation, ...]]:
    """Return how the robot's program may end, and the expectations that say so, if there are any.

    A fault of a submit program does not end that of the robot.
    """
    causes: Mapping[str, Callable[[Expectation], bool]] = {
        "fault": lambda one: one.kind == "fault" and not one.file.lower().endswith(".sub"),
        "running": lambda one: one.kind == "runs" and one.arguments == ("on",),
        "halt": lambda one: one.kind == "halt",
    }
    for ending, is_cause in causes.items():
        if found := tuple(one for one in expectations if is_cause(one)):
            return (("end", "halt") if ending == "halt" else (ending,)), found
    return ("end",), ()


_WORDS: Final = re.compile(r'"[^"]*"|[^\s"]+')
_BASIS: Final = re.compile(r"\s\[([A-Z]{3}-\d\d(?:\.[a-z])?)\]$")
_WITHIN: Final = re.compile(rf"(?:^| )within ({_NUMBER})$")
_EVENT: Final = r"(?:(?:start|end|apex|blend-start|blend-end|planned) \d+|mark \w+|(?:out|in) \d+)"
_MOMENT: Final = rf"(?:{_EVENT}(?: [-+] {_NUMBER})?|{_NUMBER})"
_WHEN: Final = re.compile(
    rf"(?:^| )(?:(?P<relation>at|before|after) (?P<one>{_MOMENT})(?P<exactly> exactly)?"
    rf"|between (?P<first>{_MOMENT}) and (?P<last>{_MOMENT}))$"
)
_NEAR: Final = re.compile(rf"(?:^| )near ({_POINT}) by ({_NUMBER})$")
_MOMENT_PARTS: Final = re.compile(
    rf"(?:(?P<event>[a-z-]+) (?P<of>\w+)(?: (?P<sign>[-+]) (?P<more>{_NUMBER}))?"
    rf"|(?P<at>{_NUMBER}))$"
)


def read_expectation(text: str, file: str, line: int) -> Expectation:
    """Return the expectation in the text after ``;>``. Raises `ExpectationError`."""
    cited = _BASIS.search(text.strip())
    rest = " ".join(_WORDS.findall(text.strip()[: cited.start()] if cited else text))
    word, _, rest = rest.partition(" ")
    kind = KINDS.get(word)
    if kind is None:
        raise ExpectationError(f"there is no expectation {word!r}")
    tolerance, when = None, None
    near: tuple[float, ...] = ()
    if found := _WITHIN.search(rest):
        tolerance, rest = float(found[1]), rest[: found.start()]
    if found := _WHEN.search(rest):
        when, rest = _when(found), rest[: found.start()]
    if found := _NEAR.search(rest):
        near, rest = (*map(float, found[1].split()), float(found[2])), rest[: found.start()]
    if near and not kind.timed:
        raise ExpectationError(f"{word} happens at no place")
    if when is not None and not kind.timed:
        raise ExpectationError(f"{word} happens at no time")
    if tolerance is not None and not (kind.tolerant or when is not None):
        raise ExpectationError(f"{word} has no tolerance")
    if tolerance is not None and tolerance < 0:
        raise ExpectationError("a tolerance is not negative")
    if not re.fullmatch(kind.form, rest):
        raise ExpectationError(f"{rest or 'nothing'!r} cannot stand behind {word}")
    arguments = tuple(_WORDS.findall(rest))
    rests_on = cited[1] if cited else ""
    return Expectation(word, arguments, file, line, text.strip(), when, tolerance, rests_on, near)


def _when(found: re.Match[str]) -> When:
    if found["relation"]:
        is_exact = found["exactly"] is not None
        relation = cast(Literal["at", "before", "after"], found["relation"])
        return When(relation, _anchor(found["one"]), exactly=is_exact)
    return When("between", _anchor(found["first"]), _anchor(found["last"]))


def _anchor(text: str) -> Anchor:
    parts = _MOMENT_PARTS.match(text)
    assert parts is not None, "the pattern before was the same"
    if parts["at"] is not None:
        return Anchor("", "", float(parts["at"]))
    more = float((parts["sign"] or "") + (parts["more"] or "0"))
    return Anchor(parts["event"], parts["of"], more)
