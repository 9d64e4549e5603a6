"""Copies of programs."""

import random
from collections import Counter
from pathlib import Path

import pytest

from grammar.notation.krl_grammar import krl_grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.bench.copies import Template, templates, write_copies, write_corpus
from support.files.discovery import source_files

PROGRAM = """&ACCESS RVP
DEF place_box1( )
  DECL INT count
  ;FOLD PTP P1 Vel=100 % {PE}
  count = 12.5 + box1.x
  fr={x 0.05,y 0,z 120.5E1}
  $OUT[7] = TRUE
  mask = 'B0110'
  note[] = "part 12"
  state = #BUSY2
  LOOP
    PTP XP1
  ENDLOOP
END
"""
FAILING = "DEF b()\ncount = 1\nWAT count\nEND\n"
ROUTINES = "DEF main()\nEND\n" + "".join(f"DEF part{n}()\nA={n}\nEND\n" for n in range(200))

FINDER = FailureFinder(Recognizer(krl_grammar()))


def template_of(folder: Path, text: str) -> Template:
    """Return the template of a program in a folder of its origin."""
    file = folder / "OWNER__CELL" / "R1" / "main.src"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8", newline="\n")
    (found,) = templates(source_files([folder]), FINDER)
    return found


def copy(template: Template, number: int = 7) -> str:
    """Return a copy with the digits backwards."""
    return template.copy("9876543210", f"_{number}", random.Random(number))


def test_copy_changes_names_and_numbers_only(tmp_path: Path) -> None:
    """Whole numbers and all names that others know stay: the copy is as valid as its program."""
    expected = (
        PROGRAM.replace("place_box1(", "place_box1_7(")
        .replace("count", "count_7")
        .replace("12.5 + box1.x", "12.4 + box1_7.x")
        .replace("  fr={x 0.05,y 0,z 120.5E1}", "  fr_7={x 0.04,y 0,z 120.4E1}")
        .replace("mask", "mask_7")
        .replace("note[]", "note_7[]")
        .replace("state", "state_7")
        .replace("XP1", "XP1_7")
    )
    assert expected == copy(template_of(tmp_path, PROGRAM))
    recognizer = FINDER.recognizer
    assert recognizer.kinds(PROGRAM) == recognizer.kinds(expected)


def test_failing_lines_keep_their_names(tmp_path: Path) -> None:
    """What fails is the same in every copy."""
    expected = "DEF b_7()\ncount_7 = 1\nWAT count\nEND\n"
    assert expected == copy(template_of(tmp_path, FAILING))


def test_some_routines_are_left_out(tmp_path: Path) -> None:
    """The first routine stays; of the others a tenth is missing, other ones in each copy."""
    template = template_of(tmp_path, ROUTINES)
    counts = []
    for number in range(5):
        text = copy(template, number)
        assert text.startswith(f"DEF main_{number}()")
        assert FINDER.recognizer.accepts(text)
        counts.append(tuple(n for n in range(200) if f"part{n}_" in text))
    assert 5 == len(set(counts))
    assert 800 < sum(map(len, counts)) < 1_000


def test_corpus_has_the_size_and_no_content_twice(tmp_path: Path) -> None:
    """Copies lie as their programs do, and are as large as asked for by less than a file more."""
    template = template_of(tmp_path / "from", PROGRAM)
    for folder, seed in (("a", 1), ("b", 1), ("c", 2)):
        write_copies([template], tmp_path / folder, 20_000, seed)
    a, b, c = (
        {
            file.relative_to(tmp_path / name): file.read_bytes()
            for file in tmp_path.glob(f"{name}/*/*/*")
        }
        for name in "abc"
    )
    assert Path("OWNER__CELL_1", "R1", "main_1.src") in a
    assert 20_000 <= sum(map(len, a.values())) < 20_000 + 300
    assert 1 == max(Counter(a.values()).values())
    assert a == b != c


def test_programs_without_a_name_make_no_corpus(tmp_path: Path) -> None:
    """Text without a name gives no template, and without templates nothing can be written."""
    (tmp_path / "a.src").write_text("; 12\nEND\n", encoding="utf-8")
    assert [] == list(templates(source_files([tmp_path]), FINDER))
    with pytest.raises(ValueError, match="no name"):
        write_corpus([tmp_path], tmp_path / "out", 1_000, 1)


@pytest.mark.parametrize("has_programs", [True, False])
def test_a_tenth_of_a_corpus_is_random(tmp_path: Path, *, has_programs: bool) -> None:
    """All of it is, where there is nothing to copy; whatever is written is reported and valid."""
    template_of(tmp_path / "from", PROGRAM)
    reported: list[int] = []
    roots = [tmp_path / "from"] if has_programs else []
    written = write_corpus(roots, tmp_path / "to", 40_000, 1, reported.append)
    files = [path for path in (tmp_path / "to").rglob("*") if path.is_file()]
    copies = [path for path in files if "OWNER" in str(path)]
    assert has_programs == (36_000 <= sum(path.stat().st_size for path in copies))
    assert (len(files), sum(reported)) == (written.files, written.bytes)
    assert written.cells == len(list((tmp_path / "to").iterdir()))
    assert all(FINDER.recognizer.accepts(path.read_text(encoding="utf-8")) for path in files)
