"""Generated programs: valid, bounded, the same for a seed, and all of the language."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings

from conformance.differential.campaign import fuzz, world_seed
from conformance.differential.choices import Choices, SeededChoices
from conformance.differential.code import Size
from conformance.differential.coverage import Counts, counted, language, missing
from conformance.differential.divergence import prepared
from conformance.differential.programs import Sample, generate, seeded
from conformance.differential.runs import EXECUTORS, trace_of
from conformance.differential.strategies import programs
from interp.faults import LinkError
from interp.native import AVAILABLE
from interp.program import Limits

#: Faults that no program can raise which the checker lets pass, and one that nothing raises.
NEVER = {("fault", "nesting")}
#: What stands for what cannot be run; generated programs can.
UNREACHABLE = {("instruction", "UNLINKED")}


def test_programs_follow_from_their_number() -> None:
    """The same seed and number give the same program, others another."""
    assert seeded(3, 7) == seeded(3, 7)
    assert len({seeded(3, number).files for number in range(50)}) == 50
    assert seeded(3, 7) != seeded(4, 7)


def test_every_program_is_valid() -> None:
    """The project's own checker finds no error in any program."""
    for number in range(120):
        prepared(seeded(11, number).files)


def test_every_program_ends_within_its_budget() -> None:
    """No run uses up its statements, and none that is not disturbed executes more than it may."""
    size = Size()
    limits = Limits(statements=size.budget * 2, per_slice=25)
    for number in range(80):
        program = prepared(seeded(12, number).files)
        facts = trace_of(program, EXECUTORS["tree"], world_seed(12, number), limits)
        last = facts[-1]
        assert last[0] in ("End", "Fail")
        assert "BudgetExhausted" not in str(last)
        assert "LinkError" not in str(last)


@pytest.fixture(scope="module")
def counts() -> Counts:
    """What some hundred programs execute, counted together."""
    found = fuzz(350, 1, ["tree"])
    return found.counts


def test_statements_and_operators_are_all_covered(counts: Counts) -> None:
    """Every statement, operator and function comes up, and every variant of statements."""
    left = missing(counts)
    found = {(kind, name) for kind, names in left.items() for name in names}
    rare = {one for one in found if one[0] in ("fault", "instruction")}
    assert found - rare <= {("function", name) for name in ("STRTOE3AXIS", "STRTOE3POS")}
    assert {"node", "variant", "operator", "function", "instruction", "fault"} == set(language())


def test_instructions_are_covered(counts: Counts) -> None:
    """Nearly all instructions come up in a few hundred programs."""
    names = language()["instruction"]
    found = [name for name in names if counts["instruction", name]]
    assert len(found) >= 0.95 * len(names)


def test_counts_are_of_what_was_executed() -> None:
    """What stands on lines that were never reached does not count."""
    text = "DEF PROG()\nINT I\nI=1\nIF I==2 THEN\nWAIT SEC 1+2*I\nENDIF\nEND\n"
    program = prepared((("PROG.SRC", text),))
    found = counted(program, trace_of(program, EXECUTORS["tree"], "x"))
    assert (1, 1, 0) == (found["node", "If"], found["operator", "=="], found["node", "WaitSeconds"])
    assert (0, 0) == (found["operator", "*"], found["instruction", "MUL_INT"])


class _First(Choices):
    """Always the first choice."""

    def below(self, end: int) -> int:
        assert end >= 1
        return 0


def test_the_simplest_choices_make_a_program() -> None:
    """Where every decision is the first one, the program is short and valid."""
    sample = generate(_First())
    prepared(sample.files)
    assert sum(text.count("\n") for _, text in sample.files) < 60


def test_weights_and_chances() -> None:
    """A chance of 0 never comes, one of 100 always; weights are kept."""
    choices = SeededChoices("x")
    assert [False] * 50 == [choices.chance(0) for _ in range(50)]
    assert [True] * 50 == [choices.chance(100) for _ in range(50)]
    drawn = [choices.weighted(((1, "a"), (9, "b"))) for _ in range(1000)]
    assert 50 < drawn.count("a") < 160


@given(programs())
@settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
def test_hypothesis_makes_the_same_language(sample: Sample) -> None:
    """Programs drawn by hypothesis check too, and executors agree on them."""
    try:
        program = prepared(sample.files)
    except LinkError as error:
        pytest.fail(f"{error}\n{dict(sample.files)}")
    expected = trace_of(program, EXECUTORS["tree"], "drawn")
    assert expected == trace_of(program, EXECUTORS["vm"], "drawn")
    if AVAILABLE:
        assert expected == trace_of(program, EXECUTORS["native"], "drawn")
