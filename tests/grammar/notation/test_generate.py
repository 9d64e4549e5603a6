"""The generated parser is that of the grammar, and a change on either side is found."""

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from grammar.notation import generate
from grammar.notation.generate import (
    ANTLR_VERSION,
    GENERATED,
    GRAMMAR,
    GenerationError,
    check,
    main,
)

FILES = ["KRLLexer.py", "KRLParser.py", "__init__.py", "krl_grammar.py"]


@pytest.fixture
def copy(tmp_path: Path) -> tuple[Path, Path]:
    """A grammar with its generated folder that may be changed."""
    shutil.copy(GRAMMAR, tmp_path / "KRL.g4")
    shutil.copytree(
        GENERATED, tmp_path / "_generated", ignore=shutil.ignore_patterns("__pycache__")
    )
    return tmp_path / "KRL.g4", tmp_path / "_generated"


def test_the_committed_parser_is_up_to_date() -> None:
    """What is committed was generated from the grammar beside it."""
    assert check() is None


def test_a_copy_is_up_to_date(copy: tuple[Path, Path]) -> None:
    """The check depends on the files only, and line ends of another system change nothing."""
    grammar, folder = copy
    assert check(grammar, folder) is None
    for path in (grammar, *(folder / name for name in FILES)):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert check(grammar, folder) is None


def test_a_changed_grammar_is_found(copy: tuple[Path, Path]) -> None:
    """Any change of the grammar, be it in a comment, makes the parser stale."""
    grammar, folder = copy
    grammar.write_bytes(grammar.read_bytes() + b"// more\n")
    assert "KRL.g4 is not what" in str(check(grammar, folder))
    assert "make grammar" in str(check(grammar, folder))


@pytest.mark.parametrize("name", FILES)
def test_a_changed_generated_file_is_found(copy: tuple[Path, Path], name: str) -> None:
    """An edit of a generated file is found, and so is its loss."""
    grammar, folder = copy
    path = folder / name
    path.write_bytes(path.read_bytes() + b"\n")
    assert str(check(grammar, folder)).startswith(f"{name} is not what")
    path.unlink()
    assert "incomplete" in str(check(grammar, folder))


@pytest.mark.parametrize("manifest", ["", "nonsense\n", "0" * 64 + "  KRL.g4\n", None])
def test_a_spoilt_manifest_is_found(copy: tuple[Path, Path], manifest: str | None) -> None:
    """Digests that are missing, wrong or unreadable do not pass."""
    grammar, folder = copy
    path = folder / generate.MANIFEST
    path.unlink()
    if manifest is not None:
        path.write_text(manifest, encoding="utf-8")
    assert check(grammar, folder) is not None


def test_generated_files_say_what_made_them() -> None:
    """Every generated file names its generator, and its ANTLR is the pinned one."""
    for name in ("KRLLexer.py", "KRLParser.py"):
        first = (GENERATED / name).read_text(encoding="utf-8").splitlines()[0]
        assert f"# Generated from KRL.g4 by ANTLR {ANTLR_VERSION}" == first
    assert "make grammar" in (GENERATED / "__init__.py").read_text(encoding="utf-8")


# -------------------------------------------------------------------- generating, without Java


@pytest.fixture
def antlr(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """A stand-in for ANTLR that notes its calls and puts out the grammar's text."""
    calls: list[dict[str, Any]] = []

    def run(command: list[str], **options: Any) -> subprocess.CompletedProcess[str]:
        calls.append({"command": command, **options})
        text = (Path(options["cwd"]) / command[-1]).read_text(encoding="utf-8")
        if "BROKEN" in text:
            return subprocess.CompletedProcess(command, 1, "", "error(1): BROKEN\nmore\n")
        for name in ("KRLLexer.py", "KRLParser.py"):
            (Path(options["cwd"]) / name).write_text(f"# {name}\n# {text}", encoding="utf-8")
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr("subprocess.run", run)
    monkeypatch.setattr("shutil.which", lambda *_, **__: "antlr4")
    return calls


def test_what_is_generated_passes_the_check(antlr: list[dict[str, Any]], tmp_path: Path) -> None:
    """Lexer, parser, package and manifest are written, by the pinned ANTLR, and belong together."""
    grammar, folder = tmp_path / "some.g4", tmp_path / "new" / "folder"
    grammar.write_text("grammar KRL;\na : A ;\nA : 'A' ;\n", encoding="utf-8", newline="\n")
    generate.generate(grammar, folder)
    assert {*FILES, generate.MANIFEST} == {path.name for path in folder.iterdir()}
    assert all(b"\r" not in path.read_bytes() for path in folder.iterdir())
    assert check(grammar, folder) is None
    (call,) = antlr
    assert ANTLR_VERSION == call["env"]["ANTLR4_TOOLS_ANTLR_VERSION"]
    assert "-Werror" in call["command"]


def test_a_refused_grammar_leaves_the_folder_alone(
    antlr: list[dict[str, Any]], tmp_path: Path
) -> None:
    """What ANTLR refuses is an error of one line, its first, and nothing is written."""
    grammar, folder = tmp_path / "some.g4", tmp_path / "new"
    grammar.write_text("grammar BROKEN;\n", encoding="utf-8")
    with pytest.raises(GenerationError, match=r"^error\(1\): BROKEN$"):
        generate.generate(grammar, folder)
    assert len(antlr) == 1
    assert not folder.exists()


def test_without_antlr_there_is_one_clear_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where ANTLR is missing the command says so and ends with 2."""
    monkeypatch.setattr("shutil.which", lambda *_, **__: None)
    monkeypatch.setattr(sys, "argv", ["generate"])
    assert 2 == main()
    out, err = capsys.readouterr()
    assert ("", 1) == (out, err.count("\n"))
    assert "antlr4 is missing" in err


def test_the_check_as_a_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """``--check`` ends with 0 where all is well and with 1 where the parser is stale."""
    monkeypatch.setattr(sys, "argv", ["generate", "--check"])
    assert 0 == main()
    assert "the generated parser is up to date\n" == capsys.readouterr().out
    monkeypatch.setattr(generate, "check", lambda: "stale")
    assert 1 == main()
    assert "stale\n" == capsys.readouterr().out


def test_verifying_generates_afresh(
    antlr: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """``--verify`` compares with what ANTLR makes today, here something else."""
    monkeypatch.setattr(sys, "argv", ["generate", "--verify"])
    assert 1 == main()
    assert "differs from what ANTLR generates" in capsys.readouterr().out
    assert len(antlr) == 1
