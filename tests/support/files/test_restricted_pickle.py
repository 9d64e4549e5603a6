"""Values of our own classes, read back from bytes that anybody may have written."""

import os
import pickle
from pathlib import Path

import pytest

from grammar.check.project.batch import CheckOptions
from grammar.syntax.references import Space
from support.files.restricted_pickle import dumps, loads


def test_values_come_back() -> None:
    """Data classes and enumerations of the named packages, in plain containers, are read back."""
    value = {"a": (CheckOptions(stops=True), Space.TYPE, frozenset({1}))}
    assert value == loads(dumps(value), ["grammar"])


@pytest.mark.parametrize("value", [Path("a"), os.system, Space, complex(1, 2)])
def test_nothing_else_is_built(value: object) -> None:
    """Functions, and classes of other packages, are refused."""
    with pytest.raises(ValueError, match="not readable"):
        loads(pickle.dumps((CheckOptions(), value)), ["support"])


def test_damage_is_refused() -> None:
    """Bytes cut anywhere, or none, raise `ValueError` and nothing else."""
    whole = dumps({"a": (CheckOptions(), 1.5)})
    for end in range(len(whole)):
        with pytest.raises(ValueError, match="not readable"):
            loads(whole[:end], ["grammar"])
