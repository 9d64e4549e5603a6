"""A syntax error costs its statement, not the file."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.diagnostics.error_recovery import recover
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import names_in_text

CELL = """&ACCESS RVP
DEF CELL()
  DECL INT COUNT
  ; counting
  FOR COUNT = 1 TO 3
    IF COUNT == 2 THEN
      WORK(COUNT)
    ELSE
      HALT
    ENDIF
  ENDFOR
  SWITCH COUNT
    CASE 1
      WORK(1)
    DEFAULT
      WORK(2)
  ENDSWITCH
END

DEF WORK(A:IN)
  DECL INT A
  $OUT[A] = TRUE
END
"""


def routines(module: ast.Module | None) -> list[str]:
    assert module is not None
    assert isinstance(module.content, ast.Program)
    return [routine.name.text for routine in module.content.routines]


@pytest.mark.parametrize(
    ("right", "wrong", "line"),
    [
        ("WORK(COUNT)", "WORK(COUNT", 7),
        ("ENDIF", "ENDIFF", 10),
        ("ENDIF", "", 11),
        ("ELSE", "ELS", 8),
        ("FOR COUNT", "FRO COUNT", 5),
        ("ENDFOR", "ENDFO", 11),
        ("      HALT\n", "      REPEAT\n        HALT\n        \n", 12),
        ("CASE 1", "CSE 1", 13),
        ("ENDSWITCH", "ENDSWICH", 17),
        ("END\n\nDEF", "EEND\n\nDEF", 18),
        ("END\n\nDEF", "\n   \nDEF", 20),
        ("DEF CELL()", "DFE CELL()", 2),
        ("DEF WORK(A:IN)", "DEF WORK(A:IN", 20),
        ("DEF WORK(A:IN)", "DEF WORK(A:IN) =", 20),
        ("CASE 1", "CASE 1 )", 13),
        ("CASE 1", "CASE ) 1", 13),
        ("FOR COUNT = 1 TO 3", "FOR COUNT = 1 TO 3 )", 5),
    ],
)
def test_one_mistake_is_one_failure_and_keeps_all_routines(
    right: str, wrong: str, line: int
) -> None:
    """A damaged line gives one failure, on it or where its loss shows, and callers see all."""
    found = recover(CELL.replace(right, wrong, 1))
    assert [line] == [failure.line for failure in found.failures if not failure.follows]
    assert ["CELL", "WORK"] == routines(found.syntax)


def test_a_variable_with_the_name_of_a_keyword_is_one_failure() -> None:
    """Its declaration is reported; its uses follow, and all other names of the lines are known."""
    text = CELL.replace("INT COUNT", "INT OFF, COUNT").replace("HALT", "OFF = off + COUNT ;off")
    found = recover(text.replace("COUNT == 2", "OFF == 2"))
    assert [(3, False), (6, True), (9, True)] == [
        (failure.line, failure.follows) for failure in found.failures
    ]
    assert found.syntax is not None
    assert "OF_ = OF_ + COUNT ;off" in found.text


@pytest.mark.parametrize(
    ("line", "lines"),
    [("COUNT[1=3", [5, 7]), ("ENDFI", [5]), ("HALT ENDIF", [5]), ("  N=2 +", [5, 7])],
)
def test_a_block_is_missed_behind_another_mistake(line: str, lines: list[int]) -> None:
    """An open block is reported unless a line that failed before may be what closes it."""
    text = f"DEF NEG()\nINT N\nIF N==1 THEN\nN=2\n{line}\n\nEND\n"
    found = recover(text)
    assert lines == [failure.line for failure in found.failures if not failure.follows]


def test_what_follows_from_a_routine_that_is_not_closed() -> None:
    """Where its end has no room in the text, the whole cannot be read; it is one failure still."""
    text = CELL.replace("  ; counting\n", "").replace("END\n\nDEF", "\n\nDEFFCT BOOL", 1)
    found = recover(f"{text[:-4]}ENDFCT\n; the last line")
    assert found.syntax is None
    assert [19] == [failure.line for failure in found.failures if not failure.follows]
    assert len(found.failures) > 1


def test_what_was_left_out_is_known() -> None:
    """The text of the lines that cannot be read is kept: they may declare something."""
    found = recover(CELL.replace("DECL INT A\n", "DECL INT A B\n"))
    assert "DECL INT A B" == found.dropped.strip()


@pytest.mark.parametrize("lost", [0, 4, 10, 30, 62, 130, 200])
def test_a_file_without_its_end_is_cut(lost: int) -> None:
    """What ends too early may have declared anything; a line that cannot be read ends nothing."""
    text = CELL.replace("WORK(1)", "WORK(1").rstrip()
    assert (lost > 0) == recover(text[: len(text) - lost]).is_cut


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("DEFDAT CELL\nENUM STATES EMPTY, FU", {"STATES"}),
        ("DEF CELL()\nHALT\nCOUNT = COU", {"COU"}),
        ("DEFDAT CE", {"CE"}),
    ],
)
def test_a_line_that_is_cut_is_not_read(text: str, words: set[str]) -> None:
    """A name in it may be the beginning of one, whether a controller would read it or not."""
    found = recover(text)
    assert found.is_cut
    assert words <= names_in_text(found.dropped)
    assert 1 == len(found.failures)
    assert (found.syntax is None) == (text == "DEFDAT CE")


def test_places_stay() -> None:
    """What is read has the places that it has in the text."""
    text = CELL.replace("WORK(COUNT)", "WORK(COUNT")
    found = recover(text, "cell.src")
    assert found.syntax is not None
    assert isinstance(found.syntax.content, ast.Program)
    start, end = found.syntax.content.routines[1].name.span
    assert "WORK" == text[start:end]
    assert ["cell.src"] == [failure.path for failure in found.failures]


@given(st.data())
def test_any_line_may_be_lost(data: st.DataObject) -> None:
    """Whatever line is damaged, recovery ends, and tells of a failure unless there is none."""
    lines = CELL.splitlines(keepends=True)
    at = data.draw(st.integers(1, len(lines) - 1))
    damage = data.draw(st.sampled_from(["", "?\n", "END\n", "IF\n", "DEF\n", "ENDIF\n", "A B C\n"]))
    text = "".join([*lines[:at], damage, *lines[at + 1 :]])
    if isinstance(read_module(text), list):
        found = recover(text)
        assert any(not failure.follows for failure in found.failures)


@pytest.mark.parametrize(
    ("head", "end", "read"),
    [
        ("IF A = = 3 THEN", "ENDIF", "IF TRUE THEN"),
        ("FOR I=1 TOO 3", "ENDFOR", "FOR I=1 TO 1"),
        ("REPEAT", "UNTIL A > > 3", "UNTIL TRUE"),
    ],
)
def test_blocks_with_a_line_that_cannot_be_read(head: str, end: str, read: str) -> None:
    """Such a block is gone through once, and only the line is told."""
    found = recover(f"DEF WORK()\n{head}\nB=1\n{end}\nEND\n")
    assert found.syntax is not None
    assert read in [line.rstrip() for line in found.text.splitlines()]
    assert [False] == [failure.follows for failure in found.failures]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("&ACCESS RVP\n&PARAM EDITMASK = *\nINT N\nN=1\nEND\nDEF B()\nEND\n", ["WORK", "B"]),
        ("DEF B()\nEND\n; a comment that is long\nGLOBAL INTERRUPT OFF 3\nEND\n", ["B", "A"]),
        ("DEE WORK(P:IN)\nN=1\nEND\n", ["WORK"]),
    ],
)
def test_a_first_line_that_is_lost_costs_no_other_line(text: str, names: list[str]) -> None:
    """A free line before takes it; the first routine is called like the file."""
    found = recover(text, "R1/WORK.src")
    assert names == routines(found.syntax)
    assert 1 == len(found.failures)
    assert names[names == ["B", "A"]] in found.dropped


@pytest.mark.parametrize("head", ["IF A = = 3 THEN", "FOR I=1 TOO 3", "CASE ) 1"])
def test_a_head_that_cannot_be_read_and_opens_nothing(head: str) -> None:
    """A damaged head without its end, as somebody types it, costs no other line."""
    found = recover(f"DEF WORK()\n{head}\nB=1\nEND\nDEF OTHER()\nEND\n")
    assert ["WORK", "OTHER"] == routines(found.syntax)
    assert [2] == [failure.line for failure in found.failures if not failure.follows]
