"""What programs exercise: what stands on lines that were executed, and no other."""

from conformance.differential.campaign import fuzz
from conformance.differential.construct_coverage import counted, language, missing
from conformance.differential.divergence import prepared
from conformance.differential.runs import EXECUTORS, trace_of


def test_programs_execute_most_of_it() -> None:
    """A few dozen programs execute nearly all kinds of statements and instructions."""
    left = missing(fuzz(80, 1, ["tree"]).counts)
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
