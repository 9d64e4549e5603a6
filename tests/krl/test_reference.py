"""The references of the commands and of the library."""

from krl.reference import LIBRARY_PAGE, PAGE, library_reference, reference


def test_the_reference_is_up_to_date() -> None:
    """docs/commands.md is what the commands say of themselves."""
    assert reference() == PAGE.read_text(encoding="utf-8")


def test_the_reference_of_the_library_is_up_to_date() -> None:
    """docs/python-reference.md is what the docstrings of the library say."""
    assert library_reference() == LIBRARY_PAGE.read_text(encoding="utf-8")
