"""Predefined functions: numbers, random numbers, texts, conversions, variables by name."""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    INT_MAX,
    INT_MIN,
    REAL,
    UNKNOWN,
    Array,
    Enumeration,
    Structure,
    Type,
)
from interp.values.builtins import BUILTINS, FUNCTIONS, WORLD, Randomness, Surroundings, call
from interp.values.faults import FAULTS, Fault
from interp.values.json_form import from_json, real_text, to_json
from interp.values.texts import Outcome
from interp.values.values import (
    ArrayValue,
    EnumValue,
    Value,
    constant,
    empty,
    set_text,
    single,
    text_of,
)

CASE_SENSE = System.load().types["CASE_SENSE_T"]
assert isinstance(CASE_SENSE, Enumeration)
SENSITIVE, INSENSITIVE = constant(CASE_SENSE, "CASE_SENS"), constant(CASE_SENSE, "NOT_CASE_SENS")
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)
LETTERS = st.text(st.characters(min_codepoint=1, max_codepoint=255), max_size=12)
FEW_LETTERS = st.text("aAbB", max_size=6)
COLOUR = Enumeration("COLOUR", ("RED",))


def _nowhere(_name: str) -> None:
    return None


def _call(name: str, *arguments: Any) -> Outcome:
    return call(name, arguments, Surroundings(Randomness(), _nowhere))


def _result(name: str, *arguments: Any) -> Any:
    return _call(name, *arguments)[0]


def _slug(name: str, *arguments: Any) -> str:
    with pytest.raises(Fault) as caught:
        _call(name, *arguments)
    return caught.value.slug


def _text(size: int, text: str) -> ArrayValue:
    array = empty(Array(CHAR, (size,)))
    assert isinstance(array, ArrayValue)
    set_text(array, text)
    return array


# ---------------------------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [
        *(("ABS", (-2.5,), 2.5), ("ABS", (2.5,), 2.5), ("ABS", (-7,), 7.0), ("ABS", (0.0,), 0.0)),
        *(("SQRT", (2.0,), 1.4142135381698608), ("SQRT", (0.0,), 0.0), ("SQRT", (16,), 4.0)),
        *(("SIN", (30.0,), 0.5), ("SIN", (90.0,), 1.0), ("SIN", (-90.0,), -1.0)),
        *(("SIN", (0.0,), 0.0), ("SIN", (36000.0,), 0.0), ("SIN", (390.0,), 0.5)),
        *(("COS", (60.0,), 0.5), ("COS", (180.0,), -1.0), ("COS", (0.0,), 1.0)),
        *(("COS", (-60.0,), 0.5), ("COS", (3.6e8,), 1.0)),
        *(("TAN", (45.0,), 1.0), ("TAN", (-45.0,), -1.0), ("TAN", (225.0,), 1.0)),
        *(("ACOS", (1.0,), 0.0), ("ACOS", (0.0,), 90.0), ("ACOS", (-1.0,), 180.0)),
        *(("ACOS", (0.5,), 60.0), ("ATAN2", (1.0, 1.0), 45.0), ("ATAN2", (1.0, -1.0), 135.0)),
        *(("ATAN2", (-1.0, -1.0), -135.0), ("ATAN2", (-1.0, 1.0), -45.0)),
        *(("ATAN2", (0.0, -1.0), 180.0), ("ATAN2", (0.0, 5.0), 0.0), ("ATAN2", (2, 0), 90.0)),
        ("ATAN2", (-3.0, 0.0), -90.0),
    ],
)
def test_functions_of_numbers(name: str, arguments: Sequence[float], expected: float) -> None:
    """Functions of REAL, in degrees; ATAN2(Y,X) has the full circle [FCT-01, FCT-02]."""
    found = _result(name, *arguments)
    assert float is type(found)
    assert pytest.approx(expected, abs=1e-15) == found


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        *(("SQRT", (-1.0,)), ("SQRT", (-1e-45,)), ("ACOS", (1.0000001192092896,))),
        *(("ACOS", (-2.0,)), ("ATAN2", (0.0, 0.0)), ("ATAN2", (0, -0.0))),
        *(("TAN", (90.0,)), ("TAN", (-90.0,)), ("TAN", (270.0,)), ("TAN", (450.0,))),
    ],
)
def test_functions_have_a_domain(name: str, arguments: Sequence[float]) -> None:
    """Where a function has no value it faults: no result is infinite or no number [FCT-01]."""
    assert "domain" == _slug(name, *arguments)


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - {"INV_POS"}))
@given(data=st.data())
def test_functions_give_singles(name: str, data: st.DataObject) -> None:
    """For any REAL there is a REAL as result, or a fault that the table names [TYP-02]."""
    primitive = FUNCTIONS[name]
    operands = [data.draw(SINGLES | st.floats(-1, 1, width=32)) for _ in primitive.operands]
    slug = ""
    try:
        result = _result(name, *operands)
    except Fault as raised:
        slug = raised.slug
    if slug:
        assert slug in primitive.faults
    else:
        assert result == single(result)


@given(st.floats(-720, 720, width=32))
def test_angles_are_degrees(angle: float) -> None:
    """Sine and cosine lie on the circle, and ATAN2 finds the angle again [FCT-02]."""
    sine, cosine = _result("SIN", angle), _result("COS", angle)
    assert pytest.approx(math.sin(math.radians(angle)), abs=1e-7) == sine
    assert pytest.approx(1, abs=1e-6) == sine**2 + cosine**2
    found = _result("ATAN2", sine, cosine)
    assert -180 <= found <= 180
    assert pytest.approx(0, abs=2e-4) == math.remainder(found - angle, 360)


@given(SINGLES.map(abs).filter(bool))
def test_roots_are_those_of_singles(number: float) -> None:
    """The root is the REAL next to the exact one: rounding once is enough [TYP-02]."""
    root = Fraction(_result("SQRT", number))
    half = Fraction(math.ulp(float(root))) * 2**28  # half a unit in the last place of a single
    assert (root - half) ** 2 <= Fraction(number) <= (root + half) ** 2


def test_inverse_of_a_pose() -> None:
    """INV_POS turns a pose round, also one that is not an E6POS [FCT-03, ARI-04]."""
    pose = from_json(_structure("FRAME"), {"X": 1, "Y": 2, "Z": 3, "A": 90, "B": 0, "C": 0})
    found = _result("INV_POS", pose)
    assert "E6POS" == found.type.name
    assert pytest.approx((-2, 1, -3, -90, 0, 0), abs=1e-6) == found.members[:6]


def _structure(name: str) -> Structure:
    type_ = System.load().types[name]
    assert isinstance(type_, Structure)
    return type_


# ---------------------------------------------------------------------------------- random numbers


def test_random_numbers_are_fixed() -> None:
    """The numbers follow from the seed alone, as any implementation of the generator has them."""
    numbers = Randomness(1)
    states = []
    for _ in range(3):
        number = numbers()
        states.append(numbers.state)
        assert numbers.state / 2**32 == number
    assert [270369, 67634689, 2647435461] == states
    assert Randomness(1)() == Randomness(0)()
    assert Randomness(2)() != Randomness(1)()


def test_frand_takes_its_numbers_from_outside() -> None:
    """FRAND spreads the number it is given between its limits, as a REAL [FCT-01]."""
    for number, expected in ((0.0, 2.0), (0.5, 3.0), (0.75, 3.5)):
        surroundings = Surroundings(lambda number=number: number, _nowhere)  # type: ignore[misc]
        assert (expected, {}) == call("FRAND", (2, 4), surroundings)


@given(SINGLES, SINGLES, st.floats(0, 1, exclude_max=True))
def test_frand_stays_between(least: float, most: float, number: float) -> None:
    """The result of FRAND lies between its limits, both included [FCT-01]."""
    low, high = sorted((least, most))
    found = call("FRAND", (low, high), Surroundings(lambda: number, _nowhere))[0]
    assert isinstance(found, float)
    assert low <= found <= high


# ---------------------------------------------------------------------------------- STR…


@pytest.mark.parametrize(
    ("text", "expected"),
    [(_text(5, ""), 0), (_text(5, "abc"), 3), (_text(5, "abcde"), 5), ("ab", 2), ("", 0), ("x", 1)],
    ids=str,
)
def test_strlen_is_the_used_length(text: Value, expected: int) -> None:
    """STRLEN counts up to the first element that is not used [FCT-04, FCT-06]."""
    assert expected == _result("STRLEN", text)


def test_strdecllen_is_the_declared_length() -> None:
    """STRDECLLEN gives the size, used or not [FCT-06]."""
    assert 5 == _result("STRDECLLEN", _text(5, "ab"))
    assert 1 == _result("STRDECLLEN", _text(1, ""))


def test_strclear_empties() -> None:
    """STRCLEAR returns TRUE, and no text is left, whatever it was [FCT-06]."""
    for text in ("", "abc"):
        assert (True, {0: ""}) == _call("STRCLEAR", _text(3, text))


@pytest.mark.parametrize(
    ("size", "text", "added", "result", "after"),
    [
        (6, "abc", "de", 5, "abcde"),
        (5, "abc", "de", 5, "abcde"),
        (4, "abc", "de", 0, None),
        (3, "", "", 0, ""),
        (3, "abc", "", 3, "abc"),
        (3, "", "abc", 3, "abc"),
        (3, "", "abcd", 0, None),
    ],
)
def test_stradd(size: int, text: str, added: str, result: int, after: str | None) -> None:
    """STRADD returns the joined length; 0 and no change where it does not fit [FCT-06]."""
    target = _text(size, text)
    found = _call("STRADD", target, _text(9, added))
    assert result == found[0]
    assert (target if after is None else after) == found[1].get(0, target)
    assert text == text_of(target)


@pytest.mark.parametrize(
    ("start", "text", "wanted", "mode", "expected"),
    [
        *((1, "abcabc", "abc", SENSITIVE, 1), (2, "abcabc", "abc", SENSITIVE, 4)),
        *((4, "abcabc", "abc", SENSITIVE, 4), (5, "abcabc", "abc", SENSITIVE, 0)),
        *((1, "abc", "C", SENSITIVE, 0), (1, "abc", "C", INSENSITIVE, 3)),
        *((1, "aBc", "b", INSENSITIVE, 2), (1, "", "a", SENSITIVE, 0)),
        *((1, "abc", "", SENSITIVE, 0), (0, "abc", "a", SENSITIVE, 0)),
        *((-3, "abc", "a", SENSITIVE, 0), (99, "abc", "a", SENSITIVE, 0)),
        *((1, "\xe4", "\xc4", INSENSITIVE, 0), (1, "abc", "abcd", SENSITIVE, 0)),
    ],
)
def test_strfind(start: int, text: str, wanted: str, mode: EnumValue, expected: int) -> None:
    """STRFIND gives the place, counted from 1, where the text begins; 0 for nowhere [FCT-04]."""
    assert expected == _result("STRFIND", start, _text(8, text), wanted, mode)


@pytest.mark.parametrize(
    ("one", "other", "mode", "expected"),
    [
        *(("abc", "abc", SENSITIVE, True), ("abc", "aBc", SENSITIVE, False)),
        *(("abc", "aBC", INSENSITIVE, True), ("abc", "ab", SENSITIVE, False)),
        *(("", "", SENSITIVE, True), ("", " ", INSENSITIVE, False)),
        *(("[", "{", INSENSITIVE, False), ("z", "Z", INSENSITIVE, True)),
    ],
)
def test_strcomp(one: str, other: str, mode: EnumValue, expected: bool) -> None:
    """STRCOMP compares the used parts, with or without letter case [FCT-04]."""
    assert expected is _result("STRCOMP", _text(5, one), _text(9, other), mode)


@pytest.mark.parametrize(
    ("size", "source", "result"),
    [(3, "abc", True), (3, "", True), (3, "abcd", False), (5, "abc", True)],
)
def test_strcopy(size: int, source: str, result: bool) -> None:
    """STRCOPY copies a text that fits; of one that does not, nothing [FCT-04]."""
    target = _text(size, "xyz")
    found = _call("STRCOPY", target, source)
    assert result is found[0]
    assert (source if result else target) == found[1].get(0, target)


@given(LETTERS, LETTERS, st.integers(1, 24))
def test_strings_against_python(one: str, other: str, size: int) -> None:
    """Length, joining and copying are those of Python's texts [FCT-04]."""
    used = one[:size]
    target = _text(size, one)
    assert len(used) == _result("STRLEN", target)
    added = _call("STRADD", target, other)
    fits = len(used + other) <= size
    assert (len(used + other) if fits else 0) == added[0]
    assert text_of(added[1].get(0, target)) == (used + other if fits else used)
    assert (len(other) <= size) is _result("STRCOPY", target, other)


@given(FEW_LETTERS, FEW_LETTERS.filter(bool), st.integers(1, 8), st.booleans())
def test_search_against_python(text: str, wanted: str, start: int, is_sensitive: bool) -> None:
    """Searching and comparing are those of Python's texts, places counted from 1 [FCT-04]."""
    mode = SENSITIVE if is_sensitive else INSENSITIVE
    one, other = (text, wanted) if is_sensitive else (text.lower(), wanted.lower())
    assert one.find(other, start - 1) + 1 == _result("STRFIND", start, text, wanted, mode)
    assert (one == other) is _result("STRCOMP", text, wanted, mode)


# ---------------------------------------------------------------------------------- STRTO…


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        *(("STRTOINT", "12", 12), ("STRTOINT", " -7 ", -7), ("STRTOINT", "+3", 3)),
        *(("STRTOINT", "2147483647", INT_MAX), ("STRTOINT", "-2147483648", INT_MIN)),
        *(("STRTOINT", "007", 7), ("STRTOREAL", "1.5", 1.5), ("STRTOREAL", "-.5", -0.5)),
        *(("STRTOREAL", "2.", 2.0), ("STRTOREAL", "3", 3.0), ("STRTOREAL", "1e3", 1000.0)),
        *(("STRTOREAL", "0.1", single(0.1)), ("STRTOREAL", "1E-50", 0.0)),
        *(
            ("STRTOBOOL", "TRUE", True),
            ("STRTOBOOL", " false ", False),
            ("STRTOBOOL", "True", True),
        ),
    ],
)
def test_conversions_of_texts(name: str, text: str, expected: Value) -> None:
    """A text that is a value gives it, and TRUE [FCT-05]."""
    found = _call(name, _text(16, text), None)
    assert found[0] is True
    assert expected == found[1][1]
    assert type(expected) is type(found[1][1])


@pytest.mark.parametrize(
    ("name", "text"),
    [
        *(("STRTOINT", ""), ("STRTOINT", "1.5"), ("STRTOINT", "abc"), ("STRTOINT", "1 2")),
        *(("STRTOINT", "2147483648"), ("STRTOINT", "-2147483649"), ("STRTOINT", "0x1F")),
        *(("STRTOINT", "9" * 5000), ("STRTOINT", "\xb2"), ("STRTOINT", "--1")),
        *(("STRTOREAL", ""), ("STRTOREAL", "."), ("STRTOREAL", "1e39"), ("STRTOREAL", "nan")),
        *(("STRTOREAL", "inf"), ("STRTOREAL", "1,5"), ("STRTOREAL", "1e"), ("STRTOREAL", "1_0")),
        *(("STRTOBOOL", "1"), ("STRTOBOOL", ""), ("STRTOBOOL", "YES")),
        *(("STRTOFRAME", ""), ("STRTOFRAME", "X"), ("STRTOFRAME", "X 1 Y 2")),
        *(("STRTOFRAME", "{X 1,X 2}"), ("STRTOFRAME", "{S 1}"), ("STRTOFRAME", "1,2,3")),
        *(("STRTOFRAME", "X 1,,Y 2"), ("STRTOFRAME", "{POS: X 1}"), ("STRTOFRAME", "{X 1")),
        *(("STRTOPOS", "S 1.5"), ("STRTOAXIS", "A7 1"), ("STRTOFRAME", "X 1e99")),
    ],
)
def test_texts_that_are_no_value(name: str, text: str) -> None:
    """A text that is no value of the type gives FALSE and changes nothing [FCT-05]."""
    assert (False, {}) == _call(name, text, None)


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("STRTOFRAME", "{X 1,Y 2,Z 3,A 4,B 5,C 6}", dict(zip("XYZABC", range(1, 7), strict=True))),
        ("STRTOFRAME", "x 1.5, z -2", {"X": 1.5, "Z": -2}),
        ("STRTOFRAME", "{FRAME: X 1}", {"X": 1}),
        ("STRTOFRAME", "1,2,3,4,5,6", dict(zip("XYZABC", range(1, 7), strict=True))),
        ("STRTOPOS", "{X 1,S 2,T 35}", {"X": 1, "S": 2, "T": 35}),
        ("STRTOE3POS", "E3 1", {"E3": 1}),
        ("STRTOE6POS", "{ E6POS : E6 1 }", {"E6": 1}),
        ("STRTOAXIS", "A1 0,A6 -90", {"A1": 0, "A6": -90}),
        ("STRTOE3AXIS", "E1 1", {"E1": 1}),
        ("STRTOE6AXIS", "{A1 1,E6 2}", {"A1": 1, "E6": 2}),
    ],
)
def test_positions_from_texts(name: str, text: str, expected: dict[str, float]) -> None:
    """Positions are read from components, separated by commas [FCT-05, FCT-06]."""
    found = _call(name, text, None)
    assert found[0] is True
    value = to_json(found[1][1])
    assert expected == {member: part for member, part in value.items() if part is not None}
    assert name.removeprefix("STRTO") == found[1][1].type.name  # type: ignore[union-attr]


def test_strtostring_copies() -> None:
    """STRTOSTRING copies a text that fits, source first [FCT-05]."""
    assert (True, {1: "abc"}) == _call("STRTOSTRING", "abc", _text(3, ""))
    assert (False, {}) == _call("STRTOSTRING", "abcd", _text(3, ""))


@given(SINGLES, st.integers(INT_MIN, INT_MAX))
def test_numbers_survive_as_texts(number: float, whole: int) -> None:
    """What a REAL or an INT is written as gives it again [FCT-05, TYP-02]."""
    assert number == _call("STRTOREAL", real_text(number), None)[1][1]
    assert whole == _call("STRTOINT", str(whole), None)[1][1]


# ---------------------------------------------------------------------------------- variables


@pytest.mark.parametrize(
    ("found", "state"),
    [
        *((None, "UNKNOWN"), ((INT, None), "DECLARED"), ((INT, 0), "INITIALIZED")),
        *(((BOOL, False), "INITIALIZED"), ((Array(CHAR, (3,)), _text(3, "")), "DECLARED")),
        ((Array(CHAR, (3,)), _text(3, "a")), "INITIALIZED"),
    ],
)
def test_varstate(found: tuple[Type, Value | None] | None, state: str) -> None:
    """VARSTATE tells whether a variable is declared and has a value [TYP-18]."""
    asked: list[str] = []

    def find(name: str) -> tuple[Type, Value | None] | None:
        asked.append(name)
        return found

    reply = call("VARSTATE", (_text(80, "F.X"),), Surroundings(Randomness(), find))
    assert f"#{state}" == to_json(reply[0])
    assert ["F.X"] == asked


@pytest.mark.parametrize(
    ("type_", "word"),
    [
        *((INT, "INT"), (REAL, "REAL"), (BOOL, "BOOL"), (CHAR, "CHAR"), (COLOUR, "ENUM")),
        *((_structure("FRAME"), "FRAME"), (_structure("E6POS"), "E6POS")),
        *((_structure("E3AXIS"), "E3AXIS"), (_structure("LOAD"), "STRUC"), (UNKNOWN, "UNKNOWN")),
        *((Array(REAL, (2,)), "REAL"), (None, "UNKNOWN")),
    ],
)
def test_vartype(type_: Type | None, word: str) -> None:
    """VARTYPE tells the type of a variable; of what is not declared it is unknown [TYP-18]."""
    found = None if type_ is None else (type_, None)
    surroundings = Surroundings(Randomness(), lambda _name: found)
    assert f"#TYP_{word}" == to_json(call("VARTYPE", ("X",), surroundings)[0])


# ---------------------------------------------------------------------------------- the tables


def test_every_predefined_routine_has_its_place() -> None:
    """What is predefined either computes or needs the world, and nothing does both [FCT-01]."""
    functions = set(System.load().functions)
    assert functions == set(BUILTINS) | WORLD
    assert set() == set(BUILTINS) & WORLD
    assert set(FUNCTIONS) <= set(BUILTINS)
    assert {"PULSE", "CWRITE", "SET_KRLMSG", "FORWARD", "INVERSE", "ERR_RAISE"} <= WORLD


def test_functions_are_described() -> None:
    """A function has a sentence, faults of the catalogue, and as many operands as parameters."""
    for name, primitive in FUNCTIONS.items():
        assert primitive.name == name.lower()
        assert primitive.sentence
        assert set(primitive.faults) <= set(FAULTS)
        assert len(primitive.operands) == len(BUILTINS[name].parameters)


def test_changes_are_reported() -> None:
    """The table tells which arguments a function may change; all of SREAD's variables [FCT-09]."""
    for name, places in (("STRADD", [0]), ("STRTOINT", [1]), ("STRLEN", []), ("SWRITE", [0, 1, 2])):
        assert places == [place for place in range(9) if BUILTINS[name].is_out(place)]
    assert [1, 2, 4, 5] == [place for place in range(6) if BUILTINS["SREAD"].is_out(place)]


@pytest.mark.parametrize("name", ["sin", "Sin", "SIN"])
def test_names_have_no_letter_case(name: str) -> None:
    """A function is called in any letter case [TYP-05]."""
    assert 1.0 == _result(name, 90)


@pytest.mark.parametrize(
    ("name", "arguments", "slug"),
    [
        *(("SIN", (), "argument"), ("SIN", (1.0, 2.0), "argument"), ("STRLEN", (1,), "argument")),
        *(("STRADD", (1, "a"), "argument"), ("STRDECLLEN", ("ab",), "argument")),
        *(("SIN", (None,), "uninitialised"), ("STRLEN", (None,), "uninitialised")),
        *(("SIN", (True,), "inadmissible"), ("SQRT", ("A",), "inadmissible")),
        ("STRFIND", (1, "a", "a", 1), "inadmissible"),
        ("STRCLEAR", (None,), "argument"),
    ],
)
def test_wrong_arguments_fault(name: str, arguments: Sequence[Any], slug: str) -> None:
    """Too few, too many, missing and wrong arguments are faults [ARI-04, TYP-13]."""
    assert slug == _slug(name, *arguments)


def test_arguments_are_converted() -> None:
    """An INT passed to a REAL parameter and a REAL passed to an INT are converted [ARI-04]."""
    assert 3.0 == _result("SQRT", 9)
    assert 3 == _result("STRFIND", 1.5, "aba", "a", SENSITIVE)
