"""What a machine relies on is made sure of: each rule refuses the program that breaks it."""

from __future__ import annotations

from array import array
from dataclasses import replace

import pytest

from grammar.semantics.types import Array, Structure
from grammar.syntax.source import Source
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.compiler.project import compile_program
from interp.bytecode.instruction_set.table import MAX_CELLS
from interp.bytecode.program import Program
from interp.bytecode.verifier.operand_stack import Flow
from interp.bytecode.verifier.verify import VerificationError, verify
from interp.program.load import load

HEAD = """\
bytecode 4
enum E ONE TWO
enum F ONE TWO
struct S A:INT B:REAL[3]
struct FRAME X:REAL Y:REAL Z:REAL A:REAL B:REAL C:REAL
text T "abc"
builtin SINE SIN in:REAL -> REAL
ask IN Read ("$IN" in:INT) -> BOOL
ask TOOL Read ("$TOOL") -> FRAME
ask OUT Write ("$OUT" 1) in:BOOL
ask TRIGGER SetTrigger "DISTANCE" 0.0 FALSE 0.0 &ACT nil nil
data M.X INT
data M.R REAL
data M.A INT[2,3]
data M.V S
"""
REST = """
code MAIN routine "m.src" 1
  local I INT
  local Q REAL
  local B BOOL
  local C CHAR
  local N E
  local V S
  local A INT[4]
  local T CHAR[4]
begin
{body}
END:
  RETURN
end
code SUB routine "m.src" 9
  in I INT
  ref R REAL
  view L INT[]
  in V S
  result INT
begin
  LINE 9 E
  LOAD_LOCAL I
  RETURN_VALUE
E:
  FAIL no_result
end
code ACT action of MAIN "m.src" 1
  ref I INT from 0
begin
{action}
  RETURN
end
code WHEN condition of MAIN "m.src" 1
  ref I INT from 0
  result BOOL
begin
{condition}
end
"""


def program(body: str = "", action: str = "", condition: str = "", head: str = HEAD) -> Program:
    condition = condition or "  PUSH_BOOL TRUE\n  RETURN_VALUE"
    return assemble(head + REST.format(body=body, action=action, condition=condition))


def refused(of: Program, message: str) -> None:
    with pytest.raises(VerificationError, match=message) as caught:
        verify(of)
    assert "\n" not in str(caught.value)


def test_good_program_is_verified() -> None:
    """The frame that the bad programs are put into is good itself."""
    verify(program())


def test_everything_is_verified(everything: str) -> None:
    """A program with something of everything is valid, and its stacks are known everywhere."""
    depths = array("i", verify(assemble(everything)).depths)
    assert 6 == max(depths)
    assert -1 not in depths


_BODIES = [
    ("ADD_INT", "the stack is empty"),
    ("PUSH_INT 1\nADD_INT", "the stack is empty"),
    ("PUSH_INT 1\nPUSH_REAL 1.0\nADD_INT", "an operand has the wrong type"),
    ("PUSH_INT 1\nSTORE_LOCAL Q", "an operand has the wrong type"),
    ("PUSH_INT 1\nSTORE_DATA M.R", "an operand has the wrong type"),
    ("PUSH_INT 1\nRETURN", "the stack must be empty here"),
    ("DROP", "stack is empty"),
    ("PUSH_NOTHING\nDROP", "a value is required"),
    ("PUSH_NOTHING\nSTORE_LOCAL I", "an operand has the wrong type"),
    ("PASS_LOCAL I\nSTORE_LOCAL I", "an operand has the wrong type"),
    ("PUSH_BOOL TRUE\nJUMP_IF L\nPUSH_INT 1\nL:\nDROP", "paths meet with different stacks"),
    ("LINE 2 L\nPUSH_INT 1\nL:\nDROP", "paths meet with different stacks"),
    ("PUSH_INT 1\nLINE 2 END\nDROP", "the stack must be empty here"),
    ("PUSH_REAL real:7f800000\nDROP", "is not a real"),
    ("PUSH_REAL real:7fc00000\nDROP", "is not a real"),
    ("PUSH_CHAR 256\nDROP", "is not a char"),
    ("PUSH_BOOL 2\nDROP", "is not a bool"),
    ("PUSH_ENUM E #2\nDROP", "no such constant"),
    ("PUSH_ENUM INT #0\nDROP", "no such constant"),
    ("PUSH_ENUM E ONE\nPUSH_ENUM F ONE\nEQ_ENUM\nDROP", "an operand has the wrong type"),
    ("PUSH_INT 1\nPUSH_INT 1\nEQ_ENUM\nDROP", "a constant of an enumeration is required"),
    ("PUSH_REAL 1.0\nCASE 1 END\nDROP", "an INT, a CHAR or a constant of an enumeration"),
    ("PUSH_BOOL TRUE\nCASE 1 END\nDROP", "an INT, a CHAR or a constant of an enumeration"),
    ("PUSH_ENUM E ONE\nCASE 2 END\nDROP", "2 is not a value of E"),
    ("LOAD_LOCAL 99\nDROP", "is not a local"),
    ("LOAD_DATA 99\nDROP", "is not a data"),
    ("REF_LOCAL V.B INT\nDROP", "no part of this type begins here: INT"),
    ("REF_LOCAL V.B S\nDROP", "no part of this type begins here: S"),
    ("REF_DATA M.A[2,1] S\nDROP", "no part of this type begins here: S"),
    ("REF_LOCAL I #99\nDROP", "is not a type"),
    ("LOAD_REF I\nDROP", "no parameter begins at this cell"),
    ("PUSH_INT 1\nLOAD\nDROP", "a reference to a single cell is required"),
    ("REF_LOCAL V S\nLOAD\nDROP", "a reference to a single cell is required"),
    ("REF_LOCAL Q REAL\nPUSH_INT 1\nSTORE", "have different types"),
    ("REF_LOCAL V S\nMEMBER 1 INT\nLOAD\nDROP", "no part of this type begins here: INT"),
    ("REF_LOCAL V S\nMEMBER 99 INT\nLOAD\nDROP", "no part of this type begins here: INT"),
    ("PUSH_INT 1\nMEMBER 1 INT\nLOAD\nDROP", "a reference is required"),
    ("REF_LOCAL I INT\nPUSH_INT 1\nINDEX INT[4]\nLOAD\nDROP", "an operand has the wrong type"),
    ("REF_LOCAL I INT\nPUSH_INT 1\nINDEX INT\nLOAD\nDROP", "an array is required: INT"),
    ("PUSH_INT 1\nINDEX_LOCAL A INT[5]\nLOAD\nDROP", r"begins here: INT\[5\]"),
    ("PUSH_INT 1\nINDEX_DATA M.A INT[2,3]\nLOAD\nDROP", "the stack is empty"),
    ("PUSH_INT 1\nELEMENT_LOCAL A INT[3]\nDROP", r"begins here: INT\[3\]"),
    ("REF_LOCAL A INT[4]\nPUSH_INT 1\nROW INT[4] 1\nSET_TEXT T", "not all of them"),
    ("REF_DATA M.A INT[2,3]\nROW INT[2,3] 0\nSET_TEXT T", "at least one index"),
    ("REF_LOCAL A INT[4]\nVIEW INT[4]\nSET_TEXT T", "an operand has the wrong type"),
    ("REF_LOCAL T CHAR[4]\nSET_TEXT T", "an operand has the wrong type"),
    ("REF_LOCAL T CHAR[4]\nVIEW CHAR[4]\nSET_TEXT #7", "is not a text"),
    ("REF_LOCAL V S\nREF_LOCAL I INT\nCOPY S", "an operand has the wrong type"),
    ("REF_LOCAL V S\nREF_LOCAL V S\nFILL_POSE S S", "the same family"),
    ("REF_LOCAL V S\nREF_LOCAL V S\nREF_LOCAL V S\nCOMPOSE S S", "Cartesian positions"),
    ("FOR_LOCAL I I 0 END", "the step must not be 0"),
    ("FOR_LOCAL Q I 1 END", "counter and limit must be INT"),
    ("FOR_LOCAL I Q 1 END", "counter and limit must be INT"),
    ("FOR_DATA M.R I 1 END", "counter and limit must be INT"),
    ("FAIL #99", "is not a fault"),
    ("LINE 0 END", "is not a line"),
    ("LINE 2 END\nCALL SUB\nDROP", "stack is empty"),
    ("LINE 2 END\nCALL ACT", "only a routine can be called: ACT"),
    ("CALL MAIN", "a LINE is required before a call or a request"),
    ("PUSH_INT 1\nASK IN\nDROP", "a LINE is required before a call or a request"),
    ("LINE 2 END\nPUSH_REAL 1.0\nASK IN\nDROP", "an input has the wrong type"),
    ("LINE 2 END\nASK TOOL", "the stack is empty"),
    ("LINE 2 END\nREF_LOCAL V S\nASK TOOL", "an operand has the wrong type"),
    ("PUSH_INT 1\nBUILTIN SINE\nDROP", "an input has the wrong type"),
    ("PUSH_INT 1\nRETURN_VALUE", "the code object has no result"),
    ("L:\nJUMP L", "a cycle without a LINE or an ASK"),
    ("L:\nPUSH_BOOL TRUE\nJUMP_IF L", "a cycle without a LINE or an ASK"),
    ("L:\nFOR_LOCAL I I 1 L", "a cycle without a LINE or an ASK"),
    ("TELL_REF I INT 0", "no parameter :OUT"),
    ("PUSH_NO_VIEW CHAR 1\nSET_TEXT T", "an operand has the wrong type"),
    ("PUSH_NO_VIEW INT[4] 1\nCALL SUB", "the elements of an array cannot be arrays"),
    ("PUSH_NO_VIEW INT 4\nCALL SUB", "an array has 1 to 3 dimensions"),
    ("PASS_VIEW I\nCALL SUB", "no parameter begins at this cell"),
    ("REF_LOCAL T CHAR[4]\nVIEW CHAR[4]\nCOPY_VIEW T CHAR[5]\nSET_TEXT T", "begins here"),
    ("PUSH_NO_VIEW CHAR 1\nCOPY_VIEW T CHAR[4]\nSET_TEXT T", "an operand has the wrong type"),
    ("UNLINKED #5", "is not a text"),
    ("TELL_LOCAL I REAL", "no part of this type begins here: REAL"),
    ("TELL INT 4", "an array has 1 to 3 dimensions"),
]


@pytest.mark.parametrize(("body", "message"), _BODIES)
def test_body_is_refused(body: str, message: str) -> None:
    """Operands, kinds on the stack, places, and ways through a routine are checked."""
    refused(program(body), message)


def test_arguments_are_of_the_kinds_of_parameters() -> None:
    """A value for a value, a reference for a structure, a view for an array without sizes."""
    good = [
        "PUSH_INT 1",
        "REF_LOCAL Q REAL",
        "REF_LOCAL A INT[4]\nVIEW INT[4]",
        "REF_LOCAL V S",
    ]
    call = "\nCALL SUB\nDROP"
    verify(program("LINE 2 END\n" + "\n".join(good) + call))
    verify(program("LINE 2 END\n" + "\n".join(["PUSH_NOTHING", *good[1:]]) + call))
    for place, bad in enumerate(["REF_LOCAL I INT", "PUSH_REAL 1.0", good[3], "PUSH_NOTHING"]):
        arguments = [*good[:place], bad, *good[place + 1 :]]
        refused(
            program("LINE 2 END\n" + "\n".join(arguments) + call), "an argument has the wrong type"
        )


@pytest.mark.parametrize(
    ("condition", "message"),
    [
        ("LINE 2 E\nE:\nPUSH_BOOL TRUE\nRETURN_VALUE", "cannot change anything"),
        ("AT 2 E\nE:\nPUSH_BOOL TRUE\nRETURN_VALUE", "cannot change anything"),
        ("LOAD_REF I\nPUSH_INT 1\nSTORE\nPUSH_BOOL TRUE\nRETURN_VALUE", "cannot change anything"),
        ("PUSH_INT 1\nRETURN_VALUE", "an operand has the wrong type"),
        ("RETURN", "the code object must return a result"),
        ("L:\nPUSH_BOOL TRUE\nJUMP_IF L\nPUSH_BOOL TRUE\nRETURN_VALUE", "can only jump forwards"),
    ],
)
def test_condition_is_refused(condition: str, message: str) -> None:
    """A condition gives a BOOL, ends, and changes nothing."""
    refused(program(condition=condition), message)


def test_handed_over_are_actions_of_the_same_code_object() -> None:
    """An action uses the variables of its owner's frame, so only its owner hands it over."""
    verify(program("LINE 2 END\nASK TRIGGER"))
    refused(program(action="LINE 2 E\nASK TRIGGER\nE:"), "belongs to another code object")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("from 0\nbegin", "from 1\nbegin", "the owner has no I there"),
        ("from 0\nbegin", "from 99\nbegin", "the owner has no I there"),
        ("from 0\nbegin", "\nbegin", "each parameter must capture a variable"),
        ("action of MAIN", "action of WHEN", "the owner must be a routine"),
        ("action of MAIN", "action", "there is no owner"),
        ("action of MAIN", "routine of MAIN", "cannot have an owner"),
        ("condition of MAIN", "action of MAIN", "an action cannot have a result"),
        ("result BOOL", "result INT", "the result of a condition must be BOOL"),
        ("  result INT", "  result S", "a result must have one cell"),
        ("view L INT[]", "view L INT[,,,]", "1 to 3 dimensions"),
        ("-> BOOL", "-> #99", "no such type"),
        ("-> BOOL", "", "only Read and Invoke have results"),
        ('("$IN" in:INT)', '("$IN" in:REAL)', "field 1 is not of the kind path"),
        ('("$IN" in:INT)', '(in:INT "$IN")', "field 1 is not of the kind path"),
        ('("$IN" in:INT)', '"$IN"', "field 1 is not of the kind path"),
        ('Read ("$IN"', 'Nothing ("$IN"', "is not a request"),
        ('("$OUT" 1) in:BOOL', '("$OUT" 1)', "2 fields are required"),
        ('("$OUT" 1) in:BOOL', '("$OUT" 1) in:S', "by reference"),
        ('("$OUT" 1) in:BOOL', '("$OUT" 1) ref:BOOL=', "cannot change this argument"),
        ('Write ("$OUT" 1) in:BOOL', 'Invoke "F" (in:BOOL=)', "cannot change this argument"),
        (
            'Write ("$OUT" 1) in:BOOL',
            'Invoke "F" (ref:BOOL=(1))',
            "field 2 is not of the kind arguments",
        ),
        ('("$OUT" 1) in:BOOL', '("$OUT" 1) !E.#5', "no such constant"),
        ('("$OUT" 1) in:BOOL', '("$OUT" 1) real:7f800000', "is not a REAL"),
        ("FALSE 0.0 &ACT", "FALSE 0.0 &WHEN", "field 5 is not of the kind action"),
        ("SIN in:REAL -> REAL", "SIN in:INT -> INT", "its result is REAL"),
        ("SIN in:REAL -> REAL", "SIN in:BOOL -> REAL", "argument 1 is not a REAL"),
        ("SIN in:REAL -> REAL", "SIN -> REAL", "it has 1 arguments"),
        ("SIN in:REAL -> REAL", "SIN ref:REAL= -> REAL", "argument 1 cannot"),
        ("SIN in:REAL -> REAL", "PULSE in:REAL -> REAL", "no such function"),
        ("SIN in:REAL -> REAL", "STRLEN view:INT[] -> INT", "argument 1 is not a CHAR"),
        ("data M.X INT", "data M.X INT[1048000]\ndata M.Y INT[1048000]", "more than 1,048,576"),
        ("data M.R REAL", "data M.R REAL = real:7fc00000", "is not a REAL"),
        ("data M.X INT", "data M.X BOOL = 2", "is not a BOOL"),
        ("data M.X INT", "data M.X E = 2", "is not a E"),
        ('text T "abc"', 'text T "€"', "letters that no CHAR holds"),
    ],
)
def test_tables_are_refused(old: str, new: str, message: str) -> None:
    """Heads of code objects, requests, functions, texts and data are checked."""
    text = HEAD + REST.format(body="", action="", condition="  PUSH_BOOL TRUE\n  RETURN_VALUE")
    assert text != text.replace(old, new)
    refused(assemble(text.replace(old, new)), message)


def test_code_objects_end() -> None:
    """No way leads behind the last instruction."""
    good = program("LINE 2 END")
    cut = replace(good.codes[0], instructions=good.codes[0].instructions[:-1])
    refused(replace(good, codes=(cut, *good.codes[1:])), "is not a target|ends without RETURN")
    empty = replace(good.codes[0], instructions=())
    refused(replace(good, codes=(empty, *good.codes[1:])), "no instructions")


def test_stack_is_what_was_worked_out() -> None:
    """A stack that is too small would overflow, and a larger one is no canonical image."""
    good = program("PUSH_INT 1\nDROP")
    for stack in (0, 2, -1):
        bad = replace(good.codes[0], stack=stack)
        refused(replace(good, codes=(bad, *good.codes[1:])), "the stack needs 1 cells")


def test_types_are_made_of_types_before_them() -> None:
    """Types are numbered, distinct, and each is made of those before it."""
    good = program()
    refused(replace(good, types=good.types[1:]), "four scalar types")
    refused(replace(good, types=(*good.types, good.types[6])), "defined twice")
    strange = Structure("STRANGE", good.types[7].members)  # type: ignore[union-attr]
    verify(replace(good, types=(*good.types, strange)))
    far = Array(Structure("FAR", strange.members), (2,))
    refused(replace(good, types=(*good.types, far)), "types that are not defined before it")
    refused(replace(good, types=(*good.types, Array(far.element, (None,)))), "not defined before")
    refused(replace(good, types=(*good.types, Structure("NONE", ()))), "no variable can be of")
    twice = Structure("STRANGE", (*strange.members, strange.members[0]))
    refused(replace(good, types=(*good.types, twice)), "no variable can be of")
    refused(replace(good, types=(*good.types, Array(good.types[0], (-1,)))), "no variable can")


def test_huge_arrays_are_refused() -> None:
    """No type, no frame and no data list has more than the largest number of cells."""
    good = program()
    huge = Array(good.types[0], (MAX_CELLS, 2))
    refused(replace(good, types=(*good.types, huge)), "more than 1,048,576")
    text = HEAD + REST.format(body="", action="", condition="  PUSH_BOOL TRUE\n  RETURN_VALUE")
    large = text.replace("local A INT[4]", "local A INT[1048570]")
    refused(assemble(large), "data lists and a frame")


def test_stacks_that_hold_the_same_are_one() -> None:
    """What lies on the stack in a chain of a hundred operators is an object for each operand."""
    text = "DEF MAIN()\nDECL FRAME X\nX=X" + ":X" * 100 + "\nX=X" + ":X" * 100 + "\nEND\n"
    program = compile_program(load([Source(text, "main.src")], "main.src")).program
    stacks = Flow(program, program.codes[0]).stacks()
    assert 101 < max(one.cells for one in stacks if one is not None)
    assert len({id(one) for one in stacks}) < 120
