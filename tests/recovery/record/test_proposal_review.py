"""A proposal says what it brings and what it costs, and each figure can be counted again."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, apply, from_data
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import Cluster, Clusters, cluster
from recovery.clustering.negative_score import negative_counter
from recovery.negatives.negatives import Negative
from recovery.record.proposal_review import Reviewer
from recovery.record.record_types import ProposalRecord
from recovery.survey.survey import Survey, survey

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)


def program(*lines: str) -> str:
    return "\n".join(["DEF A()", *lines, "END", ""])


NEGATIVES = (
    program("HALT 1"),
    program("IF A,B THEN", "ENDIF"),
    program("DECL INT A B"),
    program("FOR I=1 STEP 2 TO 9", "ENDFOR"),
    program("A=1,2"),
    program("A=1 STEP 2"),
    program("END 5"),
    program("STEP"),
    program("A=1"),  # which the grammar accepts beforehand
)
#: Lines that the grammar lacks, each alone.
LINES = {
    "volatile1.src": program("LIN P1 C_VEL"),
    "volatile2.src": program("LIN XHOME C_VEL", "A=1"),
    "volatile3.src": program("LIN P3 C_VEL", "LIN P4 C_VEL"),
    "copies/volatile3.src": program("LIN P3 C_VEL", "LIN P4 C_VEL"),
    "return1.src": program("RETURN 1"),
    "return2.src": program("HALT", "RETURN TRUE"),
    "list1.src": program("DECL INT A,B", "A=1"),
    "list2.src": program("DECL INT A,B,C", "DECL REAL X,Y"),
    "both.src": program("DECL INT A,B", "RETURN 1"),
    "fine.src": program("A=1"),
    "name1.src": program("C_VEL=1", "C_VEL=C_VEL+1"),
    "name2.src": program("c_vel = 4"),
    "copies/name2.src": program("c_vel = 4"),
    "name3.src": program("C_VEL2 = 4"),
}
#: Blocks of which the grammar lacks something, so that one line follows from another.
BLOCKS = {
    "step1.src": program("FOR I=1 TO 9 STEP 2", "ENDFOR"),
    "step2.src": program("FOR J=A TO B STEP K", "A=1", "ENDFOR"),
    "step3.src": program("FOR K=1 TO 9 STEP X", "HALT", "ENDFOR"),
    **{
        f"switch{n}.src": program(f"SWITCH {name}", "CASE 1", "HALT", f"CASE {n}", "ENDSWITCH")
        for n, name in enumerate(("X", "Y", "MODE"), 2)
    },
}


class Reviewed:
    """A corpus of files, its clusters, and what is proposed for them."""

    def __init__(self, root: Path, files: dict[str, str]) -> None:
        for name, text in files.items():
            file = root / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        self.root = root
        self.found: Survey = survey([root], PRELIMINARY, jobs=1)
        negatives = [Negative(None, text, "it is wrong", "parse") for text in NEGATIVES]
        self.clusters: Clusters = cluster(
            self.found, count_negatives=negative_counter(PRELIMINARY, negatives)
        )
        self.reviewer = Reviewer(self.found, self.clusters)
        self.records = [(c, self.reviewer.records(c)) for c in self.clusters.ranked]

    def proposals(self) -> list[ProposalRecord]:
        """What is told of all proposals, cluster by cluster."""
        return [record for _, records in self.records for record in records]

    def parsing(self, grammar: Grammar) -> set[str]:
        """The files that parse under a grammar, surveyed anew."""
        again = survey([self.root], grammar, jobs=1)
        return {path for f in again.files if not f.failures for path, _ in f.places}

    def of(self, found: Cluster, *edits: Edit) -> ProposalRecord:
        """What the reviewer says of edits of our own, proposed for a cluster."""
        ours = replace(found.proposals[0], edits=edits)
        alone = replace(found, proposals=(ours,), restores=found.restores[:1])
        (record,) = Reviewer(self.found, replace(self.clusters, ranked=(alone,))).records(alone)
        return record

    def named(self, title: str) -> Cluster:
        """The cluster whose title has these words."""
        return next(c for c in self.clusters.ranked if title in c.title)


@pytest.fixture(scope="module")
def lines(tmp_path_factory: pytest.TempPathFactory) -> Reviewed:
    return Reviewed(tmp_path_factory.mktemp("lines"), LINES)


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> Reviewed:
    return Reviewed(tmp_path_factory.mktemp("blocks"), BLOCKS)


def grammar_of(record: ProposalRecord) -> Grammar:
    """The grammar a proposal makes, read from its text."""
    return read(apply(PRELIMINARY, [from_data(edit) for edit in record["edits"]]).text)


def patched(text: str, diff: str) -> str:
    """A text after a unified difference, as any tool applies one."""
    old, new, place = text.splitlines(keepends=True), list[str](), 0
    for line in diff.splitlines()[2:]:
        if hunk := re.fullmatch(r"@@ -(\d+)(?:,\d+)? \+\d+(?:,\d+)? @@", line):
            start = int(hunk[1]) - 1
            new += old[place:start]
            place = start
        elif line.startswith("+"):
            new.append(line[1:] + "\n")
        else:
            assert old[place] == line[1:] + "\n"
            if line.startswith(" "):
                new.append(old[place])
            place += 1
    return "".join([*new, *old[place:]])


# ---------------------------------------------------------------------------- what it brings


def recount(of: Reviewed, tell: Callable[[set[str], set[str]], int]) -> list[int]:
    """A figure for each proposal, from the files that parse before and after it."""
    before = of.parsing(PRELIMINARY)
    return [tell(before, of.parsing(grammar_of(record))) for record in of.proposals()]


def restored(before: set[str], after: set[str]) -> int:
    return len(after - before)


def test_restores_counts_the_files_that_parse_with_it(lines: Reviewed) -> None:
    """Survey the corpus under the edited grammar: so many more files parse."""
    assert recount(lines, restored) == [record["restores"] for record in lines.proposals()]


def test_restores_counts_no_file_in_which_something_is_left(blocks: Reviewed) -> None:
    """An edit that lets a block be opened and not be closed restores no file."""
    assert recount(blocks, restored) == [record["restores"] for record in blocks.proposals()]


def test_mends_and_advances_count_lines(lines: Reviewed) -> None:
    """A proposal mends at least one line, and never one it only lets be read further."""
    for found, records in lines.records:
        for proposal, record in zip(found.proposals, records, strict=True):
            assert (len(proposal.mended), len(proposal.advanced)) == (
                record["mends"],
                record["advances"],
            )
            assert not proposal.mended & proposal.advanced
        assert records[0]["mends"] > 0


# ----------------------------------------------------------------------------- what it costs


def test_breaks_counts_the_files_that_parse_no_more(lines: Reviewed) -> None:
    """A word that some programs use as a name cannot be reserved without breaking them."""
    broken = recount(lines, lambda before, after: len(before - after))
    assert broken == [record["breaks"] for record in lines.proposals()]
    assert 3 in broken
    assert 0 in broken


def test_negatives_accepted_are_counted(lines: Reviewed) -> None:
    """Programs that must stay rejected, were so far, and would be no longer."""
    refused = [text for text in NEGATIVES if not RECOGNIZER.accepts(text)]
    for record in lines.proposals():
        accepts = Recognizer(grammar_of(record)).accepts
        assert sum(map(accepts, refused)) == record["accepts_negatives"], record["edit"]


def test_a_second_reading_is_an_ambiguity(lines: Reviewed) -> None:
    """Each mended line that has two readings under the edited grammar is counted."""
    found = lines.named("RETURN")
    count = len(found.proposals[0].mended)
    literal = Insert("return", (1, 2), "literal?")
    assert 0 == lines.of(found, literal)["ambiguities"]
    twice = lines.of(found, literal, AddAlternative("simpleStatement", "RETURN literal"))
    assert count == twice["ambiguities"] > 1


def test_a_second_reading_of_a_new_keyword_is_an_ambiguity(blocks: Reviewed) -> None:
    """The lines are read with the words that the proposal reserves."""
    found = blocks.named("STEP")
    step = (AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?"))
    assert 0 == blocks.of(found, *step)["ambiguities"]
    twice = blocks.of(found, *step, AddAlternative("expression", "disjunction STEP disjunction"))
    assert len(found.proposals[0].mended) == twice["ambiguities"] > 1


# ----------------------------------------------------------------------------- what it changes


def test_the_difference_applies(lines: Reviewed) -> None:
    """The difference shown, applied to the grammar, is the grammar after the edits."""
    for record in lines.proposals():
        expected = apply(PRELIMINARY, [from_data(edit) for edit in record["edits"]]).text
        assert expected == patched(PRELIMINARY.text, record["diff"])
        assert expected != PRELIMINARY.text


def test_the_edited_recogniser_reads_what_the_new_grammar_reads(lines: Reviewed) -> None:
    """What reviews a proposal is the grammar it makes."""
    texts: Sequence[str] = [*LINES.values(), *NEGATIVES]
    for found, records in lines.records:
        for proposal, record in zip(found.proposals[:1], records, strict=False):
            wider = lines.reviewer.wider(proposal)
            assert wider is not None
            expected = list(map(Recognizer(grammar_of(record)).accepts, texts))
            assert expected == list(map(wider.accepts, texts))
