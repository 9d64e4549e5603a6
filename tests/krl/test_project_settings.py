"""`krl.toml`, and what `krl check` makes of it and of known findings."""

import json
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import pytest

from krl.baseline_file import baseline_place
from krl.cli import main
from krl.errors import InputError
from krl.project_settings import read_settings, settings_of

PROGRAM = "DEF A()\nINT N\nN = 1.5\nEXIT\n$OUT[N] = TRUE\nEND\n"


@pytest.fixture
def cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with a note and a warning in each of two files; the working folder is above it."""
    monkeypatch.chdir(tmp_path)
    root = tmp_path / "cell"
    (root / "old").mkdir(parents=True)
    (root / "a.src").write_text(PROGRAM, encoding="utf-8")
    (root / "old" / "b.src").write_text(PROGRAM.replace("A()", "B()"), encoding="utf-8")
    return root


@pytest.fixture
def codes(capsys: pytest.CaptureFixture[str]) -> Callable[..., list[tuple[str, str, str]]]:
    """File, code and severity of what a check of a folder says."""

    def run(*words: str) -> list[tuple[str, str, str]]:
        main(["check", "--no-cache", "--format", "json", *words])
        found = json.loads(capsys.readouterr().out)
        return [(one["path"].rpartition("/")[2], one["code"], one["severity"]) for one in found]

    return run


Codes = Callable[..., list[tuple[str, str, str]]]
A = [("a.src", "KRL209", "note"), ("a.src", "KRL401", "warning")]
B = [("b.src", "KRL209", "note"), ("b.src", "KRL401", "warning")]


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("", A + B),
        ('ignore = ["KRL4"]', [A[0], B[0]]),
        ('select = ["KRL401"]', [A[1], B[1]]),
        ('exclude = ["old"]', A),
        ('exclude = ["OLD/*.src"]', A),
        ('exclude = ["a.src"]', B),
        ('[severity]\nKRL2 = "error"\nKRL401 = "off"', [(A[0][0], "KRL209", "error"),
                                                       (B[0][0], "KRL209", "error")]),
        ('[severity]\nKRL = "off"\nKRL401 = "note"', [("a.src", "KRL401", "note"),
                                                     ("b.src", "KRL401", "note")]),
        ('[per-file-ignores]\n"old/*" = ["KRL"]', A),
    ],
)  # fmt: skip
def test_settings_decide_what_is_reported(
    cell: Path, codes: Codes, settings: str, expected: list[tuple[str, str, str]]
) -> None:
    """Each key does what the option of its name does, from whatever folder one checks."""
    (cell / "krl.toml").write_text(settings, encoding="utf-8")
    assert expected == codes("cell")
    assert expected == codes(str(cell))


def test_the_command_line_stands_above_the_settings(cell: Path, codes: Codes) -> None:
    """A choice of codes replaces the one in the settings; --no-settings leaves all of them out."""
    (cell / "krl.toml").write_text('select = ["KRL209"]\nexclude = ["old"]', encoding="utf-8")
    assert A[1:] == codes("cell", "--select", "KRL401")
    assert A + B == codes("cell", "--no-settings")


def test_what_is_excluded_alone_cannot_be_checked(
    cell: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One sentence and status 2."""
    (cell / "krl.toml").write_text('exclude = ["a.src"]', encoding="utf-8")
    path = next(cell.rglob("a.src"))
    assert 2 == main(["check", "--no-cache", str(path)])
    assert f"krl: {path}: krl.toml excludes all that is to be checked\n" == capsys.readouterr().err


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ("ignor = []", "no setting is called ignor; ignore?"),
        ("ignore = 3", "ignore must be a list of texts"),
        ('ignore = ["KRX"]', "ignore: no code begins with KRX"),
        ('[severity]\nKRL1 = "bad"', "severity: KRL1 must be one of error, warning, note, off"),
        ("complete = 1", "complete must be true or false"),
        ('profile = "kss9"', "profile: kss9 is unknown; there are kss5, kss8, and any .toml file"),
        ('profile = "cell.toml"', "profile: there is no file cell.toml"),
        ("= 1", "Invalid"),
        ("\x00", "Invalid"),
    ],
)
def test_wrong_settings_are_one_line(tmp_path: Path, settings: str, said: str) -> None:
    """The file and the key are named."""
    file = tmp_path / "krl.toml"
    file.write_text(settings, encoding="utf-8")
    with pytest.raises(InputError, match=said.replace("?", r"\?")) as raised:
        read_settings(file)
    assert str(raised.value).startswith(str(file))


def test_the_file_of_a_profile_is_relative_to_the_settings(tmp_path: Path) -> None:
    """A profile is the name of a built-in one or a file."""
    file = tmp_path / "krl.toml"
    (tmp_path / "cell.toml").touch()
    for written, expected in (("kss5", "kss5"), ("cell.toml", str(tmp_path / "cell.toml"))):
        file.write_text(f'profile = "{written}"', encoding="utf-8")
        assert expected == read_settings(file).profile


def test_settings_of_two_projects_are_not_mixed(tmp_path: Path) -> None:
    """Paths below different settings are refused, those below the same are not."""
    for name in ("a", "b"):
        (tmp_path / name / "R1").mkdir(parents=True)
        (tmp_path / name / "krl.toml").touch()
    found = settings_of([tmp_path / "a", tmp_path / "a" / "R1"])
    assert found is not None
    assert tmp_path / "a" == found.root
    with pytest.raises(InputError, match="different projects"):
        settings_of([tmp_path / "a", tmp_path / "b"])


def test_known_findings_are_left_out(
    cell: Path, codes: Codes, capsys: pytest.CaptureFixture[str]
) -> None:
    """A baseline keeps back what it knows, wherever it moves, and lets through what is new."""
    assert 0 == main(["check", "--no-cache", "cell", "--write-baseline", "cell/known.json"])
    (cell / "krl.toml").write_text('baseline = "known.json"', encoding="utf-8")
    text = PROGRAM.replace("INT N", "INT N\n\nBOOL M").replace("EXIT", "EXIT\nM = 7\n$FLAG[1] = M")
    (cell / "a.src").write_text(text, encoding="utf-8")
    (cell / "old" / "b.src").unlink()
    capsys.readouterr()
    assert [("a.src", "KSS1446", "error")] == codes("cell")
    main(["check", "--no-cache", str(cell)])
    assert "1 error; 2 known ones left out, 2 known ones are gone" in capsys.readouterr().err


@pytest.mark.parametrize("content", ["", "[]", "{", '{"version": 1}'])
def test_a_damaged_baseline_is_one_line(
    cell: Path, content: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is no baseline, or is not there, is wrong usage."""
    (cell / "known.json").write_text(content, encoding="utf-8")
    assert 2 == main(["check", "cell", "--baseline", "cell/known.json"])
    assert 2 == main(["check", "cell", "--baseline", "cell/none.json"])
    first, second = capsys.readouterr().err.splitlines()
    assert "known.json" in first
    assert "make it with --write-baseline" in second


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "known.json",
            '{"version": 1, "findings": [{"path": "", "code": "", "text": "", "count": 1e999}]}',
        ),
        ("krl.toml", f"a{'.a' * 200} = 1"),
    ],
)
def test_what_asks_too_much_of_a_reader_is_one_line(
    cell: Path, name: str, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A count beyond all numbers, and a key that would take minutes to read, are refused."""
    (cell / name).write_text(text, encoding="utf-8")
    known = ["--baseline", "cell/known.json"] if name == "known.json" else []
    assert 2 == main(["check", "cell", *known])
    assert name in capsys.readouterr().err


def test_a_baseline_on_another_drive_knows_whole_paths(monkeypatch: pytest.MonkeyPatch) -> None:
    """Windows has no way from one drive to another, which Python tells as an error."""

    def on_another_drive(*_: object) -> str:
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr("os.path.relpath", on_another_drive)
    file = Path("KRC/a.src").absolute()
    assert file.as_posix() == baseline_place(Path("known.json"))(str(file))


def test_mending_writes_files_and_showing_does_not(
    cell: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """--diff shows what --fix does; encoding, line ends and all else stay."""
    file = cell / "a.src"
    before = "DEF A() ; \xfc\r\nIF TRUE\r\nENDIF\r\nEND\r\n".encode("cp1252")
    file.write_bytes(before)
    assert 1 == main(["check", "--no-cache", "--diff", "cell/a.src"])
    assert ["-IF TRUE", "+IF TRUE THEN"] == [
        line for line in capsys.readouterr().out.splitlines() if line[1:3] == "IF"
    ]
    assert before == file.read_bytes()
    assert 0 == main(["check", "--no-cache", "--fix", "cell/a.src"])
    assert before.replace(b"TRUE", b"TRUE THEN") == file.read_bytes()
    assert 0 == main(["check", "--no-cache", "--diff", "cell/a.src"])


def test_findings_for_github(cell: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One command a finding, with what would end it escaped."""
    (cell / "a,%.src").write_text(PROGRAM, encoding="utf-8")
    main(["check", "--no-cache", "--format", "github", "--select", "KRL401", "cell/a,%.src"])
    (line,) = capsys.readouterr().out.splitlines()
    assert line.startswith("::warning file=cell/a%2C%25.src,line=4,endLine=4,col=1,endColumn=5,")
    assert line.endswith(",title=KRL401::EXIT outside a loop")


@pytest.mark.usefixtures("cell")
def test_cases_for_junit_counted_once(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The statistics of a report are made once, not again for each of its files."""
    from junitparser import TestSuite

    counted: list[TestSuite] = []

    def count(suite: TestSuite) -> None:
        counted.append(suite)

    monkeypatch.setattr(TestSuite, "update_statistics", count)
    main(["check", "--no-cache", "--format", "junit", "cell"])
    assert (2, 1) == (capsys.readouterr().out.count("<testcase"), len(counted))


def test_findings_for_junit(cell: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A test case a file, failed where there is more than notes."""
    (cell / "c.src").write_text("DEF C()\nEND\n", encoding="utf-8")
    main(["check", "--no-cache", "--format", "junit", "cell"])
    suite = ET.fromstring(capsys.readouterr().out)
    failed = {case.get("name"): len(case) for case in suite.iter("testcase")}
    assert {"a.src": 1, "b.src": 1, "c.src": 0} == failed


@pytest.mark.usefixtures("cell")
def test_rules_are_named_on_demand(capsys: pytest.CaptureFixture[str]) -> None:
    """Text has the IDs of rules with --verbose only."""
    main(["check", "--no-cache", "cell"])
    assert "[CTL-02]" not in capsys.readouterr().out
    main(["check", "--no-cache", "--verbose", "cell"])
    assert "[CTL-02]" in capsys.readouterr().out


def test_a_watch_checks_again_when_a_program_changes(
    cell: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first check comes at once, another one after each change of programs."""

    def one_change(*roots: Path, watch_filter: Callable[[object, str], bool], **_: object):  # type: ignore[no-untyped-def]
        assert (Path("cell"),) == roots
        assert [True, False] == [watch_filter(None, name) for name in ("x/A.SRC", "x/a.log")]
        yield set[tuple[str, str]]()  # it watches, and nothing has changed yet
        (cell / "a.src").write_text("DEF A()\nEND\n", encoding="utf-8")
        yield {("modified", "a.src")}

    watchfiles = pytest.importorskip("watchfiles")
    monkeypatch.setattr(watchfiles, "watch", one_change)
    assert 0 == main(["check", "--no-cache", "--watch", "cell"])
    said = [line for line in capsys.readouterr().err.splitlines() if "checked" in line]
    assert ["2 warnings, 2 notes", "1 warning, 1 note"] == [line.split(": ")[1] for line in said]
