"""Values that are kept for the user."""

import os
from pathlib import Path

import pytest

from support.files import kept_values
from support.files.kept_values import kept

_LONG = "x" * 20_000
_CODE = ("support",)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which values are kept."""
    monkeypatch.setattr(kept_values, "user_cache", lambda: tmp_path)
    return tmp_path / "values"


def _refuse() -> str:
    raise AssertionError("it is kept")


def test_what_was_made_of_the_same_texts_is_not_made_again() -> None:
    """Of other texts, or of the same ones cut elsewhere, it is."""
    assert "first" == kept(_CODE, ("a", _LONG), lambda: "first")
    assert "first" == kept(_CODE, ("a", _LONG), _refuse)
    assert "other" == kept(_CODE, ("b", _LONG), lambda: "other")
    assert "cut" == kept(_CODE, ("ax", _LONG[1:]), lambda: "cut")


def test_other_code_makes_it_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A value that other code has made is stale."""
    kept(_CODE, (_LONG,), lambda: "old")
    monkeypatch.setattr(kept_values, "code_digest", lambda *_: "changed")
    assert "new" == kept(_CODE, (_LONG,), lambda: "new")


@pytest.mark.parametrize("damage", [b"", b"x", None])
def test_what_is_damaged_is_made_again(cache: Path, damage: bytes | None) -> None:
    """A file that is empty, something else or cut."""
    kept(_CODE, (_LONG,), lambda: "whole")
    (file,) = cache.iterdir()
    file.write_bytes(file.read_bytes()[:-3] if damage is None else damage)
    assert "again" == kept(_CODE, (_LONG,), lambda: "again")
    assert "again" == kept(_CODE, (_LONG,), _refuse)


def test_what_cannot_be_kept_is_made(cache: Path) -> None:
    """Short texts, values that no file can hold, a folder that is a file."""
    assert 1 == kept(_CODE, ("short",), lambda: 1)
    assert 2 == kept(_CODE, (_LONG,), lambda: lambda: 2)()
    assert [] == list(cache.glob("*"))
    cache.rmdir()
    cache.write_text("")
    assert 3 == kept(_CODE, (_LONG,), lambda: 3)


def test_the_oldest_go(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No more bytes than the limit are kept, and what was used last stays."""
    kept(_CODE, ("a", _LONG), lambda: 0)
    (file,) = cache.iterdir()
    monkeypatch.setattr(kept_values, "_MOST_KEPT", 2 * file.stat().st_size)
    os.utime(file, ns=(1, 1))
    for name in "bc":
        kept(_CODE, (name, _LONG), lambda: 0)
    assert 2 == len(list(cache.iterdir()))
    assert 1 == kept(_CODE, ("a", _LONG), lambda: 1)
