"""The reference of the commands."""

from krl.reference import PAGE, reference


def test_the_reference_is_up_to_date() -> None:
    """docs/commands.md is what the commands say of themselves."""
    assert reference() == PAGE.read_text(encoding="utf-8")
