"""The ranking is worked out in several runs, and one that differs is told."""

import os

from grammar.notation import g4
from recovery.bench.assessment import BenchMaterial
from recovery.bench.mutation import mutants
from recovery.bench.stability import rankings, same_ranking


def test_two_runs_tell_the_same(small_grammar: str) -> None:
    """Other hashes and more processes change no ranking, and the environment stays as it was."""
    grammar = g4.read(small_grammar)
    before = os.environ.get("PYTHONHASHSEED")
    shown = (("a", "DEF A()\nHALT\nEND\n"), ("b", "DEF A()\nWAIT B\nEND\n"))
    chosen = [m for m in mutants(grammar) if m.kind == "alternative"]
    done: list[int] = []
    found = rankings(BenchMaterial(grammar, shown, (), ()), chosen, 2, done.append)
    assert found[0] == found[1]
    assert len(chosen) == len(set(found[0]))
    assert [1, 1] == done
    assert before == os.environ.get("PYTHONHASHSEED")


def test_one_other_ranking_counts() -> None:
    """A mutant counts whose ranking is the same in all runs."""
    assert 0.5 == same_ranking([["a", "b"], ["a", "b"], ["a", "c"]])
    assert same_ranking([[], []]) is None
