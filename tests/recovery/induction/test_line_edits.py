"""Words that begin lines of one form."""

import pytest

from recovery.induction.line_edits import go_on_alike

_NAME, _LIST, _CALL = ("_",), ("_", "','", "_"), ("_", "'('")


@pytest.mark.parametrize(
    ("some", "others", "alike"),
    [
        ({_NAME, _LIST}, {_NAME, _LIST, _CALL}, True),
        ({_NAME, _LIST}, {_LIST}, True),
        ({_NAME}, {_CALL}, False),
        ({_NAME}, set(), False),
    ],
)
def test_words_go_on_alike(
    some: set[tuple[str, ...]], others: set[tuple[str, ...]], alike: bool
) -> None:
    """Half of what follows one word follows the other; a word that nothing follows is like none."""
    assert alike == go_on_alike(some, others)
