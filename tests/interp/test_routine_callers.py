"""Routines that call those with parameters, and variables of which no type is known."""

from grammar.semantics.predefined import System
from grammar.semantics.types import INT, UNKNOWN, Array, Enumeration, Member, Structure
from grammar.syntax.source import Source
from grammar.syntax.unparse import unparse
from grammar.syntax.walk import walk
from interp.program.load import load
from interp.program.routine_callers import with_caller, with_callers
from interp.program.variables import cells, is_complete, is_referable


def test_callers_give_every_parameter_a_value() -> None:
    """A routine with parameters is called with a variable of each type, filled in every part."""
    text = (
        "DEF main()\nEND\nDEFFCT CHAR[8] f(A[]:OUT,P:IN,S[]:IN,M:IN,B:IN)\nINT A[]\n"
        "FRAME P\nCHAR S[]\nDECL CIRC_TYPE M\nBOOL B\nRETURN S[]\nENDFCT\n"
    )
    program = load([Source(text, "main.src")], "main.src")
    made = with_callers(program)
    assert {"KRL_CALLS_1": "f"} == made.called
    assert made.source.text.startswith(text)
    added = made.source.text[len(text) :].split("\n")
    assert ["DECL INT P1[8]", "DECL FRAME P2", "DECL CHAR P3[8]"] == added[2:5]
    given = {"P1[8]=1", "P2.C=1.0", 'P3[]="A"', "P4=#BASE", "P5=TRUE"}
    assert given <= set(added)
    assert "R[]=f(P1[],P2,P3[],P4,P5)" in added
    load([made.source], "main.src")  # it checks without an error


def test_a_program_begins_with_arguments_that_stand_in() -> None:
    """A routine with parameters gets constants of calls or of its SWITCH, and places for points."""
    text = (
        "DEF job(N:IN,SIDE:IN,P:IN,F:IN)\nINT N,SIDE\nE6POS P\nBOOL F\nSWITCH SIDE\nCASE 4\n"
        "ENDSWITCH\nEND\n"
    )
    other = "DEF other()\nINT I\njob(I,I)\njob(-I,I,,FALSE)\njob(7,I,,TRUE)\nEND\n"
    sources = [Source(text, "job.src"), Source(other, "other.src")]
    program = with_caller(load(sources, "job.src", strict=False, stands_in=True))
    start, syntax = program.start(), program.main.module.syntax
    assert syntax is not None
    written = unparse(syntax).split("\n")
    assert {"P1 = 7", "P2 = 4", "P4 = FALSE"} <= {line.strip() for line in written}
    assert any("P3 = {X " in line for line in written)
    assert "KRL_CALLS_0" == start.name
    assert text == program.main.source.text
    assert {1} == {start.unit.line(one) for one in walk(start.node)}
    assert ["N", "SIDE", "P", "F"] == [
        one.name for one in program.stand_ins if one.origin == "argument"
    ]


def test_a_caller_has_a_name_of_its_own() -> None:
    """A routine of the file may have the name that a caller would get."""
    text = "DEF KRL_CALLS_0(N:IN)\nINT N\nEND\n"
    program = with_caller(load([Source(text, "main.src")], "main.src", strict=False))
    assert "KRL_CALLS_1" == program.start().name


def test_what_cannot_be_called_is_reported() -> None:
    """A parameter of no known type is no parameter that can be given a value."""
    text = "DEF main()\nEND\nDEF f(S:OUT)\nDECL Strange S\nEND\n"
    program = load([Source(text, "main.src")], "main.src", strict=False)
    made = with_callers(program)
    assert {} == made.called
    assert program.main.source is made.source


def test_complete_types() -> None:
    """A variable can be of a type whose parts and sizes are all known."""
    frame = System.load().types["FRAME"]
    for type_, expected in (
        (INT, True),
        (frame, True),
        (UNKNOWN, False),
        (Array(INT, (None,)), False),
        (Array(INT, (2, 3)), True),
        (Array(INT, (1, 1, 1, 1)), False),
        (Enumeration("E", ()), False),
        (Enumeration("E", ("A", "a")), False),
        (Structure("S", (Member("A", UNKNOWN),)), False),
    ):
        assert expected is is_complete(type_)
    assert (1, 6, 12) == (cells(UNKNOWN), cells(frame), cells(Array(frame, (2,))))


def test_references_have_one_type() -> None:
    """A variable passed :OUT has the type of the parameter; sizes of arrays may differ [ARI-04]."""
    assert is_referable(Array(INT, (None,)), Array(INT, (3,)))
    assert not is_referable(Array(INT, (None,)), Array(INT, (3, 3)))
    assert not is_referable(INT, System.load().types["FRAME"])
