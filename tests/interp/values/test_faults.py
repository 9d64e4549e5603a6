"""The catalogue of faults."""

import pytest

from grammar.semantics.predefined import System
from grammar.semantics.rules import tiers
from interp.values.faults import FAULTS, Fault, fault


def test_faults_are_made_from_the_catalogue() -> None:
    """A fault has the text, number and rules that the catalogue has under its slug."""
    index = fault("index")
    assert "index" == index.slug
    assert 1444 == index.number
    assert ("TYP-09", "MSG-15") == index.rules
    assert index.text == str(index)
    with pytest.raises(KeyError):
        fault("no such fault")


@pytest.mark.parametrize(
    ("slug", "number"),
    [
        *(("index", 1444), ("stack", 1424), ("nesting", 1426), ("invalid", 1422)),
        *(("inadmissible", 1446), ("read_only", 1388), ("operand", 2256), ("argument", 2274)),
        *(("division_by_zero", None), ("overflow", None), ("uninitialised", 1422)),
    ],
)
def test_faults_have_the_numbers_of_the_controller(slug: str, number: int | None) -> None:
    """Message numbers are those of the rules MSG; where no message is known there is none."""
    assert number == FAULTS[slug].number


def test_catalogue_names_what_exists() -> None:
    """Every number is a known message and every rule a known rule."""
    numbers = {kind.number for kind in FAULTS.values()} - {None}
    assert set() == numbers - {message.number for message in System.load().messages}
    rules = {rule for kind in FAULTS.values() for rule in kind.rules}
    assert set() == rules - set(tiers())
    assert all(kind.rules for kind in FAULTS.values())


def test_codes_are_places_and_texts_are_kept_apart() -> None:
    """A fault has the code of its place, and no two have the same text."""
    assert list(range(len(FAULTS))) == [kind.code for kind in FAULTS.values()]
    assert list(FAULTS) == [kind.slug for kind in FAULTS.values()]
    assert len(FAULTS) == len({kind.text for kind in FAULTS.values()})


def test_faults_compare_by_what_they_say() -> None:
    """Two faults of a kind are equal, whoever raised them; two kinds are not."""
    assert fault("index") == fault("index")
    assert hash(fault("index")) == hash(fault("index"))
    assert fault("index") != fault("overflow")
    assert fault("index") != Fault("index", "another text")
    assert "Fault('index', 'an array index lies outside the array', 1444)" == repr(fault("index"))
