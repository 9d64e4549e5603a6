"""Lines have one cause when one edit mends them, whatever they look like."""

import zlib
from collections.abc import Sequence
from random import Random

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause
from recovery.clustering.causes import find_causes
from recovery.clustering.edit_trial import EditTrial
from recovery.clustering.negative_score import NegativeCounter, Rivals
from recovery.clustering.search import CauseSearch
from recovery.proposals.edit_site import LinePattern
from recovery.survey.survey import survey_texts

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)
STEPS = [f"FOR I={a} TO {b} STEP {c}\nENDFOR" for a, b, c in ("12X", "AB2", "IJK", "XY7")]
LISTS = ["DECL INT A,B", "DECL REAL X,Y,Z", "DECL BOOL ON_OFF,OLD"]
RETURNS = ["RETURN 1", "RETURN TRUE", "RETURN 2.5"]
VOLATILE = ["LIN P1 C_VEL", "LIN XHOME C_VEL", "CIRC P1,P2 C_VEL"]
HOPELESS = ["A ? B", "§"]


def program(line: str) -> str:
    return f"DEF A()\n{line}\nEND\n"


def lines_of(*texts: str) -> list[LinePattern]:
    """The failing line of each text; STEP and C_VEL are meant as keywords."""
    found = survey_texts([(text, program(text)) for text in texts], PRELIMINARY)
    lines = []
    for file in found.files:
        failed = file.failures[0]
        meant = ((i, word) for i, word in enumerate(failed.words) if word in ("STEP", "C_VEL"))
        lines.append(LinePattern(found.forms[failed.form], tuple(meant)))
    return lines


def nothing_wrong(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
    del edits, rivals
    return 0


def causes(
    groups: Sequence[Sequence[str]],
    count_negatives: NegativeCounter = nothing_wrong,
    weights: Sequence[int] | None = None,
) -> list[Cause]:
    """The causes of lines that come in these groups, numbered through them."""
    lines = lines_of(*(text for group in groups for text in group))
    numbers = iter(range(len(lines)))
    return find_causes(
        RECOGNIZER,
        lines,
        weights or [1] * len(lines),
        [[next(numbers) for _ in group] for group in groups],
        count_negatives,
    )


def together(found: Sequence[Cause]) -> list[set[int]]:
    return [set(cause.lines) for cause in found]


ALL = [STEPS, LISTS, RETURNS, HOPELESS, VOLATILE]


@pytest.fixture(scope="module")
def all_causes() -> list[Cause]:
    return causes(ALL)


def test_every_line_has_one_cause(all_causes: list[Cause]) -> None:
    """Each line is in exactly one cause, those that no edit mends too."""
    count = sum(map(len, ALL))
    assert list(range(count)) == sorted(n for cause in all_causes for n in cause.lines)


def test_lines_mended_by_one_edit_have_one_cause(all_causes: list[Cause]) -> None:
    """Groups that one edit mends as a whole stay whole."""
    assert [{0, 1, 2, 3}, {4, 5, 6}] == [one for one in together(all_causes) if min(one) in (0, 4)]


def test_lines_mended_by_different_edits_have_different_causes() -> None:
    """A group that took lines of two causes for one is split."""
    mixed = [text for pair in zip(LISTS, RETURNS, strict=True) for text in pair]
    found = together(causes([mixed]))
    assert [{0, 2, 4}, {1, 3, 5}] == sorted(found, key=min)


def test_a_line_of_another_group_joins_when_the_same_edit_mends_it() -> None:
    """What grouped the lines beforehand does not decide: the edit does."""
    found = together(causes([STEPS[:2], STEPS[2:], LISTS[:1], LISTS[1:]]))
    assert [{0, 1, 2, 3}, {4, 5, 6}] == found


def test_lines_that_nothing_mends_stay_together_without_a_proposal() -> None:
    """A cause that nobody knows a remedy for is shown all the same."""
    (found,) = causes([HOPELESS])
    assert ((0, 1), ()) == (found.lines, found.proposals)


def test_lines_nested_beyond_measure_get_no_search() -> None:
    """A search would read hundreds of openers at each trial; such lines are still in a cause."""
    deep = "LOOP\n" * 300
    [line] = lines_of(f"{deep}DECL INT A,B")
    assert line.is_enormous
    [usual] = lines_of("LOOP\n" * 20 + "DECL INT A,B")
    assert not usual.is_enormous
    [found] = find_causes(RECOGNIZER, [line], [1], [[0]], nothing_wrong)
    assert Cause((0,), ()) == found


def test_proposals_mend_what_they_say(all_causes: list[Cause]) -> None:
    """The best proposal mends lines of its cause only, and each tells all lines it mends."""
    lines = lines_of(*(text for group in ALL for text in group))
    trial = EditTrial(RECOGNIZER, lines)
    gone: set[int] = set()
    for cause in all_causes:
        for proposal in cause.proposals:
            # lines that have their cause already are not asked again
            assert trial.result(proposal.edits).mended - gone == proposal.mended
            assert trial.result(proposal.edits).advanced - gone == proposal.advanced
        if cause.proposals:
            assert set(cause.proposals[0].mended) <= set(cause.lines)
            assert cause.proposals[0].mended
        gone |= set(cause.lines)


def test_proposals_differ(all_causes: list[Cause]) -> None:
    """No proposal is made twice for one cause."""
    for cause in all_causes:
        assert len({proposal.edits for proposal in cause.proposals}) == len(cause.proposals)


@pytest.mark.parametrize("salt", range(2))
def test_what_lets_in_negatives_comes_last(salt: int) -> None:
    """Proposals are ordered by the count of negatives first, and record it."""

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        del rivals
        return zlib.crc32(f"{salt}{edits}".encode()) % 3

    for cause in causes([STEPS[:2], LISTS[:2], RETURNS], count_negatives):
        said = [proposal.accepts_negatives for proposal in cause.proposals]
        assert [count_negatives(proposal.edits) for proposal in cause.proposals] == said
        assert sorted(said) == said


def test_an_edit_that_lets_in_no_negative_is_preferred() -> None:
    """An edit that accepts negatives gives way to another that mends the same lines."""
    (plain,) = causes([LISTS])
    best = plain.proposals[0]

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        del rivals
        return 5 if tuple(edits) == best.edits else 0

    (careful,) = causes([LISTS], count_negatives)
    assert best.edits != careful.proposals[0].edits
    assert best.mended == careful.proposals[0].mended


def test_among_equals_the_most_restrictive_comes_first(all_causes: list[Cause]) -> None:
    """Of edits that mend the same lines and accept no negatives, the narrowest comes first."""
    for cause in all_causes:
        if not cause.proposals:
            continue
        best = cause.proposals[0]
        equals = [p for p in cause.proposals if p.mended == best.mended]
        assert min(p.breadth for p in equals) == best.breadth


def first_edits(lines: Sequence[str], *proposals: tuple[tuple[Edit, ...], int]) -> tuple[Edit, ...]:
    """The edits that rank first for lines, of edits with their breadth that all mend them."""
    search = CauseSearch(RECOGNIZER, lines_of(*lines), [1] * len(lines), nothing_wrong)
    found = [search.proposal(edits, breadth) for edits, breadth in proposals]
    assert {frozenset(range(len(lines)))} == {proposal.mended for proposal in found}
    return search.ranked(found, range(len(lines)))[0].edits


def test_words_that_most_lines_lack_are_reserved_by_no_first_proposal() -> None:
    """One line of four has the word as a type: the others do not fail for it."""
    plain = (Insert("declaration", (1, 4), "(',' NAME)*"),)
    form = "DECL (BOOL | INT | REAL | STEP) NAME (',' NAME)* eol"
    reserving = (AddToken("STEP"), AddAlternative("declaration", form))
    assert plain == first_edits([*LISTS, "DECL STEP A,B"], (plain, 18), (reserving, 13))


def test_a_second_reading_of_the_lines_costs_more_than_breadth() -> None:
    """What a value and an expression read alike is ambiguous, though it is called narrower."""
    plain = (Insert("return", (1, 2), "expression?"),)
    twice = (Insert("return", (1, 2), "(literal | expression)?"),)
    assert plain == first_edits(RETURNS, (plain, 30), (twice, 5))


def test_every_group_is_reported_done() -> None:
    """Progress counts the groups, one after the other."""
    done: list[int] = []
    lines = lines_of(*LISTS, *HOPELESS)
    find_causes(RECOGNIZER, lines, [1] * 5, [[0, 1, 2], [3], [4]], nothing_wrong, done.append)
    assert 3 == sum(done)


def test_the_order_of_lines_in_a_group_does_not_decide_who_belongs_together() -> None:
    """Shuffled, the same lines have the same causes."""
    texts = [*STEPS[:2], *LISTS[:2], *RETURNS[1:]]
    shuffled = Random(1).sample(texts, len(texts))
    first, second = (
        {frozenset(given[n] for n in cause.lines) for cause in causes([given])}
        for given in (texts, shuffled)
    )
    assert first == second
