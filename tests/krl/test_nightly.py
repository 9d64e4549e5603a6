"""`krl nightly` that goes on where it was: what is there is not done again, nor trusted blindly."""

import io
import json
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from krl.cli import main
from krl.nightly import step_runner

DATE = "2026-01-02"
_LACKED = "not run to its end: too little time, cut off after"
_ON = {"executor": "vm", "robot": "none", "reason": "why"}


def run(folder: Path, capsys: pytest.CaptureFixture[str], *steps: str) -> tuple[int, list[str]]:
    """A nightly run of some steps: its status, and what it told on stdout."""
    only = [word for step in steps for word in ("--only", step)]
    given = ["--date", DATE, "--out", str(folder), "--history", str(folder / "h.jsonl")]
    return main(["nightly", *given, *only]), capsys.readouterr().out.splitlines()


def steps_of(folder: Path) -> dict[str, str]:
    record = json.loads((folder / DATE / "nightly.json").read_text(encoding="utf-8"))
    return {name: step["status"] for name, step in record["steps"].items()}


def test_what_is_there_is_not_done_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The record of a step is taken as it is; the run is one line, however often it went on."""
    (tmp_path / DATE).mkdir()
    record = tmp_path / DATE / "fuzz.json"
    record.write_text('{"programs": 7, "seed": 1, "differences": []}', encoding="utf-8")
    before = record.stat().st_mtime_ns
    for _ in range(2):
        assert 0 == run(tmp_path, capsys, "fuzz")[0]
    assert before == record.stat().st_mtime_ns
    assert {"fuzz": "ok"} == steps_of(tmp_path)
    [line] = (tmp_path / "h.jsonl").read_text(encoding="utf-8").splitlines()
    assert 7 == json.loads(line)["fuzz"]["programs"]


@pytest.mark.parametrize("content", [b"", b"[1]", b'{"programs": 1e999}', b"[" * 90_000, b"\xff"])
def test_a_damaged_record_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes
) -> None:
    """A step whose record cannot be read has failed; it is not taken for done."""
    (tmp_path / DATE).mkdir()
    (tmp_path / DATE / "fuzz.json").write_bytes(content)
    assert 1 == run(tmp_path, capsys, "fuzz")[0]
    assert {"fuzz": "failed: fuzz.json there is damaged"} == steps_of(tmp_path)


def test_a_night_that_goes_on_knows_how_its_steps_went(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status and seconds of a step that was done before the nightly run broke off are kept."""
    (tmp_path / DATE).mkdir()
    (tmp_path / DATE / "fuzz.json").write_text('{"differences": []}', encoding="utf-8")
    kept = {"fuzz": {"status": "findings", "seconds": 12.5, "page": ""}}
    (tmp_path / DATE / "steps.json").write_text(json.dumps(kept), encoding="utf-8")
    assert 0 == run(tmp_path, capsys, "fuzz")[0]
    record = json.loads((tmp_path / DATE / "nightly.json").read_text(encoding="utf-8"))
    assert kept == record["steps"]


class Terminal(io.StringIO):
    """A terminal that remembers what it shows."""

    def isatty(self) -> bool:
        """It is one."""
        return True


def test_progress_of_a_step_is_seen_on_a_terminal_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a step shows of its progress passes through; its last line is known without colours."""
    shows = (
        "import sys; from rich.console import Console; Console(stderr=True).print('[red]3 of 9')"
    )
    for stream, is_seen in ((Terminal(), True), (io.StringIO(), False)):
        monkeypatch.setattr(sys, "stderr", stream)
        assert (0, "3 of 9") == step_runner._watched([sys.executable, "-c", shows], 600, 1 << 40)
        assert is_seen == ("\x1b[" in stream.getvalue()) == bool(stream.getvalue())


def test_results_of_the_last_night_are_at_hand(tmp_path: Path) -> None:
    """A step of a new nightly run begins with the results that the one before has kept."""
    old = tmp_path / "2026-01-01" / "recover" / "cache" / "results.sqlite"
    old.parent.mkdir(parents=True)
    old.write_bytes(b"kept")
    step_runner._recall(tmp_path / DATE, "recover")
    assert b"kept" == (tmp_path / DATE / "recover/cache/results.sqlite").read_bytes()
    step_runner._recall(tmp_path / DATE, "growth")
    assert not (tmp_path / DATE / "growth").exists()


def _step(monkeypatch: pytest.MonkeyPatch, *outcomes: tuple[int | None, str]) -> list[list[str]]:
    """Have steps end so, one after the other, the last for ever; their commands."""
    left, asked = list(outcomes), list[list[str]]()

    def watched(command: list[str], _seconds: float, _memory: int) -> tuple[int | None, str]:
        asked.append(command)
        status, last = left.pop(0) if len(left) > 1 else left[0]
        if status in (0, 1):
            record = last if last.startswith("{") else '{"differences": []}'
            Path(command[-1]).write_text(record, encoding="utf-8")
        return status, last

    monkeypatch.setattr(step_runner, "_watched", watched)
    return asked


@pytest.mark.parametrize(
    ("outcomes", "told"),
    [
        ([(0, "")], "ok"),
        ([(2, "no such thing"), (0, "")], "flaky: failed: no such thing; then ok"),
        ([(-9, "krl: running cases: 160 of 275"), (2, "")], "failed: killed by signal 9"),
        ([(2, "no such thing"), (None, "")], "failed: no such thing"),
        ([(None, "far")], "cut off after 18 minutes"),
    ],
)
def test_a_step_that_fails_is_tried_once_more(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    outcomes: list[tuple[int | None, str]],
    told: str,
) -> None:
    """What then succeeds is told as flaky and a failure all the same; time is spent once."""
    asked = _step(monkeypatch, *outcomes)
    assert (told != "ok") == run(tmp_path, capsys, "recover")[0]
    assert {"recover": told} == steps_of(tmp_path)
    assert 1 + ("failed" in told) == len(asked)
    assert "recover/index.html" not in (tmp_path / DATE / "index.html").read_text()


def test_the_summary_mentions_and_links_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a case says is set as code, with how to run it again."""
    result = {"executor": "vm", "robot": "none", "verdict": "fail", "reason": "a `b` | @c"}
    case = {"name": "io/one", "verdict": "fail", "results": [result]}
    _step(monkeypatch, (1, json.dumps({"cases": [case]})))
    assert 1 == run(tmp_path, capsys, "conform")[0]
    summary = (tmp_path / DATE / "summary.md").read_text(encoding="utf-8")
    assert "vm/none: a 'b' ¦ @c`, again with `krl conform io/one --executor vm" in summary


@pytest.mark.parametrize(
    ("then", "told"), [("pass", "is flaky: it failed on vm/none"), ("fail", "failed on vm/none")]
)
def test_a_case_that_fails_is_run_once_more(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    then: str,
    told: str,
) -> None:
    """What passes then is flaky, and a failure all the same; it runs as it did."""
    records = [
        {"cases": [{"name": "io/one", "results": [{**_ON, "verdict": verdict}]}]}
        for verdict in ("fail", then)
    ]
    asked = _step(monkeypatch, (1, json.dumps(records[0])), (1, json.dumps(records[1])))
    status, out = run(tmp_path, capsys, "conform-arm")
    assert (1, f"failed: case io/one {told}: why") == (status, out[0])
    repeated = ["conform", "io/one", "--executor", "native", "--robot", "mujoco", "--json"]
    assert repeated == asked[1][3:-1]
    assert run(tmp_path, capsys, "conform-arm")[0] == 1  # when it goes on, nothing is done again
    assert 2 == len(asked)


def test_what_is_kept_is_bounded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pages of old runs go, broken runs too, records later, results but once; else all stays."""
    runs = [f"2024-{day:04}" for day in range(400)]
    for name in (*runs, "mine"):
        (tmp_path / name).mkdir()
        for file in ("index.html", "summary.md", "nightly.json"):
            (tmp_path / name / file).write_text("{}", encoding="utf-8")
    (tmp_path / "mine" / "nightly.json").unlink()
    broken = tmp_path / runs.pop(100)
    (broken / "nightly.json").rename(broken / "steps.json")
    for name in (DATE, runs[-1]):
        (tmp_path / name / "recover" / "cache").mkdir(parents=True)
    _step(monkeypatch, (0, ""))
    assert 0 == run(tmp_path, capsys, "recover")[0]
    pages = sorted(one.parent.name for one in tmp_path.glob("*/index.html"))
    assert [*runs[-30:], DATE, "mine"] == pages
    assert [*runs[-365:], DATE] == sorted(
        one.parent.name for one in tmp_path.glob("*/nightly.json")
    )
    assert not broken.exists()
    assert [DATE] == [one.parents[1].name for one in tmp_path.glob("*/recover/cache")]


def test_one_page_leads_to_the_last_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It knows when that was made, as no later run may be left to say that none came."""
    _step(monkeypatch, (0, ""))
    run(tmp_path, capsys, "recover")
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert f'href="{DATE}/index.html"' in page
    assert re.search(r'"made": ?"20\d\d-\d\d-\d\dT', page)
    assert "There has been no nightly run for" in page


def test_a_history_that_cannot_be_kept_is_refused_at_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody wants to know that after an hour."""
    (tmp_path / "h.jsonl").mkdir()
    asked = _step(monkeypatch, (0, ""))
    assert (2, []) == run(tmp_path, capsys, "recover")
    (tmp_path / "h.jsonl").rmdir()

    def full(**_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "TemporaryFile", full)
    assert (2, []) == run(tmp_path, capsys, "recover")
    assert not asked


def test_two_runs_do_not_write_into_one_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second one is refused, with the process of the first; that one may end in any way."""
    holds = (
        "import sys; from pathlib import Path; from krl.nightly.run_lock import alone\n"
        f"with alone(Path({str(tmp_path)!r})): print('held', flush=True); input()"
    )
    asked = _step(monkeypatch, (0, ""))
    command = [sys.executable, "-c", holds]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as first:
        assert first.stdout is not None, "it is a pipe"
        assert "held\n" == first.stdout.readline()
        options = ["--out", str(tmp_path), "--history", str(tmp_path / "h.jsonl")]
        assert 2 == main(["nightly", *options, "--only", "recover"])
        told = f"{tmp_path / 'nightly.lock'}: process {first.pid} is a nightly run there"
        assert told in capsys.readouterr().err
        assert not asked
        first.kill()
    assert 0 == run(tmp_path, capsys, "recover")[0]


def test_what_is_no_lock_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file of that name may be somebody's."""
    file = tmp_path / "nightly.lock"
    file.write_bytes(b"mine" * 1000)
    options = ["--out", str(tmp_path), "--history", str(tmp_path / "h.jsonl")]
    assert 2 == main(["nightly", *options, "--only", "fuzz"])
    assert f"krl: {file}: file is not a database\n" == capsys.readouterr().err


def test_a_step_without_time_is_not_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is told with what it took before, is no failure, and the run is not good."""
    steps = {"growth": {"status": "ok", "seconds": 600.0}}
    (tmp_path / "h.jsonl").write_text(json.dumps({"date": "1", "steps": steps}), encoding="utf-8")
    asked = _step(monkeypatch, (0, ""))
    late = iter([0.0, *[3500.0] * 100])
    monkeypatch.setattr(time, "monotonic", lambda: next(late))
    status, out = run(tmp_path, capsys, "recover", "growth", "bench-vm")
    assert (1, []) == (status, [line for line in out if line.startswith("failed")])
    assert {
        "recover": "not run: no time left",
        "growth": "not run: no time left; it took 10.0 minutes on 1",
        "bench-vm": "ok",
    } == steps_of(tmp_path)
    assert 1 == len(asked)
    summary = (tmp_path / DATE / "summary.md").read_text(encoding="utf-8")
    told = "incomplete: 2 steps not run: recover, growth"
    assert (told, True) == (out[0], told in summary)


@pytest.mark.parametrize(
    ("begun", "took", "told"),
    [
        (3300.0, 0.0, f"{_LACKED} 5 minutes"),
        (0.0, 600.0, f"{_LACKED} 9 minutes; it took 10.0 minutes on 1"),
        (0.0, 60.0, "cut off after 9 minutes"),
    ],
)
def test_a_step_that_lacked_time_did_not_fail(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    begun: float,
    took: float,
    told: str,
) -> None:
    """It was cut off before its share was over, or before it ended the last time."""
    steps = {"growth": {"status": "ok", "seconds": took}}
    (tmp_path / "h.jsonl").write_text(json.dumps({"date": "1", "steps": steps}), encoding="utf-8")
    _step(monkeypatch, (None, ""))
    late = iter([0.0, *[begun] * 100])
    monkeypatch.setattr(time, "monotonic", lambda: next(late))
    status, out = run(tmp_path, capsys, "growth")
    assert {"growth": told} == steps_of(tmp_path)
    assert (1, told.startswith("cut off")) == (status, out[0].startswith("failed: step growth"))


def test_what_was_cut_off_is_told_and_done_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The cases that were done are kept, those that ran are named; the rest is run again."""
    case = {"name": "io/one", "verdict": "fail", "results": [{**_ON, "verdict": "fail"}]}
    part = {"cases_total": 1, "cases": [case]}
    part |= {"not_run": ["io/two", "io/x"], "running": ["io/two on vm/none"]}
    asked = list[list[str]]()

    def watched(command: list[str], _seconds: float, _memory: int) -> tuple[int | None, str]:
        asked.append(command)
        Path(command[-1]).write_text(json.dumps(part), encoding="utf-8")
        return None, ""

    monkeypatch.setattr(step_runner, "_watched", watched)
    for _ in range(2):
        status, out = run(tmp_path, capsys, "conform")
        told = "while io/two on vm/none ran; 2 of 3 cases are not done"
        assert (1, f"failed: step conform: cut off after 15 minutes, {told}") == (status, out[0])
        assert "failed: case io/one failed on vm/none: why" in out
    assert 2 == len([one for one in asked if "--html" in one])


def test_a_run_that_broke_off_is_the_first_failure_of_the_next(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody looks at a page that was never written."""
    (tmp_path / "2026-01-01").mkdir()
    _step(monkeypatch, (0, ""))
    status, out = run(tmp_path, capsys, "recover")
    assert (1, "failed: the nightly run of 2026-01-01 did not finish") == (status, out[0])
    page = (tmp_path / DATE / "index.html").read_text(encoding="utf-8")
    assert '<li class="bad own">the nightly run of 2026-01-01 did not finish' in page


def test_a_run_that_cannot_tell_its_results_is_red(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Page, summary and record say so, and so does the exit status."""

    def broken(*_: object) -> None:
        raise OSError(28, "No space left on device")

    _step(monkeypatch, (0, ""))
    monkeypatch.setattr("krl.nightly.report.write_claims_page", broken)
    assert 0 != run(tmp_path, capsys, "recover")[0]
    for name in ("index.html", "summary.md", "nightly.json"):
        text = (tmp_path / DATE / name).read_text(encoding="utf-8")
        assert "the nightly run failed: OSError: [Errno 28] No space left on device" in text
