"""The digest of code and tables sees every change that a result may depend on."""

import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import grammar
from support.files.code_digest import code_digest


@pytest.fixture
def copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A package `grammar_copy` with all that `grammar` has."""
    package = tmp_path / "grammar_copy"
    generated = shutil.ignore_patterns("_generated", "__pycache__")
    shutil.copytree(Path(grammar.__file__).parent, package, ignore=generated)
    monkeypatch.syspath_prepend(tmp_path)
    yield package
    sys.modules.pop(package.name, None)
    code_digest.cache_clear()


def _digest() -> str:
    code_digest.cache_clear()
    return code_digest("grammar_copy")


def _grow(package: Path, name: str) -> None:
    file = package / name
    file.write_bytes(file.read_bytes() + b"\n")


def _move(package: Path) -> None:
    (package / "parser" / "lexer.py").rename(package / "lexer.py")


@pytest.mark.parametrize(
    "change",
    [
        *(
            pytest.param(lambda package, name=name: _grow(package, name), id=name)
            for name in (
                "__init__.py",
                "parser/lexer.py",
                "system/variables.tsv",
                "constructs/0038-for-step.toml",
                "notation/g4.lark",
                "KRL.g4",
            )
        ),
        pytest.param(_move, id="moved"),
    ],
)
def test_every_change_is_another_digest(copied: Path, change: Callable[[Path], None]) -> None:
    """A changed file in any folder counts, and so does one that lies elsewhere than before."""
    before = _digest()
    assert before == _digest()
    change(copied)
    assert before != _digest()


def test_each_package_counts(copied: Path) -> None:  # noqa: ARG001
    """The digest of two packages is neither that of the first nor that of the second."""
    both = code_digest("grammar_copy", "support")
    assert 3 == len({both, code_digest("grammar_copy"), code_digest("support")})
