"""What documents show, they show as it is: commands with their output, options, Python, TOML."""

import ast
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
import typer

from conformance.suite.case import CASES
from conformance.suite.registry import registry
from krl.commands.app import app

ROOT = Path(__file__).parents[1]
DOCUMENTS = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "conformance/CASES.md")),
    *sorted((ROOT / "corpus").glob("*/README.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]
BLOCKS = [
    (f"{document.relative_to(ROOT).as_posix()}:{text.count(chr(10), 0, block.start()) + 1}", block)
    for document in DOCUMENTS
    for text in [document.read_text(encoding="utf-8")]
    for block in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
]
TRANSCRIPTS = {place: block[2] for place, block in BLOCKS if block[2].startswith("$ ")}

_TIMES = re.compile(r"\bin \d+\.\d s\b|\b[\d,.]+ runs a second\b")  # by the clock


def _of_language(language: str) -> dict[str, str]:
    return {place: block[2] for place, block in BLOCKS if block[1] == language}


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A copy of what documented commands read, where they may write."""
    for folder in ("corpus/programs", "corpus/negatives", "examples"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    (tmp_path / "grammar").mkdir()
    shutil.copy(ROOT / "grammar" / "preliminary.g4", tmp_path / "grammar")
    return tmp_path


@pytest.mark.slow
@pytest.mark.parametrize("place", TRANSCRIPTS)
def test_commands_print_what_documents_show(place: str, checkout: Path) -> None:
    """A block that begins with `$` has commands and what they print, times apart.

    A line with `…` alone stands for any lines; what follows `(krl)` is typed at its prompt.
    """
    folder = checkout
    for shown in re.split(r"^\$ ", TRANSCRIPTS[place], flags=re.MULTILINE)[1:]:
        command, _, expected = shown.partition("\n")
        words = shlex.split(command)
        if words[0] == "cd":
            folder /= words[1]
            continue
        assert "krl" == words[0]
        typed = re.findall(r"^\(krl\) (.*)$", expected, re.MULTILINE)
        done = subprocess.run(
            [sys.executable, "-m", "krl", *words[1:]],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"},
            input="\n".join(typed),
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode in (0, 1), done.stderr
        found, wanted = _lines(done.stdout), _lines(expected)
        pattern = "".join(
            "(?:.*\n)*?" if "…" == line.strip() else f"{re.escape(line)}\n" for line in wanted
        )
        if re.fullmatch(pattern, "".join(f"{line}\n" for line in found)) is None:
            assert wanted == found


def _lines(output: str) -> list[str]:
    """Without times, what was typed, empty lines and rules of tables."""
    lines = (_TIMES.sub("TIME", line.rstrip()) for line in output.splitlines())
    return [line for line in lines if line.strip(" ─") and not line.startswith("(krl) ")]


@cache
def _krl() -> object:
    return typer.main.get_command(app())


def _commands(words: list[str]) -> tuple[object, list[str]]:
    """The innermost command that words name, and the words behind it."""
    command = _krl()
    while words and words[0] in (inner := getattr(command, "commands", {})):
        command, words = inner[words[0]], words[1:]
    return command, words


def _documented_commands() -> Iterator[tuple[str, str]]:
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        code = "\n".join(
            re.findall(r"```.*?\n(.*?)```", text, re.DOTALL) + re.findall(r"`(.+?)`", text)
        )
        for line in re.findall(
            r"^(?:\$ |\S+[/\\])?krl ([a-z].*?)(?: {2,}.*|\s#.*)?$", code, re.MULTILINE
        ):
            yield document.relative_to(ROOT).as_posix(), line


def test_commands_of_documents_have_their_options() -> None:
    """Each option that a document gives to a command of `krl` is one of this command."""
    unknown = []
    for document, line in _documented_commands():
        command, words = _commands(line.split())
        known = {
            name
            for parameter in getattr(command, "params", ())
            for name in (*parameter.opts, *parameter.secondary_opts)
        }
        used = {re.split("[=|]", word)[0] for word in words if re.match("--?[a-z]", word)}
        unknown += [(document, line, name) for name in used - known - {"--help"}]
    assert [] == unknown


@pytest.mark.parametrize("place", _of_language("python"))
def test_python_of_documents_imports_what_there_is(place: str) -> None:
    """It is Python, and its imports from the workbench can be made."""
    tree = ast.parse(_of_language("python")[place])
    imports: list[ast.stmt] = [
        node for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    exec(compile(ast.Module(imports, []), place, "exec"), {})


@pytest.mark.parametrize("place", _of_language("toml"))
def test_toml_of_documents_is_toml(place: str) -> None:
    """Each block of TOML can be read."""
    assert tomllib.loads(_of_language("toml")[place])


def test_counts_of_documents_are_those_of_today() -> None:
    """Rules and repositories are counted exactly; `some` allows a twentieth more or less."""
    sources = tomllib.loads((ROOT / "corpus" / "sources.toml").read_text(encoding="utf-8"))
    counts = {
        "rules of KRL": len(registry()),
        "public repositories": len(sources["source"]),
        "conformance cases": sum(
            path.read_bytes().startswith(b";@") for path in CASES.rglob("*.*")
        ),
    }
    texts = {path: path.read_text(encoding="utf-8") for path in (*DOCUMENTS, ROOT / "CHANGELOG.md")}
    wrong = []
    for what, count in counts.items():
        stated = [
            (path.name, some, int(number.replace(",", "")))
            for path, text in texts.items()
            for some, number in re.findall(rf"(some )?\b([\d,]+)\s+{what}", text)
        ]
        assert stated
        wrong += [one for one in stated if abs(one[2] - count) > (count / 20 if one[1] else 0)]
    assert [] == wrong
