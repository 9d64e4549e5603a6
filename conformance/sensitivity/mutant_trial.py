"""Mutants against cases: which mutants make a case fail.

Each mutant has a process of its own, a copy of one that has everything loaded, so that nothing it
does outlives it. It is tried on the cases that run one of its lines, until one fails. A case that
takes many times as long as any should has failed too, and so has one on which the machine in C, of
which the mutant is no part, does something else than the tree interpreter.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import tomllib
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.util import find_spec
from itertools import islice, zip_longest
from operator import itemgetter
from pathlib import Path
from typing import Any, Final, Literal, NoReturn

from conformance.evaluation.execution import Setup, missing, observe
from conformance.evaluation.observation import Observation
from conformance.evaluation.verdicts import KnownFailures
from conformance.runner import Result, observed_within, run_case
from conformance.sensitivity.line_reach import NOTHING_KEPT, Reach, reach_of, seen_digest
from conformance.sensitivity.mutants import (
    InvalidMutant,
    Mutant,
    around,
    cited,
    load,
    put_in_place,
    uses_of,
)
from conformance.suite.case import Case
from support.files.code_digest import code_digest
from support.files.result_store import ResultStore
from support.parallel.ordered_map import ordered_map

#: Red: a case has failed, or executors differ on it. Soft: only cases whose rules may not fail have
#: noticed. Equivalent: none
#: can, and ``equivalent.toml`` says why. Invalid: it could not be put in place.
Fate = Literal["red", "soft", "survived", "equivalent", "invalid"]

_SETUP: Final = Setup("tree", "kinematic")
_IN_C: Final = Setup("native", "kinematic")
#: Packages of which the machine in C has its own: it is run beside the tree interpreter.
_APART: Final = ("values", "tree")
_EQUIVALENT: Final = Path(__file__).with_name("equivalent.toml")
#: The fields of a trial but for its mutant.
OF_TRIAL: Final = ("fate", "case", "why", "reached", "sure", "runs", "changed")
#: So many cases that may fail are run with a mutant that none of them notices.
MOST: Final = 1000
#: So many seconds of computing a case may take; all of them take less than a tenth of it.
_SECONDS: Final = 2.0
#: So much address space in bytes a mutant may take; a usual run takes less than a quarter of it.
_MEMORY: Final = 4 << 30


@dataclass(frozen=True, slots=True)
class Trial:
    """What became of a mutant.

    ``case`` is the one that noticed it, ``why`` what it said, or why none can. ``reached`` is how
    many cases run its lines, ``sure`` how many of them may fail, ``runs`` how many were run.
    ``changed`` is the first that did something else with it, whether it noticed that or not.
    """

    mutant: Mutant
    fate: Fate
    case: str = ""
    why: str = ""
    reached: int = 0
    sure: int = 0
    runs: int = 0
    changed: str = ""


def is_possible() -> bool:
    """Whether this system can copy a process and limit what it takes."""
    return hasattr(os, "fork") and find_spec("resource") is not None


def kept_trials(folder: Path | None) -> ResultStore:
    """What is known of mutants of this code, in a folder; a context manager."""
    return ResultStore(
        folder, f"mutants {code_digest('conformance', 'grammar', 'interp', 'support')}"
    )


def reaches_of(
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    store: ResultStore = NOTHING_KEPT,
) -> list[Reach]:
    """What the cases run that can notice anything, in the order in which they are tried.

    Those that may fail come first; among them of each suite the one that expects most for what it
    costs, then the second of each, and so on. ``on_done`` is called for the cases as they run.
    ``store`` is one of `kept_trials`.
    """
    running = [case for case in cases if case.phase == "run"]
    places: Counter[tuple[bool, str]] = Counter()
    keyed = []
    for one in sorted(reach_of(running, _SETUP, jobs, on_done, store), key=_price):
        kind = not one.case.may_fail, one.case.suite
        places[kind] += 1
        keyed.append(((kind[0], places[kind], *_price(one)), one))
    return [one for _, one in sorted(keyed, key=itemgetter(0))]


def _price(reach: Reach) -> tuple[float, str]:
    """What an expectation of a case costs; its name keeps the order the same."""
    return reach.cost / len(reach.case.expectations), reach.case.name


def try_mutants(
    mutants: Sequence[Mutant],
    reaches: Sequence[Reach],
    jobs: int = 1,
    most: int = MOST,
    on_done: Callable[[int], None] = lambda _count: None,
    store: ResultStore = NOTHING_KEPT,
) -> list[Trial]:
    """What becomes of each mutant, in their order; the same whatever ``jobs`` is.

    Where more cases run its lines than ``most`` that may fail, only the first of them are tried.
    ``on_done`` is called for the mutants as they are tried. ``store`` is one of `kept_trials`: what
    it holds for the same cases is not tried again.
    """
    tried = hashlib.sha256(repr([(most, one.case.name, one.seen) for one in reaches]).encode())
    tried.update("".join(one.case.digest for one in reaches).encode())
    keys = {one: f"trial {one.name} {tried.hexdigest()}" for one in mutants}
    found: dict[Mutant, Trial] = {}
    for one, key in keys.items():
        row = store.get_record(key)
        if row is not None:
            found[one] = Trial(one, **row)
    on_done(len(found))
    new = [one for one in keys if one not in found]
    tasks = ((mutant, _candidates(mutant, reaches, most)) for mutant in new)
    for trial in ordered_map(_tried, tasks, jobs=jobs):
        found[trial.mutant] = trial
        row = {each: getattr(trial, each) for each in OF_TRIAL}
        store.put([(keys[trial.mutant], row)])
        on_done(1)
    return [_if_equivalent(found[one]) for one in mutants]


def _if_equivalent(trial: Trial) -> Trial:
    if trial.fate != "survived":
        return trial
    reason = equivalent().get(trial.mutant.change, "")
    if not reason and 0 < trial.runs == trial.reached and not trial.changed:
        reason = _search(trial.mutant)
    return replace(trial, fate="equivalent", why=reason) if reason else trial


@cache
def equivalent() -> Mapping[tuple[str, ...], str]:
    """The changes that no case can notice, and why; identified by content, not place."""
    keys = ("module", "function", "source", "was", "now")
    return {tuple(row[key] for key in keys): row["reason"] for row in _known()["mutant"]}


def _search(mutant: Mutant) -> str:
    """Why a mutant changes only how something is sought; empty where it changes what is found."""
    row = searches().get((mutant.module, mutant.function))
    return "" if row is None or mutant.source in row.get("deciding", ()) else row["reason"]


@cache
def searches() -> Mapping[tuple[str, str], Mapping[str, Any]]:
    """Functions and constants that say how something is sought, by module and name: their tables.

    A change of them that changes nothing seen only takes longer or shorter.
    """
    return {(row["module"], name): row for row in _known()["search"] for name in row["names"]}


@cache
def _known() -> dict[str, list[dict[str, Any]]]:
    return tomllib.loads(_EQUIVALENT.read_text(encoding="utf-8"))


@dataclass(frozen=True, slots=True)
class _Candidates:
    """The cases to try on a mutant; ``reached`` and ``sure`` as in `Trial`."""

    tried: tuple[Reach, ...]
    reached: int
    sure: int


def _candidates(mutant: Mutant, reaches: Sequence[Reach], most: int) -> _Candidates:
    """Of the cases that run its lines ``most`` that may fail, and a tenth as many of the others.

    Where fewer may fail there are more of the others, as executors that differ fail any case.
    First one for each line around it, the rarest first; then one of each rule that the code there
    cites; then one of each way through its module, as cases that run the same lines there mostly
    notice the same; then every so many of what is left, so that long ones are among them. A change
    of a search is tried on all cases that run it: it is equivalent only where none sees it.
    """
    uses = uses_of(mutant)
    reaching = [one for one in reaches if any(one.has(*lines) for lines in uses.items())]
    hard = [one for one in reaching if one.case.may_fail]
    tried = reaching
    if not _search(mutant):
        soft = [one for one in reaching if not one.case.may_fail]
        room = max(most - len(hard), most // 10, 1)
        tried = [*_chosen(mutant, hard, most), *_chosen(mutant, soft, room)]
    # the lines are large, and no longer needed
    return _Candidates(tuple(replace(one, lines={}) for one in tried), len(reaching), len(hard))


def _chosen(mutant: Mutant, cases: Sequence[Reach], most: int) -> Iterator[Reach]:
    """At most so many of the cases."""
    chosen: dict[str, Reach] = {}
    for way in (_of_rarest(mutant, cases), _of_rules(mutant, cases), _of_ways(mutant, cases)):
        new = (one for one in way if one.case.name not in chosen)
        chosen.update((one.case.name, one) for one in islice(new, most // 4))
    yield from chosen.values()
    left = [one for one in cases if one.case.name not in chosen]
    room = most - len(chosen)
    if room:
        yield from left[:: -(-len(left) // room) or 1]


def _of_rarest(mutant: Mutant, cases: Sequence[Reach]) -> Iterator[Reach]:
    """For each line around a mutant the first case that runs it, the rarest lines first."""
    near = around(mutant)
    running_it: dict[tuple[str, int], list[Reach]] = {}
    for one in cases:
        for module, lines in near.items():
            for line in lines.intersection(one.lines.get(module, ())):
                running_it.setdefault((module, line), []).append(one)
    found: set[str] = set()
    for _, those in sorted(running_it.items(), key=lambda item: (len(item[1]), item[0])):
        if those[0].case.name not in found:
            found.add(those[0].case.name)
            yield those[0]


def _of_rules(mutant: Mutant, cases: Sequence[Reach]) -> Iterator[Reach]:
    """A case of each rule that the code around a mutant cites, the rarest first, then a second."""
    wanted = cited(mutant)
    stating: dict[str, list[Reach]] = {}
    for one in cases:
        for rule in wanted.intersection(one.case.rules):
            stating.setdefault(rule, []).append(one)
    rows = (those for _, those in sorted(stating.items(), key=lambda row: (len(row[1]), row[0])))
    return (one for turn in zip_longest(*rows) for one in turn if one is not None)


def _of_ways(mutant: Mutant, cases: Sequence[Reach]) -> list[Reach]:
    """One case of each way through a mutant's module, then a second."""
    turns: Counter[frozenset[int]] = Counter()
    found = []
    for one in cases:
        way = one.lines.get(mutant.module, frozenset())
        turns[way] += 1
        found.append((turns[way], one))
    return [one for _, one in sorted(found, key=itemgetter(0))]


# ------------------------------------------------------------------------- one mutant, one process


def _tried(mutant: Mutant, cases: _Candidates) -> Trial:
    """Try a mutant in a copy of this process; its last message is the result."""
    trial = Trial(mutant, "survived")
    if not any(uses_of(mutant).values()):
        return replace(trial, fate="invalid", why="it is used only while modules are loaded")
    if not cases.tried:
        return trial
    _load(cases.tried[0].case)
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        _in_copy(mutant, cases, writing)
    os.close(writing)
    with os.fdopen(reading, "rb") as heard:
        while heard.peek(1):
            trial = pickle.load(heard)
    os.waitpid(child, 0)
    return trial


@cache
def _loaded() -> list[str]:
    return []


def _load(case: Case) -> None:
    """Load all that cases need, once, so that every copy has it."""
    if not _loaded():
        load()
        _loaded().append(run_case(case, [_SETUP]).verdict)


def _in_copy(mutant: Mutant, cases: _Candidates, pipe: int) -> NoReturn:
    warnings.simplefilter("ignore")  # of computing with what a mutant has made
    try:
        with os.fdopen(pipe, "wb", buffering=0) as results:
            for trial in _trials(mutant, cases):
                results.write(pickle.dumps(trial))
        os._exit(0)
    finally:
        os._exit(1)


def _trials(mutant: Mutant, cases: _Candidates) -> Iterator[Trial]:
    """Before each case what is true if it ends the process, and at the end what became of it."""
    import resource  # not on every system

    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, resource.RLIM_INFINITY))
    reached, sure, runs, changed = cases.reached, cases.sure, 0, ""
    setups = [_SETUP]
    if mutant.package in _APART and not missing(_IN_C):
        setups.append(_IN_C)
    try:
        with put_in_place(mutant):
            for runs, one in enumerate(cases.tried, 1):
                case = one.case
                fate: Fate = "red" if case.may_fail else "soft"
                yield Trial(mutant, fate, case.name, "the process ended", reached, sure, runs)
                noticed, why, seen = _noticed(one, setups)
                changed = changed or (case.name if seen != one.seen else "")
                if noticed:
                    yield Trial(mutant, noticed, case.name, why, reached, sure, runs, changed)
                    return
            yield Trial(mutant, "survived", "", "", reached, sure, runs, changed)
    except InvalidMutant as error:
        yield Trial(mutant, "invalid", "", str(error), reached, sure)


def _noticed(reach: Reach, setups: Sequence[Setup]) -> tuple[Fate | None, str, str]:
    """How a case notices the mutant that is in place, why, and the digest of what was seen.

    Where nothing else is seen than without it, nothing is evaluated, and the other executor has
    nothing to differ from.
    """
    case = reach.case
    first = observed_within(case, setups[0], _SECONDS)
    digest = seen_digest(first)
    if digest == reach.seen:
        return None, "", digest

    def see(case: Case, setup: Setup) -> Observation:
        return first if setup is setups[0] else observe(case, setup)

    results = run_case(case, setups, KnownFailures(), see, most=_SECONDS).results
    bad = sorted((one for one in results if one.verdict not in ("pass", "skipped")), key=_grave)
    if bad:
        return ("red" if bad[0].verdict == "fail" else "soft"), bad[0].reason, digest
    if any(one.verdict == "pass" for one in results):
        return None, "", digest
    return ("red" if case.may_fail else "soft"), "it was skipped", digest


def _grave(result: Result) -> bool:
    """What comes first in order: that it failed."""
    return result.verdict != "fail"
