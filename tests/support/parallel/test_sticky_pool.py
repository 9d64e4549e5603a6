"""Processes chosen by number keep what tasks leave in them."""

import pytest

from support.parallel.sticky_pool import StickyPool


def _kept(key: str, value: int | None = None, _state: dict[str, int] = {}) -> int | None:  # noqa: B006
    # what a process keeps, here as a default that stays between calls
    if value is not None:
        _state[key] = value
    return _state.get(key)


@pytest.mark.parametrize("count", [1, 2])
def test_a_process_keeps_what_a_task_left(count: int) -> None:
    """It is there for later tasks of the same process; errors come back."""
    with StickyPool(count) as pool:
        written = [pool.submit(number, _kept, "k", number) for number in range(count)]
        assert list(range(count)) == [one.result() for one in written]
        read = [pool.submit(number, _kept, "k") for number in range(count)]
        assert list(range(count)) == [one.result() for one in read]
        with pytest.raises(ZeroDivisionError):
            pool.submit(0, divmod, 1, 0).result()


def test_the_least_loaded_process_is_next() -> None:
    """Loads are added up by process."""
    with StickyPool(3) as pool:
        assert [0, 1, 2, 1, 0] == [pool.least_loaded(load) for load in (5, 1, 9, 5, 1)]
