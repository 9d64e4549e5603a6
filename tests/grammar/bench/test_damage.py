"""Damage of backups, drawn by seed."""

import pytest

from grammar.bench.damage import DAMAGES, damaged_source
from grammar.syntax.source import Source

TEXT = "DEF WORK()\nINT COUNTER\n" + "COUNTER = COUNTER + 1 ; Zähler\n" * 99 + "END\n"
PATHS = [f"R1/{number}.{kind}" for number in range(20) for kind in ("src", "dat")]


@pytest.mark.parametrize("kind", DAMAGES)
def test_some_files_are_damaged(kind: str) -> None:
    """A kind damages some files and spares others, the same by the same seed."""
    texts = []
    for _ in range(2):
        found = [damaged_source(Source(TEXT, path), kind, 3) for path in PATHS]
        texts.append([None if one is None else one.text for one in found])
    assert texts[0] == texts[1]
    assert 0 < texts[0].count(TEXT) < len(PATHS)


def test_lists_are_lost() -> None:
    """``lists`` spares programs."""
    sources = [Source(TEXT, path) for path in PATHS]
    lost = [one.path for one in sources if damaged_source(one, "lists", 1) is None]
    assert {"dat"} == {path.rpartition(".")[2] for path in lost}


def test_only_names_are_misspelt() -> None:
    """``names`` leaves key words and comments."""
    for path in PATHS:
        found = damaged_source(Source(TEXT, path), "names", 1)
        assert found is not None
        words = [line.split() for line in found.text.splitlines()]
        assert ["DEF"] == words[0][:1]
        assert ["INT"] == words[1][:1]
        assert ["; Zähler"] * 99 == [" ".join(line[-2:]) for line in words[2:-1]]
