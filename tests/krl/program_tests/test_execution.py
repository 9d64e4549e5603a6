"""Tests of robot programs pass and fail for what programs do."""

from collections.abc import Callable
from pathlib import Path

import pytest

from krl.program_tests.execution import Outcome, run_test
from krl.program_tests.test_files import TestFileError, read_tests

Write = Callable[[str], Path]
Run = Callable[[str], dict[str, Outcome]]

#: What is so, and something near it that is not.
PAIRS = [
    ("out 1 TRUE near XPICK by 0.1", "out 1 TRUE near 545 100 701 by 0.9"),
    ("out 1 TRUE between 1 and 3", "out 1 TRUE before 1"),
    ("out 2 never", "out 1 never"),
    ("value count 2", "value count 1"),
    ("value XPICK.Y 100.0", "value XPICK.Y 101.0"),
    ("passes XPICK within 0.1", "passes 545 100 710 within 0.1"),
    ("axes 0 -90 90 0 30 0 at 0.9 within 30", "axes 0 -90 90 0 30 0 at 0.9 within 0.1"),
    ("avoids sphere 545 100 690 by 9.9", "avoids sphere 545 100 690 by 10.1"),
    ("avoids box 546 0 0 to 700 200 900", "avoids box 544 50 0 to 700 200 900"),
    ("avoids box 1 -50 -900 to 200 50 900 in 545 100 0 90 0 0", "avoids in_the_way"),
    ("speed most 0.6", "speed most 0.3"),
    ("calls measure times 1", "calls measure never"),
    ("calls measure before 9", "calls mesure never"),
    ("ends before 5", "ends before 1"),
    ("work.src:12: runs 1", "work.src:12: runs 2"),
    ("work.src:8: lasts 1.2 within 0.1", "work.src:8: lasts 1.2 within 0.001"),
    ("message 1 never", 'message "part"'),
]


def test_what_is_so_passes_and_what_is_nearly_so_fails(run: Run) -> None:
    """Each expectation is met by what happens, and not by something slightly different."""
    zone = 'zones.in_the_way = "box -5 -5 -5 to 5 5 5 in 545 100 700 0 0 0"\n'
    outcomes = run(
        zone
        + "".join(
            f"[[test]]\nname = '{name} {place}'\ncall = 'work(1)'\nexpect = ['{text}']\n"
            for place, pair in enumerate(PAIRS)
            for name, text in zip(("so", "not so"), pair, strict=True)
        )
    )
    failed = {name for name, outcome in outcomes.items() if outcome.failures}
    assert {f"not so {place}" for place in range(len(PAIRS))} == failed


def test_a_failure_says_what_was_expected_and_seen(run: Run) -> None:
    """It has the line of the test, what it expects, the time and the line of KRL."""
    text = '[[test]]\nname = "late"\ncall = "work(1)"\nexpect = ["out 1 TRUE before 0.5"]\n'
    head, expected, seen = run(text)["late"].failures
    assert head.endswith("test_work.toml:5: late")
    assert "    expected: out 1 TRUE before 0.5" == expected
    assert seen.startswith("    seen:     1.")
    assert seen.endswith(" s (work.src:9)")


def test_a_failure_names_called_routines_that_no_file_has(run: Run, tmp_path: Path) -> None:
    """A message that an option package would have shown is not looked for in vain.

    BAS is not named, as its stand-in does what it does on controllers.
    """
    text = 'DEF tell()\n  BAS(#INITMOV, 0)\n  MsgNotify("part")\nEND\n'
    (tmp_path / "tell.src").write_text(text, encoding="utf-8")
    outcomes = run("program = 'tell.src'\n[[test]]\nname = 'a'\nexpect = ['message 1']\n")
    note = "    note:     missing, so calls did nothing: MSGNOTIFY"
    assert outcomes["a"].failures[-1] == note


def test_a_fault_fails_a_test_that_does_not_expect_it(run: Run) -> None:
    """A program that stops with a fault passes only where this fault is expected."""
    outcomes = run(
        "[[test]]\nname = 'no'\ncall = 'measure(7)'\nexpect = ['out 1 never']\n"
        "[[test]]\nname = 'yes'\ncall = 'measure(7)'\nexpect = ['fault division_by_zero']\n"
        "[[test]]\nname = 'other'\ncall = 'measure(7)'\nexpect = ['fault 1422']\n"
    )
    assert ["no", "other"] == [name for name, one in outcomes.items() if one.failures]
    assert "    line:     work.src:29: RETURN (a / 0)" in outcomes["no"].failures


def test_stand_ins_replace_routines_call_by_call(run: Run) -> None:
    """The first call has the first statements, all behind the last have the last."""
    outcomes = run(
        "stand_ins.measure = [['RETURN (7.5)'], ['RETURN (a + 0.5)']]\n"
        "[[test]]\nname = 'first'\ncall = 'measure(3)'\nexpect = ['result 7.5']\n"
        "[[test]]\nname = 'in a program'\ncall = 'work(1)'\nbefore = ['count = measure(1)',"
        " 'count = measure(400)']\nexpect = ['value count 403', 'out 2 TRUE']\n"
        "[[test]]\nname = 'lines'\ncall = 'work(1)'\nbefore = '''\ncount = measure(1)\n\n"
        "count = measure(400)\n'''\nexpect = ['value count 403', 'out 2 TRUE']\n"
    )
    assert [] == [name for name, one in outcomes.items() if one.failures]


def test_what_nothing_declares_is_an_error_with_its_line(write: Write) -> None:
    """A misspelt variable, routine or input ends its own test alone, in one line."""
    path = write(
        "[[test]]\nname = 'good'\ncall = 'measure(0)'\nexpect = ['result 1.5']\n"
        "[[test]]\nname = 'a'\ncall = 'work(1)'\nset.cuont = 1\nexpect = ['out 1 TRUE']\n"
        "[[test]]\nname = 'b'\ncall = 'wrok(1)'\nexpect = ['out 1 TRUE']\n"
        "[[test]]\nname = 'c'\nio = ['t=1 IM[3]=TRUE']\ncall = 'work(1)'\nexpect = ['out 1 TRUE']\n"
    )
    tests = read_tests(path)
    said = []
    for one in tests[1:]:
        with pytest.raises(TestFileError) as error:
            run_test(one, tests, executor=None, update=False)
        said.append(str(error.value).removeprefix(f"{path}:"))
    assert "8: 'cuont' is declared nowhere" == said[0]
    assert "12: no routine is called 'wrok'" == said[1]
    assert said[2].startswith("14: ")
    assert () == run_test(tests[0], tests, executor=None, update=False).failures


def test_executors_agree(write: Write) -> None:
    """A test has the same outcome on every executor, coverage included."""
    tests = read_tests(
        write(
            "io = 'on OUT[1]=TRUE after 0.2 IN[1]=TRUE'\n[[test]]\nname = 'one'\n"
            "call = 'work(1)'\nexpect = ['value count 2', 'out 1 TRUE at 0']\n"
        )
    )
    tree, vm = (run_test(tests[0], tests, executor=name, update=False) for name in ("tree", "vm"))
    assert tree == vm
    assert 3 == len(tree.failures)


def test_coverage_counts_lines_and_branches(run: Run) -> None:
    """Loops tell whether they were entered and passed by, SWITCH its cases, IF both ways."""
    outcomes = run(
        "[[test]]\nname = 'none'\ncall = 'work(0)'\nexpect = ['out 1 TRUE']\n"
        "[[test]]\nname = 'two'\nset.count = -2\nbefore = '$FLAG[9] = TRUE'\ncall = 'work(2)'\n"
        "stand_ins.measure = 'RETURN (200)'\nexpect = ['out 2 TRUE']\n"
    )
    none, two = (outcomes[name].coverage["work.src"] for name in ("none", "two"))
    assert {"entered": 0, "zero times": 1} == none["branches"][11]
    assert {"entered": 1, "zero times": 0} == two["branches"][11]
    assert {"entered": 0, "zero times": 1} == none["branches"][14]
    assert {"TRUE": 0, "FALSE": 1} == none["branches"][17]
    assert {"TRUE": 1, "FALSE": 0} == two["branches"][17]
    assert {"CASE 1": 1, "CASE 2": 0, "no CASE": 0} == none["branches"][23]
    assert (0, 2, 1) == (none["lines"][12], two["lines"][12], none["lines"][25])
    assert {0} == {count for line, count in two["lines"].items() if line > 20}


def test_a_loop_that_is_always_entered_is_no_branch(write: Write) -> None:
    """FOR from one number up to another has one way only; down or to a variable it has two."""
    path = write("[[test]]\nname = 'x'\nexpect = ['ends']\n")
    head = "FOR i = {}\nENDFOR\n"
    path.with_name("work.src").write_text(
        f"DEF work()\nINT i\n{head.format('1 TO 2')}{head.format('2 TO 1')}END\n", encoding="utf-8"
    )
    tests = read_tests(path)
    found = run_test(tests[0], tests, executor=None, update=False).coverage["work.src"]
    assert {5: {"entered": 0, "zero times": 1}} == found["branches"]


def test_a_recording_is_compared_and_reported_as_a_diff(write: Write) -> None:
    """What differs from the recorded run stands in the failure, line by line."""
    head = "recorded = true\nio = 'on OUT[1]=TRUE after 0.2 IN[1]=TRUE'\n[[test]]\nname = 'r'\n"
    path = write(head + "call = 'work(1)'\n")
    tests = read_tests(path)
    unrecorded = run_test(tests[0], tests, executor=None, update=False).failures
    assert ("not recorded yet" in unrecorded[0], 1) == (True, len(unrecorded))
    anew = run_test(tests[0], tests, executor=None, update=True)
    assert ((), True) == (anew.failures, anew.recorded[0].endswith("lines"))
    recorded = next((path.parent / "recorded").iterdir())
    text = recorded.read_text(encoding="utf-8")
    assert ("work.src:" in text, "µ" in text) == (True, False)
    recorded.write_text(text.replace("work.src:", "work.src:1"), encoding="utf-8")
    assert () == run_test(tests[0], tests, executor=None, update=False).failures
    assert () == run_test(tests[0], tests, executor=None, update=True).recorded
    assert text == recorded.read_text(encoding="utf-8")
    path.write_text(head + "call = 'work(1)'\nset.count = 99\n", encoding="utf-8")
    tests = read_tests(path)
    outcome = run_test(tests[0], tests, executor=None, update=False)
    assert any("fault" in line and line.startswith("    +") for line in outcome.failures)
    anew = run_test(tests[0], tests, executor=None, update=True)
    assert set(anew.recorded[1:]) < set(outcome.failures)
    assert any(line.startswith("    + fault") for line in anew.recorded)


def test_without_a_call_a_routine_with_parameters_says_what_to_write(write: Write) -> None:
    """The line names the key that would mend it."""
    path = write("[[test]]\nname = 'x'\nexpect = ['ends']\n")
    path.with_name("work.src").write_text("DEF work(n:IN)\nINT n\nEND\n", encoding="utf-8")
    tests = read_tests(path)
    with pytest.raises(TestFileError, match='call = "…" says what is called'):
        run_test(tests[0], tests, executor=None, update=False)
