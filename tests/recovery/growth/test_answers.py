"""A cluster of the start is answered by the construct from which on its lines can be read."""

from collections.abc import Sequence
from pathlib import Path
from typing import cast

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, RemoveAlternative
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.failures import beginning
from recovery.analysis import analyse, with_answers
from recovery.growth.answers import answered
from recovery.ledger.construct import Construct
from recovery.ledger.ledger import replay
from recovery.record.record_types import ClusterRecord
from recovery.survey.survey import Survey, survey

START = read_file(GRAMMAR.with_name("preliminary.g4"))
FILES = {
    "step.src": "DEF A()\nFOR I=1 TO 9 STEP 2\nENDFOR\nHALT 1\nEND\n",
    "more.src": "DEF A()\nFOR J=1 TO 9 STEP J\nENDFOR\nEND\n",
    "halt.src": "DEF A()\nHALT 1\nBRAKE 1\nEND\n",
    "never.src": "DEF A()\nA=1 2\nEND\n",
}


def construct(number: int, title: str, *edits: Edit) -> Construct:
    return Construct(title.lower(), title, edits, number, "accepted")


STEPS = replay(
    START,
    [
        construct(1, "Brake", AddAlternative("brake", "BRAKE INTEGER")),
        construct(
            2, "Step", AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")
        ),
        construct(3, "Halt", AddAlternative("halt", "HALT INTEGER")),
        construct(4, "No brake", RemoveAlternative("brake", 2)),
    ],
)


@pytest.fixture
def found(tmp_path: Path) -> Survey:
    for name, text in FILES.items():
        (tmp_path / name).write_bytes(text.encode())
    return survey([tmp_path], START, jobs=1)


def cluster(found: Survey, *places: tuple[str, int]) -> ClusterRecord:
    """A cluster with lines of these files as its examples."""
    paths = {Path(file.path).name: file.path for file in found.files}
    first, *others = [{"path": paths[name], "line": line} for name, line in places]
    return cast("ClusterRecord", {"title": "A", "example": first, "examples": others})


def answers(found: Survey, *clusters: Sequence[tuple[str, int]]) -> list[str | None]:
    given = [cluster(found, *places) for places in clusters]
    return [c["answered_by"] for c in answered(given, found, STEPS, jobs=1)["clusters"]]


def test_the_construct_that_makes_a_line_readable_answers(found: Survey) -> None:
    """Also where other lines of the file fail still."""
    assert ["0002-step", "0003-halt", None] == answers(
        found, [("step.src", 2)], [("halt.src", 2)], [("never.src", 2)]
    )


def test_most_of_the_lines_decide(found: Survey) -> None:
    """Two of three, but not one of two."""
    assert ["0002-step", None, "0003-halt"] == answers(
        found,
        [("step.src", 2), ("more.src", 2), ("never.src", 2)],
        [("step.src", 2), ("never.src", 2)],
        [("step.src", 4), ("step.src", 2)],
    )


def test_a_line_that_fails_again_is_not_answered(found: Survey) -> None:
    """Readable for good is what counts."""
    assert [None] == answers(found, [("halt.src", 3)])


def test_the_constructs_that_answered_are_reported_once(found: Survey) -> None:
    """In the order of the ledger, with the edit each made at its place."""
    given = [cluster(found, ("halt.src", 2)), cluster(found, ("step.src", 2))] * 2
    told = answered(given, found, STEPS, jobs=1)["constructs"]
    assert ["0002-step", "0003-halt"] == [c["id"] for c in told]
    assert "+STEP : 'STEP' ;" in told[0]["diff"]
    assert "STEP" not in told[1]["diff"]


def test_a_ledger_without_constructs_answers_nothing(found: Survey) -> None:
    """There is nothing but the start."""
    assert {
        "clusters": [{**cluster(found, ("step.src", 2)), "answered_by": None}],
        "constructs": [],
    } == (answered([cluster(found, ("step.src", 2))], found, [], jobs=1))


def test_answers_are_kept(found: Survey, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also that there is none; only what is new is read under the grammars of the ledger."""
    given = [cluster(found, ("step.src", 2)), cluster(found, ("never.src", 2))]
    new = cluster(found, ("halt.src", 2))
    kept = answered(given, found, STEPS, jobs=1, cache=tmp_path / "cache")
    read: set[str] = set()

    def noted(text: str, line: int) -> str:
        read.add(text)
        return beginning(text, line)

    monkeypatch.setattr("recovery.growth.answers.beginning", noted)
    again = answered([*given, new], found, STEPS, jobs=1, cache=tmp_path / "cache")
    assert kept["clusters"] == again["clusters"][:2]
    assert {FILES["halt.src"]} == read


def test_the_record_of_the_start_repeats_nothing(found: Survey) -> None:
    """Files and clusters are told, failures and origins are those of the grammar in force."""
    record = analyse(found, (), grammar_name="start")
    told = with_answers(record, found, STEPS, jobs=1)
    assert {
        "grammar",
        "files",
        "parsed",
        "bytes",
        "greedy",
        "clusters",
        "constructs",
    } <= told.keys()
    assert not told.keys() & {"failures", "origins", "skipped", "copies", "swallowed"}
    assert [c["id"] for c in record["clusters"]] == [c["id"] for c in told["clusters"]]
    titles = {c["title"]: c["answered_by"] for c in told["clusters"]}
    assert "0002-step" == next(titles[t] for t in titles if t.startswith("FOR"))
