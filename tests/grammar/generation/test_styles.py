"""Both styles of the generator together: all nodes of the syntax tree; decisions from a seed."""

from collections import Counter
from collections.abc import Iterator
from itertools import islice
from typing import get_args

from grammar.generation.cells.cells import files
from grammar.generation.choices import SeededChoices, Weighted
from grammar.generation.closed.programs import seeded
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.walk import walk
from support.files.decode import Decoded, decode

#: Statements and expressions that neither style writes, each with its reason.
LEFT_OUT: dict[str, str] = {}


def texts() -> Iterator[str]:
    """Programs of both styles."""
    for number in range(300):
        yield from (text for _, text in seeded(3, number).files)
    for file in islice(files(seed=3, number=1), 60):
        source = decode(file.data)
        assert isinstance(source, Decoded), file.path
        yield source.text


def test_every_node_is_generated() -> None:
    """Some style writes every statement and expression but those that are left out for a reason."""
    missing = {one.__name__ for one in get_args(ast.Statement | ast.Expression)} - LEFT_OUT.keys()
    for text in texts():
        module = read_module(text)
        assert isinstance(module, ast.Module), text
        written = {type(node).__name__ for node in walk(module)}
        assert [] == sorted(written & LEFT_OUT.keys())
        missing -= written
        if not missing:
            break
    assert set() == missing


def test_weights_decide_how_often_something_is_drawn() -> None:
    """What weighs nine times as much is drawn about nine times as often."""
    choices = SeededChoices("weights")
    weighted = Weighted((9, "often"), (1, "seldom"))
    drawn = Counter(choices.weighted(weighted) for _ in range(2_000))
    assert 1_700 < drawn["often"] < 1_900


def test_chances() -> None:
    """A chance of 0 never comes, one of 100 always."""
    choices = SeededChoices("chances")
    assert [False] * 50 == [choices.chance(0) for _ in range(50)]
    assert [True] * 50 == [choices.chance(100) for _ in range(50)]


def test_few_are_different_and_in_order() -> None:
    """As many as asked for are chosen, none twice, in the order given; all where there are less."""
    choices = SeededChoices("few")
    chosen = list(choices.few(range(100), 10))
    assert 10 == len(set(chosen))
    assert sorted(chosen) == chosen
    assert [1, 2] == list(choices.few([1, 2], 5))
