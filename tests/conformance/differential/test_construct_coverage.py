"""What programs exercise: what stands on lines that were executed, and no other."""

from conformance.differential.campaign import fuzz
from conformance.differential.construct_coverage import (
    counted,
    language,
    missing,
    needs,
    reached,
)
from conformance.differential.divergence import prepared
from conformance.differential.runs import EXECUTORS, trace_of
from conformance.suite.case import CASES, read_case


def test_programs_execute_most_of_it() -> None:
    """A few dozen programs execute nearly all kinds of statements and instructions."""
    left = missing(fuzz(60, 1, ["tree"]).counts)
    known = language()
    for kind in ("node", "variant", "operator", "instruction"):
        assert len(left.get(kind, ())) <= 0.25 * len(known[kind])


def test_counts_are_of_what_was_executed() -> None:
    """What stands on lines that were never reached does not count."""
    text = "DEF PROG()\nINT I\nI=1\nIF I==2 THEN\nWAIT SEC 1+2*I\nENDIF\nEND\n"
    program = prepared((("PROG.SRC", text),))
    found = counted(program, trace_of(program, EXECUTORS["tree"], "x"))
    assert (1, 1, 0) == (found["node", "If"], found["operator", "=="], found["node", "WaitSeconds"])
    assert (0, 0) == (found["operator", "*"], found["instruction", "MUL_INT"])


def test_a_rule_needs_what_all_its_cases_use() -> None:
    """The timer and its flag are needed by both; what one of them does besides is not."""
    cases = [read_case(CASES / f"io/{name}.src") for name in ("timer_flag", "timer_counts_down")]
    (needed,) = needs(cases).values()
    (alone,) = needs(cases[1:]).values()
    assert {"$TIMER", "$TIMER_STOP", "$TIMER_FLAG"} == {
        name for kind, name in needed if kind == "variable"
    }
    assert ("node", "WaitSeconds") in alone - needed


def test_a_rule_is_reached_by_all_that_it_needs() -> None:
    """Neither by a part of it, nor by what stands on lines that were not executed."""
    rules = {"A-01": frozenset({("node", "Halt"), ("operator", "+")}), "A-02": frozenset()}
    text = "DEF PROG()\nINT I\nI=1+1\n{}IF I==1 THEN\nHALT\nENDIF\nEND\n"
    found = []
    for more in ("", "HALT\n"):
        program = prepared((("PROG.SRC", text.format(more)),))
        counts = counted(program, trace_of(program, EXECUTORS["tree"], "x"))
        found.append(list(reached(rules, counts)))
    assert [["A-02"], ["A-01", "A-02"]] == found


def test_a_case_reaches_its_own_rule() -> None:
    """Run like a generated program it executes all that the rule needs of it."""
    case = read_case(CASES / "control/while_tests_first.src")
    rules = needs([case])
    program = prepared(tuple((one.path, one.text) for one in case.sources))
    counts = counted(program, trace_of(program, EXECUTORS["tree"], "x"))
    needed = rules["CTL-01"] - {("operator", "+")}  # on a line that is never executed
    assert ["CTL-01"] == list(reached({"CTL-01": needed}, counts))
