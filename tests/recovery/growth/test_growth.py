"""The record of the growth says what each construct brought, to the line."""

from pathlib import Path
from typing import Any

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from recovery.growth import growth as growth_module
from recovery.growth.growth import growth
from recovery.ledger.construct import Construct, Evidence
from recovery.ledger.ledger import replay
from recovery.ledger.metrics import metrics
from recovery.record.record_types import GrowthRecord
from support.files.discovery import IngestError

START = read_file(GRAMMAR.with_name("preliminary.g4"))
STEP = "DEF A()\nFOR I=1 TO 9 STEP 2\nENDFOR\nEND\n"
FILES = {
    "fine.src": "DEF A()\nHALT\nEND\n",
    "name.src": "DEF A()\nSTEP=1\nEND\n",
    "step.src": STEP,
    "copies/step.src": STEP,
    "two.src": "DEF A()\nHALT 1\nHALT 2\nFOR I=1 TO 9 STEP 2\nENDFOR\nEND\n",
    "never.src": "DEF A()\nA=1 2\nEND\n",
    "table.dat": "1;2;3\n4;5;6\n",
}


def construct(number: int, title: str, *edits: Edit, evidence: Evidence | None = None) -> Construct:
    return Construct(
        title.lower(),
        title,
        edits,
        number,
        "accepted",
        "Why.",
        evidence or Evidence(),
        ("X",),
        ("Y",),
    )


LEDGER = (
    construct(
        1,
        "Step",
        AddToken("STEP"),
        Insert("forStatement", (1, 7), "(STEP expression)?"),
        evidence=Evidence(files=4, origins=2, lines=7, rules=("CTL-05",), seen=("o/a.src:3",)),
    ),
    construct(2, "Halt", AddAlternative("halt", "HALT INTEGER")),
)
STEPS = replay(START, LEDGER)


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        file = tmp_path / "cell" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text.encode())
    return tmp_path / "cell"


def names(paths: list[str]) -> list[str]:
    return [path.split("cell/")[1] for path in paths]


def test_the_steps_counted_by_hand(corpus: Path) -> None:
    """STEP restores two files and takes one away, HALT with a number restores another."""
    steps = growth([corpus], START, STEPS, jobs=1)["steps"]
    expected = [
        (0, "preliminary", 2, 0, 0),
        (1, "0001-step", 3, 2, 1),
        (2, "0002-halt", 4, 1, 0),
    ]
    assert expected == [
        (s["number"], s["id"], s["parsed"], s["restored"], s["broken"]) for s in steps
    ]
    assert ["copies/step.src", "step.src"] == names(steps[1]["restored_files"])
    assert ["name.src"] == names(steps[1]["broken_files"])
    assert ["two.src"] == names(steps[2]["restored_files"])


def test_failing_lines_are_those_of_the_surveys(corpus: Path) -> None:
    """Each content counts once."""
    from recovery.survey.survey import survey

    steps = growth([corpus], START, STEPS, jobs=1)["steps"]
    grammars = [START, *(grammar for _, grammar in STEPS)]
    counted = [
        sum(len(f.failures) for f in survey([corpus], grammar, jobs=1).files)
        for grammar in grammars
    ]
    assert counted == [step["failing_lines"] for step in steps]


def test_bytes_and_files_include_copies(corpus: Path) -> None:
    """The same in every step; a table is no file."""
    record = growth([corpus], START, STEPS, jobs=1)
    sizes = {name: len(text) for name, text in FILES.items() if name != "table.dat"}
    assert (6, 5, sum(sizes.values())) == (record["files"], record["distinct"], record["bytes"])
    assert {(6, sum(sizes.values()))} == {(s["files"], s["bytes"]) for s in record["steps"]}
    assert sizes["fine.src"] + sizes["name.src"] == record["steps"][0]["parsed_bytes"]
    assert ["table.dat"] == names([s["path"] for s in record["skipped"]])


def test_a_step_names_its_construct(corpus: Path) -> None:
    """Title, grounds, evidence, the edit in words and as a difference, the examples."""
    step = growth([corpus], START, STEPS, jobs=1)["steps"][1]
    assert ("Step", "accepted", "Why.") == (step["title"], step["state"], step["summary"])
    assert ["corroborated", "documented"] == step["grounds"]
    assert (4, 2, 7, ["CTL-05"], ["o/a.src:3"]) == tuple(
        step["evidence"][key] for key in ("files", "origins", "lines", "rules", "seen")
    )
    assert "reserve STEP" == step["edits"][0]
    lines = step["diff"].splitlines()
    assert "+STEP : 'STEP' ;" in lines
    assert 1 == sum(line.startswith("-") for line in lines)
    assert (["X"], ["Y"]) == (step["accept"], step["reject"])


def test_each_step_is_measured(corpus: Path) -> None:
    """Under its own grammar, and each figure has its meaning."""
    record = growth([corpus], START, STEPS, jobs=1)
    grammars = [START, *(grammar for _, grammar in STEPS)]
    assert [dict(metrics(g)) for g in grammars] == [s["metrics"] for s in record["steps"]]
    assert record["meanings"].keys() == record["steps"][0]["metrics"].keys()


def test_what_remains_is_listed_with_its_reason(corpus: Path) -> None:
    """A broken fact of KRL, where one is known; the failing line with its token."""
    record = growth([corpus], START, STEPS, jobs=1)
    left = {Path(f["path"]).name: f for f in record["remaining_files"]}
    assert {"name.src", "never.src"} == left.keys()
    assert ("", 0) == (left["name.src"]["fact"], left["name.src"]["fact_line"])
    assert 2 == left["never.src"]["fact_line"]
    line = next(x for x in record["remaining"] if x["path"].endswith("never.src"))
    assert (2, 5, "2", "A=1 2") == tuple(line[key] for key in ("line", "column", "token", "text"))


def test_a_ledger_without_constructs_has_one_step(corpus: Path) -> None:
    """The start stands alone."""
    record = growth([corpus], START, [], jobs=1)
    assert [0] == [step["number"] for step in record["steps"]]
    assert START.sha256 == record["grammar_sha256"]


def test_the_record_is_kept(corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is worked out a second time, but for a construct that tells something else."""

    def settled(record: GrowthRecord) -> dict[str, Any]:
        return {key: value for key, value in record.items() if key != "seconds"}

    cache = tmp_path / "cache"
    first = growth([corpus], START, STEPS, jobs=1, cache=cache)
    assert settled(first) == settled(growth([corpus], START, STEPS, jobs=1))
    retold = [(construct(1, "Told anew", *LEDGER[0].edits), STEPS[0][1])]
    assert "Told anew" == growth([corpus], START, retold, jobs=1, cache=cache)["steps"][1]["title"]
    monkeypatch.setattr(growth_module, "_record", lambda *_: pytest.fail("worked out again"))
    assert settled(first) == settled(growth([corpus], START, STEPS, jobs=1, cache=cache))


def test_nothing_to_read_is_an_error(tmp_path: Path) -> None:
    """As for a survey."""
    with pytest.raises(IngestError):
        growth([tmp_path], START, STEPS)
