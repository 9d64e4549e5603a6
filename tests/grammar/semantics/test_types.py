"""Types are values; what may be assigned, passed, compared and reckoned with follows the rules."""

import pickle
from itertools import product

import pytest

from grammar.semantics.assignability import (
    assignable,
    case_label,
    condition,
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
    component,
    subscript,
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


@pytest.mark.parametrize(
    ("to", "value", "message", "rule"),
    [
        (INT, BOOL, 1446, "ARI-11"),
        (INT, Text(4), 1446, "ARI-11"),
        (BOOL, INT, 1446, "ARI-11"),
        (INT, FRAME, 1446, "ARI-11"),
        (FRAME, REAL, 1446, "ARI-11"),
        (FRAME, E6AXIS, 1446, "ARI-11"),
        (INT, Constant("T1"), 1446, "TYP-16"),
        (ORI, Constant("CONST"), 2296, "TYP-20"),
        (ORI, IPO, 1446, "ARI-11"),
        (CHAR, Text(2), None, "TYP-03"),
        (FRAME, Aggregate(("X", "S")), 2125, "TYP-20"),
        (POS, Aggregate(("E1",)), 2125, "TYP-20"),
        (FRAME, Aggregate(("A1",), AXIS), 1446, "ARI-11"),  # type: ignore[arg-type]
        (INT, Aggregate(("X",)), 1446, "ARI-11"),
        (INT, INTS, 2052, "TYP-20"),
        (INTS, INT, 2052, "TYP-20"),
        (INTS, GRID, 1446, "ARI-11"),
        (PAIR, FRAME, 1446, "ARI-11"),
    ],
)
def test_what_cannot_be_assigned(to: Type, value: Type, message: int | None, rule: str) -> None:
    """A fault has the controller's number where there is one, and the rule that says so."""
    verdict = assignable(to, value)
    assert (False, message) == (verdict.is_fine, verdict.message)
    assert rule in verdict.rules
    assert not verdict.is_unconfirmed
    assert "TYP-12" in initial(to, value).rules


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


@pytest.mark.parametrize(
    ("parameter", "argument", "by_value", "by_reference"),
    [
        (INT, REAL, True, False),
        (REAL, INT, True, False),
        (INT, INT, True, True),
        (INT, BOOL, False, False),
        (FRAME, E6POS, True, False),
        (NAME, Array(CHAR, (80,)), True, True),
        (Array(INT, (None,)), INTS, True, True),
        (Array(INT, (None,)), GRID, False, False),
        (Array(REAL, (None,)), INTS, False, False),
        (INT, INTS, False, False),
        (ORI, ORI, True, True),
        (ORI, IPO, False, False),
    ],
)
def test_in_converts_and_out_must_match(
    parameter: Type, argument: Type, by_value: bool, by_reference: bool
) -> None:
    """A variable passed :OUT has the type of the parameter; sizes may differ [ARI-04]."""
    assert by_value == bool(passable(parameter, argument, is_out=False, is_variable=True))
    assert by_reference == bool(passable(parameter, argument, is_out=True, is_variable=True))


def test_faults_of_arguments_have_their_numbers() -> None:
    """2274 is the fault of an argument, unless a constant or component is the fault."""
    wrong = passable(INT, BOOL, is_out=False, is_variable=True)
    assert (2274, True) == (wrong.message, "ARI-04" in wrong.rules)
    assert 2274 == passable(INT, REAL, is_out=True, is_variable=True).message
    assert 2296 == passable(ORI, Constant("NO"), is_out=False, is_variable=False).message
    assert 2052 == passable(INT, INTS, is_out=True, is_variable=True).message


def test_arrays_are_passed_out_only() -> None:
    """A parameter :IN is no array [SCO-07]."""
    assert ("SCO-07",) == declarable(INTS, is_out=False).rules
    assert declarable(INTS, is_out=True)
    assert declarable(INT, is_out=False)


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


# ---------------------------------------------------------------------------------- places


def test_places_cite_the_rules_of_their_statement() -> None:
    """The rule of the statement stands before the general one."""
    assert ("CTL-01", "ARI-11") == condition(INT, "CTL-01").rules


@pytest.mark.parametrize(
    ("chosen", "label", "message"),
    [
        (INT, INT, None),
        (CHAR, Text(1), None),
        (ORI, Constant("VAR"), None),
        (UNKNOWN, Constant("ANY"), None),
        (INT, Text(4), 2255),
        (INT, REAL, 2255),
        (INT, Constant("VAR"), 2255),
        (ORI, INT, 2255),
        (ORI, Constant("CONST"), 2296),
        (REAL, INT, None),  # the selector is the fault, and told once
    ],
)
def test_labels_of_case(chosen: Type, label: Type, message: int | None) -> None:
    """A label has the type of the selector [CTL-03]."""
    verdict = case_label(chosen, label)
    assert (message is None, message) == (verdict.is_fine, verdict.message)


# ------------------------------------------------------------------------------- operators


@pytest.mark.parametrize(
    ("left", "operator", "right", "message", "is_unconfirmed"),
    [
        (INT, "+", BOOL, 2256, False),
        (FRAME, "+", FRAME, 2256, False),
        (Text(4), "*", INT, 2256, False),
        (INTS, "+", INT, 2052, False),
        (CHAR, "-", INT, 2256, True),  # no manual at hand says so
        (REAL, "B_OR", INT, None, False),
        (BOOL, "B_AND", BOOL, None, False),
        (BOOL, "AND", REAL, None, False),
        (INT, "OR", BOOL, None, False),
        (BOOL, "==", INT, None, False),
        (Text(4), "==", INT, None, False),
        (ORI, "==", INT, None, False),
        (BOOL, "<", BOOL, None, True),  # ARI-10 alone is recollection
        (ORI, ">", Constant("VAR"), None, True),
        (FRAME, "==", FRAME, None, True),
        (NAME, "==", NAME, None, True),
        (ORI, "==", Constant("CONST"), 2296, False),
        (INTS, "==", INT, 2052, False),
        (INT, ":", FRAME, None, True),
        (FRAME, ":", AXIS, None, True),
    ],
)
def test_wrong_operands(
    left: Type, operator: str, right: Type, message: int | None, is_unconfirmed: bool
) -> None:
    """A wrong operand is refused with its rule, and nothing follows from the result."""
    typed = binary(operator, left, right)
    assert (False, message) == (typed.verdict.is_fine, typed.verdict.message)
    assert is_unconfirmed == typed.verdict.is_unconfirmed
    assert UNKNOWN == typed.type


def test_what_is_no_operator_is_a_mistake_of_ours() -> None:
    """An operator that KRL does not have is refused."""
    with pytest.raises(ValueError, match="not a binary operator"):
        binary("MOD", INT, INT)
    with pytest.raises(ValueError, match="not a unary operator"):
        unary("*", INT)


# --------------------------------------------------------------------- indices, components


@pytest.mark.parametrize(
    ("array", "given", "message"),
    [
        (INT, [True], 2295),
        (FRAME, [False], 2295),
        (INTS, [True, True], None),
        (GRID, [True], None),
    ],
)
def test_wrong_indices(array: Type, given: list[bool], message: int | None) -> None:
    """An array has as many indices as dimensions; nothing else has any [TYP-08, TYP-20]."""
    typed = subscript(array, given)
    assert (False, message) == (typed.verdict.is_fine, typed.verdict.message)
    assert "TYP-20" in typed.verdict.rules
    assert UNKNOWN == typed.type


def test_components() -> None:
    """A component has its type, in any letter case; what has none is message 2125 [TYP-20]."""
    assert REAL == component(POS, "x").type
    assert INT == component(POS, "T").type
    assert UNKNOWN == component(UNKNOWN, "ANY").type
    assert FRAME == component(PAIR, "right").type
    for type_ in (FRAME, INT, ORI):
        typed = component(type_, "S")
        assert (False, 2125) == (typed.verdict.is_fine, typed.verdict.message)
    assert 2052 == component(Array(FRAME, (4,)), "X").verdict.message


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
