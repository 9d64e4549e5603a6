"""An edit keeps its place where edits before it are missing, or is refused."""

import pytest

from grammar.notation.edits import (
    AddAlternative,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    Replace,
    apply,
)
from grammar.notation.g4 import read
from grammar.notation.model import Grammar, GrammarError
from grammar.notation.rebase import rebased

TOKENS = "A : 'A' ;\nB : 'B' ;\nC : 'C' ;\nD : 'D' ;\n"
BEFORE = read(f"grammar G;\nr\n    : A B\n    | C D A\n    ;\n{TOKENS}")


def grown(*edits: Edit) -> Grammar:
    return apply(BEFORE, edits)


@pytest.mark.parametrize(
    ("earlier", "edit", "expected"),
    [
        (Insert("r", (1, 1), "D?"), Insert("r", (1, 3), "C?"), Insert("r", (1, 2), "C?")),
        (Insert("r", (1, 1), "D?"), Insert("r", (1, 2), "C?"), Insert("r", (1, 1), "C?")),
        (Insert("r", (1, 3), "D?"), Insert("r", (1, 4), "C?"), None),
        (Insert("r", (1, 1), "D?"), MakeOptional("r", (1, 2)), MakeOptional("r", (1, 1))),
        (Insert("r", (2, 1), "B?"), Replace("r", (2, 2), "A", 2), Replace("r", (2, 1), "A", 2)),
        (AddAlternative("r", "D"), MakeOptional("r", (3, 1)), None),
        (RemoveAlternative("r", 1), RemoveAlternative("r", 1), RemoveAlternative("r", 2)),
        (RemoveAlternative("r", 1), Insert("r", (1, 2), "B?"), Insert("r", (2, 2), "B?")),
        (AddToken("E"), AddAlternative("r", "A"), AddAlternative("r", "A")),
    ],
)
def test_places_are_found_by_their_neighbours(
    earlier: Edit, edit: Edit, expected: Edit | None
) -> None:
    """Without the earlier edit the later one has the address of the same place, if there is one."""
    if expected is None:
        with pytest.raises(GrammarError, match="rule r has no such place"):
            rebased(edit, grown(earlier), BEFORE)
    else:
        assert expected == rebased(edit, grown(earlier), BEFORE)


def test_an_alternative_is_known_by_its_elements() -> None:
    """The neighbours occur in two alternatives, and another one has the number now."""
    whole = read(f"grammar G;\nr\n    : A A\n    | B C\n    | B C D\n    | B C A\n    ;\n{TOKENS}")
    other = read(f"grammar G;\nr\n    : B C\n    | B C D\n    | B C A\n    ;\n{TOKENS}")
    assert Insert("r", (2, 2), "A?") == rebased(Insert("r", (3, 2), "A?"), whole, other)


def test_a_place_that_is_not_certain_is_refused() -> None:
    """Two places have the same neighbours, and neither has the old address."""
    other = read(f"grammar G;\nr\n    : A B A B\n    ;\n{TOKENS}")
    whole = read(f"grammar G;\nr\n    : D? A C A B A B\n    ;\n{TOKENS}")
    with pytest.raises(GrammarError, match="rule r has 2 such places"):
        rebased(Insert("r", (1, 5), "C?"), whole, other)
    with pytest.raises(GrammarError, match="there is no rule s"):
        rebased(Insert("s", (1, 1), "C?"), whole, other)
