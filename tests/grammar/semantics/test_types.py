"""Types are values; what may be assigned, passed, compared and reckoned with follows the rules."""

import pickle
from itertools import product

import pytest

from grammar.semantics.assignability import (
    assignable,
    case_label,
    declarable,
    initial,
    passable,
)
from grammar.semantics.operations import (
    ARITHMETIC,
    BITWISE,
    EQUALITY,
    LOGICAL,
    ORDER,
    binary,
    unary,
)
from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    FINE,
    INT,
    REAL,
    SCALARS,
    UNKNOWN,
    Aggregate,
    Array,
    Constant,
    Enumeration,
    Member,
    Scalar,
    Structure,
    Text,
    Type,
    Unknown,
    Verdict,
)

SYSTEM = System.load()
FRAME, POS, E6POS = (SYSTEM.types[name] for name in ("FRAME", "POS", "E6POS"))
AXIS, E6AXIS = (SYSTEM.types[name] for name in ("AXIS", "E6AXIS"))
ORI, IPO, CIRC = (SYSTEM.types[name] for name in ("ORI_TYPE", "IPO_MODE", "CIRC_TYPE"))
INTS, GRID = Array(INT, (3,)), Array(REAL, (2, 3))
NAME, TEXTS = Array(CHAR, (8,)), Array(CHAR, (4, 8))
PAIR = Structure("PAIR", (Member("Left", INT), Member("Right", FRAME)))
EVERYTHING: list[Type] = [
    *(INT, REAL, BOOL, CHAR, FRAME, POS, E6POS, AXIS, E6AXIS, ORI, IPO, PAIR),
    *(INTS, GRID, NAME, TEXTS, Text(0), Text(1), Text(9), Constant("BASE"), UNKNOWN),
    *(Aggregate(("X", "Y")), Aggregate(("A1",)), Aggregate(("X",), POS)),  # type: ignore[arg-type]
]


# ------------------------------------------------------------------------------------ types


def test_letter_case_does_not_tell_types_apart() -> None:
    """Structures and enumerations are equal when they say the same [TYP-05]."""
    again = Structure("Pair", (Member("LEFT", INT), Member("RIGHT", FRAME)))
    assert PAIR == again
    assert hash(PAIR) == hash(again)
    assert Enumeration("E", ("A", "b")) == Enumeration("e", ("a", "B"))
    assert {PAIR: 1} == {again: 1}


def test_types_travel_between_processes() -> None:
    """A type that was pickled equals itself."""
    assert pickle.loads(pickle.dumps(EVERYTHING)) == EVERYTHING


def test_types_are_shown_as_written() -> None:
    """A type is shown as in a declaration, a literal by what it is."""
    assert ["REAL[2,3]", "PAIR", "#BASE"] == [str(t) for t in (GRID, PAIR, Constant("BASE"))]
    assert "CHAR[,]" == str(Array(CHAR, (None, None)))


# ------------------------------------------------------------------------------- assignment


def test_everything_can_be_assigned_to_itself_but_arrays_of_texts() -> None:
    """A variable receives a value of its own type."""
    variables = [t for t in EVERYTHING if not isinstance(t, Text | Constant | Aggregate)]
    assert all(assignable(t, t).is_lossless for t in variables)
    assert all(assignable(t, t) for t in variables)


@pytest.mark.parametrize("type_", EVERYTHING)
def test_the_unknown_fits_everywhere(type_: Type) -> None:
    """What comes from packages not at hand is never reported."""
    assert assignable(type_, UNKNOWN)
    assert assignable(UNKNOWN, type_)
    assert passable(UNKNOWN, type_, is_out=True, is_variable=True)
    assert passable(type_, UNKNOWN, is_out=True, is_variable=True)


def test_no_pair_of_types_is_left_without_an_answer() -> None:
    """Whatever two types meet, there is a verdict, and a bad one gives rules and a reason."""
    for one, other in product(EVERYTHING, EVERYTHING):
        verdicts = [assignable(one, other), initial(one, other), case_label(one, other)]
        verdicts += [
            passable(one, other, is_out=is_out, is_variable=is_variable)
            for is_out, is_variable in product((True, False), repeat=2)
        ]
        for operator in [*ARITHMETIC, *EQUALITY, *ORDER, *LOGICAL, *BITWISE, ":"]:
            typed = binary(operator, one, other)
            assert typed.verdict or UNKNOWN == typed.type
            verdicts.append(typed.verdict)
        for verdict in verdicts:
            assert verdict or (verdict.rules and verdict.reason)
            assert isinstance(verdict.is_unconfirmed, bool)


def test_an_open_structure_takes_what_another_of_its_name_has() -> None:
    """A type that a file may declare otherwise fits to its namesake."""
    theirs = Structure("PDAT", (Member("VEL", REAL), Member("NEW", INT)))
    assert assignable(SYSTEM.types["PDAT"], theirs)
    assert passable(SYSTEM.types["PDAT"], theirs, is_out=True, is_variable=True)
    assert assignable(SYSTEM.types["PDAT"], Aggregate(("NEW",)))


def test_arrays_of_what_is_not_known_fit_to_arrays() -> None:
    """A parameter whose type is not known takes arrays of as many dimensions, and texts."""
    some = Array(UNKNOWN, (None,))
    assert assignable(some, INTS)
    assert assignable(INTS, some)
    assert assignable(some, Text(12))
    assert passable(some, INTS, is_out=True, is_variable=True)
    assert not assignable(some, GRID)


# ------------------------------------------------------------------------------- parameters


def test_texts_are_passed_in() -> None:
    """KUKA's own programs pass arrays of CHAR :IN, and so do predefined functions."""
    assert declarable(NAME, is_out=False)
    assert declarable(TEXTS, is_out=False)
    assert passable(NAME, Text(3), is_out=False, is_variable=False)
    refused = passable(NAME, INT, is_out=False, is_variable=False)
    assert (2274, "CHAR[8] is expected here, and this is INT") == (refused.message, refused.reason)


def test_structures_within_structures_are_compared_once() -> None:
    """Equality takes no longer for a structure that holds another one many times over."""

    def tower(last: Type) -> Structure:
        built = Structure("T", (Member("A", last), Member("B", last)))
        for _ in range(40):
            built = Structure("T", (Member("A", built), Member("B", Array(built, (2,)))))
        return built

    assert tower(INT) == tower(INT)
    assert tower(INT) != tower(REAL)


# ------------------------------------------------------------------------------- operators


def test_what_is_no_operator_is_a_mistake_of_ours() -> None:
    """An operator that KRL does not have is refused."""
    with pytest.raises(ValueError, match="not a binary operator"):
        binary("MOD", INT, INT)
    with pytest.raises(ValueError, match="not a unary operator"):
        unary("*", INT)


# --------------------------------------------------------------------- indices, components


def test_a_verdict_without_rules_is_sure() -> None:
    """What no rule speaks of is plain."""
    assert not FINE.is_unconfirmed
    assert not Verdict(False, ("ARI-11",), "").is_unconfirmed
    assert bool(FINE)
    assert CIRC != IPO


@pytest.mark.parametrize("one", [*SCALARS.values(), UNKNOWN])
def test_there_is_one_of_each_scalar_type(one: Scalar | Unknown) -> None:
    """Also where it was read from a file: the check compares them by identity."""
    assert pickle.loads(pickle.dumps(one)) is one
