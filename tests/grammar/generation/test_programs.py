"""Generated programs: valid, bounded, the same for a seed, and all of the language."""

from __future__ import annotations

import re

import pytest
from hypothesis import HealthCheck, given, settings

from conformance.differential.campaign import fuzz, world_seed
from conformance.differential.construct_coverage import counted, language, missing
from conformance.differential.divergence import prepared
from conformance.differential.runs import EXECUTORS, trace_of
from grammar.generation.programs.choices import Choices, SeededChoices
from grammar.generation.programs.code import Size
from grammar.generation.programs.programs import Sample, generate, seeded
from grammar.generation.programs.strategies import programs
from interp.native import AVAILABLE
from interp.program.load import Limits
from interp.values.faults import LinkError


def test_programs_follow_from_their_number() -> None:
    """The same seed and number give the same program, others another."""
    assert seeded(3, 7) == seeded(3, 7)
    assert len({seeded(3, number).files for number in range(50)}) == 50
    assert seeded(3, 7) != seeded(4, 7)


def test_every_program_is_valid() -> None:
    """The project's own checker finds no error in any program."""
    for number in range(60):
        prepared(seeded(11, number).files)


def test_every_program_ends_within_its_budget() -> None:
    """No run uses up its statements, and none that is not disturbed executes more than it may."""
    size = Size()
    limits = Limits(statements=size.budget * 2, per_slice=25)
    for number in range(50):
        program = prepared(seeded(12, number).files)
        facts = trace_of(program, EXECUTORS["tree"], world_seed(12, number), limits)
        last = facts[-1]
        assert last[0] in ("End", "Fail")
        assert "BudgetExhausted" not in str(last)
        assert "LinkError" not in str(last)


def test_all_of_the_language_is_written() -> None:
    """Every statement, variant, operator and function comes up in some thousand programs."""
    text = "\n".join(body for number in range(1500) for _, body in seeded(1, number).files)
    words = set(re.findall(r"[A-Z][A-Z0-9_]*", text))
    known = language()
    assert set() == set(known["function"]) - words
    singles = {name for name in known["variant"] if re.fullmatch(r"[A-Z_]+", name)}
    assert set() == singles - words
    patterns = {
        *(rf"INTERRUPT {word}\b" for word in ("ON", "OFF", "ENABLE", "DISABLE")),
        *(rf"{word} {way} " for word in ("ANIN", "ANOUT", "DIGIN") for way in ("ON", "OFF")),
        *(rf"{edge} ?=" for edge in ("START", "PART", "END", "DISTANCE", "PATH", "PRIO")),
        *(r"GLOBAL INTERRUPT DECL", r"CASE [^\n]*,", r"STEP -", r"#BASE\n", r"#TOOL\n", r"\(, "),
        *(r"RETURN [^\n]", r"\nEND\n", r"ONSTART", r":OUT", r":IN", r"\[,\]", r"\[,,\]", "RESUME"),
        *(re.escape(f" {one} ") for one in known["operator"] if not one.startswith("sign")),
    } - {re.escape(" : ")}
    assert set() == {one for one in patterns if not re.search(one, text)}


def test_programs_execute_most_of_it() -> None:
    """A few dozen programs execute nearly all kinds of statements and instructions."""
    left = missing(fuzz(80, 1, ["tree"]).counts)
    known = language()
    for kind in ("node", "variant", "operator", "instruction"):
        assert len(left.get(kind, ())) <= 0.25 * len(known[kind])


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
