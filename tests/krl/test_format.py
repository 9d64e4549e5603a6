"""`krl format` from the outside: what it writes, what it leaves alone, and what it says."""

import codecs
import os
import stat
import sys
import zipfile
from pathlib import Path

import pytest

from krl.cli import main

LOOSE = b"def a()\r\nx=1 ;c\r\nend"
SET = b"DEF a()\r\nx = 1 ;c\r\nEND"
BROKEN = b"DEF b()\nx=(\nEND\n"
posix_only = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such rights")


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working directory of its own, in which nothing lies."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("KRL_TRACEBACK", raising=False)
    return tmp_path


def lay(name: str, data: bytes) -> Path:
    file = Path(name)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(data)
    return file


def test_it_writes_what_it_sets_out(capsys: pytest.CaptureFixture[str]) -> None:
    """A file is set out in its place, line ends and the missing last one kept."""
    file = lay("a.src", LOOSE)
    assert 0 == main(["format", "a.src"])
    assert SET == file.read_bytes()
    assert "formatted a.src\n1 formatted\n" == capsys.readouterr().out
    assert 0 == main(["format", "a.src"])
    assert "1 as it should be\n" == capsys.readouterr().out
    assert [file] == list(Path().iterdir())


def test_check_writes_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    """With --check files that would change are named, and the status says so."""
    lay("cell/a.src", LOOSE)
    lay("cell/b.src", SET)
    assert 1 == main(["format", "--check", "cell"])
    assert LOOSE == Path("cell/a.src").read_bytes()
    out = "would change cell/a.src\n1 as it should be, 1 would change\n"
    assert out == capsys.readouterr().out
    assert 0 == main(["format", "--check", "cell/b.src"])


def test_syntax_errors_are_left_alone(capsys: pytest.CaptureFixture[str]) -> None:
    """A file that does not parse is named on one line with the place, and the others are done."""
    lay("cell/a.src", LOOSE)
    lay("cell/b.src", BROKEN)
    lay("cell/c.src", b"DEF c()\nx=" + b"(" * 500 + b"1" + b")" * 500 + b"\nEND\n")
    assert 1 == main(["format", "cell"])
    assert (SET, BROKEN) == (Path("cell/a.src").read_bytes(), Path("cell/b.src").read_bytes())
    said = capsys.readouterr()
    assert "formatted cell/a.src\n1 formatted, 2 left alone\n" == said.out
    first, second = said.err.splitlines()
    assert "cell/b.src:2:4: left alone: syntax error at the end of the line" == first
    assert second.startswith("cell/c.src:2:")
    assert second.endswith("nested more than 200 deep")


def test_archives_are_only_checked(capsys: pytest.CaptureFixture[str]) -> None:
    """Nothing is ever written into an archive."""
    with zipfile.ZipFile("backup.zip", "w") as archive:
        archive.writestr("KRC/R1/a.src", LOOSE)
        archive.writestr("KRC/R1/b.src", SET)
    before = Path("backup.zip").read_bytes()
    assert 1 == main(["format", "backup.zip"])
    assert before == Path("backup.zip").read_bytes()
    out = "would change backup.zip/KRC/R1/a.src\n1 as it should be, 1 would change\n"
    assert out == capsys.readouterr().out


@pytest.mark.parametrize(
    ("before", "encoding", "after"),
    [
        (b"", "cp1252", b""),
        (b"", "utf-8", b""),
        (codecs.BOM_UTF8, "utf-8", b""),
        (codecs.BOM_UTF16_LE, "utf-16-le", b""),
        (b"", "cp1252", b"\x1a\x00\x00"),
    ],
)
def test_the_encoding_stays(before: bytes, encoding: str, after: bytes) -> None:
    """Encoding, byte order mark and the padding of old controllers are as they were."""
    text, expected = 'def a()\nx="ä" ;ö\nend\n', 'DEF a()\nx = "ä" ;ö\nEND\n'
    file = lay("a.src", before + text.encode(encoding) + after)
    assert 0 == main(["format", "a.src"])
    assert before + expected.encode(encoding) + after == file.read_bytes()


@posix_only
def test_rights_stay() -> None:
    """Who may read and write a file is not changed."""
    file = lay("a.src", LOOSE)
    file.chmod(0o640)
    assert 0 == main(["format", "a.src"])
    assert 0o640 == stat.S_IMODE(file.stat().st_mode)
    assert SET == file.read_bytes()


def test_a_failed_write_leaves_the_file_whole(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where the disk refuses, the old file stays, nothing lies about, and the status is 2."""

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    file = lay("a.src", LOOSE)
    lay("b.src", SET)
    monkeypatch.setattr(Path, "replace", refuse)
    assert 2 == main(["format", "."])
    assert LOOSE == file.read_bytes()
    assert ["a.src", "b.src"] == sorted(os.listdir())  # noqa: PTH208  names are plainer here
    said = capsys.readouterr()
    assert "a.src: not written: Permission denied\n" == said.err
    assert "1 as it should be, 1 not written\n" == said.out


def test_what_is_no_krl_is_skipped(capsys: pytest.CaptureFixture[str]) -> None:
    """Other files of the same name are named with the reason, and are no finding."""
    lay("cell/a.src", SET)
    lay("cell/b.dat", b"\x00\x01" * 99)
    assert 0 == main(["format", "cell"])
    said = capsys.readouterr()
    assert "1 as it should be, 1 skipped\n" == said.out
    assert said.err.startswith("cell/b.dat: skipped: binary data")


def test_one_file_that_is_no_krl_is_reported_once(capsys: pytest.CaptureFixture[str]) -> None:
    """What was asked for and cannot be formatted is one line, and status 2."""
    lay("b.zip", b"junk")
    assert 2 == main(["format", "b.zip"])
    assert ("", "b.zip: skipped: not a zip archive\n") == capsys.readouterr()
