"""`krl check` from the outside: what it prints, its statuses, its options."""

import io
import json
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest

from krl.cli import main
from krl.commands.check import watching

WRONG = "DEF A()\nDECL INT N\nIF N = 1 THEN\nHALT\nENDIF\nEND\n"
LOOSE = "DEF B()\nHALT\nEXIT\nEND\n"
FINE = "DEF C()\nHALT\nEND\n"

pytestmark = pytest.mark.usefixtures("elsewhere")


@pytest.fixture
def programs(elsewhere: Path) -> Path:
    for name, text in (("A", WRONG), ("B", LOOSE), ("C", FINE)):
        (elsewhere / f"{name}.src").write_text(text, encoding="utf-8", newline="\n")
    return elsewhere


def check(*arguments: str) -> int:
    return main(["check", "--jobs", "1", *arguments])


def records(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[dict[str, Any]]:
    check("--format", "json", *arguments)
    loaded = json.loads(capsys.readouterr().out)
    assert isinstance(loaded, list)
    return loaded


@pytest.mark.usefixtures("programs")
def test_text_has_a_caret_and_a_fix(capsys: pytest.CaptureFixture[str]) -> None:
    """Findings go to stdout with their line, the summary to stderr."""
    assert 1 == check("A.src")
    out, err = capsys.readouterr()
    assert (
        """A.src:3:6: error KRL001: a comparison is written ==
  3 | IF N = 1 THEN
    |      ^
    = write ==

"""
        == out
    )
    assert "1 file checked: 1 error\n" == err


JOINED = (
    "A.src:4:1: note KRL701: 4 names are declared in no file at hand: "
    "FAR, OUTER, LOST, …; --verbose tells each\n"
)
EACH = "".join(
    f"A.src:{line}:1: note KRL701: the routine {name} is declared in no file at hand; used once\n"
    for line, name in enumerate(("FAR", "OUTER", "LOST", "GONE"), 4)
)


@pytest.mark.parametrize(("options", "notes"), [([], JOINED), (["--verbose"], EACH)])
def test_errors_come_last_and_names_of_missing_files_are_one_note(
    elsewhere: Path, capsys: pytest.CaptureFixture[str], options: list[str], notes: str
) -> None:
    """A single error of an incomplete backup stands above the summary, which counts all notes."""
    body = "HALT\nEXIT\nFAR()\nOUTER()\nLOST()\nGONE()\n= 1"
    (elsewhere / "A.src").write_text(f"DEF A()\n{body}\nEND\n", encoding="utf-8")
    (elsewhere / "B.src").write_text("DEF B()\nAWAY()\nEND\n", encoding="utf-8")
    assert 1 == check("--no-cache", *options, ".")
    out, err = capsys.readouterr()
    assert (
        f"{notes}"
        "B.src:2:1: note KRL701: the routine AWAY is declared in no file at hand; used once\n"
        "A.src:3:1: warning KRL401: EXIT outside a loop\n"
        'A.src:8:1: error KRL001: no line begins with "="\n'
        == "".join(f"{line}\n" for line in out.splitlines() if ".src:" in line)
    )
    assert "2 files checked: 1 error, 1 warning, 5 notes" in err


def test_parameters_without_declaration_are_one_warning_a_file(
    elsewhere: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A file that lists the heads of routines has one warning on all of them, and three in JSON."""
    heads = "".join(f"DEF {name}(X:IN)\nEND\n" for name in "ABC")
    (elsewhere / "A.src").write_text(heads, encoding="utf-8")
    check("--no-cache", "--select", "KRL115", ".")
    out, err = capsys.readouterr()
    message = "3 routines do not declare all parameters: lines 1, 3, 5"
    assert f"A.src:1:7: warning KRL115: {message}" == out.splitlines()[0]
    assert "1 file checked: 3 warnings\n" == err
    assert [1, 3, 5] == [one["line"] for one in records(capsys, "--select", "KRL115", ".")]


@pytest.mark.usefixtures("programs")
@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (["C.src"], 0),
        (["C.src", "--stops"], 0),
        (["B.src"], 1),
        (["."], 1),
        (["B.src", "--syntax-only"], 0),
        (["A.src", "--syntax-only"], 1),
        (["B.src", "--ignore", "KRL4"], 0),
        (["B.src", "--select", "KSS,KRL001"], 0),
        (["B.src", "--select", "KRL4", "--ignore", "KRL402"], 1),
    ],
)
def test_exit_status(arguments: list[str], status: int) -> None:
    """Errors and warnings are findings; notes, and what was not asked for, are not."""
    assert status == check(*arguments)


@pytest.mark.usefixtures("programs")
def test_json_has_the_fields_of_the_design(capsys: pytest.CaptureFixture[str]) -> None:
    """A list of records, in order of path and line."""
    found = records(capsys, ".")
    assert [("A.src", 3, "KRL001"), ("B.src", 3, "KRL401")] == [
        (one["path"], one["line"], one["code"]) for one in found
    ]
    fields = {"path", "line", "column", "end_column", "severity", "code", "message"}
    assert all(fields <= one.keys() for one in found)


@pytest.mark.usefixtures("programs")
def test_sarif(capsys: pytest.CaptureFixture[str]) -> None:
    """SARIF 2.1.0 with a rule for each code."""
    check("--format", "sarif", ".")
    log = json.loads(capsys.readouterr().out)
    assert "2.1.0" == log["version"]
    (run,) = log["runs"]
    assert ["KRL001", "KRL401"] == [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert ["A.src", "B.src"] == [
        one["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] for one in run["results"]
    ]


@pytest.mark.parametrize("format_", ["text", "json", "sarif"])
def test_findings_go_to_a_file(
    capsys: pytest.CaptureFixture[str], programs: Path, format_: str
) -> None:
    """The file has what the terminal would have."""
    check("--format", format_, ".")
    shown = capsys.readouterr().out
    assert 1 == check("--format", format_, "--out", "deep/found", ".")
    assert "" == capsys.readouterr().out
    assert shown == (programs / "deep" / "found").read_text("utf-8")


@pytest.mark.usefixtures("programs")
def test_stops_are_reported_on_demand(capsys: pytest.CaptureFixture[str]) -> None:
    """With --stops, or when their codes are selected, and only then."""
    stops = ["KRL601"]
    assert [] == records(capsys, "C.src")
    assert stops == [one["code"] for one in records(capsys, "C.src", "--stops")]
    assert stops == [one["code"] for one in records(capsys, "C.src", "--select", "KRL6")]


@pytest.mark.usefixtures("programs")
def test_unchanged_files_come_from_the_cache(capsys: pytest.CaptureFixture[str]) -> None:
    """The second check of the same files says so, and prints the same."""
    check(".")
    first = capsys.readouterr()
    check(".")
    again = capsys.readouterr()
    assert first.out == again.out
    assert "3 files checked (3 unchanged): " in again.err
    check("--no-cache", ".")
    assert "unchanged" not in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="the home is elsewhere there")
def test_without_a_cache_it_works_all_the_same(
    programs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A cache that cannot be written to keeps nobody from checking."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(programs / "A.src"))
    assert 0 == check("C.src")


def test_bad_input_ends_in_findings(capsys: pytest.CaptureFixture[str], elsewhere: Path) -> None:
    """Enormous nesting and enormous lines are told on one line each."""
    deep = "(" * 10_000 + "1" + ")" * 10_000
    (elsewhere / "DEEP.src").write_text(f"DEF DEEP()\nN = {deep}\nEND\n", encoding="utf-8")
    (elsewhere / "LONG.src").write_text(f"DEF LONG()\n{'A' * 2_000_000}\nEND\n", encoding="utf-8")
    assert [("DEEP.src", 2, "KRL003"), ("LONG.src", 2, "KRL001")] == [
        (one["path"], one["line"], one["code"]) for one in records(capsys, ".")
    ]


@pytest.mark.parametrize("kind", ["json", "sarif"])
def test_records_steer_no_terminal_either(
    kind: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """What is not printable is escaped in JSON, and reads the same; letters stay letters."""
    steering = ("\x7f", "\x9f", "\u202e", "\U000e0001")
    lines = "".join(f"X = {char} 1\n" for char in (*steering, "é"))
    file = tmp_path / "a.src"
    file.write_text(f"DEF A()\n{lines}END\n", encoding="utf-8")
    assert 1 == check("--format", kind, str(file))
    told = capsys.readouterr().out
    assert not [c for c in told if not c.isprintable() and c != "\n"]
    whole = json.dumps(json.loads(told), ensure_ascii=False)
    assert "é" in told
    assert [] == [char for char in steering if f'before \\"{char}\\"' not in whole]


def test_colours_on_a_terminal(programs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where there are colours, text is the same with them taken away."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLUMNS", "200")
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stdout", stream)
    check(str(programs / "A.src"))
    shown = stream.getvalue()
    assert "\x1b[1;31merror KRL001:" in shown.replace("\x1b[1;31m: error", "\x1b[1;31merror")


BACKUP = {
    "KRC/R1/Program/work.src": "DEF WORK()\nOPEN(1, 2)\nSHUT(1)\nEND\n",
    "KRC/R1/TP/tools.src": (
        "DEF TOOLS()\nEND\nGLOBAL DEF OPEN(N :IN)\nDECL INT N\n$OUT[N] = TRUE\nEND\n"
    ),
    "KRC/R1/System/$config.dat": "DEFDAT $CONFIG\nENDDAT\n",
    "KRC/STEU/Mada/$custom.dat": "DEFDAT $CUSTOM PUBLIC\nENDDAT\n",
}
#: What the checker says of the program, which only the other files can tell.
OF_WORK = [("work.src", 2, "KRL301", "error"), ("work.src", 3, "KRL701", "note")]


@pytest.fixture
def backup(elsewhere: Path) -> Path:
    """A backup as a folder and as an archive, beside one another."""
    with ZipFile(elsewhere / "backup.zip", "w") as archive:
        for name, text in BACKUP.items():
            archive.writestr(name, text)
            file = elsewhere / "backup" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
    return elsewhere


def test_entry_from_inside(
    capsys: pytest.CaptureFixture[str], backup: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Paths are those of the folder that one stands in, whatever the project is."""
    monkeypatch.chdir(backup / "backup/KRC/R1/Program")
    found = records(capsys, "--no-cache", "work.src")
    assert OF_WORK == [(one["path"], one["line"], one["code"], one["severity"]) for one in found]


def test_nothing_is_missing(capsys: pytest.CaptureFixture[str], backup: Path) -> None:
    """With --complete a routine that no file has is an error."""
    found = records(capsys, "--no-cache", "--complete", str(backup / "backup"))
    assert ["KRL301", "KRL102"] == [one["code"] for one in found if one["severity"] == "error"]


@pytest.mark.parametrize(
    ("body", "expected"),
    [("", (0, 0, 0)), ("INT N\nN = 1\nN = N", (0, 1, 0)), ("N = = 1", (1, 1, 0))],
)
def test_what_fails_a_check_can_be_chosen(
    tmp_path: Path, body: str, expected: tuple[int, int, int]
) -> None:
    """Errors only, warnings too, or nothing."""
    (tmp_path / "a.src").write_text(f"DEF A()\n{body}\nEND\n", encoding="utf-8")
    words = ["check", "--no-cache", str(tmp_path), "--fail-on"]
    assert expected == tuple(main([*words, which]) for which in ("error", "any", "never"))


@pytest.mark.parametrize("is_there", [False, True])
def test_a_baseline_that_cannot_be_read_comes_before_fixes(programs: Path, is_there: bool) -> None:
    """No file is changed where the check behind the fixes could not run."""
    if is_there:
        assert check(str(programs), "--write-baseline", "known.json") == 0
    assert check(str(programs), "--fix", "--baseline", "known.json") == (1 if is_there else 2)
    assert ("N == 1" in (programs / "A.src").read_text(encoding="utf-8")) is is_there


def test_fixes_of_checks_and_of_syntax(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both are shown and applied, at the places of the file as it was."""
    text = "DEF A()\n  INT F[5]\n  B(F)\n  IF F[1] = 2 THEN\n  ENDIF\nEND\n{}"
    called = "DEF B(X[] :OUT)\n  INT X[]\n  X[1] = 2\nEND\n"
    file = tmp_path / "A.src"
    file.write_text(text.format(called), encoding="utf-8")
    assert 1 == check("--diff", str(file))
    assert "+  B(F[])" in capsys.readouterr().out.splitlines()
    assert 0 == check("--fix", str(file))
    after = text.replace("B(F)", "B(F[])").replace("] = 2 THEN", "] == 2 THEN").format(called)
    assert after == file.read_text(encoding="utf-8")


def test_watching_notices_all_that_matters(programs: Path) -> None:
    """A save while a check runs counts, and so do settings above the folder and a baseline."""
    pytest.importorskip("watchfiles")
    settings, known, folder = programs / "krl.toml", programs / "known.json", programs / "cell"
    folder.mkdir()
    files = [settings]
    looks = watching.changes([folder], lambda: files)

    def is_noticed() -> bool:
        thread = threading.Thread(target=next, args=(looks,), daemon=True)
        thread.start()
        thread.join(20)
        return not thread.is_alive()

    assert is_noticed()
    (folder / "A.src").write_text(FINE, encoding="utf-8")
    assert is_noticed()
    settings.write_text("", encoding="utf-8")
    assert is_noticed()
    files.append(known)
    settings.unlink()
    assert is_noticed()
    known.write_text("", encoding="utf-8")
    assert is_noticed()


def test_watching_goes_on(
    programs: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Changed settings apply, and files or settings that cannot be read end nothing."""
    settings = programs / "krl.toml"

    def changes(_paths: object, _beside: object) -> Iterator[None]:
        yield
        settings.write_text('ignore = ["KRL001"]', encoding="utf-8")
        yield
        settings.write_text("ignore =", encoding="utf-8")
        yield
        settings.unlink()
        text = (programs / "A.src").read_text(encoding="utf-8")
        (programs / "A.src").unlink()
        yield
        (programs / "A.src").write_text(text, encoding="utf-8")
        yield

    monkeypatch.setattr(watching, "changes", changes)
    assert 0 == check("--no-cache", "--watch", "A.src")
    said = [line.split(" (")[0] for line in capsys.readouterr().err.splitlines()]
    assert [
        "1 file checked: 1 error",
        "1 file checked: no findings",
        f"krl: {settings}: not TOML: Invalid value",
        "krl: A.src: no such file or folder",
        "1 file checked: 1 error",
    ] == said
