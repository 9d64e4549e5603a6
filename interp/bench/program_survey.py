"""The survey of main programs of many backups, in parallel processes and within limits.

The files of an origin are read and linked once, in one process, which then runs its programs one
after the other. A program ends at the latest when its virtual time, its processor time or its
statements are used up. A defect of ours ends only that program. Results are stored by the content
of the origin, so that an interrupted survey can be continued.
"""

from __future__ import annotations

import hashlib
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import asdict, dataclass, field, replace
from itertools import product
from pathlib import Path
from random import Random
from typing import Any, Final, Literal

from grammar.bench.damage import damaged_source
from grammar.syntax.source import Source
from interp.bench.main_programs import (
    MainProgram,
    is_of_controller,
    main_programs,
    run_main,
    survey_profile,
)
from interp.program.load import Limits
from interp.robot.simulation.factory import RobotName
from interp.session import RunSetup
from support.files.code_digest import code_digest
from support.files.result_store import ResultStore
from support.parallel.sticky_pool import StickyPool

#: The largest number of statements of a program: an endless computation is detected before.
_STATEMENTS: Final = 3_000_000


@dataclass(frozen=True, slots=True)
class Origin:
    """The origin of files, the files, and the kind of damage that they have."""

    name: str
    sources: tuple[Source, ...]
    damage: str = ""


#: The part of a backup that remains: all, the files of its users without the folders of the
#: controller, all except data lists, or each program file by itself.
Part = Literal["whole", "modules", "code", "file"]


@dataclass(frozen=True, slots=True)
class RandomSample:
    """Draws a random sample of paths; each path is drawn independently of the others."""

    share: float = 1.0
    seed: int = 1

    def draws(self, path: str) -> bool:
        """Return whether a path is in the sample."""
        return Random(f"{self.seed} {path}").random() < self.share


def remaining(origins: Iterable[Origin], part: Part) -> Iterator[Origin]:
    """Yield the origins with only the remaining part of their files."""
    for origin in origins:
        some = [one for one in origin.sources if _remains(one, part)]
        if part == "file":
            yield from (replace(origin, name=one.path, sources=(one,)) for one in some)
        else:
            yield replace(origin, sources=tuple(some))


def damaged(origins: Iterable[Origin], kinds: Sequence[str], seed: int) -> Iterator[Origin]:
    """Yield each origin with each kind of damage, one at a time; "" means no damage."""
    for origin, kind in product(origins, kinds):
        some = (damaged_source(one, kind, seed) if kind else one for one in origin.sources)
        yield replace(origin, sources=tuple(one for one in some if one), damage=kind)


def _remains(source: Source, part: Part) -> bool:
    if part == "modules":
        return not is_of_controller(source.path)
    return part == "whole" or source.kind != "dat"


@dataclass(frozen=True, slots=True)
class RunBounds:
    """How programs are run, and which of them: those that ``sample`` draws.

    ``until`` is the limit of virtual time in µs, ``cpu`` that of processor time in s.
    """

    executor: str
    robot: RobotName = "none"
    until: int = 600_000_000
    cpu: float = 30.0
    stands_in: bool = True
    sample: RandomSample = RandomSample()


@dataclass(frozen=True, slots=True)
class SurveyedOrigin:
    """An origin whose programs have run: their rows, and the unreadable files with reasons.

    A row has ``origin``, ``damage`` and ``path``, the fields of
    `interp.bench.main_programs.MainProgramResult`, and ``wall`` in seconds.
    """

    origin: Origin
    rows: tuple[dict[str, Any], ...]
    unread: tuple[tuple[str, str], ...]


def survey(
    origins: Sequence[Origin],
    bounds: RunBounds,
    *,
    jobs: int = 1,
    cache: Path | None = None,
    on_found: Callable[[int], None] = lambda _count: None,
    on_done: Callable[[], None] = lambda: None,
) -> Iterator[SurveyedOrigin]:
    """Yield the result of each origin when it is complete; the largest origins are begun first.

    ``on_found`` is called with the number of further programs found, ``on_done`` for each that has
    run. ``cache`` is a folder for results.
    """
    key = code_digest("grammar", "interp", "support")
    with ResultStore(cache, f"programs {key}") as store, StickyPool(jobs) as pool:
        yield from _Survey(pool, store, bounds, on_found, on_done).run(origins)


@dataclass(slots=True)
class _Running:
    """An origin in a process, with the rows of its programs by index, and a digest of its input."""

    origin: Origin
    process: int
    digest: str
    paths: list[str] = field(default_factory=list)
    unread: list[tuple[str, str]] = field(default_factory=list)
    rows: dict[int, dict[str, Any]] = field(default_factory=dict)

    def placed(self, place: int, row: dict[str, Any]) -> dict[str, Any]:
        """Return a row with its origin, damage and path."""
        name, damage = self.origin.name, self.origin.damage
        return {"origin": name, "damage": damage, "path": self.paths[place], **row}


@dataclass(slots=True, eq=False)
class _Survey:
    """Assigns an origin at a time to each process."""

    _pool: StickyPool
    _store: ResultStore
    _bounds: RunBounds
    _on_found: Callable[[int], None]
    _on_done: Callable[[], None]
    #: The program of each pending result; ``None`` for the list of an origin's programs.
    _pending: dict[Future[Any], tuple[_Running, int | None]] = field(default_factory=dict)

    def run(self, origins: Sequence[Origin]) -> Iterator[SurveyedOrigin]:
        """See `survey`."""
        todo = deque(sorted(origins, key=lambda origin: -_size(origin.sources)))
        for process in range(min(self._pool.count, len(todo))):
            self._begin(todo, process)
        while self._pending:
            ready, _ = wait(self._pending, return_when=FIRST_COMPLETED)
            for one in ready:
                running, program = self._pending.pop(one)
                if program is None:
                    self._listed(running, *one.result())
                else:
                    self._ran(running, program, one.result())
                if len(running.rows) == len(running.paths):
                    self._begin(todo, running.process)
                    yield self._finished(running)

    def _begin(self, todo: deque[Origin], process: int) -> None:
        if todo:
            origin = todo.popleft()
            texts = [(one.path, one.text) for one in origin.sources]
            asked = (origin.name, texts, self._bounds)
            digest = hashlib.sha256(repr(asked).encode()).hexdigest()
            future = self._pool.submit(process, _list_programs, origin, self._bounds)
            self._pending[future] = _Running(origin, process, digest), None

    def _listed(self, running: _Running, paths: list[str], unread: list[tuple[str, str]]) -> None:
        running.paths, running.unread = paths, unread
        self._on_found(len(paths))
        for place in range(len(paths)):
            kept = self._store.get_record(f"{running.digest} {place}")
            if kept is not None:
                running.rows[place] = running.placed(place, kept)
                self._on_done()
                continue
            future = self._pool.submit(running.process, _run_program, place, self._bounds)
            self._pending[future] = running, place

    def _ran(self, running: _Running, place: int, row: dict[str, Any]) -> None:
        running.rows[place] = running.placed(place, row)
        self._store.put([(f"{running.digest} {place}", row)])
        self._on_done()

    @staticmethod
    def _finished(running: _Running) -> SurveyedOrigin:
        rows = tuple(row for _, row in sorted(running.rows.items()))
        return SurveyedOrigin(running.origin, rows, tuple(running.unread))


def _size(sources: Sequence[Source]) -> int:
    return sum(len(source.text) for source in sources)


# --------------------------------------------------------------------------- in a process

#: The programs of the origin on which this process works.
_programs: list[MainProgram] = []


def _list_programs(origin: Origin, bounds: RunBounds) -> tuple[list[str], list[tuple[str, str]]]:
    """Return the paths of the main programs of an origin, and its unreadable files."""
    mains, unread = main_programs(origin.sources, stands_in=bounds.stands_in)
    _programs[:] = [main for main in mains if bounds.sample.draws(main.path)]
    return [main.path for main in _programs], unread


def _run_program(place: int, bounds: RunBounds) -> dict[str, Any]:
    """Return the row of one program: the fields of `MainProgramResult`, and its wall-clock time."""
    profile = survey_profile()
    setup = RunSetup(
        executor=bounds.executor,
        robot=bounds.robot,
        profile=profile,
        until=bounds.until,
        limits=Limits(statements=_STATEMENTS, functions=_STATEMENTS, per_slice=profile.statements),
        is_tolerant=bounds.stands_in,
        skips_failures=bounds.stands_in,
    )
    start, used = time.perf_counter(), time.process_time()
    ran = run_main(_programs[place], setup, is_over=lambda: time.process_time() - used > bounds.cpu)
    return {**asdict(ran), "wall": round(time.perf_counter() - start, 3)}
