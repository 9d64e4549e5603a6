"""The record of a survey: the fields others rely on, and figures that agree with one another."""

import json
from collections import Counter, defaultdict
from collections.abc import Mapping
from pathlib import Path

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import cluster
from recovery.record.record_types import SurveyRecord
from recovery.record.survey_record import record_of
from recovery.survey.survey import Survey, survey, survey_texts

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)
FILES = {
    "north/step1.src": b"DEF A()\r\nFOR I=1 TO 9 STEP 2\r\nENDFOR\r\nEND\r\n",
    "north/step2.src": b"DEF A()\nLOOP\n  FOR I=1 TO N STEP K ; on\n  ENDFOR\nENDLOOP\nEND\n",
    "north/fine.src": b"DEF A()\nHALT\nEND\n",
    "north/odd.src": b"DEF A()\n\tA=1 \xa7 2\nEND",
    "south/step1.src": b"DEF A()\r\nFOR I=1 TO 9 STEP 2\r\nENDFOR\r\nEND\r\n",
    "south/step3.src": b"DEF A()\nFOR J=1 TO 5 STEP X\nENDFOR\nRETURN 1\nEND\n",
    "south/switch.src": b"DEF A()\nSWITCH X\nCASE 1\nHALT\nENDSWITCH\nEND\n",
    "south/fine.sub": b"DEF A()\nHALT\nEND\n",
    "south/junk.dat": b"\x00\x01\x02" * 40,
    "west/odd.src": b"DEF A()\n\tA=1 \xa7 2\nEND",
    "west/cut.src": b"DEF A()\nHALT",
}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Survey:
    root = tmp_path_factory.mktemp("corpus")
    for name, data in FILES.items():
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_bytes(data)
    return survey([root], PRELIMINARY, jobs=1)


@pytest.fixture(scope="module")
def record(found: Survey) -> SurveyRecord:
    made = record_of(found, cluster(found), grammar_name="grammar/some.g4")
    return {**made, "failures": [*made["failures"]]}


def short(path: str) -> str:
    return "/".join(path.split("/")[-2:])


# ----------------------------------------------------------------------------- the contract

OF_A_SURVEY = {
    "grammar": str,
    "files": int,
    "parsed": int,
    "bytes": int,
    "parsed_bytes": int,
    "seconds": float,
    "skipped": list,
    "failures": list,
    "clusters": list,
}
OF_A_SKIPPED_FILE = {"path": str, "reason": str}
OF_A_FAILURE = {
    "path": str,
    "line": int,
    "column": int,
    "token": str,
    "text": str,
    "expected": list,
    "rule": str,
    "cluster": str,
    "follows": bool,
}
OF_A_CLUSTER = {
    "id": str,
    "title": str,
    "failures": int,
    "files": int,
    "origins": int,
    "unlocks": int,
    "example": dict,
    "reproducer": dict,
    "proposals": list,
}
OF_AN_EXAMPLE = {"path": str, "line": int, "text": str}
OF_A_PROPOSAL = {"edit": str, "restores": int, "accepts_negatives": int, "ambiguities": int}


def has(data: Mapping[str, object], fields: Mapping[str, type]) -> None:
    """Each of the fields is there and of its type, to the letter."""
    assert fields == {name: type(data[name]) for name in fields if name in data}


def test_every_field_of_the_contract_is_there(record: SurveyRecord) -> None:
    """What programs outside rely on has its name and its type."""
    has(record, OF_A_SURVEY)
    assert record["skipped"]
    assert record["failures"]
    assert record["clusters"]
    for skipped in record["skipped"]:
        has(skipped, OF_A_SKIPPED_FILE)
    for failure in record["failures"]:
        has(failure, OF_A_FAILURE)
        assert all(type(token) is str for token in failure["expected"])
    for entry in record["clusters"]:
        has(entry, OF_A_CLUSTER)
        has(entry["example"], OF_AN_EXAMPLE)
        for proposal in entry["proposals"]:
            has(proposal, OF_A_PROPOSAL)
    assert any(entry["proposals"] for entry in record["clusters"])


def test_the_record_is_plain_json(record: SurveyRecord) -> None:
    """Written and read again it is the same: no tuple, no number key, no NaN."""
    assert record == json.loads(json.dumps(record, allow_nan=False))


def test_no_text_could_break_a_line_or_a_page(record: SurveyRecord) -> None:
    """Names and titles are printable, whatever the files hold."""
    for entry in record["clusters"]:
        assert entry["title"].isprintable()
        assert all(p["edit"].isprintable() for p in entry["proposals"])


# ------------------------------------------------------------------------------ the figures


def test_files_and_bytes_count_copies(record: SurveyRecord) -> None:
    """Files, parsed files and their bytes are those on the disk, copies included."""
    krl = {name: data for name, data in FILES.items() if not name.endswith("junk.dat")}
    fine = {name for name in krl if "fine" in name}
    assert (len(krl), len(fine)) == (record["files"], record["parsed"])
    assert sum(map(len, krl.values())) == record["bytes"]
    assert sum(len(krl[name]) for name in fine) == record["parsed_bytes"]
    assert len(set(krl.values())) == record["distinct"]
    assert "grammar/some.g4" == record["grammar"]


def test_copies_and_skipped_files_are_named(record: SurveyRecord) -> None:
    """Every file of the disk is a file, a copy of one, or skipped."""
    copies = {short(c["path"]): short(c["same_as"]) for c in record["copies"]}
    assert {
        "south/fine.sub": "north/fine.src",
        "south/step1.src": "north/step1.src",
        "west/odd.src": "north/odd.src",
    } == copies
    assert ["south/junk.dat"] == [short(s["path"]) for s in record["skipped"]]


def test_origins_add_up(record: SurveyRecord) -> None:
    """Each origin's files are its parsed and failed ones, and all together the survey's."""
    origins = {o["name"]: (o["files"], o["parsed"], o["failed"]) for o in record["origins"]}
    assert {"north": (4, 1, 3), "south": (4, 1, 3), "west": (2, 0, 2)} == origins


def test_clusters_count_their_failures(record: SurveyRecord) -> None:
    """A cluster has as many failures as name it, in as many files and origins as its files lie."""
    places: dict[str, list[str]] = defaultdict(list)
    for failure in record["failures"]:
        places[failure["path"]] = [failure["path"]]
    for copy in record["copies"]:
        places[copy["same_as"]].append(copy["path"])
    named = Counter(failure["cluster"] for failure in record["failures"])
    for entry in record["clusters"]:
        own = {f["path"] for f in record["failures"] if f["cluster"] == entry["id"]}
        lie = {path for first in own for path in places[first]}
        assert named[entry["id"]] == entry["failures"]
        assert len(lie) == entry["files"]
        assert len({path.split("/")[-2] for path in lie}) == entry["origins"]
        listed = [f["path"] for o in entry["files_by_origin"] for f in o["files"]]
        assert sorted(lie) == sorted(listed)
    assert named.keys() == {entry["id"] for entry in record["clusters"]}


def test_what_follows_is_marked(record: SurveyRecord) -> None:
    """Lines of a block that was not understood follow, and no others."""
    follows = {(short(f["path"]), f["line"]) for f in record["failures"] if f["follows"]}
    assert {("south/switch.src", 3), ("south/switch.src", 5)} == follows


def test_the_order_of_mending_leads_to_all_files(record: SurveyRecord) -> None:
    """Each step names a cluster, and the last lets every file parse."""
    steps = [step["cluster"] for step in record["greedy"]]
    counts = [step["parsed"] for step in record["greedy"]]
    assert {entry["id"] for entry in record["clusters"]} == set(steps)
    assert sorted(counts) == counts
    assert record["files"] == counts[-1]


# ----------------------------------------------------------------------------- the failures


def test_failures_quote_the_file(record: SurveyRecord) -> None:
    """Line, column and text of each failure are those of the file."""
    for failure in record["failures"]:
        data = FILES[short(failure["path"])].decode("cp1252")
        line = data.replace("\r\n", "\n").split("\n")[failure["line"] - 1]
        assert line == failure["text"]
        assert line[failure["column"] - 1 :].startswith(failure["token"].strip("\r\n"))


def test_expected_is_what_could_have_come(record: SurveyRecord) -> None:
    """For the first failure of a file the expected tokens are exactly those the grammar allows."""
    lexer = RECOGNIZER.lexer
    first = {failure["path"]: failure for failure in reversed([*record["failures"]])}
    for path, failure in first.items():
        kinds = RECOGNIZER.kinds(FILES[short(path)].decode("cp1252"))
        state, index = RECOGNIZER.run(RECOGNIZER.start, kinds)
        assert index is not None
        fits = [k for k in range(1, len(lexer.names)) if RECOGNIZER.step(state, k) is not None]
        ends = ["EOF"] if RECOGNIZER.step(state, kinds[-1]) is not None else []
        assert sorted([lexer.display[k] for k in fits if k != kinds[-1]] + ends) == sorted(
            failure["expected"]
        )


def test_the_rule_is_the_one_at_work(record: SurveyRecord) -> None:
    """A failing line names the rule of the grammar that could not go on."""
    rules = {(short(f["path"]), f["line"]): f["rule"] for f in record["failures"]}
    assert "forStatement" == rules["north/step1.src", 2]
    assert set(rules.values()) <= PRELIMINARY.by_name.keys()


# ----------------------------------------------------------------------------- the clusters


def test_the_example_is_a_failure_of_the_cluster(record: SurveyRecord) -> None:
    """The example stands in a file, at its line, among the lines around it."""
    for entry in record["clusters"]:
        example = entry["example"]
        lines = FILES[short(example["path"])].decode("cp1252").replace("\r\n", "\n").split("\n")
        assert lines[example["line"] - 1] == example["text"]
        context = {shown["line"]: shown["text"] for shown in example["context"]}
        assert {n: lines[n - 1] for n in context} == context
        assert example["line"] in context
        own = [f for f in record["failures"] if f["cluster"] == entry["id"] and not f["follows"]]
        assert (example["path"], example["line"]) in {(f["path"], f["line"]) for f in own}
        assert entry["token"] == example["token"]


def test_further_examples_are_of_other_places(record: SurveyRecord) -> None:
    """No example is shown twice."""
    for entry in record["clusters"]:
        shown = [(e["path"], e["line"], e["column"]) for e in entry["examples"]]
        example = entry["example"]
        assert (example["path"], example["line"], example["column"]) not in shown
        assert len(set(shown)) == len(shown)


def test_the_reproducer_fails_as_it_says(record: SurveyRecord) -> None:
    """Read under the grammar, the reproducer fails at its line and column."""
    for entry in record["clusters"]:
        small = entry["reproducer"]
        assert small is not None
        (file,) = survey_texts([("small.src", small["text"])], PRELIMINARY).files
        assert (small["line"], small["column"]) == (file.failures[0].line, file.failures[0].column)


# ------------------------------------------------------------------------------- the borders


def test_files_that_changed_meanwhile_are_shown_without_context(tmp_path: Path) -> None:
    """A file removed after the survey loses its surroundings, not its failures."""
    file = tmp_path / "a.src"
    file.write_bytes(FILES["north/step1.src"])
    found = survey([tmp_path], PRELIMINARY, jobs=1)
    file.unlink()
    (entry,) = record_of(found, cluster(found), grammar_name="g")["clusters"]
    assert [] == entry["example"]["context"]
    assert "FOR I=1 TO 9 STEP 2" == entry["example"]["text"]


def test_a_survey_without_failures_has_a_record() -> None:
    """Nothing failed: no cluster, no order, all files parsed."""
    found = survey_texts([("a.src", "DEF A()\nEND\n")], PRELIMINARY)
    record = record_of(found, cluster(found), grammar_name="g")
    assert (1, 1, [], [], []) == (
        record["files"],
        record["parsed"],
        record["clusters"],
        record["greedy"],
        record["failures"],
    )
