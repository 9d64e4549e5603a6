"""The library for scripts and notebooks."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import krl
from krl.errors import InputError

ROOT = Path(__file__).parents[2]


def test_findings_have_places_and_become_a_table(tmp_path: Path) -> None:
    """A row a finding; without any, the columns are there all the same."""
    bad, good = tmp_path / "bad.src", tmp_path / "good.src"
    bad.write_text("DEF BAD()\nINT n\nn = TRUE + 1\nEND\n", encoding="utf-8")
    good.write_text("DEF GOOD()\nEND\n", encoding="utf-8")
    found = krl.check(bad, jobs=1)
    assert 1 == found.files
    assert [3] == [one.line for one in found.errors]
    assert 3 in found.to_dataframe()["line"].tolist()
    none = krl.check(good, jobs=1).to_dataframe()
    assert (0, True) == (len(none), "code" in none.columns)


def test_a_run_has_its_ending_trace_and_path(tmp_path: Path) -> None:
    """Inputs come from lines of a script; with a robot each cycle is a row of the path."""
    file = tmp_path / "a.src"
    motion = "PTP {A1 10, A2 -90, A3 90, A4 0, A5 30, A6 0}"
    text = f"DEF a()\n{motion}\nWAIT FOR $IN[3]\n$OUT[1] = TRUE\nEND\n"
    file.write_text(text, encoding="utf-8")
    run = krl.run(file, io="t=2 IN[3]=TRUE")
    count = len(run.events)
    brief = f"Run(ending='end', seconds=2.004, at='a.src:4', error='', events=<{count}>, notes=<0>)"
    assert brief == repr(run)
    events = run.to_dataframe()
    assert [2_004_000] == events[events["kind"] == "out"]["t"].tolist()
    assert 10.0 == pytest.approx(run.path_dataframe()["q1"].iloc[-1])
    run.write_page(tmp_path / "run.html")
    assert (tmp_path / "run.html").stat().st_size > 10_000
    still = krl.run(file, robot="none", seconds=1)
    assert "time" == still.ending
    with pytest.raises(InputError, match="robot='kinematic'"):
        still.path_dataframe()


def test_a_run_reports_what_stood_in_and_was_skipped(tmp_path: Path) -> None:
    """Its notes are what `krl run` says behind it."""
    file = tmp_path / "a.src"
    file.write_text("DEF a()\nINT N\nNOWHERE()\nN=N+1\nEND\n", encoding="utf-8")
    run = krl.run(file, robot="none")
    assert ("end", ("skipped: a.src:4: a value is used that was never set",)) == (
        run.ending,
        tuple(note for note in run.notes if note.startswith("skipped: ")),
    )


def test_a_backup_has_routines_and_points(tmp_path: Path) -> None:
    """Points are what has coordinates; each component that is a number is a column."""
    (tmp_path / "a.src").write_text("DEF a()\nEND\nDEF b()\nHALT\nEND\n", encoding="utf-8")
    data = "DEFDAT a\nDECL FRAME P1={X 1,Y -2.5,Z 3,A 0,B 0,C 0}\nDECL INT n=3\nENDDAT\n"
    (tmp_path / "a.dat").write_text(data, encoding="utf-8")
    backup = krl.load_backup(tmp_path)
    assert [("a", 1), ("b", 3)] == [(one.name, one.line) for one in backup.routines]
    table = backup.to_dataframe()
    assert [("P1", -2.5)] == list(zip(table["name"], table["Y"], strict=True))
    assert ["a", "b"] == backup.routines_dataframe()["name"].tolist()


def test_what_cannot_be_done_is_an_error_of_one_sentence(tmp_path: Path) -> None:
    """Each function says what is wrong with what it was given."""
    missing = tmp_path / "missing.src"
    for function in (krl.check, krl.run, krl.recover, krl.load_backup):
        with pytest.raises(InputError, match="missing") as error:
            function(missing)
        assert "\n" not in str(error.value)


def test_a_script_without_a_guard_may_use_processes(tmp_path: Path) -> None:
    """Processes do not run the script again that makes them."""
    (tmp_path / "b").mkdir()
    for name in ("a.src", "b/b.src"):
        (tmp_path / name).write_text("DEF x()\nn = 1\nEND\n", encoding="utf-8")
    script = tmp_path / "script.py"
    script.write_text(
        "import krl\nprint('begun')\nprint(krl.check('.', jobs=2).files)\n", encoding="utf-8"
    )
    environment = {"PYTHONPATH": str(ROOT), "PATH": ""}
    done = subprocess.run(
        [sys.executable, script], cwd=tmp_path, env=environment, capture_output=True, check=False
    )
    assert (b"begun\n2\n", b"") == (done.stdout.replace(b"\r", b""), done.stderr)


def test_the_notebook_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every cell of docs/tour.ipynb, one after the other."""
    monkeypatch.chdir(ROOT)
    notebook = json.loads((ROOT / "docs" / "tour.ipynb").read_text(encoding="utf-8"))
    names: dict[str, object] = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    assert "end" == getattr(names["run"], "ending")  # noqa: B009
