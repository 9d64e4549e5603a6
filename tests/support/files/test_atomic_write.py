"""Files written whole or not at all: one, or several together."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from support.files.atomic_write import (
    JournalError,
    atomic_path,
    finish,
    write_atomic,
    write_together,
)


def content(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*.*")}


def test_a_block_that_fails_leaves_the_older_file(tmp_path: Path) -> None:
    """The target is as it was, and nothing lies beside it."""
    target = tmp_path / "new" / "a.txt"
    assert target == write_atomic(target, "old ä\r\n")
    with pytest.raises(UnicodeEncodeError), atomic_path(target) as part:
        part.write_text("half \udcff", encoding="utf-8")
    assert b"old \xc3\xa4\r\n" == target.read_bytes()
    assert [target] == list(target.parent.iterdir())


def test_the_path_has_the_suffix_of_its_target(tmp_path: Path) -> None:
    """So that who writes to it sees from its name in which form."""
    with atomic_path(tmp_path / "run.gif") as part:
        assert ".gif" == part.suffix
        part.touch()


@pytest.mark.skipif(os.name == "nt", reason="there are no such permissions")
def test_permissions_stay(tmp_path: Path) -> None:
    """A file that only its owner may read stays one."""
    target = tmp_path / "a.txt"
    target.touch(0o600)
    write_atomic(target, b"new")
    assert 0o600 == target.stat().st_mode & 0o777


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes in folders here")
def test_an_error_names_the_file_that_was_asked_for(tmp_path: Path) -> None:
    """Where nothing can be created, the name of the part beside the target is not shown."""
    target = tmp_path / ("x" * 250)  # the name of the part is too long for any system
    with pytest.raises(OSError, match="too long") as raised:
        write_atomic(target, "new")
    assert str(target) == raised.value.filename


def test_a_pipe_is_written_to_and_stays(tmp_path: Path) -> None:
    """What is no file, as a pipe, gets the content and is not replaced by a file."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_atomic(pipe, "content")
        assert b"content" == os.read(reader, 100)
    finally:
        os.close(reader)
    assert pipe.is_fifo()
    assert [pipe] == list(tmp_path.iterdir())


def test_files_are_made_changed_and_removed(tmp_path: Path) -> None:
    """What is as it was is not touched, and nothing is left beside the files."""
    for name in ("old.txt", "same.txt", "gone.txt"):
        (tmp_path / name).write_bytes(b"1")
    before = (tmp_path / "same.txt").stat().st_mtime_ns
    new = tmp_path / "folder" / "new.txt"
    changed = write_together(
        {
            tmp_path / "gone.txt": None,
            tmp_path / "never.txt": None,
            new: b"2",
            tmp_path / "old.txt": b"3",
            tmp_path / "same.txt": b"1",
        }
    )
    assert {"folder/new.txt": b"2", "old.txt": b"3", "same.txt": b"1"} == content(tmp_path)
    assert [tmp_path / "gone.txt", new, tmp_path / "old.txt"] == changed
    assert before == (tmp_path / "same.txt").stat().st_mtime_ns


def test_where_one_fails_none_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was exchanged before the failure is put back, what was made is removed."""
    (tmp_path / "a.txt").write_bytes(b"1")
    (tmp_path / "b.txt").write_bytes(b"2")
    (tmp_path / "d.txt").write_bytes(b"4")
    before = content(tmp_path)
    exchange = Path.replace

    def failing(self: Path, target: Path) -> Path:
        if target.name == "c.txt":
            raise OSError(28, "No space left on device")
        return exchange(self, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(OSError, match="No space"):
        write_together(
            {
                tmp_path / "a.txt": b"new",
                tmp_path / "b.txt": None,
                tmp_path / "new.txt": b"new",
                tmp_path / "c.txt": b"new",
                tmp_path / "d.txt": b"new",
            }
        )
    assert before == content(tmp_path)


def test_where_nothing_can_be_laid_ready_nothing_is_touched(tmp_path: Path) -> None:
    """A folder that cannot be made stops it before the first exchange."""
    (tmp_path / "a.txt").write_bytes(b"1")
    with pytest.raises(OSError, match=r"a\.txt"):
        write_together({tmp_path / "a.txt": b"2", tmp_path / "a.txt" / "b.txt": b"3"})
    assert {"a.txt": b"1"} == content(tmp_path)


KILLED = """
import os, sys
from pathlib import Path
from support.files.atomic_write import write_together
left = int(sys.argv[2])
exchange = Path.replace
def dying(self, target):
    global left
    if left == 0:
        os._exit(9)
    left -= 1
    return exchange(self, target)
Path.replace = dying
folder = Path(sys.argv[1])
write_together({folder / "a": b"2", folder / "b": b"2", folder / "gone": None},
               journal=folder / ".journal")
"""


@pytest.mark.parametrize("exchanges", range(5))
def test_a_killed_process_has_changed_all_or_nothing(tmp_path: Path, exchanges: int) -> None:
    """Killed at any exchange: what `finish` then leaves is all old or all new."""
    for name in ("a", "b", "gone"):
        (tmp_path / name).write_bytes(b"1")
    command = [sys.executable, "-c", KILLED, str(tmp_path), str(exchanges)]
    done = subprocess.run(command, check=False)
    assert (9 if exchanges < 3 else 0) == done.returncode
    finish(tmp_path / ".journal")
    after = {p.name: p.read_bytes() for p in tmp_path.iterdir() if not p.name.endswith(".part")}
    old, new = {"a": b"1", "b": b"1", "gone": b"1"}, {"a": b"2", "b": b"2"}
    assert (old if exchanges == 0 else new) == after


@pytest.mark.parametrize("wanted", ["[", "[1]", '{"relative": null}', "[" * 50_000])
def test_a_damaged_journal_is_not_followed(tmp_path: Path, wanted: str) -> None:
    """It is named, and stays for somebody to look at."""
    journal = tmp_path / "ledger" / ".journal"
    journal.parent.mkdir()
    journal.write_text(wanted, encoding="utf-8")
    with pytest.raises(JournalError, match=r"\.journal"):
        finish(journal)
    assert journal.is_file()


def test_a_journal_has_no_power_outside(tmp_path: Path) -> None:
    """A ledger that somebody sends may not remove or exchange files elsewhere."""
    journal = tmp_path / "grammar" / "ledger" / ".journal"
    journal.parent.mkdir(parents=True)
    outside = tmp_path / "outside"
    outside.write_bytes(b"1")
    for name in (outside, journal.parent / ".." / ".." / "outside"):
        journal.write_text(json.dumps({str(name): None}), encoding="utf-8")
        with pytest.raises(JournalError):
            finish(journal)
    assert b"1" == outside.read_bytes()
