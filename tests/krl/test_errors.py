"""Whatever happens behind the door, a person reads one line and a script reads a status."""

import errno
import os
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest
import typer

from grammar.syntax.node_plans import NoNode
from krl import errors


def _app(command: Callable[[], int | None]) -> typer.Typer:
    app = typer.Typer(add_completion=False, rich_markup_mode=None)
    app.command("go")(command)
    app.command("stay")(lambda: None)
    return app


def _raising(error: BaseException) -> typer.Typer:
    def command() -> None:
        raise error

    return _app(command)


@pytest.mark.parametrize(("result", "status"), [(None, 0), (0, 0), (1, 1), (2, 2)])
def test_status_is_what_the_command_returns(result: int | None, status: int) -> None:
    """A command's return value is the exit status, and nothing means 0."""
    assert status == errors.run(_app(lambda: result), ["go"])


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (errors.InputError("there is nothing here"), "krl: there is nothing here"),
        (FileNotFoundError(errno.ENOENT, "No such file", "a.src"), "krl: a.src: No such file"),
        (OSError("the disk is gone"), "krl: the disk is gone"),
        (PermissionError(), "krl: PermissionError"),
        (errors.InputError("two\n  lines\x1b[2J"), "krl: two lines\\x1b[2J"),
        (errors.InputError("x" * 9_000), f"krl: {'x' * 2_000} …"),
        (
            NoNode("halt"),
            "krl: the syntax tree has no node for a form of halt that the grammar reads: "
            "see CONTRIBUTING.md, the recipe for constructs, step 6",
        ),
        (
            BrokenProcessPool("terminated abruptly"),
            "krl: a process of krl was ended from outside; the memory may have run out",
        ),
    ],
)
def test_expected_error_is_one_line(
    error: Exception, line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """An expected error is one line on stderr, without control characters, and status 2."""
    assert errors.BAD_INPUT == errors.run(_raising(error), ["go"])
    assert ("", f"{line}\n") == capsys.readouterr()


def test_lines_are_shown_without_what_steers() -> None:
    """Blanks stay, so that columns do; all else that is not printed is spelt out."""
    assert "a  b\\x1b[2J\\u202e\\x9b\\udcff" == errors.shown("a  b\x1b[2J\u202e\x9b\udcff")


@pytest.mark.parametrize("error", [ValueError("odd"), RecursionError("deep"), MemoryError()])
def test_defect_is_one_line(
    error: Exception, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """An error that nobody foresaw is one line that says so, and status 2."""
    monkeypatch.delenv("KRL_TRACEBACK", raising=False)
    assert errors.BAD_INPUT == errors.run(_raising(error), ["go"])
    said = capsys.readouterr().err
    assert said.startswith(f"krl: a defect in krl itself, {type(error).__name__}: ")
    assert 1 == said.count("\n")


def test_defect_shows_its_traceback_on_request(monkeypatch: pytest.MonkeyPatch) -> None:
    """With KRL_TRACEBACK set a defect comes out as it is."""
    monkeypatch.setenv("KRL_TRACEBACK", "1")
    with pytest.raises(ValueError, match="odd"):
        errors.run(_raising(ValueError("odd")), ["go"])


def test_interruption(capsys: pytest.CaptureFixture[str]) -> None:
    """Ctrl-C ends with the status that shells use for it."""
    assert errors.INTERRUPTED == errors.run(_raising(KeyboardInterrupt()), ["go"])
    assert "krl: interrupted\n" == capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["bring"], "krl: No such command 'bring'. See krl --help"),
        (["go", "--fast"], "krl go: No such option: --fast. See krl go --help"),
        ([], "krl: Missing command. See krl --help"),
    ],
)
def test_wrong_usage_is_one_line(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Wrong usage is one line that names the command to ask for help, and status 2."""
    assert errors.BAD_INPUT == errors.run(_app(lambda: None), arguments)
    assert ("", f"{line}\n") == capsys.readouterr()


def _program(body: str) -> list[str]:
    """A Python program whose only command does `body`."""
    lines = [
        "import sys, typer",
        "from krl import errors",
        "app = typer.Typer()",
        "@app.command()",
        f"def go() -> None: {body}",
        "sys.exit(errors.run(app, []))",
    ]
    return [sys.executable, "-c", "\n".join(lines)]


@pytest.mark.parametrize("lines", [1, 100_000])
def test_reader_that_goes_away_is_no_error(lines: int) -> None:
    """When the reader of a pipe goes away, krl ends and says nothing, however little was said."""
    with subprocess.Popen(
        _program(f"sys.stdin.read(); [typer.echo(number) for number in range({lines})]"),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        process.stdin.close()
        assert b"" == process.stderr.read()
        assert errors.READER_GONE == process.wait()


def test_output_that_the_console_cannot_show_is_escaped() -> None:
    """A character outside the console's encoding is printed as an escape."""
    done = subprocess.run(
        _program("typer.echo(chr(0x3B1))"),
        env=os.environ | {"PYTHONIOENCODING": "cp1252"},
        capture_output=True,
        check=False,
    )
    assert (0, b"\\u03b1", b"") == (done.returncode, done.stdout.strip(), done.stderr)


def test_wildcards_are_expanded_where_shells_do_not(tmp_path: Path) -> None:
    """A wildcard becomes the files that it fits, and stays as it is when it fits none."""
    for name in ("b.src", "a.src", "c.dat"):
        (tmp_path / name).touch()
    sources, nothing = str(tmp_path / "*.src"), str(tmp_path / "*.sub")
    expected = ["recover", str(tmp_path / "a.src"), str(tmp_path / "b.src"), nothing]
    assert expected == errors._expanded(["recover", sources, nothing])
