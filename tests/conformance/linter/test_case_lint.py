"""The linter of cases finds what makes a case less than a case; ours have nothing of it."""

from pathlib import Path

import pytest

from conformance.evaluation.verdicts import KnownFailures
from conformance.linter.case_lint import lint
from conformance.suite.case import SUITES, Case
from conformance.suite.registry import registry
from conformance.suite.rule_coverage import coverage

GOOD = ";@ rule: CTL-01\n;@ title: a fact\n;@ phase: run\nDEF good()\n  HALT ;> runs 1\nEND\n"
_SIZE = "$APO.CDIS = 1\n  "
_TRIGGER = "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $FLAG[1]=TRUE"
_BLOCK = "SPLINE ;> runs 1\n    SPL {{X 1}}\n    {}\n  ENDSPLINE"


def citing(rule: str, expected: str) -> str:
    """The good case with another rule and expectation."""
    return GOOD.replace("CTL-01", rule).replace("runs 1", expected)


def test_every_hard_rule_has_a_case(own_cases: list[Case]) -> None:
    """A rule that may fail has a case, or says why none can show it."""
    covered = coverage(own_cases)
    assert [] == [rule.id for rule in covered.uncovered]
    unshown = [rule.id for rule in registry().values() if rule.unshown]
    assert ["MSG-05", "MSG-25"] == unshown
    assert covered.count(hard=True)[0] == covered.count(hard=True)[1]


def test_every_suite_has_cases(own_cases: list[Case]) -> None:
    """None of the suites is empty, and there are no others."""
    assert set(SUITES) == {case.suite for case in own_cases}


def test_known_failures_are_about_cases(own_cases: list[Case]) -> None:
    """The list can be read."""
    names = [case.name for case in own_cases]
    assert [] == KnownFailures.load().of_no_case(names)


@pytest.mark.parametrize(
    ("name", "old", "new", "part"),
    [
        ("control/good.src", "", "", ""),
        ("control/good.src", "a fact", "a fact.", "one sentence"),
        ("control/good.src", ";@ phase", ";@ profile: kss99\n;@ phase", "the profile is"),
        ("control/good.src", ";@ phase", ";@ robot: marvin\n;@ phase", "the robot is"),
        ("control/good.src", ";@ phase", ";@ io: at noon\n;@ phase", "io:1: a line begins with"),
        ("other/good.src", "", "", "no suite 'other'"),
        ("control/Good.src", "", "", "no KRL name"),
        ("control/a_name_that_is_much_too_long.src", "", "", "no KRL name"),
        ("control/good.src", "HALT", "HALT\t", "without tabs"),
        ("control/good.src", "HALT", "HALT ; é", "ASCII"),
        ("control/good.src", "HALT", "HALT ;" + 90 * "x", "longer than 100"),
        ("control/good.src", "HALT", "HALT HALT", "not grammatical"),
        (
            "control/good.src",
            "HALT",
            "HALT\n  SPLINE\n  ENDSPLINE C_SPL",
            "good.src:7: only SPL-01.b",
        ),
        ("control/good.src", "HALT", "HALT\n  PTP {A1 0} C_PTP\n  PTP {A1 9}", "of $APO.CPTP"),
        (
            "control/good.src",
            "HALT",
            "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE PRIO=-1\n  HALT",
            "good.src:5: only TRG-13.b",
        ),
        ("control/good.src", "runs 1", "accepted", "cannot be seen in phase run"),
        ("control/good.src", "runs 1", "runs 1 ;> runs 1", "stands twice"),
        ("control/good.src", "runs 1", "line at mark NOWHERE", "nothing is marked NOWHERE"),
        ("control/good.src", "runs 1", "halted", "no expectation 'halted'"),
        ("control/good.src", "DEF", ";> never\nDEF", "beside no line"),
        ("control/good.src", "runs 1", "path line 0 0 0 to 1 1 1", "CTL-01 says nothing of"),
        (
            *("control/good.src", "HALT ;> runs 1"),
            "N = $ERR.NUMBER ;> value N 5\n  N = $ERR.NUMBER ;> value N 5",
            "line 6: line 5 has not cleared $ERR",
        ),
        (
            *("control/good.src", "HALT ;"),
            "ON_ERROR_PROCEED\n  PTP_REL {A1 500}\n  HALT ;",
            "good.src:6: only FCT-12.d allows it",
        ),
        ("control/good.src", "runs 1", "halt", "CTL-01 says nothing of"),
        ("control/good.src", "runs 1", "lasts 2", "no rule says how long"),
        ("control/good.src", "runs 1", "fault 1444", "CTL-01 does not say that 1444"),
        (
            *("control/good.src", GOOD),
            citing("CTL-01, TYP-09", "error KSS1444").replace("phase: run", "phase: check"),
            "CTL-01 does not say that 1444",
        ),
        ("control/good.src", "runs 1", "message 1444 never", ""),
        *(
            ("control/good.src", "HALT ;> runs 1", told, "CTL-01 does not say that 1444")
            for told in (
                "N = $ERR.NUMBER ;> value N 1444 [CTL-01]",
                "F.X = $ERR.NUMBER ;> value F.X 1444.0",
                "N = TOLD() ;> values N 0 1444\nEND\nDEF TOLD()\n  RETURN $ERR.NUMBER",
            )
        ),
        *(
            (f"{suite}/good.src", GOOD, citing(rule, expected), part)
            for suite, rule, expected, part in (
                ("submit", "SUB-01", "line at 1", "has no period"),
                ("submit", "SUB-01", "line before 2", "has no period"),
                ("interrupt", "INT-05", "line at in 1", "the latency of an interrupt is not known"),
                ("advance", "ADV-01", "planned at start 2", "depends on the computing power"),
                ("advance", "ADV-05", "line at end 2", "depends on the computing power"),
                ("advance", "ADV-05", "line after end 2 + 0.3", "neither values nor durations"),
                ("advance", "ADV-05", "value N 1", "neither values nor durations"),
                ("advance", "ADV-05", "line after end 2 - 0.01", ""),
                ("advance", "ADV-10", "value N 1", ""),
                ("blending", "BLD-01.a", "blends", "BLD-01.a says nothing of"),
                ("motion", "MOT-09", "pose 1 2 3", "MOT-09 says nothing of"),
                ("motion", "MOT-10", "axes 1 2 3", "MOT-10 says nothing of"),
                ("types", "TYP-09", "line at 0.5", "TYP-09 gives no time"),
            )
        ),
        (
            *("control/good.src", "HALT ;> runs 1"),
            "PTP_SPLINE ;> runs 1\n    SLIN {X 1}\n  ENDSPLINE",
            "KSS2380 refuses what a controller has to take",
        ),
        (
            *("control/good.src", "run\nDEF good()\n  HALT ;> runs 1"),
            "parse\nDEF good()\n  NOWHERE() ;> accepted",
            "KRL102 refuses what a controller has to take",
        ),
        *(
            ("control/good.src", GOOD, citing(rule, expected).replace("HALT", statement), part)
            for rule, statement, expected, part in (
                ("CTL-01", "$IN[1] = TRUE\n  HALT", "runs 1", "KSS1388 refuses what a controller"),
                ("SCO-11.a", "$IN[1] = TRUE", "fault 1388", ""),
                ("CTL-01", "$VEL.CP = 99.0", "runs 1", "KSS1422 refuses what a controller"),
                ("MOT-05.d", "$VEL.CP = 99.0", "runs 1", ""),
            )
        ),
        ("control/good.src", "HALT", "$OUT['Ha'] = TRUE", "good.src:5: only TYP-04.b allows it"),
        ("control/good.src", "  HALT", "STRUC S INT N, L[2]\n  HALT", "only TYP-08.e allows it"),
        ("control/good.src", "  HALT", "STRUC S CHAR A[2], B[3], INT N\n  HALT", ""),
        ("control/good.src", "HALT", "WORK(T[1,])\n  HALT", "good.src:5: only SCO-07.b allows it"),
        (
            *("control/good.src", "HALT ;> runs 1\nEND\n"),
            "F()\n  HALT ;> runs 1\nEND\nDEFFCT INT F()\n  RETURN 1\nENDFCT\n",
            "good.src:5: only CTL-09.b allows it",
        ),
        *(
            ("control/good.src", "HALT ;> runs 1", told, part)
            for told, part in (
                ("INTERRUPT DECL 5 WHEN F(1) DO WORK() ;> runs 1", "only INT-06.c allows it"),
                ("INTERRUPT DECL 5 WHEN NOT($IN[1]) DO good()\n  HALT ;> runs 1", ""),
                ("ABS(1)\n  HALT ;> runs 1", "good.src:5: only CTL-09.b allows it"),
                ("$TIMER[1] = ATAN2(, 1)\n  HALT ;> runs 1", "only SCO-13.d allows it"),
                ("STRUC S INT L[2] ;> never [TYP-08.e]\n  HALT ;> runs 1", "only TYP-08.e allows"),
                ('SWRITE(";", T[1,]) ;> runs 1', "only SCO-07.b allows it"),
                ("$BASE = {X 1}\n  HALT ;> runs 1", "only TYP-13.d allows it"),
                ("DECL FRAME F\n  DECL AXIS J\n  F = J ;> runs 1", "good.src:7: only TYP-21"),
                ("$BASE = {X 1, Y 2, Z 3, A 4, B 5, C 6}\n  HALT ;> runs 1", ""),
                ("SLIN {X 1} C_SPL ;> apex\n  SPTP {A1 1}", "good.src:5: only BLD-12 allows it"),
                (_SIZE + "SLIN {X 1} C_SPL ;> apex\n  WAIT SEC 0\n  SPTP {A1 1}", ""),
                (f"{_TRIGGER}\n  SLIN {{X 1}} ;> runs 1", "good.src:5: only TRG-10.e allows it"),
                (f"{_TRIGGER}\n  LIN {{X 1}} ;> runs 1", ""),
                (_BLOCK.format("CONST_VEL END=0"), "good.src:5: only SPL-07.b allows it"),
                (_BLOCK.format("CONST_VEL END=0\n  SPL {X 2}"), ""),
                ("TRIGGER WHEN PATH=0 DELAY=0 DO good() PRIO=N ;> trigger", "only TRG-13.b allows"),
                ("TRIGGER WHEN PATH=0 DELAY=0 DO good() PRIO=-1 ;> trigger", ""),
                ("LIN {X 1} C_DIS\n  LIN_REL {X 1} ;> pose 1 2 3", "good.src:6: only MOT-14.b"),
                ("LIN {X 1} C_DIS\n  LIN_REL {X 1}\n  LIN {Y 1} ;> pose 1 2 3", "only MOT-14.b"),
                (
                    _SIZE + "LIN {X 1} C_DIS\n  LIN_REL {X 1}\n  LIN {X 1, Y 2, Z 3} ;> pose 1 2 3",
                    "",
                ),
                ("LIN {X 1} C_DIS C_VEL\n  HALT ;> runs 1", "good.src:5: only BLD-06.b allows it"),
                (_SIZE + "LIN {X 1} C_DIS C_DIS\n  LIN {Y 1} ;> runs 1", ""),
                ("PTP {A1 1} C_PTP ;> blends\n  LIN {X 1}", "good.src:5: only BLD-06.b allows it"),
                ("PTP {A1 1} C_PTP C_DIS\n  LIN {X 1} ;> start", "of $APO.CPTP"),
                ("N = $ERR.NUMBER ;> value N 5", "line 5: what $ERR.NUMBER holds is FCT-12"),
                ("LIN {X 1}\n  R = $POS_ACT.X ;> value R 1.0", "good.src:6: only ADV-07.b"),
                ("LIN {X 1}\n  WAIT SEC 0\n  $TIMER[1] = $POS_ACT.X ;> value $TIMER[1] 1", ""),
            )
        ),
    ],
)
def test_faults_are_found(tmp_path: Path, name: str, old: str, new: str, part: str) -> None:
    """Each fault is told, with the case it is in; a good case has none."""
    path = tmp_path / name
    path.parent.mkdir(parents=True)
    assert old in GOOD
    path.write_text(GOOD.replace(old, new, 1), encoding="utf-8", newline="\n")
    found = lint(tmp_path)
    assert bool(part) == bool(found)
    assert part in "\n".join(found)


def test_a_time_for_a_submit_program_is_found(tmp_path: Path) -> None:
    """Its turns have no period: a program waits for what it does, not for a time."""
    folder = tmp_path / "submit"
    folder.mkdir()
    sub = "DEF HELPER()\n  LOOP\n    $OUT[1] = TRUE ;> out 1 TRUE\n  ENDLOOP\nEND\n"
    (folder / "helper.sub").write_text(sub, encoding="utf-8")
    good = citing("SUB-01", "runs 1").replace(";@ phase", ";@ with: helper.sub\n;@ phase")
    for wait, found in (("SEC 1", 1), ("SEC 0.05", 1), ("SEC 0", 0), ("FOR $OUT[1]", 0)):
        (folder / "good.src").write_text(good.replace("HALT", f"WAIT {wait}"), encoding="utf-8")
        assert found == sum("WAIT FOR what it does" in fault for fault in lint(tmp_path))


def test_files_of_no_case_and_repeated_titles_are_found(tmp_path: Path) -> None:
    """Each file belongs to a case, each fact stands once."""
    folder = tmp_path / "control"
    folder.mkdir()
    (folder / "good.src").write_text(GOOD, encoding="utf-8")
    (folder / "again.src").write_text(GOOD.replace("good", "again"), encoding="utf-8")
    (folder / "stray.src").write_text("DEF stray()\nEND\n", encoding="utf-8")
    found = "\n".join(lint(tmp_path))
    assert "control/good: another case has the same title" in found
    assert "control/stray.src: it belongs to no case" in found
