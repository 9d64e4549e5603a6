"""Failures of a nightly run, each with a link and the command that repeats it.

A failure is: a step that did not end; a case that fails on any executor and robot; a case of an
unsure rule that passed in the previous run; a violated law; executors that diverge on a random
program; a planted fault that no case notices; a figure of a bench that is far worse than before.
"""

import shlex
from collections.abc import Iterator, Mapping
from typing import NotRequired, TypedDict
from urllib.parse import urlencode

from reports.nightly.history import bench_figures, worse_figures
from reports.rendering.number_format import counted
from reports.rendering.record_fields import Record, nested, records, text
from reports.rendering.sanitizing import shown

#: The start of the text of a failure of the nightly run itself, as opposed to one of a step.
OF_THE_RUN = "the nightly run "
_FINE = ("ok", "findings")
#: The steps that run cases; their pages are in folders of the same names.
_CONFORM = ("conform", "conform-arm")
#: The suffix of the name of a step that runs the failed cases of such a step once more.
AGAIN = "-again"
_ROBOTS = ("none", "kinematic", "mujoco")
_LONGEST = 200
_MOST_PROGRAMS = 5


class Failure(TypedDict):
    """A failure of a nightly run. ``page`` and ``command`` are empty if there is none.

    ``files`` are those of a program that demonstrates it, texts by name.
    """

    what: str
    page: str
    command: str
    files: NotRequired[Record]


def failures(
    made: Mapping[str, Record], steps: Mapping[str, Record], before: Record | None = None
) -> list[Failure]:
    """Return all failures of a run, from the records and the states of its steps by name.

    ``before`` are the earlier results (`reports.nightly.history.known_before`).
    """
    return [
        *_steps(steps),
        *(one for name in _CONFORM if name in made for one in _cases(name, made)),
        *(one for name in _CONFORM for one in _no_longer_passing(name, made, before or {})),
        *_laws(nested(made.get("conform-laws", {}), "metamorphic")),
        *_programs(made.get("fuzz", {})),
        *_unnoticed(made.get("bench-conform", {})),
        *_fallen(nested(before or {}, "bench"), bench_figures(made)),
    ]


def _steps(steps: Mapping[str, Record]) -> Iterator[Failure]:
    for name, step in steps.items():
        status = text(step, "status")
        if status not in _FINE:
            yield Failure(what=f"step {name}: {status}", page="", command="")


def _unnoticed(bench: Record) -> Iterator[Failure]:
    for one in records(bench, "survivors"):
        fault = shown(text(one, "fault"), _LONGEST)
        what = f"no case notices the planted fault: {text(one, 'group')}: {fault}"
        yield Failure(what=what, page="", command=f"krl conform --fault {shlex.quote(fault)}")


def _fallen(before: Record, now: Record) -> Iterator[Failure]:
    for figure in worse_figures(before, now):
        if figure.is_far:
            bench = figure.name.partition(".")[0]
            command = f"krl nightly --only {shlex.quote(f'bench-{bench}')}"
            yield Failure(what=f"figure {figure}", page="", command=command)


def failed_cases(step: str, record: Record) -> list[str]:
    """Return the names of the cases that failed in a step that runs cases, from its record."""
    cases = records(record, "cases") if step in _CONFORM else ()
    return [text(case, "name") for case in cases if _failed(case)]


def _failed(case: Record) -> list[Record]:
    return [one for one in records(case, "results") if text(one, "verdict") == "fail"]


def _cases(step: str, made: Mapping[str, Record]) -> Iterator[Failure]:
    """Yield the cases that failed; one is flaky if it did not fail when it was run once more."""
    again = {text(case, "name"): case for case in records(made.get(step + AGAIN, {}), "cases")}
    for case in records(made[step], "cases"):
        if failed := _failed(case):
            name = text(case, "name")
            is_flaky = name in again and not _failed(again[name])
            where = ", ".join(f"{text(one, 'executor')}/{text(one, 'robot')}" for one in failed)
            how = f"{'is flaky: it ' if is_flaky else ''}failed on {where}"
            reason = shown(text(failed[0], "reason"), _LONGEST)
            yield _of_case(step, case, f"{how}: {reason}", failed[0])


def _no_longer_passing(step: str, made: Mapping[str, Record], before: Record) -> Iterator[Failure]:
    """Yield cases that do not fail a step by themselves, but passed in its previous run."""
    was = nested(nested(before, step), "cases")
    for case in records(made.get(step, {}), "cases"):
        now = text(case, "verdict")
        if now == "unconfirmed" and str(was.get(text(case, "name"), "")).startswith("pass "):
            unmet = (one for one in records(case, "results") if text(one, "verdict") == now)
            yield _of_case(step, case, f"passed before, now {now}", next(unmet, {}))


def _of_case(step: str, case: Record, what: str, result: Record) -> Failure:
    name = text(case, "name")
    options = [
        f" --{option} {text(result, option)}"
        for option, ours in (("executor", ("tree", "vm", "native")), ("robot", _ROBOTS))
        if text(result, option) in ours
    ]
    return Failure(
        what=f"case {name} {what}",
        page=f"{step}/index.html#{urlencode({'case': name})}",
        command=f"krl conform {name}{''.join(options)}",
    )


def _laws(record: Record) -> Iterator[Failure]:
    for law in records(record, "laws"):
        for broken in records(law, "broken")[:1]:
            difference = shown(text(broken, "difference"), _LONGEST)
            what = f"law '{text(law, 'name')}' broken by {text(broken, 'program')}: {difference}"
            programs = record.get("programs")
            yield Failure(what=what, page="", command=f"krl conform --metamorphic {programs}")


def _programs(record: Record) -> Iterator[Failure]:
    """Yield the first reduced programs on which executors diverge."""
    found = records(record, "differences")
    command = f"krl fuzz --programs {record.get('programs')} --seed {record.get('seed')}"
    for one in found[:_MOST_PROGRAMS]:
        actual, expected = (shown(text(one, name), _LONGEST) for name in ("actual", "expected"))
        what = f"program {one.get('program')} of the fuzzer diverges on {text(one, 'executor')}"
        yield Failure(
            what=f"{what}: {actual}, where {expected} is expected",
            page="",
            command=command,
            files=nested(one, "files"),
        )
    if len(found) > _MOST_PROGRAMS:
        more = counted(len(found) - _MOST_PROGRAMS, "more divergence")
        yield Failure(what=f"{more} of the fuzzer", page="", command=command)
