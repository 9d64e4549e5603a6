"""A proposal is completed with what its lines still need."""

from collections.abc import Sequence

import pytest

from grammar.notation.edits import AddAlternative, AddRule, Edit, Insert, MakeOptional, Widen, apply
from grammar.notation.g4 import read
from recovery.clustering.cause import Cause
from recovery.clustering.completion import completed, continued
from recovery.clustering.negative_score import Rivals
from tests.recovery.clustering.test_joined_causes import (
    GRAMMAR,
    mends_all,
    search,
    search_in,
)

LESS = AddAlternative("line", "IF NAME '<' NAME NEWLINE")


def test_lines_left_get_more_of_the_same_rule() -> None:
    """What mends the other lines is added to what mends some."""
    searched = search()
    [one] = completed(searched, Cause((0, 1, 2, 3), (searched.proposal((LESS,), 0),))).proposals
    assert {LESS, AddAlternative("line", "IF NAME '>' NAME NEWLINE")} == set(one.edits)
    assert mends_all(one)


def test_what_costs_negatives_is_not_added() -> None:
    """A completed proposal accepts no more of them than the proposal itself."""

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        del rivals
        return "'<'" in str(edits) and "'>'" in str(edits)

    searched = search(count_negatives)
    cause = Cause((0, 1, 2, 3), (searched.proposal((LESS,), 0),))
    assert cause == completed(searched, cause)


def test_a_proposal_that_cannot_mend_nearly_all_lines_stays_as_it_is() -> None:
    """No edit reads a character that the grammar does not know: that is another cause."""
    searched = search_in(GRAMMAR, [f"IF A {sign} B\n" for sign in "<>?"])
    cause = Cause((0, 1, 2), (searched.proposal((LESS,), 0),))
    assert cause == completed(searched, cause)


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        # inside an alternative that is added
        (
            LESS,
            Insert("line", (3, 4), "NAME?"),
            AddAlternative("line", "IF NAME '<' NAME? NAME NEWLINE"),
        ),
        # inside a part that is inserted, behind it, and a part like it
        (
            Insert("line", (1, 3), "('<' NAME)?"),
            Widen("line", (1, 3, 1, 1), "'>'"),
            Insert("line", (1, 3), "(('<' | '>') NAME)?"),
        ),
        (
            Insert("line", (1, 3), "('<' NAME)?"),
            Insert("line", (1, 4), "('>' NAME)?"),
            Insert("line", (1, 3), "(('<' | '>') NAME)?"),
        ),
    ],
)
def test_a_change_of_what_is_added_is_part_of_it(first: Edit, second: Edit, expected: Edit) -> None:
    """So both are one edit."""
    assert (expected,) == continued(GRAMMAR, (first,), (second,))


def test_a_change_behind_what_is_inserted_keeps_its_place() -> None:
    """Addresses are those of the grammar without the insertion."""
    first, second = Insert("line", (1, 2), "LIN?"), MakeOptional("line", (1, 5))
    edits = continued(GRAMMAR, (first,), (second,))
    assert {first, MakeOptional("line", (1, 4))} == set(edits or ())
    one_by_one = apply(apply(GRAMMAR, (first,)), (second,))
    assert one_by_one.text == apply(GRAMMAR, edits or ()).text


def test_the_same_text_is_changed_in_every_rule() -> None:
    """What is missing in several rules is one thing."""
    twice = apply(GRAMMAR, [AddRule("line", "head : IF NAME NEWLINE ;")])
    first = [AddAlternative("head", "LIN NAME"), AddAlternative("line", "LIN NAME")]
    edits = continued(read(twice.text), first, [Insert("line", (3, 3), "NAME?")])
    assert edits is not None
    assert {AddAlternative(rule, "LIN NAME NAME?") for rule in ("head", "line")} == set(edits)


def test_what_cannot_be_one_edit_is_none() -> None:
    """Two changes of a rule whose places depend on each other are not written as one."""
    assert (
        continued(GRAMMAR, [Widen("line", (1, 3), "'<'")], [Insert("line", (1, 2), "LIN?")]) is None
    )
