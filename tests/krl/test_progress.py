"""What is said of progress where there is no terminal."""

import pytest

from krl.terminal.progress import Bar, progress_bar


@pytest.mark.parametrize(
    ("interval", "lines"),
    [
        ("10", ["krl: reading: 2 of 9", "krl: reading: 4 of 9"]),
        ("20", ["krl: reading: 4 of 9"]),
        ("nonsense", ["krl: reading: 2 of 9", "krl: reading: 4 of 9"]),
        ("0", []),
    ],
)
def test_a_line_is_written_at_intervals(
    interval: str,
    lines: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Each interval of seconds has one, from the beginning of the command on."""
    moments = {"now": 100.0}
    monkeypatch.setenv("KRL_PROGRESS", interval)
    monkeypatch.setattr("krl.terminal.progress.monotonic", lambda: moments["now"])
    monkeypatch.setattr(Bar, "_written", 100.0)
    with progress_bar("reading") as bar:
        for now in (105.0, 112.0, 117.0, 123.0):
            moments["now"] = now
            bar()
            bar.expect(9)
    told = capsys.readouterr()
    assert ("", lines) == (told.out, told.err.splitlines())
