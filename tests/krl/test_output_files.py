"""Records are written whole, and whatever names of files they hold."""

import json
import os
from pathlib import Path

import pytest

from krl.errors import Unusable
from krl.output_files import check_files, whole, write_json


def test_names_that_are_no_text(tmp_path: Path) -> None:
    """Half of a character, as names of files have it that are no UTF-8, comes back as it was."""
    record = {"path": "a\udcff.src", "text": "é 𝄞 \x1b"}
    write_json(record, tmp_path / "new" / "a.json")
    assert record == json.loads((tmp_path / "new" / "a.json").read_text(encoding="utf-8"))
    assert ["a.json"] == [file.name for file in (tmp_path / "new").iterdir()]


def test_what_fails_leaves_no_half(tmp_path: Path) -> None:
    """A record that cannot be told leaves the older one as it was, and nothing beside it."""
    target = tmp_path / "a.json"
    write_json({"old": 1}, target)
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json({"new": float("nan")}, target)
    with pytest.raises(UnicodeEncodeError), whole(target) as part:
        part.write_text("half \udcff", encoding="utf-8")
    assert {"old": 1} == json.loads(target.read_text(encoding="utf-8"))
    assert [target] == list(tmp_path.iterdir())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes in folders here")
def test_a_pipe_is_written_to_and_stays(tmp_path: Path) -> None:
    """What is no file, as a pipe, gets the record and is not replaced by a file."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_json({"a": 1}, pipe)
        assert b'{"a": 1}\n' == os.read(reader, 100)
    finally:
        os.close(reader)
    assert pipe.is_fifo()
    assert [pipe] == list(tmp_path.iterdir())


def test_places_where_no_file_can_be(tmp_path: Path) -> None:
    """A folder, and a place below a file, are refused before any work; a new folder is none."""
    file = tmp_path / "a"
    file.touch()
    check_files(None, file, tmp_path / "new" / "deep" / "a.json")
    for target, why in ((tmp_path, "a folder, not a file"), (file / "x" / "b", "is not a folder")):
        with pytest.raises(Unusable, match=why):
            check_files(None, target)
