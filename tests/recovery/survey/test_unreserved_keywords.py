"""Words that a grammar lacks and reads as names without any failure."""

from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import Edit, RemoveAlternative, RemoveRule, apply
from grammar.notation.model import Grammar
from grammar.parser.lexer import lexer_of
from recovery.survey.unreserved_keywords import UnreservedKeyword, UnreservedKeywords, names_used

PRELIMINARY = g4.read_file(Path(g4.__file__).parents[1].joinpath("preliminary.g4"))


def without_true() -> Grammar:
    rule = PRELIMINARY.by_name["literal"]
    number = next(
        i for i, a in enumerate(rule.alternatives, 1) if rule.source_of(a).strip() == "TRUE"
    )
    edits: list[Edit] = [RemoveAlternative("literal", number), RemoveRule("TRUE")]
    return g4.read(apply(PRELIMINARY, edits).text)


def programs(count: int) -> list[tuple[str, str]]:
    return [
        (
            f"origin {n % 2}",
            f"DEF P{n}()\nDECL BOOL B{n}\nB{n}=TRUE\nIF B{n}==TRUE THEN\nENDIF\nEND\n",
        )
        for n in range(count)
    ]


def suspected(given: list[tuple[str, str]], grammar: Grammar) -> list[UnreservedKeyword]:
    """The suspects among programs given as (origin, text)."""
    count = UnreservedKeywords()
    for origin, text in given:
        count.add(origin, names_used(text, lexer_of(grammar)))
    return list(count.found())


def test_a_keyword_read_as_a_name_everywhere_is_suspected() -> None:
    """TRUE, which nobody declares or assigns, is named with its readers."""
    assert suspected(programs(4), without_true()) == [UnreservedKeyword("TRUE", 4, 2)]


def test_a_known_keyword_is_not_suspected() -> None:
    """Under a grammar that reserves TRUE it is no name at all."""
    assert suspected(programs(4), PRELIMINARY) == []


def test_a_variable_that_somebody_assigns_is_not_suspected() -> None:
    """One assignment anywhere makes a word a variable."""
    assigned = [*programs(4), ("origin 1", "DEF Q()\nTRUE=1\nEND\n")]
    assert suspected(assigned, without_true()) == []
    assert suspected(assigned[::-1], without_true()) == []


def test_one_origin_is_not_enough_where_there_are_two() -> None:
    """A word that only one origin reads may be that author's."""
    programs_of_two = [("a", text) for _, text in programs(4)] + [("b", "DEF Q()\nEND\n")]
    assert suspected(programs_of_two, without_true()) == []


@pytest.mark.parametrize("most", [0, 1, 3, 1_000])
def test_counts_on_disk_are_those_in_memory(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """However often counts move to disk, the result is the same."""
    monkeypatch.setattr(UnreservedKeywords, "MOST_IN_MEMORY", most)
    read = [("c", "DEF Q()\nWAIT FOR SEEN\nBOUND=SEEN AND BOUND\nEND\n")] * 3
    expected = [UnreservedKeyword("TRUE", 4, 2)]
    assert suspected([*programs(4), *read], without_true()) == expected
