"""Case files: front matter, companions, expectations beside their lines, selection."""

from collections.abc import Callable
from pathlib import Path

import pytest

from conformance.suite.case import Case, CaseError, find_cases, read_case, selected
from krl.cli import main

Write = Callable[[str, str], Path]

GOOD = """\
;@ rule: CTL-01, CTL-02
;@ title: a fact
;@ phase: run
;@ io: t=0.5 IN[1]=TRUE
;@ io: t=0.7 IN[2]=TRUE
DEF good()
  DECL INT N
  N = 1 ;> value N 1 ;> runs 1
  ; a comment
  ;> order 1
  N = 2 ; not an ;expectation
END
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
        return path

    return write


def test_case_has_what_its_front_matter_says(write: Write, tmp_path: Path) -> None:
    """Keys that may repeat keep their order; the rest is as written."""
    case = read_case(write("control/good.src", GOOD), tmp_path)
    assert ("control/good", "control", "good.src") == (case.name, case.suite, case.main)
    assert ("CTL-01", "CTL-02") == case.rules
    assert ("t=0.5 IN[1]=TRUE", "t=0.7 IN[2]=TRUE") == case.io
    assert (60.0, "kss8", "run") == (case.seconds, case.profile, case.phase)


def test_an_expectation_may_rest_on_another_clause(write: Write, tmp_path: Path) -> None:
    """Only those that rest on what is sure may fail the case."""
    text = GOOD.replace("CTL-01, CTL-02", "BLD-01.a, CTL-02")
    text = text.replace("value N 1 ", "value N 1 [CTL-02] ").replace("runs 1", "runs 1 [BLD-01.b]")
    case = read_case(write("control/good.src", text), tmp_path)
    assert ("BLD-01", "CTL-02") == case.rules
    assert [False, False, True] == [case.is_sure(one) for one in case.expectations]
    assert ("N", "1") == case.expectations[0].arguments
    with pytest.raises(CaseError, match=r"no rule 'BLD-01\.z'"):
        read_case(write("control/bad.src", text.replace("BLD-01.b", "BLD-01.z")), tmp_path)


def test_machine_data_are_a_file_beside_it(write: Write, tmp_path: Path) -> None:
    """It is among the sources under the name that a controller has for it."""
    write("control/arm.dat", "DEFDAT $MACHINE PUBLIC\nENDDAT\n")
    text = GOOD.replace(";@ phase: run", ";@ phase: run\n;@ machine: arm.dat")
    case = read_case(write("control/good.src", text), tmp_path)
    assert ["good.src", "$machine.dat"] == [one.path for one in case.sources]
    assert "arm.dat" == case.machine


def test_expectations_belong_to_lines_with_code(write: Write, tmp_path: Path) -> None:
    """One on a line of its own belongs to the last line that says something."""
    case = read_case(write("control/good.src", GOOD), tmp_path)
    places = [(one.kind, one.line) for one in case.expectations]
    assert [("value", 8), ("runs", 8), ("order", 8)] == places


def test_mark_within_a_text_is_none(write: Write, tmp_path: Path) -> None:
    """``;>`` between quotation marks is part of the program."""
    text = GOOD.replace("N = 2 ; not an ;expectation", 'T[] = "a ;> b" ;> never')
    case = read_case(write("control/good.src", text), tmp_path)
    assert ("never", 11) == (case.expectations[-1].kind, case.expectations[-1].line)


def test_companions_are_found_by_stem_and_by_name(write: Write, tmp_path: Path) -> None:
    """The data list of the same stem, and what ``with`` names; expectations in them count."""
    write("s/good.dat", "DEFDAT good\n  DECL INT N = 1\nENDDAT\n")
    write("s/lib.src", "DEF lib()\n  N = 1 ;> never\nEND\n")
    front = GOOD.replace(";@ phase", ";@ with: lib.src\n;@ phase")
    case = read_case(write("s/good.src", front), tmp_path)
    assert ["good.src", "good.dat", "lib.src"] == [one.path for one in case.sources]
    assert ("lib.src", 2) == (case.expectations[-1].file, case.expectations[-1].line)


def test_confidence_is_that_of_the_first_rule(write: Write, tmp_path: Path) -> None:
    """A case of an unconfirmed rule fails nobody, nor does one that says its reading is ours."""
    sure = read_case(write("s/sure.src", GOOD), tmp_path)
    recalled = GOOD.replace("CTL-01, CTL-02", "CTL-02, CTL-01")
    ours = GOOD.replace(";@ phase", ";@ unconfirmed: nobody tells\n;@ phase")
    assert sure.may_fail
    assert not read_case(write("s/recalled.src", recalled), tmp_path).may_fail
    assert not read_case(write("s/ours.src", ours), tmp_path).may_fail


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        ("CTL-01", "CTL-99", "no rule"),
        ("phase: run", "phase: walk", "phase"),
        (";@ title", ";@ name", "front matter"),
        (";@ title: a fact", ";@ rule: CTL-01", "twice"),
        (";> order 1", ";> oder 1", "no expectation"),
        (" ;> value N 1 ;> runs 1\n  ; a comment\n  ;> order 1", "", "expects nothing"),
        (";@ phase", ";@ with: nowhere.src\n;@ phase", "not beside it"),
        (";@ phase", ";@ with: ../good.src\n;@ phase", "not beside it"),
        (";@ phase", ";@ seconds: long\n;@ phase", "number"),
        ("N = 2 ;", 'N = "2 ;> never', "not closed"),
    ],
)
def test_what_is_wrong_is_reported_with_its_place(
    write: Write, tmp_path: Path, old: str, new: str, part: str
) -> None:
    """A case that says something unknown is none, and the reason is one line."""
    assert old in GOOD
    path = write("s/good.src", GOOD.replace(old, new))
    with pytest.raises(CaseError, match=part) as raised:
        read_case(path, tmp_path)
    assert "\n" not in str(raised.value)


def test_digest_changes_with_any_file(write: Write, tmp_path: Path) -> None:
    """A recording of a case is one of these very files."""
    path = write("s/good.src", GOOD)
    before = read_case(path, tmp_path).digest
    assert before == read_case(path, tmp_path).digest
    write("s/good.dat", "DEFDAT good\nENDDAT\n")
    assert before != read_case(path, tmp_path).digest


def test_selection_takes_suites_cases_rules_topics_and_paths(write: Write, tmp_path: Path) -> None:
    """Each kind of word selects; one that names nothing is an error."""
    write("one/good.src", GOOD)
    write("two/other.src", GOOD.replace("CTL-01, CTL-02", "TRG-04").replace("good", "other"))
    cases = find_cases(tmp_path)
    for word, names in {
        "one": ["one/good"],
        "two/other": ["two/other"],
        "CTL-02": ["one/good"],
        "trg": ["two/other"],
        "run": ["one/good", "two/other"],
        str(tmp_path / "one"): ["one/good"],
    }.items():
        assert names == [case.name for case in selected(cases, [word])], word
    with pytest.raises(CaseError, match="INT-01"):
        selected(cases, ["one", "INT-01"])


def test_own_cases_can_be_read(own_cases: list[Case]) -> None:
    """There are at least 500 of them, a quarter of them negative."""
    assert len(own_cases) >= 500
    assert sum(case.is_negative for case in own_cases) * 4 >= len(own_cases)
    assert len(own_cases) == len({case.name for case in own_cases})


def test_corners_are_countable_by_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    """Cases that state corners are selected, by kinds too, and what they expect is counted."""
    assert main(["conform", "corner:zero", "--list"]) == 0
    shown = capsys.readouterr()
    assert "data/division_by_zero " in shown.out
    assert "data/bit_edges " not in shown.out
    assert f"krl: {len(shown.out.splitlines())} cases with " in shown.err
