"""Recovery of a second language: a small assembler, of which no profile knows a fact."""

import re
from functools import cache
from pathlib import Path

import pytest

from grammar.notation.g4 import read, read_file
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.induction.language import CorpusFile, language_of
from recovery.induction.rounds import Induction
from recovery.negatives.negatives import NegativeSet
from support.files.discovery import IngestError

_FOLDER = Path(__file__).with_name("assembler")
_START = read_file(_FOLDER / "start.g4")
_FILES = language_of(".s").files([_FOLDER])


@cache
def _grown(start: Grammar, files: tuple[CorpusFile, ...]) -> Recognizer:
    induction = Induction(start, files, (), NegativeSet(()))
    list(induction.rounds())
    return Recognizer(induction.grammar)


def test_every_folder_is_an_origin() -> None:
    """The files of a language are found by how they end; what lies elsewhere is left out."""
    origins = {"boiler", "clock", "lift", "pump", "sorter"}
    assert origins == {origin for file in _FILES for origin in file.origins}
    assert {".s"} == {Path(file.path).suffix for file in _FILES}


def test_a_file_in_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder is its origin by name, and a byte order mark is no part of its text."""
    (tmp_path / "a.s").write_bytes(b"\xef\xbb\xbfret\n")
    monkeypatch.chdir(tmp_path)
    origins = frozenset({tmp_path.name})
    assert (CorpusFile("a.s", "ret\n", origins),) == language_of(".s").files([Path()])


def test_no_file_is_reported_in_one_line(tmp_path: Path) -> None:
    """Where nothing ends so there is nothing to learn from."""
    with pytest.raises(IngestError, match=r"no file ends in \.s$"):
        language_of(".s").files([tmp_path])


@pytest.mark.parametrize("origin", sorted({o for file in _FILES for o in file.origins}))
def test_an_origin_held_out_is_read(origin: str) -> None:
    """What four origins show reads all programs of the fifth, of which the start reads none."""
    held = [file for file in _FILES if origin in file.origins]
    recognizer = _grown(_START, tuple(file for file in _FILES if file not in held))
    assert [] == [file.path for file in held if Recognizer(_START).accepts(file.text)]
    assert [] == [file.path for file in held if not recognizer.accepts(file.text)]


@pytest.mark.parametrize(
    "line", ["push", "mov r1 r2", "jmp 1, 2 3", "equ", "ret 1 2", "ld r1, [x", "again: : ret"]
)
def test_what_no_program_shows_stays_rejected(line: str) -> None:
    """The grammar that has grown is not one of any words in a row."""
    assert not _grown(_START, _FILES).accepts(f"{line}\n")


def test_the_names_of_tokens_say_nothing() -> None:
    """Tokens with the names that KRL's have give the same grammar but for these names."""
    names = {"WORD": "NAME", "EOL": "NEWLINE"}

    def renamed(text: str) -> str:
        return re.sub(r"\b(WORD|EOL)\b", lambda found: names[found[0]], text)

    grown = _grown(_START, _FILES).grammar.text
    assert renamed(grown) == _grown(read(renamed(_START.text)), _FILES).grammar.text
