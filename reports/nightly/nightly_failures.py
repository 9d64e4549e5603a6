"""Failures of a nightly run, each with a link and the command that repeats it.

A failure is: a case that was there in the previous run and is not in this one; a step that did not
end; a case that fails on any executor and robot; a case of an unsure rule that passed in the
previous run; a violated law; executors that diverge on a random program; a planted fault that no
case notices; a figure of a bench that is far worse than before. A case that vanished on purpose is
a failure of one run: the next one is compared with that.
"""

import shlex
from collections.abc import Iterator, Mapping
from typing import NotRequired, TypedDict
from urllib.parse import urlencode

from reports.nightly.history import ON_MUJOCO, bench_figures, vanished, worse_figures
from reports.nightly.step_status import has_failed, incomplete
from reports.rendering.number_format import clip, counted
from reports.rendering.record_fields import Record, nested, records, text, texts
from reports.rendering.sanitizing import shown

#: The start of the text of a failure of the nightly run itself, as opposed to one of a step.
OF_THE_RUN = "the nightly run "
#: The steps that run cases; their pages are in folders of the same names.
_CONFORM = ("conform", "conform-arm")
#: The suffix of the name of a step that runs the failed cases of such a step once more.
AGAIN = "-again"
_ROBOTS = ("none", "kinematic", "mujoco")
_LONGEST = 200
_LONGEST_FIRST = 120
_MOST_PROGRAMS = 5


class Failure(TypedDict):
    """A failure of a nightly run. ``page`` and ``command`` are empty if there is none.

    ``files`` are those of a program that demonstrates it, texts by name. ``cases`` are the cases
    that fail alike, if there are several: their pages by name, empty if there is none.
    """

    what: str
    page: str
    command: str
    files: NotRequired[Record]
    cases: NotRequired[Record]


def failures(
    made: Mapping[str, Record], steps: Mapping[str, Record], before: Record | None = None
) -> list[Failure]:
    """Return all failures of a run, from the records and the states of its steps by name.

    ``before`` are the earlier results (`reports.nightly.history.known_before`).
    """
    return [
        *(one for name in _CONFORM if name in made for one in _vanished(name, made, before or {})),
        *_steps(steps),
        *(one for name in _CONFORM if name in made for one in _cases(name, made)),
        *(one for name in _CONFORM for one in _no_longer_passing(name, made, before or {})),
        *_laws(nested(made.get("conform-laws", {}), "metamorphic")),
        *_programs(made.get("fuzz", {})),
        *_unnoticed(made.get("bench-conform", {})),
        *_fallen(nested(before or {}, "bench"), bench_figures(made)),
    ]


def headline(record: Record) -> str:
    """Return the outcome of a run in one line, from its record; "" if it is good."""
    found = records(record, "failures")
    told = [left] if (left := incomplete(nested(record, "steps"))) else []
    if found:
        total = sum(max(1, len(nested(one, "cases"))) for one in found)
        kinds = f" of {counted(len(found), 'kind')}" if total > len(found) else ""
        first = clip(text(found[0], "what"), _LONGEST_FIRST)
        is_first = ", first" if len(found) > 1 else ""
        told.insert(0, f"{counted(total, 'failure')}{kinds}{is_first}: {first}")
    return "; ".join(told)


def _vanished(step: str, made: Mapping[str, Record], before: Record) -> Iterator[Failure]:
    record, where = made[step], ON_MUJOCO if step == "conform-arm" else ""
    there = {*texts(record, "not_run"), *(text(one, "name") for one in records(record, "cases"))}
    for told, names in vanished(nested(nested(before, step), "cases"), there):
        cases = dict.fromkeys(names, "")
        yield Failure(what=f"{where}{told}", page="", command="", cases=cases)


def _steps(steps: Mapping[str, Record]) -> Iterator[Failure]:
    for name, step in steps.items():
        status = text(step, "status")
        if has_failed(status):
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
    found: dict[str, dict[str, Record]] = {}
    for case in records(made[step], "cases"):
        if failed := _failed(case):
            name = text(case, "name")
            is_flaky = name in again and not _failed(again[name])
            how = f"{'is flaky: it ' if is_flaky else ''}failed on"
            found.setdefault(_alike(how, failed), {})[name] = failed[0]
    yield from (_of_cases(step, cases, what) for what, cases in found.items())


def _no_longer_passing(step: str, made: Mapping[str, Record], before: Record) -> Iterator[Failure]:
    """Yield cases that do not fail a step by themselves, but passed in its previous run."""
    was = nested(nested(before, step), "cases")
    found: dict[str, dict[str, Record]] = {}
    for case in records(made.get(step, {}), "cases"):
        now, name = text(case, "verdict"), text(case, "name")
        if now == "unconfirmed" and str(was.get(name, "")).startswith("pass "):
            unmet = [one for one in records(case, "results") if text(one, "verdict") == now]
            what = _alike(f"passed before, now {now} on", unmet)
            found.setdefault(what, {})[name] = next(iter(unmet), {})
    yield from (_of_cases(step, cases, what, " --strict") for what, cases in found.items())


def _alike(how: str, results: list[Record]) -> str:
    """Return what is told of a case with these results; cases that tell the same are alike."""
    where = ", ".join(f"{text(one, 'executor')}/{text(one, 'robot')}" for one in results)
    return f"{how} {where}: {shown(text(results[0], 'reason') if results else '', _LONGEST)}"


def _of_cases(step: str, cases: Mapping[str, Record], what: str, option: str = "") -> Failure:
    """Return the failure of cases that fail alike, each with a result that shows it."""
    pages = {name: f"{step}/index.html#{urlencode({'case': name})}" for name in cases}
    name, result = next(iter(cases.items()))
    options = [
        f" --{option} {text(result, option)}"
        for option, ours in (("executor", ("tree", "vm", "native")), ("robot", _ROBOTS))
        if text(result, option) in ours
    ]
    failure = Failure(
        what=f"case {name} {what}",
        page=pages[name],
        command=f"krl conform {name}{''.join(options)}{option}",
    )
    if len(cases) > 1:
        failure |= {"what": f"{counted(len(cases), 'case')} {what}", "cases": pages}
    return failure


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
