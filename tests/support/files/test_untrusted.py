"""Documents that other people wrote: limits on size and depth, and one line that says which."""

import os
import sys
from pathlib import Path

import pytest

from support.files.untrusted import DocumentError, json_of, read_bytes, read_text, toml_of


def test_what_is_larger_than_the_limit_is_not_read(tmp_path: Path) -> None:
    """A file of just the limit is read whole; a byte more, and the message names the file."""
    file = tmp_path / "a.g4"
    file.write_bytes(b"x" * (1 << 20))
    assert 1 << 20 == len(read_bytes(file, 1 << 20))
    file.write_bytes(b"x" * ((1 << 20) + 1))
    with pytest.raises(OSError, match="larger than 1 MB") as raised:
        read_bytes(file, 1 << 20)
    assert str(file) == raised.value.filename


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such pipes")
def test_a_pipe_without_a_writer_is_refused_at_once(tmp_path: Path) -> None:
    """Only regular files are read: opening this one would wait for ever."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(OSError, match="not a regular file"):
        read_bytes(pipe)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows opens no folder")
def test_a_folder_is_refused_by_its_name(tmp_path: Path) -> None:
    """The error names the folder, whoever reports it."""
    with pytest.raises(IsADirectoryError) as raised:
        read_bytes(tmp_path)
    assert str(tmp_path) == raised.value.filename


def test_any_ends_of_lines_are_those_of_a_text(tmp_path: Path) -> None:
    """A text is the same whichever system wrote it."""
    file = tmp_path / "a.txt"
    file.write_bytes(b"\xef\xbb\xbfa\r\nb\rc\n")
    assert "a\nb\nc\n" == read_text(file, "utf-8-sig")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("a = " + "[" * 50_000, "nested too deeply"),
        ("a = " + "9" * 6_000, "digits"),
        ("a = 1\n" + "a" + ".a" * 20_000 + " = 1", "100 dots in line 2"),
        ("#" * 1_000_001, "is too long"),
        ("a = ", "at end of document"),
    ],
)
def test_toml_that_asks_too_much_is_not_toml(text: str, reason: str) -> None:
    """Depth, numbers beyond all measure and mistakes end in the same way."""
    with pytest.raises(DocumentError, match=rf"TOML\b.*{reason}"):
        toml_of(text)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 100_000, "nested too deeply"),
        ("9" * 6_000, "digits"),
        ("[1e999]", "1e999 is no finite number"),
        ("[NaN]", "NaN is no finite number"),
        ("{", "line 1"),
    ],
)
def test_json_that_asks_too_much_is_not_json(text: str, reason: str) -> None:
    """So do numbers that are none, which no record may hold."""
    with pytest.raises(DocumentError, match=f"not JSON: .*{reason}"):
        json_of(text)
    assert [1.5, {"a": None}] == json_of('[1.5, {"a": null}]')
