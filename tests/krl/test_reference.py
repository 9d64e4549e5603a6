"""The references of the commands and of the library."""

from krl.reference import files
from support.files.generated_files import stale


def test_the_references_are_up_to_date() -> None:
    """They are what the commands and the docstrings of the library say of themselves."""
    assert [] == stale(files())
