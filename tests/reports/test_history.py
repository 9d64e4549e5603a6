"""The history of nightly runs, and what changed from one to the next."""

import json
from pathlib import Path
from typing import Any

import pytest

from reports.nightly.history import (
    append_run,
    changes,
    damage,
    known_before,
    last_times,
    nightly_record,
    read_history,
)
from reports.nightly.nightly_failures import failures
from reports.nightly.nightly_page import write_nightly_page


def _case(name: str, verdict: str, time: int = 1_000) -> dict[str, Any]:
    event = {"t": time, "kind": "out", "signal": "$OUT", "number": 2}
    return {"name": name, "verdict": verdict, "results": [{"events": [event]}]}


def _conform(*cases: dict[str, Any]) -> dict[str, Any]:
    return {"verdicts": {"pass": len(cases)}, "cases": list(cases)}


def _run(date: str, conform: dict[str, Any], **bench: float) -> dict[str, Any]:
    made = {"conform": conform, "bench-vm": bench, "recover": {"files": 3, "parsed": 3}}
    return nightly_record(date, made, {"conform": {"status": "ok", "seconds": 1.0}})


def test_failures_fixes_and_vanished_cases_are_reported() -> None:
    """Only what changed is told, a sentence each."""
    old = _conform(_case("a/x", "pass"), _case("a/y", "fail"), _case("a/z", "pass"))
    new = _conform(_case("a/x", "fail"), _case("a/y", "pass"), _case("a/w", "pass"))
    told = changes(_run("1", old), _run("2", new), old, new)
    assert [
        "case vanished: a/z",
        "new failure: a/x: pass → fail",
        "case appeared: a/w (pass)",
        "fixed: a/y: fail → pass",
    ] == told


def test_a_suite_that_vanished_is_one_sentence() -> None:
    """It comes before what is better; of other suites the cases are named."""
    names = ["io/a", "io/b", *(f"data/{n}" for n in range(6))]
    old = _conform(*(_case(name, "fail") for name in names))
    new = _conform(_case("data/0", "pass"))
    assert [
        "cases vanished: data/1, data/2, data/3 and 2 more cases of data",
        "suite vanished: io, 2 cases",
        "fixed: data/0: fail → pass",
    ] == changes(_run("1", old), _run("2", new))


def test_a_case_that_was_cut_off_has_not_vanished() -> None:
    """What it did before is what the next nightly run is compared with."""
    whole = _run("1", _conform(_case("a/x", "pass"), _case("a/y", "pass")))
    part = _run("2", {**_conform(_case("a/x", "pass")), "not_run": ["a/y"]})
    assert [] == changes(whole, part)
    known = known_before([whole, part])
    assert ["new failure: a/y: pass → fail"] == changes(
        known, _run("3", _conform(_case("a/x", "pass"), _case("a/y", "fail")))
    )


def test_the_same_night_again_changes_nothing() -> None:
    """Two equal nightly runs differ in nothing."""
    conform = _conform(_case("a/x", "pass"))
    assert [] == changes(_run("1", conform, ratio=2.0), _run("2", conform, ratio=2.0))


def test_shifted_times_are_reported_with_both_times() -> None:
    """An output that comes a cycle later is named."""
    old, new = _conform(_case("a/x", "pass", 12_000)), _conform(_case("a/x", "pass", 24_000))
    (told,) = changes(_run("1", old), _run("2", new), old, new)
    assert told.startswith("timing shifted: a/x: out $OUT at 0.012000 s")
    assert told.endswith("at 0.024000 s")


def test_a_slower_bench_is_reported_by_its_ratio() -> None:
    """Noise below a quarter is not told; a cost counts the other way round."""
    conform = _conform()
    before = _run("1", conform, native_vs_tree=300.0, crossing_us=2.0, vm_vs_tree=6.0)
    after = _run("2", conform, native_vs_tree=200.0, crossing_us=3.0, vm_vs_tree=5.5)
    assert [
        "worse: vm.native_vs_tree 300 → 200 (1.50 times worse)",
        "worse: vm.crossing_us 2 → 3 (1.50 times worse)",
    ] == changes(before, after)


def test_changes_for_the_worse_are_marked_on_the_page(tmp_path: Path) -> None:
    """A figure that is worse, and a case that failed for the first time."""
    before = _run("1", _conform(_case("a/x", "pass")), native_vs_tree=300.0)
    after = _run("2", _conform(_case("a/x", "fail")), native_vs_tree=100.0)
    page = write_nightly_page({**after, "changes": changes(before, after)}, tmp_path)
    assert page.read_text(encoding="utf-8").count('<li class="bad">') == 2


def test_what_a_night_did_not_do_has_not_changed() -> None:
    """A step without a record tells nothing: no case vanished, no file is gone."""
    whole = _run("1", _conform(_case("a/x", "pass")), ratio=2.0)
    part = nightly_record("2", {"fuzz": {"programs": 5, "differences": []}}, {})
    assert [] == changes(whole, part)
    assert "conform" not in part


def test_a_night_of_some_steps_hides_none_before_it() -> None:
    """The next nightly run is compared with the last one that knows of each part."""
    whole = _run("1", _conform(_case("a/x", "pass")), ratio=2.0)
    part = nightly_record("2", {"fuzz": {"programs": 5, "differences": []}}, {})
    known = known_before([whole, part])
    assert known is not None
    assert ("1", "2") == (known["of"]["conform"], known["of"]["fuzz"])
    told = changes(known, _run("3", _conform(_case("a/x", "fail")), ratio=1.0))
    assert [
        "new failure: a/x: pass → fail",
        "worse: vm.ratio 2 → 1 (2.00 times worse)",
    ] == told


def test_a_first_run_has_changed_nothing() -> None:
    """What failed in a first nightly run is listed as failed, and not once more as changed."""
    case = {"name": "a/x", "verdict": "fail", "results": [{"verdict": "fail"}]}
    made = {"conform": _conform(case), "fuzz": {"differences": [{}]}}
    steps = {"recover": {"status": "cut off after 9 minutes", "seconds": 540.0}}
    assert ["this is the first run"] == changes(None, nightly_record("1", made, steps))
    assert 3 == len(failures(made, steps))


def test_damaged_lines_hide_no_night(tmp_path: Path) -> None:
    """A line cut off is passed over, kept, and a repeated nightly run replaces its line."""
    file = tmp_path / "history.jsonl"
    append_run(file, {"date": "1"})
    file.write_text(file.read_text(encoding="utf-8") + '{"date": "2", "con', encoding="utf-8")
    append_run(file, {"date": "3", "try": 1})
    append_run(file, {"date": "3", "try": 2})
    assert [{"date": "1"}, {"date": "3", "try": 2}] == read_history(file)
    assert '{"date": "2", "con' in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "line",
    [
        "\ufffdPK\x03",
        '{"date": 7, "conform": {}}',
        '{"date": "2", "conform": []}',
        '{"date": "2", "co',
    ],
)
def test_damaged_lines_are_told(tmp_path: Path, line: str) -> None:
    """With file and line, and which run is compared instead, if any is left."""
    file = tmp_path / "history.jsonl"
    file.write_text(f'{{"date": "1"}}\n\n{line}\n', encoding="utf-8")
    told = f"history {file}: line 3 is damaged and was skipped; compared with the run of 1"
    assert [told] == damage(file, known_before(read_history(file)))
    file.write_text(f"{line}\n" * 5, encoding="utf-8")
    told = (
        "lines 1, 2, 3 and 2 more are damaged and were skipped; no earlier run is left to compare"
    )
    assert [f"history {file}: {told} with"] == damage(file, known_before(read_history(file)))


def test_no_character_of_a_title_ends_a_line(tmp_path: Path) -> None:
    """Only line feeds do."""
    file = tmp_path / "history.jsonl"
    run = {"date": "1", "recover": {"clusters": {"1": "a\u2028b\x85c"}}}
    append_run(file, run)
    assert ([run], []) == (read_history(file), damage(file, None))


def test_the_time_of_a_step_is_that_of_its_last_end() -> None:
    """A step that was cut off, or done already, says nothing about it."""
    steps = [("ok", 5.0), ("findings", 7.0), ("ok", 0.0), ("cut off after 1 minutes", 60.0)]
    runs = [
        {"date": str(n), "steps": {"fuzz": {"status": status, "seconds": seconds}}}
        for n, (status, seconds) in enumerate(steps)
    ]
    assert {"fuzz": (7.0, "1")} == last_times(runs)


def test_a_night_with_numbers_that_are_none_is_damaged(tmp_path: Path) -> None:
    """No record may hold them, so nothing that is made of such a nightly run could be written."""
    file = tmp_path / "history.jsonl"
    file.write_text('{"date": "1", "x": 1e999}\n{"date": "2", "x": NaN}\n', encoding="utf-8")
    append_run(file, {"date": "3"})
    assert [{"date": "3"}] == read_history(file)


def test_figures_beyond_measure_and_events_of_no_kind_count_nothing(tmp_path: Path) -> None:
    """A damaged record still gives a nightly run, what changed, and a page."""
    events = [{"kind": [], "t": 5}, {"kind": "out", "t": 10**400}]
    case = {"name": "a/b", "verdict": "pass", "results": [{"events": events}]}
    made: dict[str, Any] = {
        "recover": {"files": 1e308, "parsed": 10**400},
        "conform": {"cases": [case], "seconds": 10**400},
        "bench-vm": {"ratio": 10**400},
    }
    run = nightly_record("1", made, {})
    assert 0 == run["recover"]["files"] == run["recover"]["parsed"] == run["bench"]["vm.ratio"]
    worse = {**run, "bench": {"vm.ratio": 10**400}}
    assert [] == changes(worse, run, made["conform"], made["conform"])
    write_nightly_page({**run, "changes": [], "history": [run]}, tmp_path)


def test_the_page_of_a_night_shows_what_changed(tmp_path: Path) -> None:
    """Changes stand on the page, foreign text made harmless."""
    run = _run("2031-05-06", _conform(_case("a/x", "pass")))
    told = ["new failure: a/<script>alert(1)</script>: pass → fail"]
    page = write_nightly_page({**run, "changes": told, "history": [run]}, tmp_path)
    text = page.read_text(encoding="utf-8")
    assert "new failure: a/&lt;script&gt;" in text
    assert "<script>alert(1)" not in text


def test_a_year_is_kept_and_stays_small(tmp_path: Path) -> None:
    """Of older runs the figures are kept, and single cases of the last few that ran any."""
    file = tmp_path / "history.jsonl"
    old = [{"date": f"{n:04}", "conform": {"hard": 1, "cases": {"a": "pass"}}} for n in range(400)]
    some = [{"date": f"{n:04}", "fuzz": {"divergences": 0}} for n in range(400, 420)]
    file.write_text("".join(f"{json.dumps(run)}\n" for run in [*old, *some]), encoding="utf-8")
    append_run(file, {"date": "0420"})
    runs = read_history(file)
    assert ["0055", "0420"] == [runs[0]["date"], runs[-1]["date"]]
    full = [run["date"] for run in runs if "cases" in run.get("conform", {})]
    assert [f"{n:04}" for n in range(394, 400)] == full
    known = known_before(runs)
    assert known is not None
    assert {"hard": 1, "cases": {"a": "pass"}} == known["conform"]


def test_only_earlier_runs_with_a_page_are_linked(tmp_path: Path) -> None:
    """A run of another machine is in the history and on the curves, and no link leads nowhere."""
    runs = [{"date": f"2026-01-0{day}"} for day in (1, 2, 3)]
    there = tmp_path / "2026-01-02" / "index.html"
    there.parent.mkdir()
    there.touch()
    page = write_nightly_page({**runs[-1], "history": runs}, tmp_path / "2026-01-03")
    text = page.read_text(encoding="utf-8")
    linked = [run["date"] for run in runs if f'href="../{run["date"]}/index.html"' in text]
    assert (["2026-01-02"], True) == (linked, "2026-01-01" in text)
