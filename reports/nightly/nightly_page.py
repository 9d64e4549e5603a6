"""The page of a nightly run: changes, states of the steps, and curves over all runs."""

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.nightly.history import tone
from reports.nightly.nightly_failures import OF_THE_RUN, headline
from reports.nightly.step_status import has_ended
from reports.rendering.embedding import embedded_json
from reports.rendering.number_format import Figure, counted, percent, share
from reports.rendering.page import joined, render
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import plain, shown, shown_texts
from support.files.atomic_write import write_atomic

_MAX_RUNS = 400
_MAX_CHANGES = 300
_DATE = re.compile(r"\d{4}-\d\d-\d\d")
#: The number of earlier runs that are linked.
MOST_EARLIER = 30
#: The starts of links to failed cases.
_PAGES = ("conform/index.html#", "conform-arm/index.html#")
#: Labels of the figures of benches; others are shown by their names.
_IN_WORDS = {
    "recover.bytes_per_s": "survey, bytes a second",
    "recover.warm_bytes_per_s": "survey with a warm automaton, bytes a second",
    "recover.recognise_bytes_per_s": "recogniser alone, bytes a second",
    "recover.ratio_vs_antlr_python": "survey against ANTLR in Python, times",
    "recover.unchanged_s_per_mb": "survey of what has not changed, s a MB",
    "check.s_per_mb": "check, s a MB",
    "check.unchanged_s_per_mb": "check of what has not changed, s a MB",
    "check.projects": "check, projects",
    "check.peak_mb": "check, memory at most, MB",
    "scale.recover_exponent": "survey, exponent of CPU time over size",
    "scale.recover_memory_growth": "survey, memory on the largest corpus by the smallest, times",
    "scale.check_exponent": "check, exponent of CPU time over size",
    "scale.check_memory_growth": "check, memory on the largest corpus by the smallest, times",
    "vm.vm_vs_tree": "bytecode in Python against tree, times",
    "vm.native_vs_tree": "C against tree, times",
    "vm.native_vs_vm": "C against bytecode in Python, times",
    "vm.native_vs_lua": "C against Lua, times",
    "vm.compiled_vs_native": "native code against the machine in C, times",
    "vm.c_vs_compiled": "C -O2 against native code, times",
    "arm.planning_ms_per_motion": "planning, ms a motion",
    "arm.simulated_s_lookahead": "motions with look-ahead, simulated s",
    "arm.simulated_s_batch": "the same in batches, simulated s",
    "arm.inverse_per_s": "inverse kinematics, poses a second",
    "conform.share": "planted faults found, share",
    "conform.failing_share": "planted faults that turn a nightly run red, share",
    "conform.cases_per_s": "cases a second",
    "mutation.detected": "damaged grammars noticed, share",
    "mutation.rule_top1": "right rule first, share",
    "mutation.rule_top5": "right rule among five, share",
    "mutation.repair_top1": "right repair first, share",
    "mutation.repair_top5": "right repair among five, share",
    "mutation.item_top1": "right item first, share",
    "mutation.item_top5": "right item among five, share",
    "mutation.repeated": "damaged grammars surveyed more than once",
    "mutation.runs": "surveys of each of these",
    "mutation.reproducer_median_tokens": "reproducer, tokens in the median",
    "mutation.clusters_per_cause": "clusters a cause",
    "mutation.false_accept": "negatives accepted by the first proposal, share",
}

Json = dict[str, Any]


def write_nightly_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of one nightly run, and return its path.

    ``record`` is a line of the history with ``changes``, the sentences of `history.changes`,
    ``failures`` (`nightly_failures.Failure`), and ``history``, the lines up to it; every field may
    be absent. The page is written atomically. Raises OSError if the folder cannot be made or
    written.
    """
    runs = records(record, "history")[-_MAX_RUNS:]
    data = embedded_json({"runs": [_short(run) for run in runs]})
    page = render(
        "nightly.html.j2",
        script=joined(("page", "nightly")),
        styles=["page.css", "conform.css", "nightly.css"],
        data=data,
        view=_view(record, runs, folder.parent),
    )
    return write_atomic(folder / "index.html", page)


def _short(run: Record) -> Json:
    """Return a nightly run with the data for the curves."""
    recover, fuzz = nested(run, "recover"), nested(run, "fuzz")
    verdicts = nested(nested(run, "conform"), "verdicts")
    return {
        "date": shown(text(run, "date"), 40),
        "parsed": share(count(recover, "parsed"), count(recover, "files")) if recover else None,
        "passed": count(verdicts, "pass") if verdicts else None,
        "failed": count(verdicts, "fail") if verdicts else None,
        "divergences": count(fuzz, "divergences") if fuzz else None,
        "bench": {
            _in_words(name): plain(value)
            for name, value in nested(run, "bench").items()
            if isinstance(value, int | float)
        },
    }


def _view(record: Mapping[str, Any], runs: Sequence[Record], out: Path) -> Json:
    """Return what the template shows.

    ``bench`` has label, value, previous value and change. ``earlier`` are the dates of runs whose
    pages exist: none if each run has a machine of its own.
    """
    before = nested(runs[-2], "bench") if len(runs) > 1 else {}
    return {
        "record": record,
        "has_ended": has_ended,
        "own_folder": _own_folder,
        "headline": shown(headline(record)),
        "failures": [_failure(one) for one in records(record, "failures")[:_MAX_CHANGES]],
        "figures": [*_figures(record)],
        "changes": [(tone(one), shown(one)) for one in texts(record, "changes")[:_MAX_CHANGES]],
        "bench": [
            (
                _in_words(name),
                _figure(value),
                _figure(before.get(name)),
                _change(value, before.get(name)),
            )
            for name, value in nested(record, "bench").items()
            if isinstance(value, int | float)
        ],
        "runs": len(runs),
        "earlier": [
            date
            for run in reversed(runs[:-1])
            if _DATE.fullmatch(date := text(run, "date"))
            and date != text(record, "date")
            and (out / date / "index.html").is_file()
        ][:MOST_EARLIER],
    }


def _figures(record: Mapping[str, Any]) -> Iterator[Figure]:
    """Yield the headline figures; a step that was not performed has none."""
    recover, conform = nested(record, "recover"), nested(record, "conform")
    fuzz, bench = nested(record, "fuzz"), nested(record, "bench")
    if recover:
        files, parsed = count(recover, "files"), count(recover, "parsed")
        yield Figure("files parse", percent(parsed, files), f"{parsed:,} of {files:,}")
    if conform:
        verdicts = nested(conform, "verdicts")
        others = [name for name in verdicts if name != "pass" and count(verdicts, name)]
        note = ", ".join(f"{count(verdicts, name):,} {shown(name, 20)}" for name in others)
        yield Figure("runs of cases pass", f"{count(verdicts, 'pass'):,}", note or "all of them")
        hard, covered = count(conform, "hard"), count(conform, "hard_covered")
        note = f"{covered:,} of {hard:,} that may fail"
        yield Figure("rules covered", percent(covered, hard), note)
    if fuzz:
        note = counted(count(fuzz, "divergences"), "divergence")
        yield Figure("programs fuzzed", f"{count(fuzz, 'programs'):,}", note)
    if number(bench, "conform.share"):
        note = f"{number(bench, 'conform.cases_per_s'):,.0f} cases a second"
        yield Figure("planted faults found", percent(number(bench, "conform.share"), 1), note)


def _failure(record: Record) -> Json:
    return {
        "is_own": text(record, "what").startswith(OF_THE_RUN),
        **shown_texts(record, what=400, command=200),
        "page": _own(text(record, "page")),
        "files": [
            (shown(name, 80), "\n".join(shown(line, 200) for line in content.splitlines()[:200]))
            for name, content in nested(record, "files").items()
            if isinstance(content, str)
        ],
        "cases": [
            (shown(name, 80), _own(str(page)))
            for name, page in [*nested(record, "cases").items()][:_MAX_CHANGES]
        ],
    }


def _own(page: str) -> str:
    """Return a link if it leads to one of our pages, else ""."""
    return page if page.startswith(_PAGES) else ""


def _in_words(name: str) -> str:
    return _IN_WORDS.get(name) or shown(name, 80)


def _figure(value: Any) -> str:
    if not isinstance(value, int | float):
        return ""
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.4g}"


def _change(value: float, before: Any) -> str:
    """Return the change of a figure in per cent; empty without a change or previous value."""
    if not isinstance(before, int | float) or not before or value == before:
        return ""
    return f"{100 * (value - before) / abs(before):+.1f} %"


def _own_folder(page: str) -> str:
    """Return a link if it is a relative one without a scheme, as ours are, else ""."""
    is_ours = page.replace("/", "").replace(".", "").replace("-", "").isalnum()
    return page if is_ours and not page.startswith("/") else ""
