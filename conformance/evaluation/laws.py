"""Laws: what every run obeys, whatever its program.

A law needs no expectation. So a case also notices errors that are unrelated to what it states. It
is a function over one subject, as the whole run, a motion or a blend, that yields what was observed
instead. `Laws.law` declares it with its words, the rule of KRL on which it rests, and its subjects.
What no rule of KRL states is stated in docs/trace.md and docs/motion.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, islice
from operator import itemgetter
from typing import Any, Final, TypeVar

from conformance.evaluation.motions import EndedMotion, ended
from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.programmed_paths import ProgrammedPath, programmed_paths
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.simulation.tracking import PathRecord

#: What may disturb a run, as words of its program or of the script of its inputs: an override other
#: than 100, and the operator's STOP.
OVERRIDE: Final = "OV_PRO"
STOP: Final = "PRESS STOP"


@dataclass(frozen=True)
class Run:
    """A run that is judged; ``disturbances`` are those of `OVERRIDE` and `STOP` in it."""

    seen: Observation
    disturbances: frozenset[str] = frozenset()

    @property
    def path(self) -> PathRecord:
        """The path of a run that is one of `paths`."""
        assert self.seen.path is not None, "the subject of a law about a path"
        return self.seen.path

    @property
    def machine(self) -> MachineData:
        """The arm of a run that is one of `paths`."""
        assert self.seen.machine is not None, "the subject of a law about a path"
        return self.seen.machine

    @cached_property
    def motions(self) -> tuple[EndedMotion, ...]:
        """The motions that came to their end."""
        return tuple(ended(self.seen))

    @cached_property
    def free(self) -> tuple[EndedMotion, ...]:
        """Those of its motions that nothing has held."""
        return tuple(one for one in self.motions if not one.is_held)

    @cached_property
    def programmed(self) -> tuple[ProgrammedPath | None, ...]:
        """The programmed paths of those, as far as they are known; none if nothing is blended."""
        if all(one.stops for one in self.free):
            return (None,) * len(self.free)
        return tuple(programmed_paths(self.free))


_S = TypeVar("_S")
#: Subjects of laws, each with the event at which its deviations are reported.
Subjects = Iterable[tuple[Event | None, _S]]
#: What was observed instead, with its event if that is another than the subject's.
Deviations = Iterator[str | tuple[Event | None, str]]


@dataclass(frozen=True, slots=True)
class Violation:
    """An event that violates a law: the law, what was observed, and the rule of KRL if any.

    ``event`` is ``None`` if the violation is before all events.
    """

    event: Event | None
    law: str
    actual: str
    rule: str


class Laws:
    """Laws in the order in which their violations are reported.

    They say nothing of runs with the disturbances ``unless``.
    """

    def __init__(self, *unless: str) -> None:
        self._unless = unless
        self._laws: list[tuple[Callable[[Run], Subjects[Any]], str, str, Any]] = []

    def law(
        self, words: str, rule: str = "", *, of: Callable[[Run], Subjects[_S]]
    ) -> Callable[[Callable[[_S], Deviations]], None]:
        """Return a decorator that declares a law."""
        return lambda check: self._laws.append((of, words, rule, check))

    def broken(self, run: Run) -> Iterator[Violation]:
        """Yield how a run violates these laws, subject by subject; of a whole run the first."""
        laws = self._laws if run.disturbances.isdisjoint(self._unless) else []
        for of, group in groupby(laws, itemgetter(0)):
            alike = [*group]
            for event, subject in of(run):
                for _, words, rule, check in alike:
                    for found in islice(check(subject), 1 if subject is run else None):
                        place, actual = (event, found) if isinstance(found, str) else found
                        yield Violation(place, words, actual, rule)


def whole(run: Run) -> Subjects[Run]:
    """Return the run itself."""
    return ((None, run),)


def paths(run: Run) -> Subjects[Run]:
    """Return the run itself if its path and its arm are known."""
    is_known = run.seen.path is not None and run.seen.machine is not None
    return ((None, run),) if is_known else ()


def motions(run: Run) -> Subjects[EndedMotion]:
    """Return the motions that came to their end."""
    return ((one.event, one) for one in run.motions)


def free_motions(run: Run) -> Subjects[EndedMotion]:
    """Return the motions that came to their end and that nothing has held."""
    return ((one.event, one) for one in run.free)
