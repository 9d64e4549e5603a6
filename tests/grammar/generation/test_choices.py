"""Random decisions from a seed."""

from collections import Counter

from grammar.generation.choices import SeededChoices, Weighted


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
