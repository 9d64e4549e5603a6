"""Checks of whole folders: files of projects checked in processes, kept, and left out."""

import random
import re
import shutil
import zipfile
from pathlib import Path

import pytest

from grammar.check.project import batch as module
from grammar.check.project import project_check
from grammar.check.project.batch import check_paths
from grammar.check.project.project_check import CheckOptions
from grammar.check.project.report import CheckReport
from grammar.diagnostics.diagnostic import Diagnostic
from support.files.discovery import FoundFile, IngestError, Skipped, read

CELL = Path(__file__).parents[4] / "corpus" / "programs" / "search_demo"
CALLER = "DEF CALLER()\nSHIFT(5)\nEXIT\nEND\n"
CALLED = "GLOBAL DEF SHIFT(N:IN)\nDECL INT N\n$OUT[N] = TRUE\nEND\n"
CONFIG = "DEFDAT $CONFIG\nENDDAT\n"


def lay(root: Path, **files: str) -> Path:
    """Programs in a folder; two underscores stand for a dot."""
    root.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (root / name.replace("__", ".")).write_text(text, encoding="utf-8", newline="\n")
    return root


def codes(found: CheckReport) -> list[tuple[str, int, str]]:
    return [
        (one.path.rpartition("/")[2], one.region.line, one.code)
        for one in found.diagnostics
        if not one.code.startswith("KRL7")
    ]


def check(root: Path, wanted: CheckOptions = CheckOptions(), **options: object) -> CheckReport:  # noqa: B008 - frozen
    return check_paths([root], wanted, **{"jobs": 1, **options})  # type: ignore[arg-type]


def test_files_of_a_folder_are_checked_together(tmp_path: Path) -> None:
    """A call is checked against a routine of another file."""
    root = lay(tmp_path, CALLER__src=CALLER.replace("5", "5, 6"), SHIFT__src=CALLED)
    found = check(root)
    assert [("CALLER.src", 2, "KRL301"), ("CALLER.src", 3, "KRL401")] == codes(found)
    assert (2, 1, 0) == (found.files, found.projects, found.unchanged)
    assert "EXIT" == [line for _, line in found.located()][1]


def test_projects_see_nothing_of_each_other(tmp_path: Path) -> None:
    """What one controller has does not help another."""
    for name, called in (("one", CALLED), ("two", CALLED.replace("N:IN", ""))):
        drive = tmp_path / "both" / name / "KRC" / "R1"
        lay(drive / "Program", CALLER__src=CALLER, SHIFT__src=called.replace("DECL INT N", ""))
        lay(drive / "System", config__dat=CONFIG)
    found = check(tmp_path / "both")
    assert 2 == found.projects
    wrong = {one.path.split("/")[-5] for one in found.diagnostics if one.code == "KRL301"}
    assert {"two"} == wrong


def test_local_variables_keep_their_types_without_a_data_list(tmp_path: Path) -> None:
    """The list that is missing may declare what is declared nowhere, and nothing else."""
    text = "DEF WORK()\n  DECL INT N\n  N = TRUE\n  N = IN_THE_LIST\n  MISSING()\nEND\n"
    found = check(lay(tmp_path, WORK__src=text))
    assert ("WORK.src", 3, "KSS1446") in codes(found)


def test_names_that_two_lists_declare(tmp_path: Path) -> None:
    """A list that a controller has twice is one finding, in the later file."""
    text = "DEFDAT $CONFIG PUBLIC\nDECL GLOBAL INT one=1\nDECL GLOBAL INT two=2\nENDDAT\n"
    for folder in ("Program", "System"):
        lay(tmp_path / "KRC" / "R1" / folder, **{"$config__dat": text})
    (found,) = check(tmp_path).diagnostics
    assert ("KRL104", 2) == (found.code, found.region.line)
    assert "one and 1 more are declared for everybody" in found.message
    assert "System" in found.path


def test_archives_are_checked(tmp_path: Path) -> None:
    """Members of an archive are files like others."""
    archive = tmp_path / "backup.zip"
    with zipfile.ZipFile(archive, "w") as into:
        into.writestr("KRC/R1/Program/CALLER.src", CALLER)
    assert [("CALLER.src", 3, "KRL401")] == codes(check(archive))


def test_processes_find_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However the files are dealt out, the findings are the same and in the same order."""
    files = {f"P{n}__src": CALLER.replace("CALLER", f"P{n}") for n in range(6)}
    root = lay(tmp_path, SHIFT__src=CALLED.replace("N:IN", ""), **files)
    alone = check(root)
    monkeypatch.setattr(module, "_LARGE", 0)
    shared = check(root, jobs=2)
    assert (alone, [*alone.located()]) == (shared, [*shared.located()])


def test_trees_that_are_not_kept_are_read_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A project too large for its trees to be kept gives the same findings."""
    root = lay(tmp_path, CALLER__src=CALLER, SHIFT__src=CALLED)
    whole = check(root)
    monkeypatch.setattr(project_check, "_MOST_KEPT", 0)
    assert [*whole.located()] == [*check(root).located()]


def test_unchanged_projects_are_not_checked_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was found is kept with its fixes and lines; a change in any file counts."""
    root = lay(tmp_path / "root", CALLER__src="DEF CALLER()\nN == 1\nEND\n", SHIFT__src=CALLED)
    first = check(root, cache=tmp_path / "cache")
    with monkeypatch.context() as broken:
        broken.setattr(module, "recheck", None)
        again = check(root, cache=tmp_path / "cache")
    assert [*first.located()] == [*again.located()]
    assert (0, 2) == (first.unchanged, again.unchanged)
    lay(root, SHIFT__src=CALLED.replace("END", "EXIT\nEND"))
    assert 1 == (changed := check(root, cache=tmp_path / "cache")).unchanged
    assert ("SHIFT.src", 4, "KRL401") in codes(changed)


def test_without_a_cache_nothing_is_computed_for_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What later checks would need to know of each file is left out, and nothing is missing."""
    root = lay(tmp_path / "root", CALLER__src=CALLER.replace("5", "5, 6"), SHIFT__src=CALLED)
    expected = codes(check(root, cache=tmp_path / "cache"))
    monkeypatch.setattr(project_check, "needs_of", None)
    assert expected == codes(check(root))
    monkeypatch.setattr(module, "_LARGE", 0)
    assert expected == codes(check(root, jobs=2))


def test_a_second_declaration_reaches_those_who_use_the_name(tmp_path: Path) -> None:
    """A program is checked again if another list declares what it uses with another type, too."""
    text = "DEFDAT SHARED PUBLIC\nDECL GLOBAL INT COUNT=1\n{}ENDDAT\n"
    root = lay(tmp_path, SHARED__dat=text.format(""), A__src="DEF A()\nCOUNT = TRUE\nEND\n")
    assert ("A.src", 2, "KSS1446") in codes(check(root, cache=tmp_path))
    lay(root, SHARED__dat=text.format("DECL GLOBAL BOOL COUNT=TRUE\n"))
    assert [("SHARED.dat", 3, "KRL104")] == codes(check(root, cache=tmp_path))


@pytest.mark.parametrize(("seed", "jobs"), [(0, 1), (1, 1), (2, 1), (3, 2)])
def test_what_is_kept_is_what_would_be_found(
    tmp_path: Path, seed: int, jobs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After any edits the findings with kept results are those of a check of everything."""
    monkeypatch.setattr(module, "_LARGE", 0 if jobs > 1 else 10**9)
    chance = random.Random(seed)
    root = tmp_path / "cell"
    shutil.copytree(CELL, root)
    files = sorted(root.rglob("*.[sd][rua][cbt]"))
    check(root, cache=tmp_path)
    for _ in range(1 if jobs > 1 else 6):
        edit(chance.choice(files), chance)
        found, fresh = check(root, cache=tmp_path, jobs=jobs), check(root)
        assert [*fresh.located()] == [*found.located()]


def edit(file: Path, chance: random.Random) -> None:
    """Remove a file, or a line, double one, or rename a word of the file throughout."""
    text = file.read_text(encoding="latin-1") if file.exists() else "DEF NEW()\nEND\n"
    lines = text.split("\n")
    at = chance.randrange(len(lines))
    match chance.randrange(6):
        case 0:
            file.unlink(missing_ok=True)
            return
        case 1:
            del lines[at]
        case 2:
            lines.insert(at, chance.choice(lines))
        case _:
            word = chance.choice(re.findall(r"[A-Za-z]\w+", text))
            lines = text.replace(word, f"{word}X").split("\n")
    file.write_text("\n".join(lines), encoding="latin-1", newline="")


def test_other_wishes_are_other_findings(tmp_path: Path) -> None:
    """What was kept for one wish is no answer to another."""
    root = lay(tmp_path / "root", A__src="DEF A()\nHALT\nEXIT\nEND\n")
    for wanted, expected in (
        (CheckOptions(), ["KRL401"]),
        (CheckOptions(stops=True), ["KRL601", "KRL401"]),
        (CheckOptions(syntax_only=True), []),
    ):
        assert expected == [code for _, _, code in codes(check(root, wanted, cache=tmp_path))]


@pytest.mark.parametrize("damage", [b"", b"junk", b"SQLite format 3\0junk"])
def test_a_damaged_cache_is_no_harm(tmp_path: Path, damage: bytes) -> None:
    """What cannot be read is worked out again."""
    root = lay(tmp_path / "root", A__src="DEF A()\nEXIT\nEND\n")
    (tmp_path / "results.sqlite").write_bytes(damage)
    assert [("A.src", 2, "KRL401")] == codes(check(root, cache=tmp_path))


def test_what_is_no_program_is_left_out(tmp_path: Path) -> None:
    """Other files are named with their reason, and the rest is checked."""
    root = lay(tmp_path, A__src="DEF A()\nEXIT\nEND\n", EMPTY__src="", LOG__dat="some text\n")
    (root / "PICTURE.dat").write_bytes(bytes(range(256)) * 9)
    found = check(root)
    assert [("A.src", 2, "KRL401")] == codes(found)
    assert 1 == found.files
    assert ["EMPTY.src", "LOG.dat", "PICTURE.dat"] == [
        one.path.rpartition("/")[2] for one in found.skipped
    ]


@pytest.mark.parametrize("limited", ["support.files.archives.MAX_FILE_BYTES", "{}.LARGEST"])
def test_files_that_are_too_large_may_use_any_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, limited: str
) -> None:
    """They are findings, and what is declared by a slip may be used there."""
    program = "DEF A()\n" + "RECEIVED = 1\n" * 5 + "END\n"
    data = "DEFDAT B PUBLIC\nDECL GLOBAL INT RECIEVED=0\nENDDAT\n"
    root = lay(tmp_path, A__src=program, B__dat=data)
    assert [("B.dat", 2, "KRL101")] == codes(check(root))
    lay(root, C__src="DEF C()\n" + "HALT\n" * 100 + "END\n")
    monkeypatch.setattr(limited.format(project_check.__name__), 200)
    assert [("C.src", 1, "KRL003")] == codes(check(root))


def test_syntax_failures_are_reported_and_the_rest_is_checked(tmp_path: Path) -> None:
    """A file that cannot be read does not keep others from being checked."""
    root = lay(tmp_path, A__src="DEF A()\nIF 1\nEND\n", B__src="DEF B()\nEXIT\nEND\n")
    assert [("A.src", 2, "KRL001"), ("B.src", 2, "KRL401")] == codes(check(root))
    only_syntax = check(root, CheckOptions(syntax_only=True))
    assert [("A.src", 2, "KRL001")] == codes(only_syntax)


def test_comments_silence(tmp_path: Path) -> None:
    """A comment silences findings of its line, those about whole projects too."""
    text = "DEF A()\nEXIT ; krl: ignore[KRL401]\nB() ; krl: ignore[KRL701]\nEND\n"
    assert () == check(lay(tmp_path, A__src=text)).diagnostics


def test_progress_reaches_the_end(tmp_path: Path) -> None:
    """Every candidate is counted once, those left out too."""
    root = lay(tmp_path, A__src=CALLED, EMPTY__src="", B__src="DEF B()\nEND\n")
    told: list[int] = []
    done: list[int] = []
    check(root, on_found=told.append, on_done=done.append)
    assert [3] == told
    assert 3 == sum(done)


def test_a_project_is_done_before_the_next_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Progress goes by projects, and memory holds one of them, however many there are."""
    for name in ("one", "two", "three"):
        lay(tmp_path / "all" / name / "KRC" / "R1" / "Program", SHIFT__src=CALLED)
    events: list[str] = []

    def reading(found: FoundFile) -> bytes | Skipped:
        events.append("read")
        return read(found)

    monkeypatch.setattr(module, "read", reading)
    check(tmp_path / "all", on_done=lambda number: events.append("done") if number else None)
    assert ["read", "done"] * 3 == events


def test_nothing_to_check_is_said(tmp_path: Path) -> None:
    """A folder without programs is an error of who named it."""
    with pytest.raises(IngestError):
        check(tmp_path)


def test_a_hidden_folder_is_checked_where_it_is_asked_for(tmp_path: Path) -> None:
    """What is around does not show it, be there a program in it or none."""
    root = lay(tmp_path / "root", A__src="DEF A()\nEND\n")
    hidden = lay(root / ".kept", B__src="DEF B()\nEXIT\nEND\n", C__src="")
    found = check(hidden, around=[root])
    assert [("B.src", 2, "KRL401")] == codes(found)
    assert ["C.src"] == [Path(one.path).name for one in found.skipped]
    assert 1 == check(root).files


def test_findings_name_their_files_as_given(tmp_path: Path) -> None:
    """Paths have slashes and begin with what was named."""
    root = lay(tmp_path / "root", A__src="DEF A()\nEXIT\nEND\n")
    (found,) = check(root).diagnostics
    assert isinstance(found, Diagnostic)
    assert f"{root.as_posix()}/A.src" == found.path


def test_a_head_that_cannot_be_read_is_one_finding(tmp_path: Path) -> None:
    """What is left of a counter in a damaged head is no unknown name besides."""
    text = (
        "DEF A()\n  INT COUNTER\n  FOR COUNTE?R = 1 TO 3\n    HALT\n  ENDFOR\n  COUNTER = 1\nEND\n"
    )
    found = check(lay(tmp_path, A__src=text)).diagnostics
    assert ["KRL001"] == [one.code for one in found if one.region.line == 3]


def test_arrays_may_be_parameters_of_a_head_that_cannot_be_read(tmp_path: Path) -> None:
    """An array without a size that the damaged first line of its routine names is a parameter."""
    text = "DEF A(B[]:IN IN, C[]:OUT)\n  DECL CHAR B[], C[], D[]\n  C[] = B[]\nEND\n"
    found = check(lay(tmp_path, A__src=text)).diagnostics
    assert ["the array D needs a size for each dimension"] == [
        one.message for one in found if one.code == "KSS2086"
    ]


def test_a_function_that_is_cut_off_may_have_its_return_behind(tmp_path: Path) -> None:
    """That the file ends is one finding."""
    text = "DEFFCT INT F()\n  INT N\n  N = 1\n  IF N == ("
    found = check(lay(tmp_path, F__src=text)).diagnostics
    assert ["KRL001"] == [one.code for one in found if one.severity != "note"]
