"""Detection of seeded faults: which drawn mutants and planted faults make a case fail.

Each fault is planted in a process of its own, a fork of one that has loaded everything, so that it
has no effect on the next one. The cases that run one of its lines are run with it until one fails.
A case also fails if it takes many times as long as any case should, or if the machine in C, which
is not changed, does something else than the tree interpreter.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.util import find_spec
from operator import itemgetter
from pathlib import Path
from typing import Any, Final, Generic, Literal, NoReturn, TypeVar

from conformance.evaluation.case_result import Result
from conformance.evaluation.case_run import observed_within, run_case
from conformance.evaluation.execution import Setup, missing, observe
from conformance.evaluation.observation import Observation
from conformance.evaluation.verdicts import KnownFailures
from conformance.sensitivity.case_selection import Candidates, candidates
from conformance.sensitivity.code_exchange import InvalidMutant, load
from conformance.sensitivity.equivalents import equivalent, search_reason
from conformance.sensitivity.line_reach import NOTHING_KEPT, Reach, is_alike, reach_of, seen_digest
from conformance.sensitivity.mutants import Mutant
from conformance.sensitivity.seeded_faults import SeededFault, uses_of
from conformance.suite.case import Case
from support.files.code_digest import code_digest
from support.files.result_store import ResultStore
from support.parallel.ordered_map import ordered_map

#: Red: a case has failed, or executors differ on it. Soft: only cases whose rules may not fail have
#: noticed. Equivalent: none can, and ``equivalent.toml`` says why. Invalid: it cannot be planted.
Fate = Literal["red", "soft", "survived", "equivalent", "invalid"]
_Fault = TypeVar("_Fault", bound=SeededFault)

_ROBOT: Final = "kinematic"
_IN_C: Final = Setup("native", _ROBOT)
#: Modules of which the machine in C has its own: it is run beside the tree interpreter.
_APART: Final = ("interp.values.", "interp.tree.")
#: The fields of a detection but for its fault.
OF_DETECTION: Final = ("fate", "case", "why", "reached", "sure", "runs", "changed", "by_profile")
#: The largest number of cases that may fail which are run with a fault.
MOST: Final = 1000
#: The limit of processor time for a case in s: five times what any needs on a busy machine.
_SECONDS: Final = 12.0
#: The limit of address space in bytes; a usual run needs less than a quarter of it.
_MEMORY: Final = 4 << 30


@dataclass(frozen=True, slots=True)
class Detection(Generic[_Fault]):
    """The outcome of a seeded fault.

    ``case`` is the case that noticed it, and ``why`` what that case reported, or for an equivalent
    one why none can notice it. ``reached`` is the number of cases that run its lines, ``sure`` how
    many of these may fail, ``runs`` how many were run. ``changed`` is the first case whose run
    differed, whether it noticed that or not.
    """

    fault: _Fault
    fate: Fate
    case: str = ""
    why: str = ""
    reached: int = 0
    sure: int = 0
    runs: int = 0
    changed: str = ""
    by_profile: bool = False


def is_possible() -> bool:
    """Return whether this system can fork a process and limit its resources."""
    return hasattr(os, "fork") and find_spec("resource") is not None


def kept_detections(folder: Path | None) -> ResultStore:
    """Return the store of detections in a folder, as a context manager.

    It holds for this code only.
    """
    return ResultStore(
        folder, f"mutants {code_digest('conformance', 'grammar', 'interp', 'support')}"
    )


def reaches_of(
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    store: ResultStore = NOTHING_KEPT,
) -> list[Reach]:
    """Return the lines that each case runs, in the order in which cases are tried.

    Cases that may fail come first, then one of each suite in turn, in each suite those first that
    have most expectations for what they cost. Cases that do not pass are left out. ``on_done`` is
    called with the number of finished cases. ``store`` is that of `kept_detections`.
    """
    running = [case for case in cases if case.phase == "run"]
    places: Counter[tuple[bool, str]] = Counter()
    keyed = []
    for one in sorted(reach_of(running, Setup("tree", _ROBOT), jobs, on_done, store), key=_price):
        kind = not one.case.may_fail, one.case.suite
        places[kind] += 1
        keyed.append(((kind[0], places[kind], *_price(one)), one))
    return [one for _, one in sorted(keyed, key=itemgetter(0))]


def _price(reach: Reach) -> tuple[float, str]:
    """Return the cost of a case per expectation, and its name, which makes the order definite."""
    return reach.cost / len(reach.case.expectations), reach.case.name


def detect_faults(
    faults: Sequence[_Fault],
    reaches: Sequence[Reach],
    jobs: int = 1,
    most: int = MOST,
    on_done: Callable[[int], None] = lambda _count: None,
    store: ResultStore = NOTHING_KEPT,
    executor: str = "tree",
) -> list[Detection[_Fault]]:
    """Return whether faults are detected, in their order; the same for any ``jobs``.

    If more cases than ``most`` that may fail run the lines of a fault, only so many are tried.
    ``executor`` runs the cases. ``on_done`` is called with the number of finished faults. ``store``
    is that of `kept_detections`: what it has for the same cases is not tried again.
    """
    key_of = [(most, executor), *((one.case.name, one.case.digest, one.seen) for one in reaches)]
    tried = hashlib.sha256(repr(key_of).encode()).hexdigest()
    keys = [f"{one.name} {tried}" for one in faults]
    found: dict[str, Detection[_Fault]] = {}
    for one, key in zip(faults, keys, strict=True):
        row = store.get_record(key)
        if row is not None:
            found[one.name] = Detection(one, **row)
    on_done(len(found))
    new = [one for one in faults if one.name not in found]
    tasks = (
        (one, candidates(one, reaches, most, is_search=bool(search_reason(one))), executor)
        for one in new
    )
    for detection in ordered_map(_tried, tasks, jobs=jobs):
        found[detection.fault.name] = detection
        row = {each: getattr(detection, each) for each in OF_DETECTION}
        store.put([(f"{detection.fault.name} {tried}", row)])
        on_done(1)
    return [_if_equivalent(found[one.name]) for one in faults]


def _if_equivalent(detection: Detection[_Fault]) -> Detection[_Fault]:
    """Return a detection, as equivalent if its fault survived and is known to change nothing."""
    fault = detection.fault
    if detection.fate != "survived" or not isinstance(fault, Mutant):
        return detection
    known = equivalent()
    reason = known.get(fault.change) or known.get(fault.change[:3], "")
    if not reason and 0 < detection.runs == detection.reached and not detection.changed:
        reason = search_reason(fault)
    return replace(detection, fate="equivalent", why=reason) if reason else detection


# -------------------------------------------------------------------------- one fault, one process


def _tried(fault: _Fault, cases: Candidates, executor: str) -> Detection[_Fault]:
    """Try a fault in a fork of this process; the last outcome that it sends is the result."""
    detection = Detection(fault, "survived")
    if not any(uses_of(fault).values()):
        return replace(detection, fate="invalid", why="it is used only while modules are loaded")
    if not cases.tried:
        return detection
    _load(cases.tried[0].case)
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        _in_fork(fault, cases, executor, writing)
    os.close(writing)
    outcome: dict[str, Any] = {}
    with os.fdopen(reading, "rb") as received:
        while received.peek(1):
            outcome = pickle.load(received)
    os.waitpid(child, 0)
    if not outcome:
        raise RuntimeError(f"{fault.name}: its process ended before the first case")
    return Detection(fault, reached=cases.reached, sure=cases.sure, **outcome)


@cache
def _loaded() -> list[str]:
    return []


def _load(case: Case) -> None:
    """Load all that cases need, once, so that every fork has it."""
    if not _loaded():
        load()
        _loaded().append(run_case(case, [Setup("tree", _ROBOT)]).verdict)


def _in_fork(fault: SeededFault, cases: Candidates, executor: str, pipe: int) -> NoReturn:
    warnings.simplefilter("ignore")  # NumPy warns of what a fault makes it compute
    try:
        with os.fdopen(pipe, "wb", buffering=0) as results:
            for outcome in _outcomes(fault, cases, executor):
                results.write(pickle.dumps(outcome))
        os._exit(0)
    finally:
        os._exit(1)


def _outcomes(fault: SeededFault, cases: Candidates, executor: str) -> Iterator[dict[str, Any]]:
    """Yield before each case the outcome if it ends the process, and at last the real outcome.

    An outcome has the fields of `Detection`.
    """
    import resource  # not on every system

    _, hard = resource.getrlimit(resource.RLIMIT_AS)  # nobody may raise it again
    most = _MEMORY if hard == resource.RLIM_INFINITY else min(_MEMORY, hard)
    resource.setrlimit(resource.RLIMIT_AS, (most, hard))
    runs, changed = 0, ""
    differing: list[tuple[Case, Observation]] = []
    soft: dict[str, Any] = {}
    setups = [Setup(executor, _ROBOT)]
    if executor == "tree" and fault.module.startswith(_APART) and not missing(_IN_C):
        setups.append(_IN_C)
    try:
        with fault.plant():
            for runs, one in enumerate(cases.tried, 1):
                case = one.case
                if soft and not case.may_fail:
                    continue
                fate: Fate | None = "red" if case.may_fail else "soft"
                yield {"fate": fate, "case": case.name, "why": "the process ended", "runs": runs}
                seen = observed_within(case, setups[0], _SECONDS)
                if seen_digest(seen) == one.seen:
                    continue
                differing.append((case, seen))
                fate, why, by_profile = _noticed(case, seen, setups)
                if fate:
                    found = {
                        "fate": fate,
                        "case": case.name,
                        "why": why,
                        "runs": runs,
                        "changed": differing[0][0].name,
                        "by_profile": by_profile,
                    }
                    if fate == "red":
                        yield found
                        return
                    soft = soft or found
        if soft:
            yield {**soft, "runs": runs}
            return
        for case, seen in differing:
            if not is_alike(seen, observe(case, setups[0])):
                changed = case.name
                break
        yield {"fate": "survived", "runs": runs, "changed": changed}
    except InvalidMutant as error:
        yield {"fate": "invalid", "why": str(error)}


def _noticed(
    case: Case, first: Observation, setups: Sequence[Setup]
) -> tuple[Fate | None, str, bool]:
    """Return how a case notices the fault that is planted, why, and `Detection.by_profile`.

    ``first`` is what was observed with the first setup.
    """

    def see(case: Case, setup: Setup) -> Observation:
        return first if setup is setups[0] else observe(case, setup)

    results = run_case(case, setups, KnownFailures(), see, most=_SECONDS).results
    bad = sorted((one for one in results if one.verdict not in ("pass", "skipped")), key=_grave)
    if bad:
        fate: Fate = "red" if bad[0].verdict == "fail" else "soft"
        return fate, bad[0].reason, _is_by_profile(bad[0])
    if any(one.verdict == "pass" for one in results):
        return None, "", False
    return ("red" if case.may_fail else "soft"), "it was skipped", False


def _is_by_profile(result: Result) -> bool:
    """Return whether all that failed a case are laws that rest on no rule."""
    sure = [one for one in result.checks if one.state == "unmet" and one.is_sure]
    seen = result.observation
    is_other = result.divergence is not None or seen is None or seen.ending == "crash"
    return bool(sure) and not is_other and not any(one.basis for one in sure)


def _grave(result: Result) -> bool:
    """Return a key that sorts failures first."""
    return result.verdict != "fail"
