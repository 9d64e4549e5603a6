"""Random programs: valid, bounded, the same for a seed, and all of the language."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from hypothesis import given, settings, strategies
from hypothesis.strategies import SearchStrategy

from conformance.differential.campaign import world_seed
from conformance.differential.construct_coverage import language
from conformance.differential.divergence import prepared
from conformance.differential.runs import EXECUTORS, trace_of
from grammar.generation.choices import Choices
from grammar.generation.programs import Sample, generate, seeded
from grammar.generation.routine_writer import Size
from interp.native import AVAILABLE
from interp.program.load import Limits
from interp.values.faults import LinkError


def test_programs_follow_from_their_number() -> None:
    """The same seed and number give the same program, others another."""
    assert seeded(3, 7) == seeded(3, 7)
    assert len({seeded(3, number).files for number in range(50)}) == 50
    assert seeded(3, 7) != seeded(4, 7)


def test_every_program_ends_within_its_budget() -> None:
    """The check finds no error, and no run executes more statements than it may."""
    size = Size()
    limits = Limits(statements=size.budget * 2, per_slice=25)
    for number in range(16):
        program = prepared(seeded(12, number).files)
        facts = trace_of(program, EXECUTORS["tree"], world_seed(12, number), limits)
        last = facts[-1]
        assert last[0] in ("End", "Fail")
        assert "BudgetExhausted" not in str(last)
        assert "LinkError" not in str(last)


def test_all_of_the_language_is_written() -> None:
    """Every statement, variant, operator and function comes up in some thousand programs."""
    known = language()
    missing = {
        *(rf"\b{name}\b" for name in known["function"]),
        *(rf"\b{name}\b" for name in known["variant"] if re.fullmatch(r"[A-Z_]+", name)),
        *(rf"INTERRUPT {word}\b" for word in ("ON", "OFF", "ENABLE", "DISABLE")),
        *(rf"{word} {way} " for word in ("ANIN", "ANOUT", "DIGIN") for way in ("ON", "OFF")),
        *(rf"{edge} ?=" for edge in ("START", "PART", "END", "DISTANCE", "PATH", "PRIO")),
        *(r"GLOBAL INTERRUPT DECL", r"CASE [^\n]*,", r"STEP -", r"#BASE\n", r"#TOOL\n", r"\(, "),
        *(r"FOR \w+=2147483646", r"SWRITE\((\w+\[\]), [^\n]*, \1", r"STRADD\((\w+\[\]), \1\)"),
        r"\w+=STRLEN\((\w+\[\])\) ?\+ ?STRADD\(\1",
        *(r"RETURN [^\n]", r"\nEND\n", r"ONSTART", r":OUT", r":IN", r"\[,\]", r"\[,,\]", "RESUME"),
        *(re.escape(f" {one} ") for one in known["operator"] if not one.startswith("sign")),
    }
    for number in range(1500):
        for _, text in seeded(1, number).files:
            missing = {one for one in missing if not re.search(one, text)}
        if not missing:
            break
    assert set() == missing


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


class _Drawn(Choices):
    """Decisions that hypothesis makes, and makes simpler."""

    def __init__(self, draw: Callable[[SearchStrategy[int]], int]) -> None:
        self._draw = draw

    def below(self, end: int) -> int:
        return self._draw(strategies.integers(0, end - 1)) if end > 1 else 0


@strategies.composite
def programs(draw: Callable[[SearchStrategy[int]], int]) -> Sample:
    """Programs of a size that hypothesis has patience for."""
    return generate(_Drawn(draw), Size(budget=200, others=40, statements=3, depth=2, routines=1))


@given(programs())
@settings(max_examples=12)
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
