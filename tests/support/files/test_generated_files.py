"""Files that a module generates."""

from pathlib import Path

import pytest

from support.files.generated_files import main


def test_what_is_stale_is_named_and_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A file that is missing or has another text is stale until it is written."""
    (tmp_path / "old.txt").write_text("before", encoding="utf-8")
    (tmp_path / "same.txt").write_text("now\n", encoding="utf-8")
    made = {tmp_path / f"{name}.txt": "now\n" for name in ("old", "same", "new")}
    monkeypatch.setattr("sys.argv", ["it", "--check"])
    assert 1 == main("some.module", lambda: made)
    expected = [f"{name}.txt is stale: python -m some.module --write" for name in ("old", "new")]
    assert expected == capsys.readouterr().err.splitlines()
    monkeypatch.setattr("sys.argv", ["it", "--write"])
    assert 0 == main("some.module", lambda: made)
    assert [b"now\n"] * 3 == [file.read_bytes() for file in made]
    monkeypatch.setattr("sys.argv", ["it", "--check"])
    assert 0 == main("some.module", lambda: made)
