"""Failures are grouped by cause, and what mending them brings is what counting brings."""

from collections import defaultdict
from dataclasses import replace
from random import Random

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import Cluster, Clusters, cluster
from recovery.clustering.distinct_lines import Member
from recovery.clustering.edit_trial import edited
from recovery.clustering.negative_score import negative_counter
from recovery.negatives.negatives import Negative
from recovery.survey.survey import Survey, survey_texts
from recovery.survey.surveyed_files import SurveyedFile
from recovery.tuning import MOST_EXAMPLES

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
#: Pieces of programs: some are fine, some fail, some fail and make others follow.
PIECES = (
    "A=1",
    "PTP HOME",
    "IF A THEN\nHALT\nENDIF",
    "FOR I=1 TO 9 STEP 2\nA=1\nENDFOR",
    "FOR I=1 TO N STEP K\nENDFOR",
    "X[1,2]=3",
    "A=Y[I,J]",
    "SWITCH X\nCASE 1\nA=1\nCASE 2\nENDSWITCH",
    "SWITCH MODE\nCASE #T1\nHALT\nDEFAULT\nENDSWITCH",
    "RETURN 1",
    "LIN P1 C_VEL",
    "A ? B",
    "IF A THEN",
    "ENDLOOP",
)


def program(*pieces: str) -> str:
    return "\n".join(["DEF A()", *pieces, "END", ""])


def surveyed(*programs: str) -> Survey:
    return survey_texts([(f"{n:03}.src", text) for n, text in enumerate(programs)], PRELIMINARY)


def clusters_of(*pieces: str) -> Clusters:
    """Clusters of programs of one piece each."""
    return cluster(surveyed(*map(program, pieces)))


def files(found: Cluster) -> set[str]:
    return {file.path for file, _ in found.files}


# ----------------------------------------------------------------------- causes and no less


@pytest.mark.parametrize(
    "text",
    [
        "DEF A()\nLOOP 5\nHALT\nENDLOOP\nEND\n",
        "DEF A()\nIF A THEN NOW\nHALT\nENDIF\nEND\n",
        "DEFDAT A PUBLIC\nDECL INT I=1\nENDDAT\n",
    ],
)
def test_the_header_of_a_block_gets_a_part(text: str) -> None:
    """An edit that reads the whole block is better than one that reads its first line only."""
    negatives = [Negative(None, text.replace("HALT", "A=1"), "", "parse")]
    counter = negative_counter(PRELIMINARY, negatives)
    (only,) = cluster(surveyed(*[text] * 4), count_negatives=counter, text_of=lambda _: text).ranked
    wider = edited(Recognizer(PRELIMINARY), only.proposals[0].edits)
    assert wider is not None
    assert wider.accepts(text)


def test_a_program_without_failures_is_in_no_cluster() -> None:
    """Nothing failed, nothing is grouped, and there is nothing to mend."""
    found = clusters_of("HALT", "A=1")
    assert ((), (), {}) == (found.ranked, found.order, found.numbers)


def test_what_only_follows_belongs_to_its_cause() -> None:
    """A block that is not known is one cluster: its opener, what is in it, and its closer."""
    found = clusters_of("SWITCH X\nCASE 1\nA=1\nCASE 2\nENDSWITCH")
    (only,) = found.ranked
    assert (4, 3, 1) == (only.failures, only.following, only.unlocks)


# ----------------------------------------------------------------- laws, on corpora by chance


@pytest.fixture(scope="module", params=range(2))
def corpus(request: pytest.FixtureRequest) -> tuple[Survey, Clusters]:
    """A small corpus of random programs, some of them alike, and its clusters."""
    chance = Random(request.param)
    programs = [program(*chance.choices(PIECES, k=chance.randint(0, 4))) for _ in range(12)]
    found = surveyed(*programs)
    return found, cluster(found)


def wanted(file: SurveyedFile, clusters: Clusters) -> set[str]:
    """The clusters that have to be mended for a file to parse."""
    return {clusters.cluster_of(file, index) for index, _ in enumerate(file.failures)}


def count(found: Survey, clusters: Clusters, mended: set[str]) -> int:
    """Files that parse when these clusters are mended."""
    return sum(len(f.places) for f in found.files if wanted(f, clusters) <= mended)


def test_every_failure_is_in_one_cluster(corpus: tuple[Survey, Clusters]) -> None:
    """No failure is lost, none counted twice; a file is listed with its first one."""
    found, clusters = corpus
    expected: dict[str, list[tuple[str, int, bool]]] = defaultdict(list)
    for file in found.files:
        for index, failed in enumerate(file.failures):
            place = (file.digest, failed.line, failed.follows)
            expected[clusters.cluster_of(file, index)].append(place)
    assert set(expected) == {one.id for one in clusters.ranked}
    for one in clusters.ranked:
        places = expected[one.id]
        assert len(places) == one.failures
        assert sum(follows for _, _, follows in places) == one.following
        first = {digest: line for digest, line, _ in reversed(places)}
        assert first == {file.digest: line for file, line in one.files}


def test_examples_are_the_shortest_of_different_files(corpus: tuple[Survey, Clusters]) -> None:
    """Of each file the shortest failure, a direct one first, and of files the first five."""
    found, clusters = corpus
    for one in clusters.ranked:
        members = [
            Member(file, failed)
            for file in found.failing
            for index, failed in enumerate(file.failures)
            if clusters.cluster_of(file, index) == one.id
        ]
        by_file: dict[str, Member] = {}
        for member in sorted(members, key=lambda m: (m.failed.follows, len(m.failed.source))):
            if member != one.example:
                by_file.setdefault(member.file.digest, member)
        assert list(by_file.values())[:MOST_EXAMPLES] == one.others


def test_followers_are_where_their_cause_is(corpus: tuple[Survey, Clusters]) -> None:
    """A failure that follows is in the cluster of the direct failure before it."""
    found, clusters = corpus
    for file in found.files:
        cause = None
        for index, failed in enumerate(file.failures):
            own = clusters.cluster_of(file, index)
            cause = cause if failed.follows else own
            assert cause == own


def test_no_cluster_is_of_followers_only(corpus: tuple[Survey, Clusters]) -> None:
    """What follows makes no cluster of its own, and no example is taken from it."""
    _, clusters = corpus
    for found in clusters.ranked:
        assert found.following < found.failures
        assert not found.example.failed.follows
        assert found.example.file in [file for file, _ in found.files]


def test_unlocks_counts_the_files_that_fail_for_nothing_else(
    corpus: tuple[Survey, Clusters],
) -> None:
    """Mending one cluster lets so many more files parse."""
    found, clusters = corpus
    parsed = count(found, clusters, set())
    assert [count(found, clusters, {c.id}) - parsed for c in clusters.ranked] == [
        c.unlocks for c in clusters.ranked
    ]


def test_what_holds_back_most_comes_first(corpus: tuple[Survey, Clusters]) -> None:
    """Clusters are ranked by what they unlock, then by the files they are in."""
    _, clusters = corpus
    keys = [(c.unlocks, c.places) for c in clusters.ranked]
    assert sorted(keys, reverse=True) == keys


def test_the_order_of_mending_counts_right(corpus: tuple[Survey, Clusters]) -> None:
    """After each step as many files parse as counting from scratch says, at last all of them."""
    found, clusters = corpus
    mended: set[str] = set()
    for step, parsed in clusters.order:
        assert step.id not in mended
        mended.add(step.id)
        assert count(found, clusters, mended) == parsed
    assert {c.id for c in clusters.ranked} == mended
    assert not clusters.order or len(found.files) == clusters.order[-1][1]


def test_the_order_of_mending_is_greedy(corpus: tuple[Survey, Clusters]) -> None:
    """No other cluster would have let more files parse at any step."""
    found, clusters = corpus
    mended: set[str] = set()
    for step, parsed in clusters.order:
        left = {c.id for c in clusters.ranked} - mended
        assert max(count(found, clusters, mended | {other}) for other in left) == parsed
        mended.add(step.id)


def test_identities_and_titles_are_unique(corpus: tuple[Survey, Clusters]) -> None:
    """A cluster can be named by its identity or its title."""
    _, clusters = corpus
    assert len({c.id for c in clusters.ranked}) == len(clusters.ranked)
    assert len({c.title for c in clusters.ranked}) == len(clusters.ranked)
    assert len({c.signature for c in clusters.ranked}) == len(clusters.ranked)


def test_copies_count() -> None:
    """A file that lies in three places is three files to be mended."""
    found = surveyed(program("RETURN 1"), program("DECL INT A,B"), program("HALT"))
    first, *others = found.files
    copies = tuple((f"{n}/a.src", f"{n}") for n in range(3))
    more = replace(found, files=(replace(first, places=copies), *others))
    clusters = cluster(more)
    assert [3, 1] == [c.unlocks for c in clusters.ranked]
    assert [4, 5] == [parsed for _, parsed in clusters.order]
    assert [1, 1] == [len(c.files) for c in clusters.ranked]
