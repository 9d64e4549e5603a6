"""The title of a cluster says what is wrong, in the words of a maintainer."""

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import Cluster, cluster
from recovery.clustering.title import TitleWriter
from recovery.proposals.edit_site import LinePattern
from recovery.survey.survey import survey_texts

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))


def cluster_of(*lines: str, closer: str = "END\n") -> Cluster:
    """The first cluster of programs of one line each."""
    texts = [f"DEF A()\n{line}\n{closer}" for line in lines]
    found = survey_texts([(f"{n}.src", text) for n, text in enumerate(texts)], PRELIMINARY)
    return cluster(found).ranked[0]


@pytest.mark.parametrize(
    ("line", "title"),
    [
        ("RETURN 1", "RETURN followed by an integer"),
        ("A B", "A name followed by a name"),
        ("B?", "A name followed by an unknown character"),
        ("A=1.B", "Line goes on with '.'"),
        ("LIN P1 CONTINUE", "LIN with CONTINUE"),
        ("LIN P1[1] CONTINUE", "LIN with CONTINUE where '.' or C_DIS is expected"),
        ("WAIT SEC", "WAIT line ends too early"),
        ("DECL INT", "DECL line ends where a name is expected"),
        ("X[1,2]=3", "',' in '[]'"),
        ("X[,]=3", "',' right behind '['"),
        ("A=F(1,X[2,3])", "',' in '[]'"),
        ("PTP {A1 0}", "Aggregate without a name and ':'"),
        ("A[-B]=3", "'-' followed by a name in '[]' where an integer or a real number is expected"),
        ("?", "An unknown character begins a line"),
        ("FOO", "A name alone on a line"),
        ("A=B*+C", "'*' followed by '+'"),
    ],
)
def test_a_title_says_what_came_and_where(line: str, title: str) -> None:
    """The failing token, what stands before it, and what was wanted where that is one thing."""
    assert title == cluster_of(line).title


def test_reserved_words_used_as_names_are_listed() -> None:
    """They fail in many places for one reason; more than a few are counted."""
    words = ("SEC", "DELAY", "DISTANCE", "BRAKE", "TO")
    titles = [cluster_of(*(f"A={w}" for w in words[:n])).title for n in (1, 2, 4, 5)]
    assert [
        "SEC as a name",
        "DELAY and SEC as names",
        "BRAKE, DELAY, DISTANCE and SEC as names",
        "BRAKE, DELAY, DISTANCE and 2 more as names",
    ] == titles


def test_a_file_cut_off_lacks_the_end_of_a_rule() -> None:
    """The end of the file is no line of its own."""
    assert "Procedure without END" == cluster_of("HALT", closer="").title


def test_a_keyword_left_out_is_named() -> None:
    """Where one keyword before the failing token lets the line be read, that is what is missing."""
    assert "INT without DECL" == cluster_of("INT A").title


@pytest.mark.parametrize(
    ("lines", "title"),
    [
        (("SWITCH A", "SWITCH B", "SWITCH C", "SWITCH D"), "Unknown keyword SWITCH"),
        (
            tuple(f"GLOBAL INTERRUPT OFF {n}" for n in range(12)),
            "Unknown keyword GLOBAL before INTERRUPT",
        ),
        (tuple(f"FOR I=1 TO 9 STEP {n}" for n in "ABCD"), "FOR with STEP"),
        (tuple(f"DECL CONST INT A{n}" for n in range(8)), "DECL with CONST"),
    ],
)
def test_a_word_that_no_rule_knows_is_taken_for_a_keyword(
    lines: tuple[str, ...], title: str
) -> None:
    """Words that stand as keywords do are named in the title."""
    assert title == cluster_of(*lines).title


def test_equal_titles_are_made_distinct() -> None:
    """By how the line goes on, then by the rule it stands in, in words; last by a number."""
    recognizer = Recognizer(PRELIMINARY)
    finder = FailureFinder(recognizer)
    patterns = [
        LinePattern(finder.find(f"DEF A()\n{line}\nEND\n")[0].form, ())
        for line in ("A B", "A 1", "A B C", "A B C", "A B C")
    ]
    rules = ["simpleStatement", "module", "dataList", "module", "module"]
    assert [
        "No: name name",
        "No: name integer",
        "No in data list",
        "No in module",
        "No in module (2)",
    ] == TitleWriter(recognizer).distinguished(["No"] * 5, patterns, rules)


def test_the_identity_hangs_on_the_signature_and_not_on_the_title() -> None:
    """The same failing line has the same ID, whatever the sentence says."""
    found = cluster_of("DECL INT A,B")
    assert ("c-b8bdbb72", "DECL … ,", "DECL with ','") == (found.id, found.signature, found.title)
