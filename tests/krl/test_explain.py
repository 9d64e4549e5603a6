"""`krl explain`: codes in words."""

import pytest

from grammar.diagnostics.codes import by_code
from krl.cli import main


def test_every_code_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    """Each code has its title, its sentences, and how to silence it."""
    for code, entry in by_code().items():
        assert 0 == main(["explain", code.lower()])
        said = capsys.readouterr().out
        assert f"{code} {entry.slug}: {entry.title}" in said
        assert entry.explanation in said
        assert f"krl: ignore[{code}]" in said


def test_the_number_of_the_controller_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    """A code that is a message of the controller says so, with a wrong and a right program."""
    assert 0 == main(["explain", "no-such-constant"])
    said = capsys.readouterr().out
    assert "Message of the controller: 2296" in said
    assert said.index("Wrong:") < said.index("Right:")


def test_the_number_of_a_message_is_a_code(capsys: pytest.CaptureFixture[str]) -> None:
    """What stands on the controller's display is enough."""
    assert 0 == main(["explain", "2296"])
    assert capsys.readouterr().out.startswith("KSS2296 ")


def test_without_a_code_all_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    """One line a code."""
    assert 0 == main(["explain"])
    assert list(by_code()) == [line.split()[0] for line in capsys.readouterr().out.splitlines()]
