"""How the cost of a call grows."""

import pytest

from support.measure.cost_by_size import Cost, Growth


def _growth(*seconds: float, peaks: tuple[int, ...] = (1, 1, 1)) -> Growth:
    costs = (
        Cost(1_000 << number, 0.5 + cost, (100 + peak) << 20)
        for number, (cost, peak) in enumerate(zip(seconds, peaks, strict=True))
    )
    return Growth(Cost(1, 0.5, 100 << 20), tuple(costs))


@pytest.mark.parametrize(
    ("seconds", "slope"),
    [
        ((1, 2, 4), 1.0),
        ((1, 4, 16), 2.0),
        ((1, 1, 1), 0.0),
        ((0.001, 0.02, 0.15), 0.0),
        ((-0.25, 0, 0.5), 1.0),
    ],
)
def test_slope_is_the_exponent(seconds: tuple[float, ...], slope: float) -> None:
    """What a call costs without input does not count, nor what no clock can tell."""
    assert slope == pytest.approx(_growth(*seconds).time_slope)


def test_slope_of_memory() -> None:
    """Memory counts above what is there without input; a little more is no growth."""
    assert 2.0 == pytest.approx(_growth(1, 2, 4, peaks=(8, 32, 128)).memory_slope)
    assert 0.0 == _growth(1, 2, 4, peaks=(0, 1, 8)).memory_slope


def test_one_size_has_no_slope() -> None:
    """Where the first size took too long, nothing is said of growth."""
    assert None is _growth(60.0, peaks=(1,)).time_slope
