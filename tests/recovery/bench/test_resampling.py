"""Programs made from real ones for the benches."""

import hashlib
from pathlib import Path

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.bench.resampling import spread, templates, write_corpus

PROGRAM = """&ACCESS RVP
DEF place_box1( )
  DECL INT count
  ;FOLD PTP P1 Vel=100 % {PE}
  count = 12 + box1
  $OUT[7] = TRUE
  mask = 'B0110'
  note[] = "part 12"
  state = #BUSY2
  LOOP
    PTP XP1
  ENDLOOP
END
"""


@pytest.fixture(scope="module")
def recognizer() -> Recognizer:
    """A recogniser of the grammar in force."""
    return Recognizer(read_file(GRAMMAR))


def _digests(folder: Path) -> list[str]:
    return [hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(folder.rglob("*.src"))]


def test_copy_reads_as_its_program_does(recognizer: Recognizer) -> None:
    """A copy has the token kinds of its program, in the same order."""
    (template,) = templates([PROGRAM], recognizer.lexer)
    copy = template.copy("9876543210", "_7")
    assert PROGRAM != copy
    assert recognizer.kinds(PROGRAM) == recognizer.kinds(copy)


def test_copy_changes_names_and_numbers_only(recognizer: Recognizer) -> None:
    """Keywords, system variables, constants, strings and comments of a copy stay as written."""
    (template,) = templates([PROGRAM], recognizer.lexer)
    expected = (
        PROGRAM.replace("place_box1(", "place_box1_7(")
        .replace("count", "count_7")
        .replace("12 + box1", "87 + box1_7")
        .replace("$OUT[7]", "$OUT[2]")
        .replace("mask", "mask_7")
        .replace("note[]", "note_7[]")
        .replace("state", "state_7")
        .replace("XP1", "XP1_7")
    )
    assert expected == template.copy("9876543210", "_7")


def test_corpus_has_the_size_and_no_file_twice(recognizer: Recognizer, tmp_path: Path) -> None:
    """A corpus is as large as asked for, by less than a file more, and its files all differ."""
    chosen = list(templates([PROGRAM, PROGRAM.replace("box1", "pallet")], recognizer.lexer))
    written = write_corpus(chosen, tmp_path, 20_000)
    sizes = [p.stat().st_size for p in tmp_path.rglob("*.src")]
    assert written.bytes == sum(sizes)
    assert 20_000 <= written.bytes < 20_000 + max(sizes)
    assert written.files == len(set(_digests(tmp_path)))


def test_corpus_depends_on_the_seed_alone(recognizer: Recognizer, tmp_path: Path) -> None:
    """The same seed writes the same files, another seed others."""
    chosen = list(templates([PROGRAM], recognizer.lexer))
    for folder, seed in (("a", 1), ("b", 1), ("c", 2)):
        write_corpus(chosen, tmp_path / folder, 3_000, seed)
    assert _digests(tmp_path / "a") == _digests(tmp_path / "b")
    assert set(_digests(tmp_path / "a")).isdisjoint(_digests(tmp_path / "c"))


def test_programs_without_a_name_make_no_corpus(recognizer: Recognizer, tmp_path: Path) -> None:
    """Text without a name gives no template, and without templates nothing can be written."""
    assert [] == list(templates(["; 12\nEND\n"], recognizer.lexer))
    with pytest.raises(ValueError, match="no name"):
        write_corpus([], tmp_path, 1_000)


def test_spread_mixes_sizes_evenly() -> None:
    """Every beginning of the order takes from small and large alike, and nothing is lost."""
    order = spread("x" * size for size in range(16))
    assert list(range(16)) == sorted(map(len, order))
    assert {0, 1, 2, 3} == {len(text) // 4 for text in order[:4]}
