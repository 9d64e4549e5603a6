"""What memory this process has had."""

from support.measure.peak_memory import peak_memory


def test_peak_stays_when_memory_is_given_back() -> None:
    """The peak counts memory that was in use once and is no longer."""
    held = b"x" * 80_000_000
    size = len(held)
    del held
    peak = peak_memory()
    assert peak is not None
    assert size < peak < 100 * size
