"""Shrinking: what is left passes, and nothing of it can go."""

from hypothesis import given
from hypothesis import strategies as st

from recovery.reproducer.ddmin import minimized


def test_pairs_go_together() -> None:
    """Brackets around something that stays go, though neither can go alone."""

    def balanced(left: list[str]) -> bool:
        return "x" in left and left.count("(") == left.count(")")

    assert minimized(list("a(b(x)c)"), balanced) == ["x"]


@given(
    st.lists(st.integers(0, 9), max_size=60),
    st.lists(st.frozensets(st.integers(0, 9), min_size=1, max_size=3), max_size=4),
)
def test_the_result_passes_and_is_minimal(items: list[int], wanted: list[frozenset[int]]) -> None:
    """Whatever is asked of the items, the result has it and has it no longer without one item."""

    def passes(left: list[int]) -> bool:
        return all(want & set(left) for want in wanted)

    if not passes(items):
        return
    left = minimized(items, passes)
    assert passes(left)
    assert [i for i in range(len(left)) if passes(left[:i] + left[i + 1 :])] == []
