"""What makes a nightly run red, where it is shown, and how it is repeated."""

from pathlib import Path
from typing import Any

import pytest

from reports.nightly.history import changes, nightly_record
from reports.nightly.nightly_failures import failures, headline
from reports.nightly.nightly_page import write_nightly_page
from reports.nightly.nightly_summary import nightly_summary


def _conform(verdict: str, reason: str = "line 7: out 1 TRUE; seen: nothing") -> dict[str, Any]:
    result = {"executor": "vm", "robot": "mujoco", "verdict": verdict, "reason": reason}
    return {"cases": [{"name": "io/pulse", "verdict": verdict, "results": [result]}]}


_LAW = {
    "name": "renaming",
    "broken": [{"program": "data/x", "difference": "event 3"}, {"program": "data/y"}],
}


_DIVERGENCE = {
    "program": 7,
    "executor": "vm",
    "actual": "Write 2",
    "expected": "Write 1",
    "files": {"PROG.SRC": "DEF PROG()\nEND\n"},
}


@pytest.mark.parametrize(
    ("step", "record", "what", "page", "command"),
    [
        (
            "conform",
            _conform("fail"),
            "case io/pulse failed on vm/mujoco: line 7: out 1 TRUE; seen: nothing",
            "conform/index.html#case=io%2Fpulse",
            "krl conform io/pulse --executor vm --robot mujoco",
        ),
        (
            "conform-arm",
            _conform("fail"),
            "case io/pulse failed on vm/mujoco: line 7: out 1 TRUE; seen: nothing",
            "conform-arm/index.html#case=io%2Fpulse",
            "krl conform io/pulse --executor vm --robot mujoco",
        ),
        (
            "conform-laws",
            {"metamorphic": {"programs": 10, "laws": [_LAW]}},
            "law 'renaming' broken by data/x: event 3",
            "",
            "krl conform --metamorphic 10",
        ),
        (
            "fuzz",
            {"programs": 9, "seed": 4, "differences": [_DIVERGENCE]},
            "program 7 of the fuzzer diverges on vm: Write 2, where Write 1 is expected",
            "",
            "krl fuzz --programs 9 --seed 4",
        ),
        (
            "bench-conform",
            {"survivors": [{"group": "targets", "fault": "$TOOL counts nothing", "runs": 0}]},
            "no case notices the planted fault: targets: $TOOL counts nothing",
            "",
            "krl conform --fault '$TOOL counts nothing'",
        ),
    ],
)
def test_each_step_can_fail(
    step: str, record: dict[str, Any], what: str, page: str, command: str
) -> None:
    """A failure says what it is, where it is shown, and which command repeats it."""
    found = failures({step: record}, {step: {"status": "findings"}})
    assert [(what, page, command)] == [(one["what"], one["page"], one["command"]) for one in found]


def test_a_divergence_has_its_program() -> None:
    """The first ones, each with its files; the others are counted."""
    *some, last = failures({"fuzz": {"differences": [_DIVERGENCE] * 7}}, {})
    assert ([_DIVERGENCE["files"]] * 5, "2 more divergences of the fuzzer") == (
        [one.get("files") for one in some],
        last["what"],
    )


@pytest.mark.parametrize("verdict", ["pass", "unconfirmed", "known-failure", "skipped"])
def test_what_is_expected_is_no_failure(verdict: str) -> None:
    """Neither are findings of a survey, or a case of an unsure rule that was not met before."""
    made = {"conform": _conform(verdict), "recover": {"clusters": [{}]}}
    before = {"conform": {"cases": {"io/pulse": "unconfirmed 0"}}}
    assert [] == failures(made, {"recover": {"status": "findings"}}, before)


@pytest.mark.parametrize("step", ["conform", "conform-arm"])
def test_a_case_that_no_longer_passes_is_a_failure(step: str) -> None:
    """Even if its rule is not sure enough to fail it by itself; the history has what passed."""
    before = nightly_record("2026-01-01", {step: _conform("pass")}, {})
    (found,) = failures({step: _conform("unconfirmed")}, {}, before)
    reason = "line 7: out 1 TRUE; seen: nothing"
    assert f"case io/pulse passed before, now unconfirmed on vm/mujoco: {reason}" == found["what"]
    assert "krl conform io/pulse --executor vm --robot mujoco --strict" == found["command"]
    assert f"{step}/index.html#case=io%2Fpulse" == found["page"]
    after = nightly_record("2026-01-02", {step: _conform("unconfirmed")}, {})
    where = "on MuJoCo: " if step == "conform-arm" else ""
    assert f"{where}no longer passes: io/pulse: pass → unconfirmed" in changes(before, after)


@pytest.mark.parametrize("step", ["conform", "conform-arm"])
def test_cases_that_vanished_are_a_failure_once(step: str, tmp_path: Path) -> None:
    """The first one, with how many there were; the run after that is compared with this one."""
    names = ["io/a", "io/b", "io/pulse"]
    cases = [{"name": name, "verdict": "pass", "results": []} for name in names]
    before = nightly_record("2026-01-01", {step: {"cases": cases}}, {})
    made: dict[str, dict[str, Any]] = {step: {"cases": []}}
    (found,) = failures(made, {}, before)
    where = "on MuJoCo: " if step == "conform-arm" else ""
    assert (f"{where}suite vanished: io, 3 cases", names) == (found["what"], [*found["cases"]])
    told = f"3 failures of 1 kind: {where}suite vanished: io, 3 cases"
    assert told == headline({"failures": [found]})
    for text in (
        write_nightly_page({"failures": [found]}, tmp_path).read_text("utf-8"),
        nightly_summary({"failures": [found]}),
    ):
        assert told in text
    assert [] == failures(made, {}, nightly_record("2026-01-02", made, {}))


def test_cases_that_fail_alike_are_one_failure(tmp_path: Path) -> None:
    """All of them are on the page with their links; the headline counts each."""
    cases = [*_conform("fail", "crash: SyntaxError")["cases"], *_conform("fail", "else")["cases"]]
    cases += [{**cases[0], "name": "io/again"}]
    alike, other = failures({"conform": {"cases": cases}}, {})
    assert "2 cases failed on vm/mujoco: crash: SyntaxError" == alike["what"]
    assert "case io/pulse failed on vm/mujoco: else" == other["what"]
    assert headline({"failures": [alike, other]}).startswith("3 failures of 2 kinds, first: 2 ")
    text = write_nightly_page({"failures": [alike, other]}, tmp_path).read_text("utf-8")
    assert '<a href="conform/index.html#case=io%2Fagain">io/again</a>' in text


def test_a_run_without_enough_time_is_incomplete(tmp_path: Path) -> None:
    """That is no failure, and not good either."""
    run = {"steps": {"fuzz": {"status": "not run: no time left"}, "check": {"status": "ok"}}}
    assert [] == failures({}, run["steps"])
    for text in (
        write_nightly_page(run, tmp_path).read_text("utf-8"),
        nightly_summary(run),
        headline(run),
    ):
        assert "incomplete: 1 step not run: fuzz" in text


def test_the_tile_of_runs_counts_every_verdict(tmp_path: Path) -> None:
    """What is unconfirmed is neither hidden nor a failure."""
    verdicts = {"pass": 7, "fail": 0, "unconfirmed": 2, "known-failure": 0, "skipped": 3}
    text = write_nightly_page({"conform": {"verdicts": verdicts}}, tmp_path).read_text("utf-8")
    assert "2 unconfirmed, 3 skipped" in text


def test_a_step_that_did_not_end_is_a_failure() -> None:
    """A step that was cut off or broke says so."""
    (found,) = failures({}, {"fuzz": {"status": "cut off after 3 minutes"}})
    assert "step fuzz: cut off after 3 minutes" == found["what"]


def test_the_page_leads_to_failed_cases(tmp_path: Path) -> None:
    """Each failure stands on the page with its link and command; foreign links do not."""
    found = failures({"conform": _conform("fail", "<b>")}, {})
    foreign = {"what": "x", "page": "javascript:alert(1)", "command": ""}
    text = write_nightly_page({"failures": [*found, foreign]}, tmp_path).read_text("utf-8")
    assert '<a href="conform/index.html#case=io%2Fpulse">case io/pulse failed' in text
    assert "<code>krl conform io/pulse --executor vm --robot mujoco</code>" in text
    assert "javascript:alert" not in text
    assert "&lt;b&gt;" in text


@pytest.mark.parametrize(
    ("figure", "was", "became", "is_failure"),
    [
        ("rule_top1", 0.8, 0.71, False),
        ("rule_top1", 0.8, 0.7, True),
        ("rule_top1", 0.7, 0.8, False),
        ("share", 1.0, 0.9, True),
        ("native_vs_tree", 300.0, 151.0, False),
        ("native_vs_tree", 300.0, 150.0, True),
        ("native_vs_tree", 300.0, 0.0, True),
        ("native_vs_tree", 0.0, 0.0, False),
        ("check_exponent", 1.0, 2.0, True),
        ("check_exponent", 2.0, 1.0, False),
        ("s_per_mb", 1.0, 9.0, False),
    ],
)
def test_a_figure_far_worse_than_before_is_a_failure(
    figure: str, was: float, became: float, is_failure: bool
) -> None:
    """A share that is lower by a tenth of all, or a ratio twice as bad; times are noisy."""
    before = nightly_record("2026-01-01", {"bench-vm": {figure: was}}, {})
    found = failures({"bench-vm": {figure: became}}, {}, before)
    assert [one["command"] for one in found] == ["krl nightly --only bench-vm"] * is_failure
