"""Synthetic programs: valid, in every dialect, the same for everybody, and as many as asked for."""

import hashlib
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Mapping
from itertools import chain, islice
from pathlib import Path

import pytest

from grammar.generation.cells.cells import File, files
from grammar.generation.cells.dialect import Generation, Letters, a_dialect
from grammar.generation.cells.writing import write_cells
from grammar.generation.choices import SeededChoices
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser import antlr_reference
from grammar.parser.recognizer import Recognizer
from recovery.negatives.language_facts import violation
from support.files.decode import Decoded, decode

CELLS = range(1, 9)


@pytest.fixture(scope="module")
def recognizer() -> Recognizer:
    return Recognizer(read_file(GRAMMAR))


@pytest.fixture(scope="module")
def corpus() -> Mapping[File, str]:
    """Some cells whole, and their texts."""
    found = {}
    for cell in CELLS:
        for file in files(seed=1, number=cell):
            source = decode(file.data)
            assert isinstance(source, Decoded), file.path
            found[file] = source.text
    return found


@pytest.fixture(scope="module")
def kinds(corpus: Mapping[File, str], recognizer: Recognizer) -> Counter[str]:
    """How often each token occurs in them."""
    names = recognizer.lexer.names
    return Counter(names[kind] for text in corpus.values() for kind in recognizer.kinds(text))


def test_every_program_is_valid(corpus: Mapping[File, str], recognizer: Recognizer) -> None:
    """Our recogniser accepts every file."""
    assert len(corpus) > 300
    assert [] == [file.path for file, text in corpus.items() if not recognizer.accepts(text)]


def test_no_program_breaks_a_fact(corpus: Mapping[File, str]) -> None:
    """What no KRL program has, these do not have either."""
    sample = list(corpus.items())[::5]
    assert [] == [(file.path, violation(text)) for file, text in sample if violation(text)]


@pytest.mark.parametrize("cell", range(1, 7))
def test_antlr_accepts_a_sample(cell: int) -> None:
    """ANTLR's parser accepts the programs too: the shorter ones of a few cells."""
    short = (file for file in files(seed=4, number=cell) if len(file.data) < 2_000)
    for file in islice(short, 5, 50, 5):
        source = decode(file.data)
        assert isinstance(source, Decoded)
        assert None is antlr_reference.refusal(source.text), file.path


def test_no_name_is_too_long(corpus: Mapping[File, str], recognizer: Recognizer) -> None:
    """Names have at most 24 characters, those of files and constants too [TYP-05]."""
    lexer = recognizer.lexer
    numbers = {lexer.names.index("NAME"), lexer.names.index("ENUM_CONSTANT")}
    words = {word for text in corpus.values() for word in lexer.lexemes(text)}
    found = {word.lstrip("#") for word in words if lexer.kinds[word] in numbers}
    assert len(found) > 1_000
    assert [] == [name for name in found if len(name) > 24]
    assert [] == [file.path for file in corpus if len(Path(file.path).stem) > 24]


def test_every_keyword_occurs_at_last(recognizer: Recognizer) -> None:
    """With enough cells there is every statement; some types and lists are only the system's."""
    lexer = recognizer.lexer
    keywords = {name for number, name in enumerate(lexer.names) if lexer.is_keyword(number)}
    system = set("EXTFCT EXTFCTP EXTP POS E3POS AXIS E3AXIS".split())
    missing = {word: re.compile(rf"(?<![\w$#]){word}(?!\w)".encode()) for word in keywords - system}
    assert len(missing) > 100
    for file in chain.from_iterable(files(11, cell) for cell in range(1, 60)):
        for word in [word for word, pattern in missing.items() if pattern.search(file.data)]:
            del missing[word]
        if not missing:
            break
    assert {} == missing


@pytest.mark.parametrize(
    ("keyword", "share"),
    [
        # occurrences for each IF in the whole corpus that was surveyed
        *(("ELSE", 0.33), ("ENDFOR", 0.16), ("SWITCH", 0.085), ("WHILE", 0.024), ("UNTIL", 0.033)),
        *(("LIN", 0.86), ("PTP", 0.35), ("WAIT", 0.74), ("TRIGGER", 0.13), ("HALT", 0.078)),
        *(("CASE", 0.40), ("RETURN", 0.20), ("STRING", 3.2), ("ENUM_CONSTANT", 3.0)),
        *(("LBRACE", 4.6), ("CONTINUE", 0.14), ("GOTO", 0.053), ("STRUC", 0.07), ("ENUM", 0.043)),
    ],
)
def test_proportions_are_those_of_real_programs(
    kinds: Counter[str], keyword: str, share: float
) -> None:
    """What is common in real programs is common here: within a factor of three."""
    found = kinds[keyword] / kinds["IF"]
    assert share / 3 < found < share * 3


def test_all_dialects_occur() -> None:
    """Generations, letters, indentation, line ends and encodings all differ between cells."""
    dialects = [a_dialect(SeededChoices(f"krl 1 {number}")) for number in range(1, 200)]
    assert set(Generation) == {one.generation for one in dialects}
    assert set(Letters) == {one.letters for one in dialects}
    assert {"", "  ", "   ", "    ", "\t"} == {one.indent for one in dialects}
    assert {"en", "de"} == {one.language for one in dialects}


def test_files_are_stored_in_many_ways(corpus: Mapping[File, str]) -> None:
    """Line ends, byte order marks and letters outside ASCII are those of real backups."""
    data = [file.data for file in corpus]
    assert {True, False} == {b"\r\n" in one for one in data}
    assert any(b"\n" not in one for one in data)
    assert any(one.startswith(b"\xef\xbb\xbf") for one in data)
    encodings = {source.encoding for source in map(decode, data) if isinstance(source, Decoded)}
    assert {"cp1252", "utf-8"} <= encodings
    assert any(not one.endswith((b"\r", b"\n")) for one in data)


def test_cells_are_laid_out_like_controllers(corpus: Mapping[File, str]) -> None:
    """A cell has the folders and the modules of a backup, each program in a file of its name."""
    paths = [file.path for file in corpus if file.path.startswith("0001_")]
    parts = {path.split("/", 1)[1] for path in paths}
    assert {"KRC/R1/System/$config.dat", "KRC/R1/Mada/$machine.dat"} <= parts
    assert {"KRC/STEU/Mada/$machine.dat", "KRC/R1/cell.src", "KRC/R1/System/sps.sub"} <= parts
    assert any(part.startswith("KRC/R1/Program/") for part in parts)
    assert any(part.startswith("KRC/R1/TP/") for part in parts)
    stems = Counter(path.rpartition(".")[0] for path in paths)
    assert {1, 2} == set(stems.values())
    assert len(paths) == len({path.lower() for path in paths})


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


def test_corpus_depends_on_the_seed_alone() -> None:
    """Neither the process nor its hash seed has a say; another seed gives other programs."""
    script = (
        "import hashlib; from grammar.generation.cells.cells import files; "
        "print(hashlib.sha256(b''.join(f.data for f in files(7, 2))).hexdigest())"
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
    here = hashlib.sha256(b"".join(file.data for file in files(7, 2))).hexdigest()
    assert {here} == digests
    other = hashlib.sha256(b"".join(file.data for file in files(8, 2))).hexdigest()
    assert here != other
