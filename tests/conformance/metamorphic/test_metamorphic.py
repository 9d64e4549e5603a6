"""Metamorphic laws: each holds on small programs, and what breaks one is seen."""

from dataclasses import replace
from random import Random
from typing import Any

import pytest

from conformance.metamorphic import motion_changes
from conformance.metamorphic.comparison import (
    Compare,
    at_most_twice,
    no_sooner,
    same_axes,
    same_effects,
    same_geometry,
    same_trace,
)
from conformance.metamorphic.law import Law, run_law
from conformance.metamorphic.law_checks import LAWS, record_of, try_laws
from conformance.metamorphic.motion_programs import moving_program
from conformance.metamorphic.subject import Program, Run
from conformance.metamorphic.tree_rewriting import integer, rewritten
from grammar.generation.programs import Sample
from grammar.syntax import ast
from interp.tree import statements
from interp.values.operators import apply

COMPUTES = """\
DEF PROG()
  INT N, M
  DECL REAL R
  INT C
  FRAME F
  STRUC PART INT N
  DECL PART P
  P.N = 4
  F = {X 1.5, Y 2, Z 3}
  N = 0
  C=0
  WHILE N < 5
    N = N + 1
    IF N == 3 THEN
      C = C + 10
    ELSE
      NEXT()
    ENDIF
  ENDWHILE
  REPEAT
    M = N * 2 + 1
    N = N - 2
  UNTIL N <= 0
  FOR N = 5 TO -3 STEP -2
    M = M + N
  ENDFOR
  FOR N = 1 TO 3
    M = M + N
  ENDFOR
  SWITCH M
    CASE 1, 3
      R = 0.5 + 1.25
    CASE 5
      R = 2.5
    DEFAULT
      R = M / 2.0
  ENDSWITCH
  LOOP
    C = C + 1
    IF C > 20 THEN
      EXIT
    ENDIF
    LAST()
  ENDLOOP
END
DEF NEXT()
  $OUT[1] = NOT $OUT[1]
  $OUT[2] = TRUE
END
DEF LAST()
  WAIT SEC 0.01
END
"""
#: Two lines and a turn, as laws about lines need them.
MOVES = """\
DEF PROG()
  $BASE = $NULLFRAME
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  $VEL.CP = 0.4
  LIN {X 500.0, Y 50.0, Z 750.0}
  LIN {X 560.0, Y -50.0, Z 700.0}
  $OUT[3] = TRUE
  LIN {X 480.0, Y 0.0, Z 720.0}
END
"""


def _program(text: str) -> Program:
    return Program.of_sample(Sample((("PROG.SRC", text),)), "here", seconds=30.0)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_each_law_applies_and_holds(law: Law) -> None:
    """Every law changes one of three small programs at least, and nothing is noticed."""
    programs = [
        _program(COMPUTES),
        _program(MOVES),
        Program.of_sample(moving_program(1, 2), "m", 60.0),
    ]
    found = [run_law(law, program) for program in programs]
    tried = [one for one in found if one is not None]
    assert [""] * len(tried) == [one.difference for one in tried]
    assert tried


@pytest.mark.parametrize("loop", ["WHILE N < 5", "FOR I = N TO 5"])
def test_what_an_error_skips_stays_one_statement(loop: str) -> None:
    """A loop behind ON_ERROR_PROCEED is not written as several statements, but others are."""
    block = f"{loop}\nEND{loop.partition(' ')[0]}\n"
    program = _program(f"DEF PROG()\nINT I, N\nON_ERROR_PROCEED\n{block}N = 9\n{block}END\n")
    found = [run_law(law, program) for law in LAWS if "loop" in law.name or "FOR" in law.name]
    tried = [one for one in found if one is not None]
    assert [""] == [one.difference for one in tried]


def _with_n_plus_two(node: ast.Node) -> ast.Node:
    match node:
        case ast.Binary(operator="+", right=ast.IntegerLiteral(value=1)):
            return replace(node, right=integer(2))
    return node


def _counting_wrongly(program: Program, _random: Random) -> Program:
    modules = program.modules or {}
    return program.written(
        {path: rewritten(one, _with_n_plus_two) for path, one in modules.items()}
    )


@pytest.mark.parametrize("is_changed", [False, True])
def test_each_node_of_a_long_sum_is_changed_once(is_changed: bool) -> None:
    """Every operation goes through a change once, whether or not what is in it was changed."""
    seen: list[ast.Node] = []

    def change(node: ast.Node) -> ast.Node:
        if isinstance(node, ast.Binary):
            seen.append(node)
            return replace(node, operator="-") if is_changed else node
        return node

    modules = _program(f"DEF PROG()\nINT N\nN={'+'.join('N' * 12)}\nEND\n").modules or {}
    for module in modules.values():
        rewritten(module, change)
    assert 11 == len(seen)


@pytest.mark.parametrize("compare", [same_trace, same_effects])
def test_a_wrong_change_of_a_program_is_caught(compare: object) -> None:
    """Adding 2 in place of 1 breaks the law, and the first value that differs is told."""
    assert callable(compare)
    attempt = run_law(Law("wrong", "", (), compare, _counting_wrongly), _program(COMPUTES))
    assert attempt is not None
    assert "assign N 1" in attempt.difference
    assert "assign N 2" in attempt.difference
    assert attempt.changed


def _moved_too_far(program: Program, _random: Random) -> Program:
    text = program.case.sources[0].text.replace("X 560.0", "X 562.0")
    return program.with_texts({"PROG.SRC": text})


@pytest.mark.parametrize("compare", [same_axes, same_geometry])
def test_a_point_that_lies_elsewhere_is_caught(compare: object) -> None:
    """Two millimetres of another path are seen, where times are compared and where they are not."""
    assert callable(compare)
    wrong = Law("wrong", "", (), compare, _moved_too_far, Run(robot="kinematic"))
    attempt = run_law(wrong, _program(MOVES))
    assert attempt is not None
    assert ("degrees" if compare is same_geometry else "motion_end 3") in attempt.difference


def test_a_base_shifted_without_its_points_is_caught() -> None:
    """The law about frames fails when the points stay."""

    def change(program: Program, random: Random) -> Program | None:
        found = motion_changes._shifted(program, random)
        assert found is not None
        back = {f"{n - 24:.4f}": f"{n:.4f}" for n in (500, 560, 480)}
        text = found.case.sources[0].text
        for new, old in back.items():
            text = text.replace(f"X {new}", f"X {old}")
        return found.with_texts({"PROG.SRC": text})

    law = Law("wrong", "", (), same_axes, change, Run(robot="kinematic"))
    attempt = run_law(law, _program(MOVES).plain)
    assert attempt is not None
    assert attempt.difference


def test_the_override_changes_times() -> None:
    """What leaves the path as it is changes the trace: the law about it is no law about times."""
    law = next(one for one in LAWS if one.name == "override")
    attempt = run_law(replace(law, compare=same_trace), _program(MOVES))
    assert attempt is not None
    assert attempt.difference


@pytest.mark.parametrize(("percent", "compare"), [(30, at_most_twice), (200, no_sooner)])
def test_times_beyond_their_bounds_are_caught(percent: int, compare: Compare) -> None:
    """A third of the speed is more than twice the time, and twice the speed ends sooner."""
    slow = MOVES.replace("$VEL.CP = 0.4", "$VEL.CP = 0.06")
    text = slow.replace("0.06", str(0.06 * percent / 100))
    law = Law("wrong", "", (), compare, lambda *_: _program(text), Run(robot="kinematic"))
    attempt = run_law(law, _program(slow))
    assert attempt is not None
    assert "motions end after" in attempt.difference


def test_a_loop_one_pass_short_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tree interpreter whose FOR leaves its last pass out breaks a law."""

    def wrong(operator: str, left: Any, other: Any) -> Any:
        return apply({">": ">=", "<": "<="}.get(operator, operator), left, other)

    monkeypatch.setattr(statements, "apply", wrong)
    attempt = run_law(next(one for one in LAWS if one.name == "FOR as WHILE"), _program(COMPUTES))
    assert attempt is not None
    assert attempt.difference


def test_a_blend_that_depends_on_the_override_is_caught() -> None:
    """The law about the override applies to blends by distance, not to those by speed."""
    law = next(one for one in LAWS if one.name == "override")
    blends, speed = (MOVES.replace("700.0}", f"700.0}} {by}") for by in ("C_DIS", "C_VEL"))
    wrong = replace(law, change=lambda *_: _program(blends.replace("$VEL", "$APO.CDIS=30\n  $VEL")))
    assert run_law(law, _program(speed)) is None
    for one, is_broken in ((law, False), (wrong, True)):
        attempt = run_law(one, _program(blends.replace("$OUT[3] = TRUE", "")))
        assert attempt is not None
        assert is_broken is bool(attempt.difference)


def test_a_law_that_does_not_apply_says_so() -> None:
    """A program without any loop has none to be written with GOTO."""
    law = next(one for one in LAWS if one.name.startswith("GOTO"))
    assert run_law(law, _program(MOVES)) is None


def test_programs_that_know_their_lines_are_left_alone() -> None:
    """A program that reads the line of an error is not one for changes of its text."""
    text = MOVES.replace("$OUT[3] = TRUE", "$OUT[3] = $ERR.LINE_NR > 3")
    law = next(one for one in LAWS if one.name == "folding")
    assert run_law(law, _program(text)) is None


def test_the_record_counts_what_was_tried() -> None:
    """Without cases, laws are tried on generated programs; the record has each of them once."""
    found = try_laws([], 1, seed=3)
    record = record_of(found, 1, 3)
    assert [one.name for one in LAWS] == [row["name"] for row in record["laws"]]
    assert len(LAWS) >= 12
    assert sum(one.applied for one in found) == sum(row["held"] for row in record["laws"])
    assert sum(one.applied for one in found) > len(found)
