"""Synthetic corpora: valid, the same for everybody, and as large as asked for."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from grammar.generation.synthetic_corpus import cell, write_cells
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer


@pytest.fixture(scope="module")
def recognizer() -> Recognizer:
    return Recognizer(read_file(GRAMMAR))


@pytest.fixture(scope="module")
def corpus() -> Mapping[str, str]:
    """The texts of some cells, by path."""
    files = (file for number in range(1, 31) for file in cell(1, number))
    return {path: data.decode() for path, data in files}


def test_every_program_is_valid(corpus: Mapping[str, str], recognizer: Recognizer) -> None:
    """Our recogniser accepts every file."""
    assert len(corpus) > 100
    assert [] == [path for path, text in corpus.items() if not recognizer.accepts(text)]


def test_no_name_is_too_long(corpus: Mapping[str, str], recognizer: Recognizer) -> None:
    """Names have at most 24 characters [TYP-05], and nearly all differ between cells."""
    lexer = recognizer.lexer
    kind = lexer.names.index("NAME")
    words = {word for text in corpus.values() for word in lexer.lexemes(text)}
    names = {word for word in words if lexer.kinds[word] == kind}
    assert len(names) > 1_000
    assert [] == [name for name in names if len(name) > 24]


def test_cells_are_laid_out_like_controllers(corpus: Mapping[str, str]) -> None:
    """A cell has the folders of a backup, and a file comes behind those that it refers to."""
    for number in (1, 2, 3):
        names = [path.split("/", 1)[1] for path in corpus if path.startswith(f"{number:04}/")]
        assert names[0] == "KRC/R1/System/$config.dat"
        assert names[-2:] == ["KRC/R1/Program/prog.dat", "KRC/R1/Program/prog.src"]


def test_corpus_has_the_size_asked_for(tmp_path: Path) -> None:
    """There is as much as was asked for, by less than a file more, and each byte was reported."""
    reported: list[int] = []
    written = write_cells(tmp_path, 120_000, seed=5, on_bytes=reported.append)
    sizes = [path.stat().st_size for path in tmp_path.rglob("*") if path.is_file()]
    assert written.bytes == sum(sizes) == sum(reported)
    assert written.files == len(sizes) == len(reported)
    assert 120_000 <= written.bytes < 120_000 + reported[-1]


def test_larger_corpus_begins_like_a_smaller_one(tmp_path: Path) -> None:
    """The files of a small corpus are those of a larger one with the same seed."""
    write_cells(tmp_path / "small", 50_000, seed=2)
    write_cells(tmp_path / "large", 90_000, seed=2)
    for path in (tmp_path / "small").rglob("*.*"):
        same = tmp_path / "large" / path.relative_to(tmp_path / "small")
        assert path.read_bytes() == same.read_bytes()


def _digest(seed: int) -> str:
    return hashlib.sha256(b"".join(data for _, data in cell(seed, 2))).hexdigest()


def test_corpus_depends_on_the_seed_alone() -> None:
    """Neither the process nor its hash seed has a say; another seed gives other programs."""
    script = (
        "import hashlib; from grammar.generation.synthetic_corpus import cell; "
        "print(hashlib.sha256(b''.join(data for _, data in cell(7, 2))).hexdigest())"
    )
    digests = {
        subprocess.run(
            [sys.executable, "-c", script],
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
        for seed in ("0", "1")
    }
    assert {_digest(7)} == digests
    assert _digest(7) != _digest(8)
