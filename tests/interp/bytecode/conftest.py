"""Programs in assembler, and a way to run them against a world that answers from a list."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.native import AVAILABLE
from interp.port.events import Recorder
from interp.port.requests import Crash, End, Fail, Request
from interp.program.load import Limits

#: A program with something of everything, valid and not meant to make sense.
EVERYTHING = """\
bytecode 4
enum COLOUR RED GREEN BLUE
enum VAR_STATE DECLARED INITIALIZED UNKNOWN
struct POINT X:REAL Y:REAL C:COLOUR N:CHAR[8]
struct FRAME X:REAL Y:REAL Z:REAL A:REAL B:REAL C:REAL
struct POS X:REAL Y:REAL Z:REAL A:REAL B:REAL C:REAL S:INT T:INT
text HELLO "hello"
builtin SINE SIN in:REAL -> REAL
builtin ANGLE ATAN2 in:REAL 1.0 -> REAL
builtin ADDED STRADD view:CHAR[]= "ab" -> INT
builtin LENGTH STRLEN view:CHAR[] -> INT
builtin READ_INT STRTOINT "12" ref:INT= -> BOOL
builtin STATE VARSTATE "I" -> VAR_STATE
ask IN Read ("$IN" in:INT) -> BOOL
ask TOOL Read ("$TOOL") -> FRAME
ask OUT Write ("$OUT" 3) in:BOOL
ask OUT_TOOL Write ("$TOOL") ref:FRAME
ask PULSE Invoke "PULSE" (in:BOOL nil 0.5)
ask DO_IT Invoke "INVERSE" (ref:POS ref:INT= !COLOUR.RED) -> POS
ask SECONDS Wait in:REAL
ask POLL Poll TRUE
ask GO Move "LIN" ref:POS nil nil ((("$VEL" "CP") in:REAL)) ("C_DIS") nil
ask TRIGGER SetTrigger "DISTANCE" 0.0 FALSE 0.0 &ACT (("$OUT" 1) TRUE) 5
ask INTERRUPT DeclareInterrupt 3 FALSE &WHEN &ACT
ask SIGNAL Invoke "ERR_RAISE" (ref:FRAME=("$TOOLS" in:INT "F") view:CHAR[]=@0)
ask SPLINE MoveSpline "SPLINE" () \
  ({Move +9 "SPL" ref:POS nil nil () () nil} \
   {SplineRange "CONST_VEL" "START" 1.0 TRUE} {SplineStop 3.0 FALSE &WHEN}) FALSE
global MAIN.COUNT INT = 5
data MAIN.P POINT = 1.5 @2 !GREEN "ab"
data MAIN.A INT[2,3] = @2 7
data MAIN.PS POINT[3]
data MAIN.T CHAR[8] = "text"
import OTHER.TEXT MAIN.T
import OTHER.PART.AMOUNT MAIN.COUNT

code MAIN routine "main.src" 1
  local I INT
  local Q POINT
  local F FRAME
  local R POS
  local B BOOL
  local L INT[4]
  local V VAR_STATE
  local %1 INT
begin
  LINE 3 L2
  PUSH_INT 1
  STORE_LOCAL I
  TELL_LOCAL I INT
L2:
  LINE 4 L3
  LOAD_LOCAL I
  PUSH_INT 3
  INDEX_DATA MAIN.A INT[2,3]
  LOAD
  STORE_DATA MAIN.COUNT
  TELL_DATA MAIN.COUNT INT
L3:
  LINE 5 L4
  REF_LOCAL Q.X REAL
  PUSH_REAL 0.1
  BUILTIN SINE
  STORE
  TELL REAL 0
  REF_DATA MAIN.PS POINT[3]
  LOAD_LOCAL I
  INDEX POINT[3]
  MEMBER 1 REAL
  LOAD_LOCAL Q.X
  BUILTIN ANGLE
  STORE
  TELL REAL 0
L4:
  LINE 6 L5
  LOAD_LOCAL I
  ASK IN
  STORE_LOCAL B
  REF_LOCAL F FRAME
  ASK TOOL
  PUSH_BOOL TRUE
  ASK OUT
  REF_LOCAL F FRAME
  ASK OUT_TOOL
  LOAD_LOCAL B
  ASK PULSE
  REF_LOCAL R POS
  REF_LOCAL I INT
  REF_LOCAL R POS
  ASK DO_IT
  LOAD_LOCAL I
  REF_LOCAL F FRAME
  REF_DATA MAIN.T CHAR[8]
  VIEW CHAR[8]
  ASK SIGNAL
L5:
  LINE 7 L6
  REF_LOCAL R POS
  REF_LOCAL F FRAME
  FILL_POSE POS FRAME
  REF_LOCAL R POS
  REF_LOCAL F FRAME
  REF_LOCAL R POS
  COMPOSE FRAME POS
  REF_LOCAL R POS
  PUSH_REAL -0.5
  ASK GO
  ASK TRIGGER
  ASK INTERRUPT
  AT 8 L6
  REF_LOCAL R POS
  ASK SPLINE
L6:
  LINE 8 L7
  REF_DATA MAIN.T CHAR[8]
  VIEW CHAR[8]
  SET_TEXT HELLO
  TELL CHAR 1
  REF_DATA MAIN.T CHAR[8]
  VIEW CHAR[8]
  BUILTIN ADDED
  DROP
  REF_DATA MAIN.T CHAR[8]
  VIEW CHAR[8]
  BUILTIN LENGTH
  STORE_LOCAL I
  REF_LOCAL I INT
  BUILTIN READ_INT
  DROP
  BUILTIN STATE
  STORE_LOCAL V
L7:
  LINE 9 L8
  PUSH_INT 1
  STORE_LOCAL I
  PUSH_INT 4
  STORE_LOCAL %1
L7A:
  LINE 10 L7B
  LOAD_LOCAL I
  INDEX_LOCAL L INT[4]
  LOAD_LOCAL I
  INT_TO_REAL
  PUSH_REAL 1.5
  MUL_REAL
  REAL_TO_INT
  STORE
  LOAD_LOCAL I
  ELEMENT_LOCAL L INT[4]
  PUSH_INT 3
  UNLESS_LT_INT L7C
  TELL_BRANCH 1
  JUMP L7B
L7C:
  TELL_BRANCH 0
L7B:
  LINE 9 L8
  FOR_LOCAL I %1 1 L7A
L8:
  LINE 11 L9
  PUSH_ENUM COLOUR RED
  STORE_LOCAL Q.C
  REF_LOCAL Q POINT
  REF_LOCAL I INT
  LOAD_LOCAL B
  REF_LOCAL L INT[4]
  VIEW INT[4]
  PUSH_ENUM COLOUR BLUE
  CALL SUB
  STORE_LOCAL I
L9:
  PROCEED
  LINE 12 L10
  PUSH_INT 9
  ELEMENT_LOCAL L INT[4]
  DROP
L10:
  LINE 13 L11
  LOAD_LOCAL I
  CASE 1 L10A
  CASE 2 L10B
  DROP
L10A:
  REF_LOCAL Q POINT
  CLEAR POINT
  REF_DATA MAIN.P POINT
  REF_LOCAL Q POINT
  COPY POINT
  TELL POINT 0
  JUMP L11
L10B:
  PUSH_INT 2
  CASE 2 L10C
  DROP
  FAIL domain
L10C:
  UNLINKED HELLO
L11:
  LINE 14 END
  PUSH_CHAR "a"
  CHAR_TO_INT
  ADD_CONSTANT 1
  INT_TO_CHAR
  STORE_DATA MAIN.T[1]
  PUSH_INT 6
  PUSH_INT 5
  AND_BITS
  NOT_BITS
  NEG_INT
  PUSH_INT 2
  DIV_INT
  STORE_LOCAL I
END:
  RETURN
end

code SUB routine "main.src" 20
  in Q POINT
  ref OUT INT
  in B BOOL
  view L INT[]
  in C COLOUR
  local I INT
  local ROOM INT[6]
  result INT
begin
  LINE 21 L2
  LOAD_REF OUT
  PUSH_INT 2
  INDEX_VIEW L
  LOAD
  STORE
  TELL_REF OUT INT 0
L2:
  LINE 22 L3
  PUSH_INT 2
  INDEX_VIEW L
  PUSH_INT 7
  STORE
  TELL_REF L INT 0
L3:
  LINE 23 L4
  LOAD_LOCAL C
  LOAD_LOCAL Q.C
  EQ_ENUM
  JUMP_IF L4
  LOAD_VIEW L
  LOAD_VIEW L
  FILL_ARRAY INT 1
  TELL_REF L INT 1
L4:
  LINE 24 L5
  PUSH_INT 1
  REF_DATA MAIN.A INT[2,3]
  PUSH_INT 2
  ROW INT[2,3] 1
  CALL ROW_OF
  PUSH_NO_VIEW INT 1
  CALL ROW_OF
  PASS_VIEW L
  CALL ROW_OF
  LOAD_VIEW L
  COPY_VIEW ROOM INT[6]
  CALL ROW_OF
  RETURN_VALUE
L5:
  FAIL no_result
end

code ROW_OF routine "main.src" 30
  in N INT
  view R INT[]
  result INT
begin
  LINE 31 L1
  LOAD_LOCAL N
  RETURN_VALUE
L1:
  FAIL no_result
end

code ACT action of MAIN "main.src" 7
  ref I INT from 0
begin
  LINE 7 E
  LOAD_REF I
  LOAD_REF I
  LOAD
  ADD_CONSTANT 1
  STORE
E:
  RETURN
end

code WHEN condition of MAIN "main.src" 7
  ref I INT from 0
  result BOOL
begin
  LOAD_REF I
  LOAD
  ASK IN
  LOAD_REF I
  LOAD
  PUSH_INT 3
  GT_INT
  AND_BOOL
  RETURN_VALUE
end
"""


Starter = Callable[..., Machine]


def _native() -> type[Machine]:
    if not AVAILABLE:
        pytest.skip("the machine in C was not built")
    from interp.native.machine import Machine as InC

    return InC


@pytest.fixture(params=["python", "c"])
def start(request: pytest.FixtureRequest) -> Starter:
    """Makes a machine, in Python or in C, that is to run the routine MAIN of a text."""
    kind = Machine if request.param == "python" else _native()

    def starter(text: str, **options: Any) -> Machine:
        sizes = {key: options.pop(key) for key in list(options) if key in Limits.__slots__}
        return kind(verify(assemble(text)), "MAIN", Limits(**sizes), **options)

    return starter


def requests_of(running: Machine, replies: Sequence[Any] = ()) -> list[Request]:
    """All requests to the end; those that have no reply get ``None``."""
    found = [running.advance()]
    given = iter(replies)
    while not isinstance(found[-1], End | Fail | Crash):
        found.append(running.advance(next(given, None)))
    return found


Runner = Callable[..., list[Request]]


@pytest.fixture
def run(start: Starter) -> Runner:
    """Runs a text with replies; gives all requests."""

    def runner(text: str, *replies: Any, **options: Any) -> list[Request]:
        return requests_of(start(text, **options), replies)

    return runner


@pytest.fixture
def everything() -> str:
    """A valid program with something of everything."""
    return EVERYTHING


@pytest.fixture
def recorder() -> Recorder:
    """Keeps events."""
    return Recorder()
