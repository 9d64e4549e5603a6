"""The compiler: what it makes does what the tree interpreter does, for everything that KRL has."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import get_args

import pytest

from conformance.differential.corpus_routines import RoutineResult, routine_results
from conformance.differential.random_world import QuietWorld
from conformance.differential.runs import facts_of
from conformance.differential.traces import fact_of
from conformance.differential.undisturbed_run import Observed, difference, observe
from grammar.syntax import ast
from grammar.syntax.source import Source
from grammar.syntax.walk import walk
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.assembly.disassembler import disassemble
from interp.bytecode.compiler.project import Compiled, compile_program
from interp.bytecode.image.image import read_image, write_image
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.executors import Prepared
from interp.port.events import Sink
from interp.port.executor import Executor
from interp.port.requests import At, Fail, Write
from interp.program.load import CheckedProgram, Limits, load
from interp.values.faults import LinkError
from support.files.decode import decode

PROGRAMS = Path(__file__).parents[3] / "corpus" / "programs"
_LIMITS = Limits(statements=3_000)


def _loaded(text: str, **more: str) -> CheckedProgram:
    files = [Source(text, "main.src")]
    files += [Source(other, name.replace("_", ".")) for name, other in more.items()]
    return load(files, "main.src", strict=False)


def _makers(program: CheckedProgram) -> list[Callable[[Sink], Executor]]:
    """The tree interpreter and the machine."""
    prepared = Prepared(program)
    return [partial(prepared.executor, name, _LIMITS) for name in ("tree", "vm")]


def _observed(program: CheckedProgram) -> list[Observed]:
    """What both ask and tell."""
    return [observe(make, QuietWorld(1), 500) for make in _makers(program)]


def _last(text: str, **more: str) -> Exception:
    """The fault that both executors end with."""
    tree, machine = _observed(_loaded(text, **more))
    assert None is difference("", tree, machine)
    assert isinstance(tree.last, Fail)
    return tree.last.fault


# ------------------------------------------------------------------------------ every statement

_EVERYTHING = """DEF main()
DECL INT I,N,A[5],G[2,3]
DECL REAL X
DECL BOOL T
DECL CHAR C,S[8]
DECL FRAME F
DECL E6POS P
DECL CIRC_TYPE M
INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO Act(I)
INTERRUPT DECL 4 WHEN I>3 DO Act(N)
INTERRUPT DECL 5 WHEN Odd(N) DO Leave()
INTERRUPT ON 3
INTERRUPT ON 4
INTERRUPT ON
N=0
S[]="text"
C=S[1]
M=#PATH
F={X 1,Y 2,Z 3,A 0,B 0,C 90}
F=F:{FRAME: X 1,Y 0,Z 0,A 0,B 0,C 0}
P={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 2}
$BASE=F
$VEL.CP=0.5
$OUT[3]=NOT $IN[4]
X=$VEL.CP*2
FOR I=1 TO 5
  A[I]=I*I
  IF A[I]==9 THEN
    N=N+A[I]
  ELSE
    N=N-1
  ENDIF
ENDFOR
FOR I=5 TO 1 STEP -2
  Deep(A[],G[,],I)
ENDFOR
FOR X=1 TO 3
  N=N+1
ENDFOR
I=0
WHILE I<3
  I=I+1
ENDWHILE
REPEAT
  I=I-1
UNTIL I<=0
LOOP
  I=I+1
  IF I>4 THEN
    EXIT
  ENDIF
ENDLOOP
SWITCH I
  CASE 1,2
    N=1
  CASE 5
    N=Twice(N)
  DEFAULT
    N=3
ENDSWITCH
SWITCH C
  CASE "a"
    N=1
  CASE "t"
    N=N+1
ENDSWITCH
SWITCH M
  CASE #BASE
    N=1
  CASE #PATH
    N=N+2
ENDSWITCH
SWITCH I
  CASE N
    N=0
  CASE 5
    N=9
ENDSWITCH
again:
I=I+1
IF I<7 THEN
  GOTO again
ENDIF
WAIT FOR $IN[2]
WAIT SEC 0.5
CONTINUE
HALT
CONFIRM 3
ON_ERROR_PROCEED
N=1/(N-N)
PTP P
PTP_REL {A1 5} C_PTP
LIN F C_VEL
CIRC P,P,CA 90.0
SPLINE
  SPL P WITH $VEL.CP=0.2
  TRIGGER WHEN PATH=10 ONSTART DELAY=0 DO $OUT[5]=TRUE
  STOP WHEN PATH=5 IF $IN[3]
  TIME_BLOCK START
  SPL P
  TIME_BLOCK PART=30
  SPL P
  TIME_BLOCK END=2.5
ENDSPLINE
TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[6]=TRUE
TRIGGER WHEN PATH=-5 DELAY=0 DO Act(N) PRIO=-1
ANIN ON X=2.0*$ANIN[1]+0.5
ANIN OFF $ANIN[1]
ANOUT ON $ANOUT[2]=0.5*X DELAY=0.05 MINIMUM=0.1
ANOUT OFF $ANOUT[2]
$CYCFLAG[N+1]=$IN[1] AND (I>2)
PULSE($OUT[I],TRUE,0.3)
BRAKE
INTERRUPT DISABLE 3
INTERRUPT OFF 4
INTERRUPT OFF
RESUME
RETURN
END
DEF Act(K:OUT)
DECL INT K
K=K+1
BRAKE F
END
DEF Leave()
Inner()
END
DEF Inner()
RESUME
END
DEFFCT BOOL Odd(K:IN)
DECL INT K
RETURN (K B_AND 1)==1
ENDFCT
DEFFCT INT Twice(K:IN)
DECL INT K
K=K*2
RETURN K
ENDFCT
DEF Deep(V[]:OUT,W[,]:OUT,K:IN)
DECL INT V[],W[,],K
V[K]=V[K]+K
W[1,K B_AND 3]=K
END
"""


def test_every_statement() -> None:
    """Requests and events are the same, also with interrupts, RESUME and faults on the way."""
    program = _loaded(_EVERYTHING)
    assert () == compile_program(program).refusals
    assert None is difference("", *_observed(program))
    kinds = set()
    for seed in "12345":
        tree, machine = (facts_of(make, seed) for make in _makers(program))
        assert tree == machine
        kinds |= {fact[0] for fact in tree}
    assert {"evaluated", "entered", "unwound"} <= kinds


def test_program_has_every_statement() -> None:
    """No statement that is executed is missing in the program but MOVE_EMI, an option's."""
    syntax = _loaded(_EVERYTHING).main.module.syntax
    assert syntax is not None
    found = {type(node) for node in walk(syntax)}
    executed = set(get_args(ast.Statement)) - set(get_args(ast.Definition)) - found
    assert {"EmilyMotion"} == {kind.__name__ for kind in executed}


def test_round_trip() -> None:
    """Text and image give the same program again."""
    program = compile_program(_loaded(_EVERYTHING)).program
    assert program == assemble(disassemble(program))
    assert program == read_image(write_image(program))


# ------------------------------------------------------------------------------ what ends programs


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("DEF main()\nDECL INT A[2000000]\nEND\n", "the variables of main are too large"),
        ("DEF main()\nNowhere()\nEND\n", "Nowhere is declared nowhere"),
        ("DEF main()\nGOTO x\nEND\n", "the label X is not there to go to"),
        ("DEF main()\nEXIT\nEND\n", "EXIT outside of a loop"),
        ("DEF main()\nDECL INT I\nI=$NOT_KNOWN\nEND\n", "the type of $NOT_KNOWN is not known"),
        ("DEF main()\nDECL Strange S\nS=1\nEND\n", "the type of S is not known"),
        (
            "DEF main()\nDECL REAL X\nSub(X)\nEND\nDEF Sub(I:OUT)\nDECL INT I\nEND\n",
            "an argument of another type than INT",
        ),
        *(
            (
                f"DEF main()\nDECL INT I\nI=1\nSub({given})\nEND\n"
                "DEF Sub(P[]:IN)\nDECL FRAME P[]\nEND\n",
                "an argument of another type than FRAME[]",
            )
            for given in ("I", '"abc"', "I>2", "$NULLFRAME")
        ),
    ],
)
def test_what_is_not_there(text: str, reason: str) -> None:
    """A name that leads nowhere, or to no known type, ends the program when it is reached."""
    error = _last(text)
    assert isinstance(error, LinkError)
    assert reason == str(error)


@pytest.mark.parametrize("step", ["", " STEP 2", " STEP 0", " STEP -1"])
def test_a_counter_that_is_not_declared_ends_the_loop(step: str) -> None:
    """No comparison of it can be written, in either direction; the program ends all the same."""
    tree, machine = _observed(_loaded(f"DEF A()\n FOR I=5 TO 1{step}\n ENDFOR\nEND\n"))
    assert None is difference("", tree, machine)


def test_the_last_value_of_a_data_list_counts() -> None:
    """Also where it is a literal, and the element that the one before it goes to is worked out."""
    given = "DECL INT I=2\nDECL INT A[2]\nA[I]=3\nA[2]=5\n"
    program = _loaded("DEF main()\nEND\n", main_dat=f"DEFDAT main\n{given}ENDDAT\n")
    assert ((0, 2), (2, 5)) == compile_program(program).program.initial


def test_a_data_list_gives_nothing_to_what_it_imports() -> None:
    """On either executor, whichever list comes first."""
    given = "DEFDAT main\nIMPORT INT I IS /R1/A..I\nI=7\nENDDAT\n"
    source = "DEF main()\nDECL INT J\nJ=I\nEND\n"
    fault = _last(source, A_dat="DEFDAT A PUBLIC\nDECL INT I\nENDDAT\n", main_dat=given)
    assert "a value is used that was never set" == str(fault)


def test_huge_data_lists() -> None:
    """Data lists that no memory holds are refused at once."""
    program = _loaded(
        "DEF main()\nEND\n", main_dat="DEFDAT main\nINT A[600000],B[600000]\nENDDAT\n"
    )
    with pytest.raises(LinkError, match="hold too much"):
        compile_program(program)


# ------------------------------------------------------------------------------ requests of late


def test_companion_shares_the_data_lists() -> None:
    """Another machine sees what the first one assigned, and has frames of its own [SUB-01]."""
    program = _loaded(
        "DEF main()\nDECL INT L\nL=1\nA=A+L\nHALT\nA=A+L\nHALT\nEND\n",
        main_dat="DEFDAT main PUBLIC\nGLOBAL INT A=5\nENDDAT\n",
        watch_sub="DEF watch()\nDECL INT L\nL=10\nHALT\nA=A*L\nHALT\nEND\n",
    )
    told = []
    machine = Machine(verify(compile_program(program).program), "main")
    beside = machine.companion("watch")
    for one in (machine, beside, beside, machine):
        one.advance()
        told.append(machine.data()[0])
    assert [6, 6, 60, 61] == told


# ------------------------------------------------------------------------------ real programs


@pytest.mark.parametrize("folder", ["assembly", "transfer", "gluing"])
def test_own_programs(folder: str) -> None:
    """Every routine of an own project checks, compiles and runs alike on both."""
    sources = []
    for path in sorted((PROGRAMS / folder).rglob("*")):
        found = decode(path.read_bytes()) if path.is_file() else ""
        if not isinstance(found, str) and path.suffix.lower() in (".src", ".dat", ".sub"):
            sources.append(Source(found.text, path.relative_to(PROGRAMS).as_posix()))
    tried = [
        one for one in routine_results(sources, ("tree", "vm")) if isinstance(one, RoutineResult)
    ]
    assert len(tried) > 5
    for one in tried:
        assert one.stage in ("runs", "unlinked")
        assert {} == one.differences


def test_differences_are_found() -> None:
    """Steps that differ by a bit, or by their number, are told; numbers of codes are not."""
    first, *steps = (
        Write(At("a.src", 1, 0), ("$OV_PRO",), value) for value in (1, 0.0, -0.0, 0, False)
    )
    one = Observed((first, steps[0]), is_cut=False)
    for other in steps[1:]:
        found = difference("", one, Observed((first, other), is_cut=False))
        assert found is not None
        assert (1, fact_of(steps[0]), fact_of(other)) == (found.place, found.expected, found.actual)
    short = difference("", one, Observed((first,), is_cut=False))
    assert short is not None
    assert (1, fact_of(steps[0]), None) == (short.place, short.expected, short.actual)


def test_refusals_are_reported() -> None:
    """What ends the program is told with its place, once."""
    compiled = compile_program(_loaded("DEF main()\nGone()\nGone()\nEND\n"))
    assert isinstance(compiled, Compiled)
    places = [(one.path, one.line, one.reason, one.is_missing) for one in compiled.refusals]
    assert [("main.src", n, "Gone is declared nowhere", True) for n in (2, 3)] == places


def test_a_function_of_no_known_type_leaves_the_others() -> None:
    """It ends a program that begins with it; those that begin elsewhere are compiled."""
    function = "DEFFCT Lost_T given()\nRETURN 1\nENDFCT\n"
    compiled = compile_program(_loaded(f"DEF main()\nEND\n{function}"))
    assert isinstance(compiled, Compiled)
    places = [(one.path, one.line, one.reason, one.is_missing) for one in compiled.refusals]
    assert [("main.src", 3, "given gives an unknown type", True)] == places
    verify(compiled.program)
