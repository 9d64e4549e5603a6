"""A survey loses nothing, counts copies once, and says exactly where a file fails."""

import random
import shutil
import zipfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.survey import survey as survey_module
from recovery.survey.survey import Survey, survey, survey_texts
from recovery.survey.surveyed_files import SurveyedFile
from support.files.discovery import IngestError, discover

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)
GOOD = b"DEF A()\nHALT\nEND\n"
BAD = b"DEF B()\nSWITCH X\nEND\n"
LINES = (
    *("A=1", "X[1,2]=3", "IF A THEN", "ELSE", "ENDIF", "FOR I=1 TO 9 STEP 2", "ENDFOR"),
    *("SWITCH B", "CASE 1", "ENDSWITCH", "LOOP", "ENDLOOP", "LIN {X 1,Y 2} C_VEL", "?"),
    *('S="open', "", "  ; rest", "DEF N()", "END", "DEFDAT D", "ENDDAT"),
    *("\t\tPTP  HOME Vel=100", "&ACCESS RV", "é=§", "A=1 2 \0"),
)
LINE_ENDS = ("\n", "\r\n", "\r")


def lay(root: Path, files: dict[str, bytes]) -> Path:
    for name, data in files.items():
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
    return root


def zipped(file: Path, files: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(file, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return file


def surveyed(*roots: Path, jobs: int = 1, cache: Path | None = None) -> Survey:
    return survey(roots, PRELIMINARY, jobs=jobs, cache=cache)


def timeless(found: Survey) -> Survey:
    return replace(found, files=tuple(found.files), seconds=0)


def record_of(found: Survey) -> object:
    """What a survey says, whatever the numbers of its forms."""
    return found.skipped, [
        (f.places, f.size, [(replace(x, form=0), found.forms[x.form]) for x in f.failures])
        for f in found.files
    ]


def test_a_recogniser_that_has_grown_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process gives the same with a recogniser for each task, and keeps none that has grown."""
    text, contents = PRELIMINARY.text, (GOOD, BAD)
    survey_module._finder.cache_clear()
    kept = survey_module._read_contents(text, contents)
    known = survey_module._finder(text)
    assert kept == survey_module._read_contents(text, contents)
    assert known is survey_module._finder(text)
    monkeypatch.setattr(survey_module, "_MOST_STATES", 0)
    assert kept == survey_module._read_contents(text, contents)
    assert known is not survey_module._finder(text)


def only(found: Survey) -> SurveyedFile:
    (file,) = found.files
    return file


def where(file: SurveyedFile) -> list[tuple[int, int, str, str]]:
    """Line, column, token and source line of each failure."""
    return [(f.line, f.column, f.token, f.source) for f in file.failures]


def names(paths: Sequence[str], root: Path) -> list[str]:
    return [path.removeprefix(f"{root.as_posix()}/") for path in paths]


# ------------------------------------------------------------------------ nothing is lost


@pytest.fixture
def mixed(tmp_path: Path) -> Path:
    """A folder with everything that can happen to a candidate."""
    root = lay(
        tmp_path / "mixed",
        {
            "cell1/good.src": GOOD,
            "cell1/bad.SRC": BAD,
            "cell2/again.src": GOOD,
            "cell2/empty.sub": b"",
            "cell2/noise.dat": bytes(range(256)) * 8,
            "cell2/table.dat": b"1;2;3\n4;5;6\n",
            "cell2/page.src": b"<html></html>\n",
            "cell3/readme.txt": GOOD,
            "cell3/cut.zip": b"PK\x03\x04 and no more",
        },
    )
    zipped(root / "cell3" / "whole.zip", {"KRC/R1/a.src": GOOD, "KRC/R1/c.src": BAD + b"\n"})
    (root / "cell3" / "folder.src").mkdir()
    return root


def test_every_candidate_is_a_file_or_skipped(mixed: Path) -> None:
    """What discovery finds is in the survey exactly once, as a place of a file or as skipped."""
    found = surveyed(mixed)
    places = [path for file in found.files for path, _ in file.places]
    skipped = [s.path for s in found.skipped]
    assert sorted(item.path for item in discover([mixed])) == sorted(places + skipped)
    assert [
        "cell1/bad.SRC",
        "cell1/good.src",
        "cell2/again.src",
        "cell3/whole.zip/KRC/R1/a.src",
        "cell3/whole.zip/KRC/R1/c.src",
    ] == sorted(names(places, mixed))


def test_what_is_skipped_has_its_reason(mixed: Path) -> None:
    """Each skipped candidate is named, sorted, with its origin and one line that says why."""
    skipped = surveyed(mixed).skipped
    expected = {
        "cell2/empty.sub": "empty file",
        "cell2/noise.dat": "binary data",
        "cell2/page.src": "no KRL statement",
        "cell2/table.dat": "no KRL statement",
        "cell3/cut.zip": "truncated or damaged archive",
        "cell3/folder.src": "a folder",
    }
    assert list(expected) == names([s.path for s in skipped], mixed)
    for item, reason in zip(skipped, expected.values(), strict=True):
        assert item.reason.startswith(reason), item
        assert item.reason.isprintable()
        assert item.origin


def test_progress_reaches_its_end(mixed: Path) -> None:
    """The candidates announced are as many as are reported done."""
    announced: list[int] = []
    done: list[int] = []
    survey([mixed], PRELIMINARY, jobs=1, on_found=announced.append, on_done=done.append)
    assert [len(list(discover([mixed])))] == announced
    assert announced == [sum(done)]


def test_a_file_that_vanishes_is_skipped(tmp_path: Path) -> None:
    """A file that cannot be read any more when its turn comes is skipped; the others are not."""
    lay(tmp_path, {"a.src": GOOD, "b.src": BAD, "c.src": BAD + b"\n"})

    def remove(count: int) -> None:
        del count
        (tmp_path / "b.src").unlink()

    found = survey([tmp_path], PRELIMINARY, jobs=1, on_found=remove)
    assert ["a.src", "c.src"] == names([f.path for f in found.files], tmp_path)
    assert ["b.src"] == names([s.path for s in found.skipped], tmp_path)


def test_nothing_to_survey_is_an_error(tmp_path: Path) -> None:
    """A missing place, or one without any candidate, is refused rather than surveyed as empty."""
    with pytest.raises(IngestError, match="no such file or folder"):
        surveyed(tmp_path / "nowhere")
    with pytest.raises(IngestError, match=r"no \.src, \.dat or \.sub file"):
        surveyed(tmp_path)


# ---------------------------------------------------------------------------------- copies


def test_copies_are_read_once_and_counted_with_all_their_places(tmp_path: Path) -> None:
    """Equal bytes are one file with every place and origin; a byte more makes another."""
    lay(
        tmp_path,
        {"cell1/a.src": BAD, "cell2/b.sub": BAD, "cell2/sub/c.src": BAD, "cell3/d.src": BAD + b" "},
    )
    zipped(tmp_path / "backup.zip", {"KRC/R1/e.src": BAD})
    found = surveyed(tmp_path)
    shared, other = sorted(found.files, key=lambda f: -len(f.places))
    prefix = f"{tmp_path.as_posix()}/"
    assert {
        (f"{prefix}backup.zip/KRC/R1/e.src", "backup"),
        (f"{prefix}cell1/a.src", "cell1"),
        (f"{prefix}cell2/b.sub", "cell2"),
        (f"{prefix}cell2/sub/c.src", "cell2"),
    } == set(shared.places)
    assert shared.places[0][0] == shared.path
    assert ((f"{prefix}cell3/d.src", "cell3"),) == other.places
    assert [1, 1] == [len(shared.failures), len(other.failures)]


def test_copies_of_what_is_no_krl_are_all_skipped(tmp_path: Path) -> None:
    """A reason found once is given for every copy."""
    lay(tmp_path, {"a.src": b"1;2\n", "b.src": b"1;2\n", "c.src": GOOD})
    found = surveyed(tmp_path)
    assert ["a.src", "b.src"] == names([s.path for s in found.skipped], tmp_path)
    assert 1 == len({s.reason for s in found.skipped})


# --------------------------------------------------------------------------- the same survey


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """More files than one process is given at a time, failing in many ways, some of them copies."""
    chance = random.Random(7)
    root = tmp_path_factory.mktemp("many")
    programs = [
        "\n".join([f"DEF P{number}()", *chance.choices(LINES, k=chance.randint(0, 3)), "END", ""])
        for number in range(400)
    ]
    programs += programs[::20]
    named = {f"cell{n % 5}/p{n:03}.src": text.encode() for n, text in enumerate(programs)}
    return lay(root, named)


def test_processes_make_no_difference(many: Path) -> None:
    """One process and two give the same survey, to the numbering of forms."""
    assert timeless(surveyed(many)) == timeless(surveyed(many, jobs=2))


def test_the_order_of_roots_makes_no_difference(many: Path) -> None:
    """Roots are surveyed in an order of their own, and a place named twice counts once."""
    roots = sorted(many.iterdir())
    expected = timeless(surveyed(*roots))
    assert expected == timeless(surveyed(*reversed(roots)))
    assert expected == timeless(surveyed(*roots, *roots))


def test_results_kept_for_the_next_time_make_no_difference(many: Path, tmp_path: Path) -> None:
    """With a cache, cold, warm or half warm, the survey is as it is without."""
    expected = record_of(surveyed(many))
    surveyed(many / "cell1", many / "cell3", cache=tmp_path)
    assert expected == record_of(surveyed(many, cache=tmp_path))
    assert expected == record_of(surveyed(many, cache=tmp_path))


# ----------------------------------------------------------------------------- exact places


@pytest.mark.parametrize("end", LINE_ENDS)
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"], ids=["plain", "marked"])
def test_line_and_column_hold_for_every_line_end(tmp_path: Path, end: str, mark: bytes) -> None:
    """CRLF, LF and CR end a line alike, and a byte order mark is no part of the text."""
    text = end.join(["DEF A()", "", "\tA = 1", "  \tFOR I=1 TO 9  STEP 2", "ENDFOR", "END", ""])
    lay(tmp_path, {"a.src": mark + text.encode()})
    file = only(surveyed(tmp_path))
    assert [(4, 18, "STEP", "  \tFOR I=1 TO 9  STEP 2")] == where(file)
    assert text.split(end) == file.lines()


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "utf-16", "utf-32"])
def test_columns_count_characters_and_not_bytes(tmp_path: Path, encoding: str) -> None:
    """A letter that takes several bytes is one column in every encoding."""
    lay(tmp_path, {"a.src": 'DEF A()\nS="Größe" T\nEND\n'.encode(encoding)})
    assert [(2, 11, "T", 'S="Größe" T')] == where(only(surveyed(tmp_path)))


def test_an_endless_line_is_cut_but_its_column_is_right(tmp_path: Path) -> None:
    """What is kept of a line is short; where it fails is exact."""
    line = "A=" + "1+" * 4_000 + "1 B" + " C" * 4_000
    lay(tmp_path, {"a.src": f"DEF A()\n{line}\nEND\n".encode()})
    (failed,) = only(surveyed(tmp_path)).failures
    assert (2, line.index("B") + 1, "B") == (failed.line, failed.column, failed.token)
    assert line[: len(failed.source)] == failed.source
    assert len(failed.source) <= 1_000


def test_lines_are_not_shown_from_a_file_that_has_changed(tmp_path: Path) -> None:
    """The text around a failure comes from the bytes that were surveyed or from nowhere."""
    lay(tmp_path, {"a.src": BAD})
    file = only(surveyed(tmp_path))
    assert ["DEF B()", "SWITCH X", "END", ""] == file.lines()
    lay(tmp_path, {"a.src": GOOD})
    assert [] == file.lines()
    (tmp_path / "a.src").unlink()
    assert [] == file.lines()


def test_lines_come_from_archives_too(tmp_path: Path) -> None:
    """A member of an archive is read again like a file."""
    zipped(tmp_path / "a.zip", {"KRC/R1/a.src": BAD})
    assert ["DEF B()", "SWITCH X", "END", ""] == only(surveyed(tmp_path)).lines()


# ------------------------------------------------------------------------------ any text


PROGRAMS = st.lists(st.tuples(st.sampled_from(LINES), st.sampled_from(LINE_ENDS)), max_size=12)


@given(PROGRAMS)
def test_failures_lie_where_they_say(lines: list[tuple[str, str]]) -> None:
    """At most one failure a line, in order, each token at its line and column."""
    text = "".join(line + end for line, end in lines)
    file = only(survey_texts([("a.src", text)], PRELIMINARY))
    shown = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    numbers = [f.line for f in file.failures]
    # the end of the file may fail behind a line that failed already
    assert sorted(numbers) == numbers
    assert len({(f.line, f.column) for f in file.failures}) == len(numbers)
    for failed in file.failures:
        assert shown[failed.line - 1] == failed.source
        rest = failed.source[failed.column - 1 :]
        if failed.token.strip("\r\n"):
            assert rest.startswith(failed.token)
        else:  # the end of the line or of the file, behind what is no token
            assert RECOGNIZER.kinds(rest)[:-1] == []


@given(PROGRAMS)
def test_a_file_fails_exactly_where_it_is_no_program(lines: list[tuple[str, str]]) -> None:
    """Files without failures are the programs of the grammar, and the first failure is direct."""
    text = "".join(line + end for line, end in lines)
    file = only(survey_texts([("a.src", text)], PRELIMINARY))
    assert RECOGNIZER.accepts(text) == (not file.failures)
    assert not any(failed.follows for failed in file.failures[:1])


@given(st.binary(max_size=200), st.sampled_from([b"", b"DEF A()\n", b"\xff\xfe", b"PK\x03\x04"]))
def test_junk_is_a_result_and_no_error(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, head: bytes
) -> None:
    """Any bytes are surveyed or skipped, behind whatever they begin with."""
    root = tmp_path_factory.mktemp("junk")
    lay(root, {"a.src": head + data, "b.zip": head + data, "c.dat": GOOD})
    found = surveyed(root)
    assert 3 == sum(len(f.places) for f in found.files) + len(found.skipped)
    shutil.rmtree(root)


@pytest.mark.parametrize(
    "line",
    [
        "A=" + "(" * 2_000 + "1" + ")" * 2_000,
        "A=" + "(" * 2_000,
        "A=" + "-" * 5_000,
        "A" + ".B" * 5_000 + " C",
        "DECL INT " + ",".join("ABC" for _ in range(5_000)),
        "? " * 5_000,
        'A="' + "x" * 100_000,
    ],
    ids=["parentheses", "unclosed", "signs", "members", "names", "unknown", "string"],
)
def test_monstrous_lines_are_read(line: str) -> None:
    """A line far beyond what people write is a program or one failure, and takes no time."""
    file = only(survey_texts([("a.src", f"DEF A()\n{line}\nEND\n")], PRELIMINARY))
    assert RECOGNIZER.accepts(f"DEF A()\n{line}\nEND\n") == (not file.failures)
    assert {f.line for f in file.failures} <= {2}
