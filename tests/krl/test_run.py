"""`krl run` from the outside: what it prints and writes, exit status, one line for bad input."""

import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest

from interp import session
from interp.executors import available
from interp.program.load import Limits
from interp.robot.models import model_file
from interp.session import RunResult, RunSetup, run_program
from krl.cli import main

INI = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}\n"
"""The default arm with its hand down: the flange at X 445, Y 0, Z 810."""

Said = tuple[int, str, str]
Run = Callable[..., Said]


@pytest.fixture
def run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run `krl run` on a program of some lines, or on what the options name."""

    def run(body: str | None, *options: str, script: str | None = None, data: str = "") -> Said:
        arguments = ["run"]
        if body is not None:
            file = tmp_path / "main.src"
            file.write_text(f"DEF main ( )\n{body}END\n", encoding="utf-8")
            arguments.append(str(file))
        if data:
            (tmp_path / "main.dat").write_text(f"DEFDAT main\n{data}\nENDDAT\n", encoding="utf-8")
        if script is not None:
            (tmp_path / "script.io").write_text(script, encoding="utf-8")
            arguments += ["--io", str(tmp_path / "script.io")]
        status = main([*arguments, *options])
        said = capsys.readouterr()
        return status, said.out, said.err

    return run


def events(file: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]


# -- how a run ends --------------------------------------------------------------------------------


def test_a_program_that_ends(run: Run) -> None:
    """A program that runs to its end has status 0 and one line, with the time that it took."""
    assert (0, "main.src: end after 0.204 s at main.src:2\n", "") == run("WAIT SEC 0.2\n")


def test_without_the_packages_of_the_arm(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what needs an arm asks for its packages, and before it runs."""
    absent = ("numpy", "scipy")
    monkeypatch.setattr(
        "krl.extras.find_spec", lambda name: None if name in absent else find_spec(name)
    )
    assert 0 == run("WAIT SEC 0.2\n")[0]
    for options in (["--robot", "kinematic"], ["--html", "page.html"]):
        status, out, err = run("WAIT SEC 0.2\n", *options)
        assert (2, "") == (status, out)
        assert "which is not installed: " in err


def test_a_program_that_halts(run: Run) -> None:
    """HALT is an end like any other: status 0."""
    assert (0, "main.src: halt after 0 s at main.src:2\n", "") == run("HALT\n")


def test_a_fault(run: Run) -> None:
    """A fault in the program has status 1, its place, its words and the number of its message."""
    status, out, err = run("INT I[3]\nI[4]=1\n")
    text = "an array index lies outside the array (message 1444)"
    assert (1, f"main.src: fault after 0 s at main.src:3: {text}\n", "") == (status, out, err)


def test_time_that_is_over(run: Run) -> None:
    """Where the time is over before the program is, the status is 1 and the line tells where."""
    status, out, _ = run("WAIT FOR $IN[1]\n", "--max-time", "0.5")
    assert (1, "main.src: time limit after 0.5 s at main.src:2\n") == (status, out)


@pytest.mark.parametrize(("executor", "most"), [("tree", 70), ("vm", 90)])
def test_limit_of_statements(
    run: Run, monkeypatch: pytest.MonkeyPatch, executor: str, most: int
) -> None:
    """The tree interpreter has a limit of its own, as it is slower."""
    monkeypatch.setattr("krl.running.run_options._TREE_STATEMENTS", 70)
    monkeypatch.setattr("krl.running.run_options._STATEMENTS", 90)
    status, out, _ = run("LOOP\nENDLOOP\n", "--executor", executor)
    assert status == 1
    assert out.endswith(f"it has not ended after {most} statements\n")


def test_all_machines_may_begin_as_many(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Or traces would differ, where a submit program computes without end for instance."""
    seen: list[Limits | None] = []

    def noted(program: Any, setup: RunSetup, **more: Any) -> RunResult:
        seen.append(setup.limits)
        return run_program(program, setup, **more)

    monkeypatch.setattr(session, "run_program", noted)
    for executor in available():
        run("", "--executor", executor)
    assert len(seen) == len(available())
    assert 2 == len(set(seen)) == 1 + len(set(seen[1:]))


def test_what_no_file_has(run: Run) -> None:
    """What no file has stands in and is listed; with --strict its call fails when it is reached."""
    status, out, err = run("NOWHERE ( )\n")
    assert "stand-ins: derived from its uses NOWHERE (main.src:2)" == err.splitlines()[0]
    assert 0 == status
    status, out, _ = run("NOWHERE ( )\n", "--strict")
    assert 1 == status
    assert "main.src: fault after 0 s at main.src:2: NOWHERE is declared nowhere\n" == out


def test_automatic_inputs(run: Run) -> None:
    """With --io auto waits are fulfilled and a HALT is left; what never comes is told."""
    status, out, _ = run("HALT\nWAIT FOR $IN[3] AND NOT $IN[4]\n", "--io", "auto")
    assert (0, True) == (status, out.startswith("main.src: end after 2."))
    status, out, err = run("WAIT FOR $OV_PRO==50\n", "--io", "auto", "--until", "5")
    assert (1, "main.src: time limit after 5 s at main.src:2\n") == (status, out)
    assert err.startswith("waited for: $OV_PRO at main.src:2, 4.9")
    slow = "PTP {A1 -160,A2 -90,A3 90,A4 0,A5 0,A6 0}\nPTP {A1 160}\n"  # takes more than a second
    for wait in ("WAIT FOR $IN[3]", "REPEAT\nUNTIL $IN[3]"):
        status, out, _ = run(f"{slow}{wait}\n", "--io", "auto")
        assert (0, True) == (status, out.startswith("main.src: end after "))
    outputs = " OR ".join(f"$OUT[{number}]" for number in range(1, 6))
    _, _, err = run(f"WAIT FOR ({outputs}) AND $IN[7]\n", "--io", "auto", "--until", "5")
    assert err.startswith(
        "waited for: $IN[7], $OUT[1], $OUT[2], $OUT[3], 2 more at main.src:2, 4.9"
    )


def test_a_wait_without_inputs_is_shown(run: Run) -> None:
    """If nothing sets inputs, a run that ends in a WAIT FOR says so, and what could set them."""
    _, _, err = run("wait  for $IN[3]\n", "--until", "1")
    assert "waited for: wait for $IN[3]; --io auto fulfils waits, --io SCRIPT sets inputs\n" == err
    assert "" == run("WAIT SEC 9\n", "--until", "1")[2]


def test_programs_that_only_serve_end(run: Run) -> None:
    """Once the arm has stood for 20 s, WAIT SEC not counted; --until runs on."""
    body = "PTP {A1 9,A2 -90,A3 90,A4 0,A5 0,A6 0}\nWAIT SEC 100\n"
    body += "LOOP\n$OUT[1]=NOT $OUT[1]\nENDLOOP\n"
    status, out, err = run(body, "--io", "auto")
    seconds = float(out.removeprefix("main.src: time limit after ").partition(" s at main.src:")[0])
    assert (1, True) == (status, 100 <= seconds <= 105)
    assert "the arm has stood still for 20 s; --until S goes on for longer\n" in err
    _, out, err = run("WAIT FOR $OV_PRO==50\n", "--io", "auto", "--until", "50")
    assert ("main.src: time limit after 50 s at main.src:2\n", False) == (out, "stood" in err)


def test_what_a_program_without_an_end_asked_is_listed(run: Run) -> None:
    """Messages for an operator are listed with how often they came; notifications are not."""
    lines = """DECL KRLMSG_T MSG
DECL KRLMSGPAR_T PAR[3]
DECL KRLMSGOPT_T OPT
INT H
MSG={MODUL[] "P00",NR 7,MSG_TXT[] "Wrong mode"}
LOOP
H=SET_KRLMSG(#QUIT,MSG,PAR[],OPT)
H=SET_KRLMSG(#NOTIFY,MSG,PAR[],OPT)
WAIT SEC 1
ENDLOOP
"""
    _, _, err = run(lines, "--until", "4.5")
    assert "message: main.src:8: Wrong mode, 5 times\n" == err
    assert "message: main.src:8: Wrong mode\n" == run(lines, "--until", "0.5")[2]


def test_strict(run: Run) -> None:
    """With --strict an error of the checker is told in one line with status 2, and nothing runs."""
    status, out, err = run("DECL INT I\nI=TRUE\n", "--strict")
    assert (2, "") == (status, out)
    assert err.startswith("krl: main.src:3: ")
    assert 1 == err.count("\n")


def test_a_point_out_of_reach(run: Run) -> None:
    """Without machine data the arm is sized for one whole point, in a line; not with --strict."""
    point = "PTP {X 1500,Y 0,Z 900,A 0,B 90,C 0,S 2,T 2}\n"
    status, _, err = run(INI + point)
    assert (0, True) == (status, err.startswith("arm: no machine data of an arm: KR6R900 SIZED x "))
    status, out, err = run(INI + point, "--strict")
    assert (1, "", True) == (status, err, "reach" in out)


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("REAL $LENGTH_B", "0.0", "$LENGTH_B is 0: the arm has no upper arm"),
        ("REAL $LENGTH_A", "1.0E30", "$LENGTH_A has a length of 1e+30 mm"),
        ("FRAME $TX3P3", "{X 0.0,Z 9.0E30}", "$TX3P3 has a length of 9e+30 mm"),
    ],
)
def test_arm_that_cannot_be(run: Run, tmp_path: Path, name: str, value: str, said: str) -> None:
    """One line names file and line of the length, of a project and of --machine."""
    lines = model_file("kr6r900.dat").read_text("utf-8").splitlines()
    place = next(n for n, line in enumerate(lines) if line.startswith(f"{name}="))
    lines[place] = f"{name}={value}"
    (tmp_path / "$machine.dat").write_text("\n".join(lines), "utf-8")
    at = f"$machine.dat:{place + 1}: {said}"
    assert f"arm: {at}: KR6R900 SIZED is used instead\n" == run(INI)[2]
    given = tmp_path / "$machine.dat"
    assert (2, f"krl: {tmp_path}/{at}\n") == run(INI, "--machine", str(given))[::2]


def test_two_lists_of_a_controller(run: Run, tmp_path: Path) -> None:
    """Machine data in Mada count; one line for each other list names its file and line."""
    arm = model_file("kr6r900.dat").read_text("utf-8")
    config = "DEFDAT $CONFIG PUBLIC\nDECL GLOBAL INT one=1\nDECL GLOBAL INT two=2\nENDDAT\n"
    for path, text in {
        "R1/Archive/$machine.dat": arm.replace("$LENGTH_B=455", "$LENGTH_B=0"),
        "R1/Mada/$machine.dat": arm,
        "R1/Program/$config.dat": config,
        "R1/System/$config.dat": config,
        "R1/Program/go.src": f"DEF go ( )\n{INI}PTP_REL {{A1 1}}\nEND\n",
    }.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, "utf-8")
    status, _, err = run(None, str(tmp_path / "R1/Program/go.src"), "--robot", "kinematic")
    assert 0 == status
    machine, names = err.splitlines()
    assert machine.startswith("declared twice: R1/Mada/$machine.dat:")
    assert machine.endswith(", also in R1/Archive/$machine.dat")
    other = "R1/Program/$config.dat"
    assert f"declared twice: R1/System/$config.dat:2: one and 1 more, also in {other}" == names


def test_machine_data_without_an_arm(run: Run, tmp_path: Path) -> None:
    """One line names the file, unless it is that of STEU, which has no arm."""
    text = "DEFDAT $MACHINE\nINT $NUM_AX=6\nENDDAT\n"
    (tmp_path / "STEU").mkdir()
    (tmp_path / "STEU" / "$machine.dat").write_text(text)
    assert "" == run(INI)[2]
    (tmp_path / "$machine.dat").write_text(text)
    assert run(INI)[2].startswith(
        "arm: $machine.dat: no machine data of an arm, which has $LENGTH_A"
    )


def test_first_motion_is_a_line(run: Run) -> None:
    """A line that a program begins with is executed as PTP, but refused with --strict."""
    body = "LIN {X 500,Y 0,Z 700,A 0,B 180,C 0} C_DIS\nLIN {X 500,Y 99,Z 700,A 0,B 180,C 0}\n"
    status, out, err = run(body)
    assert (1, True) == (status, out.startswith("main.src: end after "))
    said = "main.src:2: the first motion is not allowed as such: executed as PTP"
    assert f"robot program: {said}" == err.splitlines()[-1]
    assert "(message 1443)" in run(body, "--strict")[1]


def test_arguments_of_the_first_routine_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What a routine with parameters begins with is listed, also where no file is missing."""
    file = tmp_path / "lift.src"
    file.write_text("DEF lift ( N :IN, M :IN )\nINT N, M\nWAIT SEC N\nEND\n", encoding="utf-8")
    assert 0 == main(["run", str(file)])
    said = "stand-ins: as arguments of the first routine N (lift.src:1), M (lift.src:1)"
    assert said == capsys.readouterr().err.splitlines()[0]


def test_no_time(run: Run) -> None:
    """A run of no time ends at once."""
    _, out, _ = run("WAIT SEC 1\n", "--until", "0")
    assert "main.src: time limit after 0 s at main.src:2\n" == out


def test_submit_that_ends(run: Run, tmp_path: Path) -> None:
    """A submit program that counts as endless is reported behind the run."""
    (tmp_path / "sps.sub").write_text("DEF SPS ( )\nLOOP\nENDLOOP\nEND\n", encoding="utf-8")
    more = ("--submit", "SPS", "--statements", "2000")
    status, _, err = run("WAIT SEC 1\n", *more)
    said = "submit program: sps.sub:2: it has not ended after 2,000 statements\n"
    assert (1, said) == (status, err)


# -- what it takes ---------------------------------------------------------------------------------


def test_routine(run: Run) -> None:
    """--routine names what the program begins with."""
    status, out, _ = run("HALT\nEND\nDEF other ( )\nWAIT SEC 0.012\n", "--routine", "other")
    assert (0, "main.src: end after 0.012 s at main.src:5\n") == (status, out)


def test_script(run: Run) -> None:
    """--io plays a script: the input comes at its time, and so the program ends."""
    status, out, _ = run("WAIT FOR $IN[7]\n", script="t=0.3 IN[7]=TRUE\n")
    assert (0, "main.src: end after 0.3 s at main.src:2\n") == (status, out)


@pytest.mark.parametrize("ending", ["sub", "src"])
@pytest.mark.parametrize("executor", available())
def test_submit(run: Run, tmp_path: Path, executor: str, ending: str) -> None:
    """--submit runs a second program beside the first, on the same variables."""
    text = "DEF beside ( )\n$FLAG[3]=TRUE\nEND\n"
    (tmp_path / f"beside.{ending}").write_text(text, encoding="utf-8")
    options = "--submit", "beside", "--max-time", "1", "--executor", executor
    status, out, _ = run("WAIT FOR $FLAG[3]\n", *options)
    assert (0, "end") == (status, out.split()[1])
    assert 1 == run("WAIT FOR $FLAG[3]\n", "--max-time", "1")[0]


def test_batches_cost_time(run: Run, tmp_path: Path) -> None:
    """--motion batch begins to move only when the program has come to the end of the batch.

    The program computes for 8 cycles between two motions that blend. Looking ahead it does so while
    the first of them is on its way; in a batch the arm waits as long, and so the run takes longer.
    """
    body = (
        f"INT I\n{INI}WAIT SEC 0.012\nPTP {{A1 60}} C_PTP\nFOR I=1 TO 8000\nENDFOR\nPTP {{A1 90}}\n"
    )
    trace = tmp_path / "trace.jsonl"
    seconds, starts, blends = [], [], []
    for one in ("lookahead", "batch"):
        status, out, _ = run(body, "--motion", one, "--trace", str(trace))
        assert 0 == status
        seconds.append(float(out.split()[3]))
        told = events(trace)
        starts.append([event["t"] for event in told if event["kind"] == "motion_start"][1])
        blends.append(sum(event["kind"] == "blend_start" for event in told))
    cost = 8 * 12_000
    assert starts[0] + cost == starts[1]
    assert seconds[0] + cost / 1e6 == pytest.approx(seconds[1], abs=1e-5)
    assert [1, 1] == blends


def test_letter_case_of_a_path_in_an_archive(run: Run, tmp_path: Path) -> None:
    """It does not count, unless files differ in nothing else; a wrong name is told as such."""
    backup = tmp_path / "backup.zip"
    with ZipFile(backup, "w") as archive:
        archive.writestr("KRC/R1/Go.src", "DEF go ( )\nHALT\nEND\n")
    assert 0 == run(None, str(backup / "krc/r1/GO.SRC"))[0]
    _, _, err = run(None, str(backup / "KRC/R1/stop.src"))
    assert err.endswith("stop.src: no KRL program of this name in the archive\n")
    with ZipFile(backup, "a") as archive:
        archive.writestr("KRC/r1/go.src", "DEF go ( )\n\nHALT\nEND\n")
    assert [2, 3] == [
        int(run(None, str(backup / name))[1].rpartition(":")[2])
        for name in ("KRC/R1/Go.src", "KRC/r1/go.src")
    ]


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="names are Unicode there")
@pytest.mark.parametrize("executor", ["tree", "vm", "native"])
def test_names_that_are_no_text(run: Run, tmp_path: Path, executor: str) -> None:
    """A file whose name is no UTF-8 runs like any other; its name is told with escapes."""
    file = tmp_path / "a\udcff\x1b.src"
    file.write_text("DEF a ( )\nHALT\nEND\n", encoding="utf-8")
    page = tmp_path / "\x1b[31m.html"
    status, out, _ = run(None, str(file), "--executor", executor, "--html", str(page))
    assert (0, "a\\xff\\x1b.src: halt after 0 s at a\\xff\\x1b.src:2\n") == (
        status,
        out[: out.index("page")],
    )
    assert "\x1b" not in out
    assert page.is_file()


# -- what it writes --------------------------------------------------------------------------------


def test_trace(run: Run, tmp_path: Path) -> None:
    """--trace writes what happened, --trace-level full each line and assignment too."""
    world, full = tmp_path / "made" / "world.jsonl", tmp_path / "full.jsonl"
    run("$OUT[3]=TRUE\n", "--trace", str(world))
    run("$OUT[3]=TRUE\n", "--trace", str(full), "--trace-level", "full")
    out = {"t": 0, "task": "robot", "kind": "out", "at": "main.src:2"}
    assert {**out, "signal": "$OUT", "number": 3, "value": True} == events(world)[0]
    assert ["out", "return", "end"] == [one["kind"] for one in events(world)]
    assert "line" in [one["kind"] for one in events(full)]


def test_a_trace_has_a_largest_size(run: Run, tmp_path: Path) -> None:
    """Then it ends with a whole line, and the run goes on to its end."""
    trace = tmp_path / "trace.jsonl"
    body = "DECL INT I\nFOR I=1 TO 12000\nIF I>0 THEN\n$OUT[1]=NOT $OUT[1]\nENDIF\nENDFOR\n"
    status, out, err = run(body, "--trace", str(trace), "--max-trace", "1")
    seen = events(trace)
    assert status == 0
    assert 999_000 < trace.stat().st_size <= 1_000_000
    (at,) = re.findall(r"trace: it ends at ([0-9.]+) s, at 1 MB; --max-trace allows more", err)
    assert 0 <= float(at) - seen[-1]["t"] / 1e6 <= 0.1
    assert "end after" in out


@pytest.mark.parametrize(
    ("option", "kept"), [("--trace", set()), ("--html", {"return", "out", "end"})]
)
def test_what_is_kept_of_a_run(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, option: str, kept: set[str]
) -> None:
    """All events for a page; for a trace only those that notes look at, because there are many."""
    kinds: set[str] = set()

    def noted(done: RunResult, *_: object) -> list[str]:
        kinds.update(event.kind for event in done.events)
        return []

    monkeypatch.setattr("krl.commands.run.run_notes", noted)
    run("$OUT[3]=TRUE\n", option, str(tmp_path / "out"))
    assert kept == kinds


def test_path(run: Run, tmp_path: Path) -> None:
    """--path writes a row for each interpolation cycle, up to the last one of the run."""
    pandas = pytest.importorskip("pandas")
    file = tmp_path / "path.csv"
    assert 0 == run(f"{INI}LIN {{Z 780}}\n", "--robot", "kinematic", "--path", str(file))[0]
    table = pandas.read_csv(file)
    assert {12_000} == set(table["t"].diff().dropna()[:-1])
    assert [445, 0, 780] == pytest.approx(table[["x", "y", "z"]].iloc[-1].tolist(), abs=0.01)


def test_page(run: Run, tmp_path: Path) -> None:
    """--html writes the page of the run and tells where it is."""
    page = tmp_path / "page.html"
    status, out, _ = run(f"{INI}$OUT[5]=TRUE\n", "--html", str(page))
    assert (0, f"page: {page}") == (status, out.splitlines()[1])
    text = page.read_text(encoding="utf-8")
    assert "$OUT" in text
    assert "main.src" in text


# -- bad input -------------------------------------------------------------------------------------


def test_routines_that_move_are_named(run: Run) -> None:
    """Where a run began with a routine that does not move, those of its file that do are named."""
    status, _, err = run("END\nDEF go ( )\nPTP {A1 5}\nEND\nDEF idle ( )\n")
    assert (0, "no motion in main; others can be selected with --routine: go\n") == (status, err)


def test_motions_to_where_the_arm_stands_are_told(run: Run) -> None:
    """Where all motions end where they start, the arm has not moved, and their lines are named."""
    home = "PTP {A1 0, A2 -90, A3 90, A4 0, A5 0, A6 0}\n"
    status, _, err = run(2 * home)
    told = "no motion; the arm stands where these end: main.src:2, main.src:3\n"
    assert (0, told) == (status, err)


def test_what_the_first_motion_depends_on_is_named(run: Run) -> None:
    """Where no motion was made, the block around the first one is told."""
    status, _, err = run("IF $IN[2] THEN\nPTP {A1 5}\nENDIF\n")
    told = (
        "no motion; the first one is inside main.src:2: IF $IN[2] THEN; --io SCRIPT sets inputs\n"
    )
    assert (0, told) == (status, err)
    status, _, err = run("IF $FLAG[2] THEN\nPTP {A1 5}\nENDIF\n")
    assert (0, "no motion; the first one is inside main.src:2: IF $FLAG[2] THEN\n") == (status, err)


def test_missing_routines_that_may_move_are_named(run: Run) -> None:
    """Where no routine at hand moves the arm, those that no file has are named."""
    status, _, err = run("go(1)\nback()\n")
    assert (0, "no motion; routines that no file has may make some: go, back") == (
        status,
        err.splitlines()[-1],
    )


def test_a_folder_is_no_program(run: Run, tmp_path: Path) -> None:
    """What could be run in a folder or an archive is named in one line."""
    (tmp_path / "cell").mkdir()
    (tmp_path / "cell" / "one.src").write_text("DEF one ( )\nEND\n", encoding="utf-8")
    with ZipFile(tmp_path / "all.zip", "w") as archive:
        archive.writestr("R1/Program/one.src", "DEF one ( )\nEND\n")
    for name, program in (("cell", "cell/one.src"), ("all.zip", "all.zip/R1/Program/one.src")):
        status, out, err = run(None, str(tmp_path / name))
        assert (2, "") == (status, out)
        assert err.endswith(f"name one of {tmp_path / program}\n"), err


def test_files_that_are_left_out(run: Run, tmp_path: Path) -> None:
    """Other files of the project that cannot be read are told, and the program runs."""
    (tmp_path / "other.src").write_text("DEF other ( )\nIF\nEND\n", encoding="utf-8")
    status, out, err = run("HALT\n")
    assert 0 == status
    assert "main.src: halt" in out
    assert err.startswith("left out: ")
    assert "other.src:2: " in err


def test_failures_that_are_not_listed_are_counted(run: Run) -> None:
    """Of the statements that failed and were skipped three are listed."""
    _, _, err = run("GONE ( )\n$OUT[0]=1/0\n$OUT[0]=2/0\n$OUT[0]=3/0\n$OUT[0]=4/0\n")
    said = [line for line in err.splitlines() if line.startswith("skipped: ")]
    assert (4, "skipped: 1 more line, see --trace or --html") == (len(said), said[-1])


def test_left_out_lines_that_a_run_reaches_come_first(run: Run, tmp_path: Path) -> None:
    """Three are listed: those of the routines that are called before those of other files."""
    for name in ("a", "b", "c", "used"):
        (tmp_path / f"{name}.src").write_text(f"DEF {name} ( )\nIF\nEND\n", encoding="utf-8")
    _, _, err = run("used ( )\n")
    assert ["used", "a", "b", "1 more in the project"] == [
        line.removeprefix("left out: ").partition(".src:")[0] for line in err.splitlines()[:4]
    ]


@pytest.mark.parametrize("line", ["IF = THEN\nENDIF", "FOR I=1 TOO 3\nENDFOR", "DECL INT ="])
def test_a_line_that_cannot_be_read(run: Run, line: str) -> None:
    """The status is 1, whatever is run in its place."""
    status, out, err = run(f"{line}\n")
    assert (1, "main.src: end after 0 s") == (status, out.partition(" at ")[0])
    assert err.startswith("left out: main.src:2: ")


@pytest.mark.skipif(sys.platform == "win32", reason="has no signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_is_ended_keeps_its_trace(tmp_path: Path, number: signal.Signals) -> None:
    """What is traced so far is kept, in whole lines, with Ctrl-C and where a service ends it."""
    file = tmp_path / "main.src"
    file.write_text("DEF MAIN()\nLOOP\nWAIT SEC 0.001\nENDLOOP\nEND\n", encoding="ascii")
    out = tmp_path / "out"
    words = ["run", str(file), "--trace", str(out / "t.jsonl"), "--until", "1000000"]
    # a background job ignores SIGINT
    heeds = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    begin = f"{heeds}; import sys; from krl.cli import main; sys.exit(main())"
    with subprocess.Popen([sys.executable, "-c", begin, *words], stderr=subprocess.PIPE) as run:
        assert run.stderr is not None
        while not (out.exists() and any(one.stat().st_size for one in out.iterdir())):
            assert run.poll() is None
            time.sleep(0.05)
        run.send_signal(number)
        assert b"t.jsonl ends where the run was interrupted" in run.stderr.read()
        assert 128 + number == run.wait(60)
    assert ["t.jsonl"] == [one.name for one in out.iterdir()]
    assert all(map(json.loads, (out / "t.jsonl").read_text(encoding="utf-8").splitlines()))


def test_strict_is_about_the_whole_project(run: Run, tmp_path: Path) -> None:
    """An error of another file is told with its code, and that it belongs to the same project."""
    (tmp_path / "other.src").write_text("DEF OTHER()\nINT I\nI=TRUE\nEND\n", encoding="utf-8")
    status, _, err = run("HALT\n", "--strict")
    assert (status, err.count("\n")) == (2, 1)
    assert err.startswith("krl: other.src:3: ")
    assert "in the project of main.src" in err
