"""Names, findings and settings in an editor, asked of the open project without a server."""

import io
import json
import subprocess
import sys
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("lsprotocol")

from grammar.check.project.batch import CheckOptions, check_paths
from grammar.check.project.framework import Checked, check_module
from grammar.diagnostics.diagnostic import Region
from grammar.semantics.link import Project
from grammar.semantics.scopes import Module
from grammar.syntax.source import Source
from krl.cli import main
from krl.commands.bench.editor_messages import tabs
from krl.commands.lsp import Bounded
from krl.language_server import workspace
from krl.language_server.calls import argument_hints, signature_at
from krl.language_server.hover import hover
from krl.language_server.names import (
    RenameError,
    completions,
    places,
    renaming,
)
from krl.language_server.protocol import _wide, characters, range_of
from krl.language_server.server import server
from krl.language_server.workspace import OpenProject

PROGRAM = """DEF CELL()
  INT N
  N = PARTS
  SPOT.X = 1
  BASE_OF = #EMPTY
  FETCH(PARTS)
END

GLOBAL DEF FETCH(COUNT:IN)
  INT COUNT
  $OUT[COUNT] = TRUE
END
"""
DATA = """DEFDAT CELL
  ENUM STATES EMPTY, FULL
  DECL STATES BASE_OF
  DECL FRAME SPOT
  DECL INT PARTS=8
  DECL FRAME SPOTS[9]
ENDDAT
"""
OTHER = "DEF OTHER()\n  INT PARTS\n  PARTS = 1\n  FETCH(PARTS)\nEND\n"


@pytest.fixture
def project(tmp_path: Path) -> OpenProject:
    """Three files, none of them on the disk."""
    made = OpenProject()
    for name, text in (("CELL.src", PROGRAM), ("CELL.dat", DATA), ("OTHER.src", OTHER)):
        made.change(f"{tmp_path.as_posix()}/{name}", text)
    return made


def listed(project: OpenProject, file: str, word: str, name: str | None = None) -> list[str]:
    """File and line of all places of a word, or of those to write a name at."""
    path = next(one for one in project.paths() if one.endswith(file))
    looked = project.look(path)
    assert looked is not None
    offset = looked.source.text.index(word)
    if name is None:
        found = places(project, looked, offset)
    else:
        found = renaming(project, looked, offset, name)
    return [f"{at.rpartition('/')[2]}:{region.line}" for at, region in found]


def offered(project: OpenProject, line: str) -> list[str]:
    """What can be written at the end of a line in CELL, behind its first declaration."""
    path = next(one for one in project.paths() if one.endswith("CELL.src"))
    project.change(path, PROGRAM.replace("  INT N\n", f"  INT N\n{line}\n"))
    looked = project.look(path)
    assert looked is not None
    return [one.name for one in completions(looked, looked.source.text.index(line) + len(line))]


def test_places_of_a_name_are_those_of_its_declaration(project: OpenProject) -> None:
    """A variable of the data list has its places there, and none where another one has the name."""
    assert ["CELL.dat:5", "CELL.src:3", "CELL.src:6"] == listed(project, "CELL.src", "PARTS")
    assert ["OTHER.src:2", "OTHER.src:3", "OTHER.src:4"] == listed(project, "OTHER.src", "PARTS")


def test_a_change_leaves_other_projects_as_they_are(tmp_path: Path) -> None:
    """Typing links and asks the files of one project, not all that are at hand."""
    made = OpenProject()
    paths = [f"{tmp_path.as_posix()}/{n}/KRC/R1/Program/OTHER.src" for n in "AB"]
    for path in paths:
        made.change(path, OTHER)
    assert paths == list(made.catch_up())
    linked = [looked.project for path in paths if (looked := made.look(path))]
    made.change(paths[0], OTHER.replace("INT", "REAL"))
    assert paths[:1] == list(made.catch_up())
    again = [looked.project for path in paths if (looked := made.look(path))]
    assert [False, True] == [one is other for one, other in zip(again, linked, strict=True)]


def test_a_line_that_cannot_be_read_hides_no_place(project: OpenProject) -> None:
    """Its name keeps its other places, and is not renamed, as that line would keep the old one."""
    path = next(one for one in project.paths() if one.endswith("CELL.src"))
    project.change(path, PROGRAM.replace("  INT N\n", "  INT N\n  IF PARTS == == N THEN\n"))
    assert {"CELL.dat:5", "CELL.src:4"} <= {*listed(project, "CELL.src", "PARTS\n")}
    with pytest.raises(RenameError, match="cannot be read"):
        listed(project, "CELL.src", "PARTS\n", "PIECES")


def test_empty_file_has_no_findings(tmp_path: Path) -> None:
    """A file without KRL is no program, as in a check, until something is written into it."""
    made = OpenProject()
    path = f"{tmp_path.as_posix()}/new.src"
    for text, count in (("", 0), ("DEF new ( )\nIF\nEND\n", 1), ("; later\n", 0)):
        made.change(path, text)
        looked = made.look(path)
        assert looked is not None
        assert count == len(looked.diagnostics)


@pytest.mark.parametrize(
    ("paths", "count"),
    [
        (("a/one.src", "b/two.src"), 1),
        (("other.src", "a/one.src", "a/x/two.src", "b/one.src"), 3),
    ],
)
def test_projects_are_those_of_a_check(tmp_path: Path, paths: tuple[str, ...], count: int) -> None:
    """Folders that call one another are one project, copies are not."""
    for path in paths:
        (file := tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        call = "lost" if path == "other.src" else "two"
        file.write_text(f"DEF {file.stem} ( )\n{call} ( )\nEND\n", "utf-8")
    made = OpenProject()
    looked = [made.look(path) for path in [*made.add_folder(tmp_path)]]
    assert len(paths) == len(looked)
    assert count == len({one.project for one in looked if one})


def test_a_routine_is_renamed_in_all_files(project: OpenProject) -> None:
    """Its head and its calls are written anew."""
    assert ["CELL.src:6", "CELL.src:9", "OTHER.src:4"] == listed(
        project, "OTHER.src", "FETCH", "BRING"
    )


@pytest.mark.parametrize(
    ("word", "name", "said"),
    [
        ("PARTS", "1ST", "is no name"),
        ("PARTS", "A" * 25, "is no name"),
        ("PARTS", "endfor", "endfor is a keyword"),
        ("PARTS", "COUNT", "has a COUNT already"),
        ("PARTS", "FETCH", "has a FETCH already"),
        ("CELL", "ROOM", "named as its file"),
        ("$OUT", "X", "no file of the project declares it"),
    ],
)
def test_a_name_that_cannot_be_is_refused(
    project: OpenProject, word: str, name: str, said: str
) -> None:
    """The reason is told: no name, a name that is taken, a routine named as its file."""
    with pytest.raises(RenameError, match=said):
        listed(project, "CELL.src", word, name)


@pytest.mark.parametrize(
    ("line", "expected", "missing"),
    [
        ("  PA", {"N", "PARTS", "$OUT", "ABS", "FRAME", "LOOP"}, {"COUNT", "EMPTY", "ENDLOOP"}),
        ("  IF N==1 TH", {"THEN", "AND"}, {"LOOP", "TO"}),
        ("AGAIN:\n  GOTO A", {"AGAIN"}, {"N", "LOOP"}),
        ("  N = 1 ; the PA", set(), {"N", "LOOP"}),
        ('  TEXT[] = ";" + "PA', set(), {"N", "LOOP"}),
        ('  F("; A", PA', {"N"}, set()),
        ("  BASE_OF = #", {"EMPTY", "FULL"}, {"N", "PARTS", "BASE", "JOINT"}),
        ("  IF BASE_OF <> #", {"EMPTY", "FULL"}, {"N", "PARTS", "BASE", "JOINT"}),
        ("  $IPO_MODE=#B", {"BASE", "TCP"}, {"EMPTY", "JOINT"}),
        ("  FETCH(#", {"EMPTY", "FULL", "BASE", "JOINT"}, {"N", "PARTS"}),
        ("  SPOT.", {"X", "Y", "Z", "A", "B", "C"}, {"N", "S"}),
        ("  SPOTS[SPOT.X].", {"X", "Y", "Z", "A", "B", "C"}, {"N", "S"}),
        ("  SPOTS[SPOTS[1].X].", {"X", "Y", "Z", "A", "B", "C"}, {"N", "S"}),
        ("  N = SPOTS[SPOT.", {"X", "Y", "Z", "A", "B", "C"}, {"N", "S"}),
    ],
)
def test_what_can_be_written_is_offered(
    project: OpenProject, line: str, expected: set[str], missing: set[str]
) -> None:
    """What the grammar has there and names that are seen; constants, members, labels alone."""
    found = offered(project, line)
    assert set() == expected - set(found)
    assert set() == missing & set(found)
    assert len(found) == len({one.upper() for one in found})


def test_hover_explains_a_finding(project: OpenProject) -> None:
    """The number of the controller's message stands beside what the name is."""
    path = next(one for one in project.paths() if one.endswith("CELL.src"))
    project.change(path, PROGRAM.replace("#EMPTY", "#EMTY"))
    looked = project.look(path)
    assert looked is not None
    said = hover(project, looked, looked.source.text.index("#EMTY") + 1)
    assert said is not None
    assert "message of the controller: 2296" in said[0]


SLIPS = {
    "RESETCLOK": "DEF RESETCLOK()\nEND\n",
    "USER": "DEF USER()\nRESETCLOK()\nEND\n",
    "ALONE": "DEF ALONE()\nHALT\nEND\n",
    "CALLS": "DEF CALLS()\n" + "RESETCLOCK()\n" * 4 + "END\n",
}


def graded(project: OpenProject, folder: Path, name: str) -> set[str]:
    """The severities of what is said of unknown routines in a file."""
    looked = project.look(f"{folder.as_posix()}/{name}.src")
    assert looked is not None
    return {one.severity for one in looked.diagnostics if "RESETCLOCK" in one.message}


def test_names_have_the_grade_of_the_project(tmp_path: Path) -> None:
    """Nothing is said before all files were asked; then what another file uses is no slip.

    Once that file no longer uses it, it is one, where it is declared.
    """
    project = OpenProject()
    for name, text in SLIPS.items():
        project.change(f"{tmp_path.as_posix()}/{name}.src", text)
    assert set() == graded(project, tmp_path, "CALLS")
    assert {*project.paths()} >= {*project.catch_up()}
    assert {"note"} == graded(project, tmp_path, "CALLS")
    project.change(f"{tmp_path.as_posix()}/USER.src", "DEF USER()\nEND\n")
    assert f"{tmp_path.as_posix()}/ALONE.src" not in [*project.catch_up()]
    assert {"warning"} == graded(project, tmp_path, "RESETCLOK")
    assert [] == [*project.catch_up()]
    project.forget(f"{tmp_path.as_posix()}/RESETCLOK.src")  # others still refer to it for a while
    assert {"warning"} != graded(project, tmp_path, "CALLS")


def test_archives_beside_files(tmp_path: Path) -> None:
    """Files that lie around an archive of several cells are one project all the same."""
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("KRC/R1/cell.src", "DEF CELL()\nEND\n")
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("one.zip", inner.getvalue())
        archive.writestr("two.zip", inner.getvalue())
    (tmp_path / "sub").mkdir()
    (tmp_path / "grip.src").write_text("DEF GRIP()\nEND\n", encoding="utf-8")
    (tmp_path / "sub/main.src").write_text("DEF MAIN()\nGRIP()\nEND\n", encoding="utf-8")
    project = OpenProject()
    assert 2 == len([*project.add_folder(tmp_path)])
    looked = project.look((tmp_path / "sub/main.src").as_posix())
    assert looked is not None
    assert "KRL701" not in {one.code for one in looked.diagnostics}


def test_an_editor_finds_what_a_check_finds(tmp_path: Path) -> None:
    """Of each file of a folder that is part of a backup, and of a second cell in another folder."""
    for name, text in (
        ("KRC/R1/System/$config.dat", "DEFDAT $CONFIG\nDECL INT PARTS\nENDDAT\n"),
        ("KRC/R1/Program/cell.src", "DEF CELL()\nPARTZ = 1\nPARTS = 2\nGRIP()\nEND\n"),
        ("KRC/R1/Program/grip.src", "DEF GRIP()\nINTERRUPT DECL 3 WHEN $IN[1] DO CELL()\nEND\n"),
    ):
        for cell in ("one", "two"):
            path = tmp_path / cell / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
    project = OpenProject()
    assert 6 == len([*project.add_folder(tmp_path)])
    begun = project.catch_up()
    assert 3 == len([next(begun) for _ in range(3)])  # one of the cells
    project.forget((tmp_path / "two/KRC/R1/Program/grip.src").as_posix())
    assert [] == [*begun]  # what has changed meanwhile is not to be relied on
    project.reload((tmp_path / "two/KRC/R1/Program/grip.src").as_posix())
    assert 3 == len([*project.catch_up()])
    told = [one for path in project.paths() for one in project.look(path).diagnostics]  # type: ignore[union-attr]
    checked = check_paths([tmp_path], CheckOptions(), jobs=1).diagnostics
    assert {"KRL101", "KRL504"} & {one.code for one in checked}
    assert [(one.code, one.severity, one.region) for one in checked] == [
        (one.code, one.severity, one.region) for one in told
    ]


def test_settings_count_in_an_editor(project: OpenProject, tmp_path: Path) -> None:
    """A finding that `krl.toml` turns off is not shown; one line that fails costs no other."""
    path = next(one for one in project.paths() if one.endswith("OTHER.src"))
    text = OTHER.replace("PARTS = 1", "PARTS == 1\n  EXIT")
    project.change(path, text)
    looked = project.look(path)
    assert looked is not None
    assert ["KRL001", "KRL401"] == [one.code for one in looked.diagnostics]
    (tmp_path / "krl.toml").write_text('ignore = ["KRL4"]', encoding="utf-8")
    project.changed()
    looked = project.look(path)
    assert looked is not None
    assert ["KRL001"] == [one.code for one in looked.diagnostics]


def test_what_is_agreed_on_counts_as_in_a_check(project: OpenProject, tmp_path: Path) -> None:
    """A file that is left out has no findings and declares nothing; known findings are not shown.

    What is known is what `krl check --write-baseline` wrote.
    """
    (tmp_path / "A.src").write_text("DEF A()\n  FETCH(1)\n  LOST = 1\nEND\n", encoding="utf-8")
    (tmp_path / "OTHER.src").write_text("DEF OTHER()\n  LOST = 2\nEND\n", encoding="utf-8")
    project.reload((tmp_path / "A.src").as_posix())
    assert [] != codes(project, "A.src")
    main(["check", str(tmp_path / "A.src"), "--write-baseline", str(tmp_path / "known.json")])
    settings = 'exclude = ["OTHER.src"]\nbaseline = "known.json"\n'
    (tmp_path / "krl.toml").write_text(settings, encoding="utf-8")
    project.changed()
    assert [] == codes(project, "A.src")
    assert [] == codes(project, "OTHER.src")
    assert "OTHER" not in offered(project, "  O")


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ('ignore = "KRL4"', "ignore must be a list of texts"),
        ('ignore = ["KRL4"]\nbaseline = "lost.json"', "lost.json: No such file or directory"),
    ],
)
def test_settings_that_a_check_refuses_are_told(
    project: OpenProject, tmp_path: Path, settings: str, reason: str
) -> None:
    """An editor says so of the file of settings, until they can be used."""
    file = tmp_path / "krl.toml"
    file.write_text(settings, encoding="utf-8")
    project.changed_on_disk(file.as_posix(), ())
    project.look(project.paths()[0])
    assert [file] == [*project.refused]
    assert reason in project.refused[file]
    file.write_text("", encoding="utf-8")
    project.changed_on_disk(file.as_posix(), ())
    project.look(project.paths()[0])
    assert {} == project.refused


def test_a_folder_that_goes_takes_its_files_along(tmp_path: Path) -> None:
    """The editor tells the folder alone; what is shown keeps the text of the editor."""
    for name in ("A", "B"):
        place = tmp_path / "old" / f"{name}.Src"
        place.parent.mkdir(exist_ok=True)
        place.write_text(f"DEF {name}()\nEND\n", encoding="utf-8")
    project, old, new = OpenProject(), tmp_path / "old", tmp_path / "new"
    assert 2 == len([*project.add_folder(tmp_path)])
    old.rename(new)
    for folder in (old, new):
        project.changed_on_disk(folder.as_posix(), {f"{old.as_posix()}/B.Src"})
    left = [*map(Path, project.paths())]
    assert [new / "A.Src", new / "B.Src", old / "B.Src"] == left
    project.changed_on_disk((tmp_path / "note.txt").as_posix(), ())
    assert left == [*map(Path, project.paths())]


def codes(project: OpenProject, file: str) -> list[str]:
    looked = project.look(next(one for one in project.paths() if one.endswith(file)))
    assert looked is not None
    return [one.code for one in looked.diagnostics]


@pytest.mark.parametrize(
    ("line", "label", "active"),
    [
        ("  FETCH(", "DEF FETCH(COUNT:IN INT)", 0),
        ("  FETCH(ABS(N), SPOT.X, ", "DEF FETCH(COUNT:IN INT)", 2),
        ("  N = ABS(PARTS+(1", "ABS", 0),
        ('  FETCH("a, b(", {X 1, Y', "DEF FETCH(COUNT:IN INT)", 1),
        ("  SPOT = {X 1, Y ", None, 0),
        ("  FETCH(1) ; FETCH(", None, 0),
        ("  N = (", None, 0),
        ("  NOWHERE(", None, 0),
    ],
)
def test_a_routine_shows_its_parameters(
    project: OpenProject, line: str, label: str | None, active: int
) -> None:
    """Also in a line that cannot be read yet; signs in texts and comments are none."""
    path = next(one for one in project.paths() if one.endswith("CELL.src"))
    project.change(path, PROGRAM.replace("  INT N\n", f"  INT N\n{line}\n"))
    looked = project.look(path)
    assert looked is not None
    found = signature_at(looked, looked.source.text.index(line) + len(line))
    assert (label is None) == (found is None)
    if found is not None and label is not None:
        assert label in found.label
        assert active == found.active


def test_parameters_without_names(project: OpenProject) -> None:
    """EXT has types in their places: they get no hint, and the help shows the types."""
    path = next(one for one in project.paths() if one.endswith("CELL.src"))
    changed = PROGRAM.replace("  INT N\n", "  EXT MOVE(INT:IN, REAL:OUT)\n  INT N\n  MOVE(N, 2)\n")
    project.change(path, changed)
    looked = project.look(path)
    assert looked is not None
    assert [] == list(argument_hints(looked, 1, 5))
    found = signature_at(looked, changed.index("MOVE(N") + 5)
    assert found is not None
    assert ("INT:IN", "REAL:OUT") == found.parameters
    assert "DEF MOVE(INT:IN, REAL:OUT)" == found.label


def message(**fields: object) -> bytes:
    body = json.dumps({"jsonrpc": "2.0", **fields}).encode()
    return b"Content-Length: %d\r\n\r\n%s" % (len(body), body)


def test_the_server_mends_completes_and_ends(tmp_path: Path) -> None:
    """Code actions and completion are answered; it ends quietly when it is told to.

    Settings that cannot be used are told of their file.
    """
    (tmp_path / "krl.toml").write_text("ignore = 1", encoding="utf-8")
    uri = (tmp_path / "A.src").as_uri()
    text = "DEF A()\n  INT N\n  IF N = 1 THEN\n  ENDIF\n  $VEL.CB = 1\nEND\n"
    place = {"line": 2, "character": 2}
    document = {"uri": uri}
    said = b"".join(
        [
            message(id=1, method="initialize", params={"capabilities": {}, "processId": None}),
            message(method="initialized", params={}),
            message(
                method="textDocument/didOpen",
                params={
                    "textDocument": {"uri": uri, "languageId": "krl", "version": 1, "text": text}
                },
            ),
            message(
                id=2,
                method="textDocument/codeAction",
                params={
                    "textDocument": document,
                    "range": {"start": place, "end": {"line": 4, "character": 0}},
                    "context": {"diagnostics": []},
                },
            ),
            message(
                id=3,
                method="textDocument/completion",
                params={"textDocument": document, "position": place},
            ),
            message(id=4, method="shutdown"),
            message(method="exit"),
        ]
    )
    command = [sys.executable, "-m", "krl", "lsp"]
    done = subprocess.run(command, input=said, capture_output=True, check=False)
    assert (0, b"") == (done.returncode, done.stderr)
    assert b'"newText":"=="' in done.stdout.replace(b": ", b":")
    assert b"ignore KRL001 here" in done.stdout
    assert b"krl.toml: ignore must be a list of texts" in done.stdout
    assert b"write CP" in done.stdout
    assert b'"label":"$OUT"' in done.stdout.replace(b": ", b":")


def test_hover_over_a_word_of_two_statements_begins_with_its_own(project: OpenProject) -> None:
    path = next(one for one in project.paths() if one.endswith("CELL.src"))
    project.change(path, PROGRAM.replace("  INT N\n", "  INT N\n  FOR N = 1 TO 2\n  ENDFOR\n"))
    looked = project.look(path)
    assert looked is not None
    said = hover(project, looked, looked.source.text.index("FOR"))
    assert said is not None
    assert "WAIT FOR" not in said[0].split("**")[2]


def test_a_line_is_looked_through_once_for_all_its_columns() -> None:
    """A line with letters beyond ASCII is no dearer for the many names in it."""
    source = Source("I=1" + "+I" * 500 + " ; ä𝄞", "a.src")
    before = _wide.cache_info().misses
    for place in range(1, 1000):
        range_of(source, Region(1, place, 1, place + 1))
    assert before + 1 == _wide.cache_info().misses


def test_a_tab_that_is_opened_is_checked_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Opening a file checks it once, and not all that are open with it again."""
    checked: list[str] = []

    def counted(project: Project, module: Module, source: Source) -> Checked:
        checked.append(source.path)
        return check_module(project, module, source)

    monkeypatch.setattr(workspace, "check_module", counted)
    for number in range(20):
        (tmp_path / f"A{number}.src").write_text(f"DEF A{number}()\nEND\n", encoding="ascii")
    with suppress(SystemExit):
        messages: Any = Bounded(io.BytesIO(tabs(tmp_path)))
        server().start_io(messages, io.BytesIO())
    assert 20 == len({*checked})
    assert len(checked) <= 60


@pytest.mark.parametrize("line", ["HALT ; all", "HALT ; ä", "HALT ; 𝄞 and 𝄞𝄞"])
def test_columns_are_code_units(line: str) -> None:
    """An editor counts a character beyond the basic plane twice; its columns lead back to ours."""
    source = Source(line, "a.src")
    units = [1 + (character > "\uffff") for character in line]
    for place in range(len(line) + 1):
        found = range_of(source, Region(1, place + 1, 1, len(line) + 1))
        wanted = (sum(units[:place]), sum(units))
        assert wanted == (found.start.character, found.end.character)
        assert place == characters(line, found.start.character)
