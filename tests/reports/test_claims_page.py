"""The page of the paper's claims: what was measured, and what to measure where nothing was."""

from pathlib import Path
from typing import Any

from reports.conformance.claims_page import write_claims_page
from reports.conformance.claims_view import claims_view

RECORDS: dict[str, dict[str, Any]] = {
    "growth": {
        "files": 200,
        "bytes": 2_000_000,
        "steps": [{"parsed": 20}, {"parsed": 110}, {"parsed": 200}],
    },
    "recover": {
        "failures": 40,
        "clusters": [
            {"title": "FOR with <STEP>", "failures": 30, "files": 12, "unlocks": 4},
            {"title": "SWITCH", "failures": 10, "files": 3, "unlocks": 3},
        ],
    },
    "bench-vm": {
        "vm_vs_tree": 6.5,
        "native_vs_tree": 250.0,
        "kernels": [
            {"name": "fib", "ns": {"tree": 9000.0, "vm": 1000.0, "native": 20.0}},
            {"name": "sort", "ns": {"tree": 4000.0, "vm": 1000.0, "native": 40.0}},
        ],
    },
    "bench-arm": {
        "motions": 200,
        "thinking_us": 12_000,
        "simulated_s_lookahead": 57.0,
        "simulated_s_batch": 58.5,
    },
    "bench-conform": {
        "mutants": 100,
        "killed": 97,
        "failing": 90,
        "aim": 0.95,
        "cases": 870,
        "cases_per_s": 149.04,
        "executor": "tree",
        "groups": [{"group": "blends", "mutants": 100, "killed": 97, "failing": 90}],
    },
    "conform": {
        "cases": [
            {
                "name": "submit/runs_beside",
                "title": "It runs beside",
                "results": [{"executor": "tree", "robot": "none", "verdict": "pass"}],
            },
            {
                "name": "motion/lin_is_straight",
                "results": [
                    {"executor": "tree", "robot": "none", "verdict": "fail"},
                    {"executor": "native", "robot": "kinematic", "verdict": "pass"},
                ],
            },
        ]
    },
}


def test_each_claim_has_its_figure() -> None:
    """The figures of the records stand beside what the paper says."""
    view = claims_view(RECORDS)
    claims = {one.anchor: one for one in view["claims"]}
    assert "100 % after 2 constructs" in claims["growth"].found
    assert "6.5 ×" in claims["bytecode"].found
    assert claims["bytecode"].is_kept is True
    assert "+1.50 s" in claims["batches"].found
    assert ["FOR with <STEP>", "SWITCH"] == [bar.label for bar in claims["clusters"].bars]
    assert [1.0, 1 / 3] == [bar.share for bar in claims["clusters"].bars]
    assert ["450 ×", "100 ×"] == [bar.values[-1] for bar in claims["c"].bars]
    assert [""] * 6 == [one.command for one in view["claims"]]


def test_causes_are_those_of_the_start() -> None:
    """Where nothing is left under the grammar in force, the start shows what failures came to."""
    start = {"clusters": [{"title": "FOR", "failures": 6, "files": 2, "unlocks": 1}]}
    record = {"failures": [], "clusters": [], "start": start}
    claim = claims_view({"recover": record})["claims"][1]
    assert claim.found.startswith("Under the restrictive start 6 failures have 1 cause")
    assert ["FOR"] == [bar.label for bar in claim.bars]


def test_sensitivity_of_the_cases_stands_with_their_speed() -> None:
    """Faults found, those that fail a case, and cases a second."""
    claim = claims_view(RECORDS)["claims"][5]
    assert "97 of them, 97.0 %; 90 of these fail a case" in claim.found
    assert "870 cases run at 149 a second" in claim.found
    assert ("100", "97", "90", "97.0 %") == claim.bars[0].values


def test_up_to_300_times_is_about_the_best_kernel() -> None:
    """The paper says "up to": a mean below it does not miss it where the best kernel is above."""
    assert claims_view(RECORDS)["claims"][3].is_kept is True
    slow = {**RECORDS["bench-vm"], "kernels": [{"name": "a", "ns": {"tree": 200.0, "native": 1.0}}]}
    assert claims_view({"bench-vm": slow})["claims"][3].is_kept is False


def test_what_was_left_out_has_the_verdict_of_its_executor() -> None:
    """A case about C counts on the machine in C, whatever others say."""
    told = {one["case"]: one["verdict"] for one in claims_view(RECORDS)["left_out"]}
    assert "pass on tree/none" == told["submit/runs_beside"]
    assert "pass on native/kinematic" == told["motion/lin_is_straight"]
    assert "not run" == told["motion/tracking_lin"]


def test_the_simulated_arm_has_a_record_of_its_own() -> None:
    """A nightly run runs it apart from the other robots, and its verdict is shown."""
    result = {"executor": "native", "robot": "mujoco", "verdict": "pass"}
    arm = {"cases": [{"name": "motion/tracking_lin", "title": "It tracks", "results": [result]}]}
    told = {
        one["case"]: one["verdict"]
        for one in claims_view({**RECORDS, "conform-arm": arm})["left_out"]
    }
    assert "pass on native/mujoco" == told["motion/tracking_lin"]
    assert "pass on native/kinematic" == told["motion/lin_is_straight"]


def test_the_cases_that_are_named_exist() -> None:
    """Each case that the page names is one of the judge's."""
    cases = Path(__file__).parents[2] / "conformance" / "cases"
    named = [one["case"] for one in claims_view({})["left_out"]]
    assert [] == [name for name in named if not (cases / f"{name}.src").is_file()]


def test_without_records_the_page_says_what_to_run(tmp_path: Path) -> None:
    """A claim that was not measured names the command that does."""
    page = write_claims_page({}, tmp_path / "claims").read_text(encoding="utf-8")
    commands = ("growth", "recover", "bench vm", "bench arm", "bench conform", "conform")
    assert [] == [one for one in commands if f"<code>krl {one} --" not in page]
    assert (
        page.count("Not measured yet") == page.count(' <span class="dim">not measured</span>') > 0
    )


def test_foreign_text_is_escaped(tmp_path: Path) -> None:
    """A title from a corpus cannot become markup; odd records do no harm."""
    page = write_claims_page(RECORDS, tmp_path).read_text(encoding="utf-8")
    assert "FOR with &lt;STEP&gt;" in page
    odd = {"growth": {"files": "x", "steps": [1, {}]}, "bench-vm": [], "conform": {"cases": [3]}}
    assert write_claims_page(odd, tmp_path).is_file()  # type: ignore[arg-type]
