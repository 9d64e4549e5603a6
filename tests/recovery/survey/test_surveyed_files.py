"""Files of a survey that parse are on disk, not in memory."""

import gc
import subprocess
import sys
from pathlib import Path

import pytest

from grammar.notation import g4
from recovery.survey.failing_line import FailingLine
from recovery.survey.survey import survey
from support.files.discovery import FoundFile

PRELIMINARY = g4.read_file(Path(g4.__file__).parents[1].joinpath("preliminary.g4"))

WITHOUT_ROOM = """
import resource, sys
from krl.cli import main
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
sys.exit(main(["recover", "--no-start", "--jobs", "1", sys.argv[1]]))
"""


def test_files_that_parse_are_not_kept_in_memory(tmp_path: Path) -> None:
    """After a survey, memory holds one file with failures and none of those that parse."""
    for number in range(50):
        (tmp_path / f"p{number}.src").write_text(f"DEF P{number}()\nEND\n", encoding="utf-8")
    (tmp_path / "bad.src").write_text("DEF BAD()\nGOTO X\nEND\n", encoding="utf-8")
    found = survey([tmp_path], PRELIMINARY, jobs=1)
    assert 51 == len(found.files)
    assert ["bad.src"] == [file.found.file.name for file in found.failing]
    gc.collect()
    assert 1 == sum(isinstance(one, FoundFile) for one in gc.get_objects())


def test_failing_lines_are_not_kept_in_memory(tmp_path: Path) -> None:
    """They are read when they are looked at, also when only the file of them is left."""
    lines = "".join(f"GOTO X{number}\n" for number in range(50))
    (tmp_path / "bad.src").write_text(f"DEF BAD()\n{lines}END\n", encoding="utf-8")
    (bad,) = survey([tmp_path], PRELIMINARY, jobs=1).failing
    gc.collect()
    assert not any(isinstance(one, FailingLine) for one in gc.get_objects())
    assert 50 == len(bad.failures)
    assert [f"GOTO X{number}" for number in range(50)] == [one.source for one in bad.failures]


def test_names_that_are_no_text_come_back(tmp_path: Path) -> None:
    """A name with bytes that are no UTF-8 is found again when the file is read anew."""
    file = tmp_path / "p\udcff\n.src"
    try:
        file.write_text("DEF P()\nEND\n", encoding="utf-8")
    except (OSError, UnicodeError):
        pytest.skip("this system has no such names")
    (one,) = survey([tmp_path], PRELIMINARY, jobs=1).files
    assert file == one.found.file
    assert ["DEF P()", "END", ""] == one.lines()


@pytest.mark.skipif(sys.platform == "win32", reason="files have no limit there")
def test_no_room_for_temporary_files_is_one_line(tmp_path: Path) -> None:
    """Where the disk is full, status is 2 with one line that says so."""
    deep = tmp_path.joinpath(*["x" * 200] * 4)
    deep.mkdir(parents=True)
    for number in range(2_000):
        (deep / f"p{number}.src").write_bytes(b"x")
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_ROOM, str(tmp_path)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert 2 == done.returncode
    assert done.stderr.startswith("krl: temporary files cannot be written: ")
    assert 1 == done.stderr.count("\n")
