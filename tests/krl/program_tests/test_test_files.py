"""Test files are read, and what is wrong with them is told in one line."""

from collections.abc import Callable
from pathlib import Path

import pytest

from krl.program_tests.test_files import TestFileError, is_test_file, read_tests

Write = Callable[[str], Path]
GOOD = "[[test]]\nname = 'x'\nexpect = ['out 1 TRUE']\n"

WRONG = [
    ("[[test]]\nname = 'x'\nexpekt = []\n", "3: expekt is not a key here"),
    ("cycle = 1\n" + GOOD, "1: cycle is not a key here"),
    ("[[tests]]\nname = 'x'\n", "1: tests is not a key here"),
    ("[[test]]\nexpect = ['out 1 TRUE']\n", "1: name is missing"),
    (GOOD + GOOD, "4: a second test is named 'x'"),
    ("[[test]]\nname = 'x'\n", "1: x expects nothing"),
    ("[[test]]\nname = 'x'\nexpect = ['out 1 TRUE',\n'out one']\n", "4: out one: 'one' cannot"),
    ("[[test]]\nname = 'x'\nexpect = ['outt 1']\n", "3: outt 1: outt is about a line"),
    ("[[test]]\nname = 'x'\nexpect = ['w.src:3: outt 1']\n", "3: w.src:3: outt 1: there is no"),
    ("[[test]]\nname = 'x'\nexpect = ['runs 1']\n", "3: runs 1: runs is about a line"),
    ("[[test]]\nname = 'x'\nexpect = ['avoids it']\n", "3: avoids it: there is no zone it"),
    ("[[test]]\nname = 'x'\nexpect = [1]\n", "3: expect has something else than texts"),
    ("zones.a = 'box 1 2 3'\n" + GOOD, "1: 'box 1 2 3' cannot stand behind avoids"),
    (GOOD + "io = ['t=x IN[1]=TRUE']\n", "4: "),
    (GOOD + "seconds = 0\n", "4: seconds are 0, which cannot be"),
    (GOOD + "seconds = true\n", "4: seconds is not a number"),
    (GOOD + "program = 'gone.src'\n", "4: gone.src: no such file"),
    (GOOD + "set.a = [1]\n", "4: a must be a number"),
    (GOOD + "stand_ins.f = [['a'], 'b', 3]\n", "4: f must be a statement of KRL"),
    ("[[test]]\nname = \n", "2: not TOML"),
]


@pytest.mark.parametrize(("text", "said"), WRONG)
def test_what_is_wrong_is_reported_in_one_line(write: Write, text: str, said: str) -> None:
    """An unknown key, a missing or bad value: file, line, and what is wrong."""
    path = write(text)
    with pytest.raises(TestFileError) as error:
        read_tests(path)
    assert str(error.value).startswith(f"{path}:{said}")
    assert "\n" not in str(error.value)


def test_what_all_share_is_added_to(write: Write) -> None:
    """Inputs and tables of a test come to those of all; the rest of it replaces theirs."""
    one, two = read_tests(
        write(
            "io = 't=0 IN[1]=TRUE'\nseconds = 5\nset.a = 1\n" + GOOD + "io = ['t=1 IN[1]=FALSE']\n"
            "set.b = true\nseconds = 7\n[[test]]\nname = 'y'\nexpect = ['ends']\n"
        )
    )
    assert ("t=0 IN[1]=TRUE", "t=1 IN[1]=FALSE") == one.io
    assert ("a = 1", "b = TRUE") == one.before
    assert (7.0, 5.0) == (one.seconds, two.seconds)


def test_tests_in_krl_are_routines(tmp_path: Path) -> None:
    """Each routine TEST… with expectations is one; what names its subject is of the whole run."""
    path = tmp_path / "test_cell.src"
    path.write_text(
        ";@ seconds = 3\nDEF test_cell()\nEND\n"
        "DEF test_a()\n  $OUT[1]=TRUE ;> runs 1 ;> out 1 TRUE\n"
        "END\nDEF other()\nEND\nDEF TEST_B()\n  WAIT SEC 1\nEND ;> ends at 1\n",
        encoding="utf-8",
    )
    first, second = read_tests(path)
    assert [("test_a", 4, 3.0), ("TEST_B", 9, 3.0)] == [
        (one.name, one.line, one.seconds) for one in (first, second)
    ]
    assert [("test_cell.src", 5), ("", 0)] == [one.about for one in first.expected]
    assert [5, 5, 11] == [one.line for one in (*first.expected, *second.expected)]


def test_front_matter_of_krl_is_checked_too(tmp_path: Path) -> None:
    """What stands behind ;@ is TOML, and a mistake in it is told with the line of the program."""
    path = tmp_path / "test_cell.src"
    path.write_text(";@ seconds = 3\n;@ secnds = 4\nDEF test_cell()\nEND\n", encoding="utf-8")
    with pytest.raises(TestFileError, match=r"test_cell\.src:2: secnds is not a key here"):
        read_tests(path)


def test_other_files_are_left_alone(tmp_path: Path) -> None:
    """TOML without tests and programs without front matter are no tests, whatever their names."""
    for name, text, is_one in (
        ("test_a.toml", "[tool]\nx = 1\n", False),
        ("test_b.toml", "[[test]]\n", True),
        ("test_c.src", "DEF test_c()\nEND\n", False),
        ("test_d.src", ";@ seconds = 1\n", True),
        ("b.toml", "[[test]]\n", False),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
        assert is_one == is_test_file(tmp_path / name)
