"""`krl conform` from the outside: selections, outputs, exit status."""

import json
import os
import signal
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import interp
from conformance.evaluation.execution import Setup, observe
from conformance.evaluation.observation import Observation
from conformance.sensitivity.mutants import Mutant, of_line
from conformance.suite.case import Case
from krl.cli import main

CASE = """\
;@ rule: {rule}
;@ title: about {name}
;@ phase: run
DEF {name}()
  DECL INT N
  N = 1 ;> value N {value}
END
"""


def write(folder: Path, name: str, value: int, rule: str = "CTL-01") -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"{name}.src"
    path.write_text(CASE.format(name=name, value=value, rule=rule), encoding="utf-8")
    return path


def run(*arguments: object) -> int:
    return main(["conform", *map(str, arguments), "--jobs", "1"])


def test_own_case_passes(capsys: pytest.CaptureFixture[str]) -> None:
    """A case of the project by its name; status 0."""
    assert 0 == run("control/exit_for", "--executor", "tree", "--robot", "none")
    assert "1 case (0 negative), 1 run: 1 pass" in capsys.readouterr().out


def test_failure_is_reported_and_gives_status_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Name, fact, rule, line and what was seen; the record and JUnit hold it too."""
    path = write(tmp_path / "control", "wrong", 2)
    record, junit = tmp_path / "out.json", tmp_path / "out.xml"
    status = run(path, "--executor", "tree", "--robot", "none", "--json", record, "--junit", junit)
    assert 1 == status
    out = capsys.readouterr().out
    assert "wrong: about wrong [CTL-01]" in out
    assert "line 6: value N 2; seen: 1" in out
    assert {"fail": 1} == {
        verdict: count
        for verdict, count in json.loads(record.read_text(encoding="utf-8"))["verdicts"].items()
        if count
    }
    assert "<failure" in junit.read_text(encoding="utf-8")


def test_unconfirmed_case_leaves_status_0(tmp_path: Path) -> None:
    """What rests on recollection fails nobody."""
    path = write(tmp_path / "control", "open", 2, rule="CTL-02")
    assert 0 == run(path, "--executor", "tree", "--robot", "none")


def test_unconfirmed_cases_count_if_told_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With --strict they are shown with what is expected and seen, and the status is 1."""
    case = write(tmp_path, "three", 3, "CTL-02")
    assert 0 == run(case, "--executor", "tree", "--robot", "none")
    assert "seen" not in capsys.readouterr().out
    assert 1 == run(case, "--executor", "tree", "--robot", "none", "--strict")
    assert "tree/none: line 6: value N 3; seen: " in capsys.readouterr().out


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
def test_a_run_that_is_terminated_records_what_it_has(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It names the case that ran, and those that are not done."""
    cases = [write(tmp_path, name, 2) for name in ("one", "two", "three")]

    def see(case: Case, setup: Setup) -> Observation:
        if case.main.startswith("two"):
            os.kill(os.getpid(), signal.SIGTERM)
        return observe(case, setup)

    monkeypatch.setattr("conformance.runner.observe", see)
    file = tmp_path / "record.json"
    options = ("--executor", "tree", "--robot", "none", "--json", file, "--html", tmp_path / "page")
    assert 143 == run(*cases, *options)
    record = json.loads(file.read_text(encoding="utf-8"))
    names = [one["name"] for one in record["cases"]]
    assert 3 == len([*names, *record["not_run"]])
    assert [f"{record['not_run'][0]} on tree/none"] == record["running"]
    page = (tmp_path / "page" / "index.html").read_text(encoding="utf-8")
    assert f"; cut off before {len(record['not_run'])} case" in page
    assert f"not run</summary>{', '.join(record['not_run'])}" in page
    assert 'class="green"' not in page
    assert f"terminated while running {record['running'][0]}" in capsys.readouterr().err


def test_lint_reports_each_fault(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder of anybody can be looked at; status 1 where something is wrong."""
    folder = tmp_path / "cases"
    folder.mkdir()
    write(folder / "control", "fine", 1)
    assert 0 == run("--lint", folder)
    write(folder / "control", "again", 1).write_text("DEF again()\nEND\n", encoding="utf-8")
    assert 1 == run("--lint", folder)
    assert "control/again.src: it belongs to no case" in capsys.readouterr().out


def test_recording_is_made_from_the_list_and_evaluated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """``--list --json`` has the digests that a recording needs; ``import`` evaluates it."""
    listed, recording = tmp_path / "list.json", tmp_path / "recording.json"
    assert 0 == run("data/round_up", "--list", "--json", listed)
    (case,) = json.loads(listed.read_text(encoding="utf-8"))["cases"]
    at = f"{case['files'][0]}:6"
    event = {"t": None, "kind": "assign", "at": at, "name": "N", "value": 8}
    told = {
        "format": "krl-recording/1",
        "controller": {"name": "KR C4", "release": "KSS 8.6"},
        "cases": [
            {
                "case": case["case"],
                "digest": case["digest"],
                "watched": ["assign"],
                "events": [event],
            }
        ],
    }
    recording.write_text(json.dumps(told), encoding="utf-8")
    assert 0 == run("import", recording, "--html", tmp_path)
    assert "recorded on KR C4 KSS 8.6" in capsys.readouterr().out
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "<h1>Recording of KR C4 KSS 8.6: no case failed" in page
    assert "cases not recorded</summary>" in page
    assert "data/round_down, " in page
    assert "every executor" not in page
    event["value"] = 7
    recording.write_text(json.dumps(told), encoding="utf-8")
    assert 1 == run("import", recording)
    assert "data/round_up" in capsys.readouterr().out


def test_a_planted_fault_is_found_and_shown_on_the_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The case that states the rule fails, the page says what was planted; then it is gone."""
    words = ("trigger/two_at_once", "--executor", "tree", "--robot", "none", "--html", tmp_path)
    assert 1 == run(*words, "--fault", "only the last TRIGGER")
    out = capsys.readouterr().out
    assert out.startswith("planted: triggers: only the last trigger counts")
    assert "trigger/two_at_once" in out
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "A fault was planted: triggers: only the last trigger counts" in page
    assert "1 case of 1 failed" in page
    assert "<span>Selection: trigger/two_at_once</span><span>Version " in page
    assert 0 == run(*words)
    assert "A fault was planted" not in (tmp_path / "index.html").read_text(encoding="utf-8")


def _on(source: str) -> list[Mutant]:
    """The mutants of the first line of the machine's arithmetic that begins so."""
    file = Path("interp", "bytecode", "vm", "arithmetic.py")
    text = (Path(interp.__file__).parents[1] / file).read_text(encoding="utf-8").splitlines()
    line = next(number for number, one in enumerate(text, 1) if one.strip().startswith(source))
    return of_line(file.as_posix(), line)


def test_a_change_of_the_machine_shows_beside_the_others(tmp_path: Path) -> None:
    """Only the machine in Python is changed: it diverges from the tree interpreter."""
    both = ("control/recursion", "--executor", "tree", "--executor", "vm", "--robot", "none")
    target = tmp_path / "record.json"
    mutant = next(
        one for one in _on("result = stack[-1] + constant") if one.operator == "arithmetic"
    )
    assert 1 == run(*both, "--json", target, "--fault", mutant.name)
    record = json.loads(target.read_text(encoding="utf-8"))
    assert record["fault"].endswith("stack[-1] + constant becomes stack[-1] - constant")
    (case,) = record["cases"]
    tree, vm = case["results"]
    assert ("pass", "fail") == (tree["verdict"], vm["verdict"])
    assert vm["divergence"]


def test_a_change_has_to_be_unambiguous(capsys: pytest.CaptureFixture[str]) -> None:
    """A line with several changes names them; where there is none, one line says so."""
    several = _on("result = stack[-1] + constant")
    assert len(several) > 1
    words = f"interp/bytecode/vm/arithmetic.py:{several[0].line}"
    assert 2 == run("control/recursion", "--fault", words)
    assert f"{several[1].name}: {several[1].was} becomes" in capsys.readouterr().err
    for words in ("interp/values/values.py:1", "interp.values.values:99999", "interp.nothing:1"):
        assert 2 == run("control/recursion", "--fault", words)
        assert "there is no such mutant" in capsys.readouterr().err


def test_a_fault_has_to_be_unambiguous(capsys: pytest.CaptureFixture[str]) -> None:
    """Words that fit several faults name them; words that fit none say where all are named."""
    assert 2 == run("control/recursion", "--fault", "targets")
    assert (
        "the Status of a target counts nothing; $TOOL counts nothing; components left out are zero"
        in capsys.readouterr().err
    )
    assert 2 == run("control/recursion", "--fault", "nobody knows this")
    assert "krl bench conform" in capsys.readouterr().err


def test_parsers_of_others_stand_beside_ours(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The table and the record have ours and theirs; theirs may fail without a status of 1.

    What only the arm needs need not be installed.
    """
    monkeypatch.setattr(
        "krl.extras.find_spec", lambda name: None if name == "scipy" else find_spec(name)
    )
    record = tmp_path / "out.json"
    words = ["compare", "control/exit_for", "--json", record, "--parser"]
    assert 0 == run(*words, f"no={sys.executable} -c 'raise SystemExit(1)'")
    (case,) = json.loads(record.read_text(encoding="utf-8"))["cases"]
    assert [("krl", "pass"), ("no", "fail")] == [
        (one["executor"], one["verdict"]) for one in case["results"]
    ]
    assert "to be refused" in capsys.readouterr().out
    for wrong in (["compare"], ["control/exit_for", "--parser", "a=b"], ["control/exit_for"]):
        assert 2 == run(*wrong)


def test_pairs_of_features_are_drawn_by_seed(capsys: pytest.CaptureFixture[str]) -> None:
    """Another seed lists other programs; none of them lies in the folder of cases."""
    listed = []
    for seed in (1, 2):
        assert 0 == run("pairs", "--seed", seed, "--list")
        listed.append(capsys.readouterr().out.splitlines())
    assert listed[0] != listed[1]
    assert all(line.startswith("pairs/drawn_") for line in listed[0] + listed[1])
