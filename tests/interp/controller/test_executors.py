"""All executors have the same trace, full level included: the controller cannot tell them apart."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from interp.executors import available

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
PROGRAMS: Mapping[str, tuple[str, str]] = {
    "search": (
        f"DEF main()\nINT I\nI=0\nINTERRUPT DECL 10 WHEN $IN[1] DO FOUND()\n{HOME}INTERRUPT ON 10\n"
        "SEARCH()\nINTERRUPT OFF 10\nI=I+1\nPTP {A1 5}\nEND\nDEF SEARCH()\nPTP {A1 100}\n"
        "WAIT SEC 0\nEND\nDEF FOUND()\nBRAKE\nPTP {A1 20}\nRESUME\nEND\n",
        "t=1.5 IN[1]=TRUE",
    ),
    "nesting": (
        "DEF main()\nINT I\nINTERRUPT DECL 20 WHEN $IN[1] DO LOW()\n"
        "INTERRUPT DECL 5 WHEN $IN[2] DO HIGH()\nINTERRUPT ON\nFOR I=1 TO 9\nWAIT SEC 0.1\nENDFOR\n"
        f"{HOME}END\nDEF LOW()\nINT K\nK=1\nWAIT SEC 0.3\nEND\nDEF HIGH()\nHALT\nEND\n",
        "t=0.1 IN[1]=TRUE\nt=0.2 IN[2]=TRUE\nt=1.2 IN[1]=FALSE\nt=1.3 IN[1]=TRUE\n"
        "on HALT after 0.1 press START",
    ),
    "pending": (  # an interrupt that came before a RESUME, which goes back to the end
        "DEF main()\nINTERRUPT DECL 9 WHEN $IN[1] DO LOW()\n"
        "INTERRUPT DECL 4 WHEN $IN[2] DO HIGH()\n"
        f"INTERRUPT DECL 20 WHEN $FLAG[2] DO LAST()\n{HOME}INTERRUPT ON\nPTP {{A1 100}}\nEND\n"
        "DEF LOW()\nWAIT SEC 1\nEND\nDEF HIGH()\nBRAKE\n$FLAG[2]=TRUE\nWAIT SEC 0.1\nRESUME\nEND\n"
        "DEF LAST()\n$OUT[4]=TRUE\nWAIT SEC 0.1\nEND\n",
        "t=0.3 IN[1]=TRUE\nt=0.4 IN[2]=TRUE",
    ),
    "triggers": (
        f"DEF main()\nINT I\nI=3\n{HOME}TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[1]=TRUE\n"
        "TRIGGER WHEN DISTANCE=1 DELAY=-50 DO DONE(I) PRIO=-1\n"
        "TRIGGER WHEN DISTANCE=0 DELAY=7 DO $OUT[I]=$IN[1]\n"
        "TRIGGER WHEN DISTANCE=0 DELAY=0 DO PULSE($OUT[9],TRUE,0.2)\nPTP {A1 1} C_PTP\nPTP {A1 2}\n"
        "END\nDEF DONE(N)\nINT N\nN=N+1\n$OUT[N]=TRUE\nEND\n",
        "t=0.5 IN[1]=TRUE",
    ),
    "signals": (
        "DEF main()\nREAL X\nINT I\nSIGNAL SPEED $ANOUT[1]\nSIGNAL NR $OUT[3] TO $OUT[6]\nX=0.25\n"
        "$CYCFLAG[2]=$IN[1] AND NOT $IN[2]\nANOUT ON SPEED=X+0.1 DELAY=0.1 MAXIMUM=0.5\n"
        "ANIN ON X=2*$ANIN[3]\nWAIT FOR $CYCFLAG[2]\nNR=9\nI=NR\nPULSE($OUT[I],TRUE,0.3)\n"
        "ANIN OFF $ANIN[3]\nX=3\nWAIT SEC 0.5\nANOUT OFF SPEED\nEND\n",
        "t=0.3 IN[1]=TRUE, ANIN[3]=0.15",
    ),
    "advance": (
        f"DEF main()\nINT I\nREAL X\n{HOME}FOR I=1 TO 4\n$VEL.CP=0.1*I\nPTP {{A1 1}} C_PTP\n"
        "$OUT_C[I]=TRUE\nX=$VEL_C.CP\nENDFOR\nCONTINUE\n$OUT[8]=TRUE\nIF $IN[1] THEN\nI=9\nENDIF\n"
        "ON_ERROR_PROCEED\nPTP {A1 500}\nI=$ERR.NUMBER\nSWITCH $MODE_OP\nCASE #T1\nI=1\n"
        "DEFAULT\nI=2\nENDSWITCH\nEND\n",
        "t=2.5 IN[1]=TRUE",
    ),
    "fault": (f"DEF main()\nINT I\n{HOME}PTP {{A1 5}}\nI=0\nI=7/I\nEND\n", ""),
    "texts": (  # more of them than a cycle has requests, some of them while the arm moves
        f"DEF main()\nINT I,K,N\nCHAR S[20]\nDECL STATE_T R\nN=0\n{HOME}FOR I=1 TO 900\nK=0\n"
        'SWRITE(S[],R,K,"%d",I*I)\nN=N+STRLEN(S[])\nIF I==450 THEN\n$OUT[1]=TRUE\nPTP {A1 1}\n'
        "ON_ERROR_PROCEED\nI=I/(K-K)\nENDIF\nENDFOR\nFOR I=1 TO 1500\nN=N+1\nENDFOR\n"
        'CONTINUE\nSWRITE(S[],R,K,"%d",N)\nSWRITE(S[],R,K,"%d",N)\n$OUT[2]=TRUE\nEND\n',
        "t=1.5 IN[1]=TRUE",
    ),
    "texts_in_interrupt": (  # which ends on one, while the program waits with one of its own
        "DEF main()\nINT K\nCHAR S[20]\nDECL STATE_T R\nINTERRUPT DECL 9 WHEN $IN[1] DO SEEN()\n"
        f'INTERRUPT ON 9\n{HOME}PTP {{A1 20}}\nK=0\nSWRITE(S[],R,K,"%d",K)\nPTP {{A1 1}}\nEND\n'
        'DEF SEEN()\nINT K\nCHAR S[20]\nDECL STATE_T R\nK=0\nSWRITE(S[],R,K,"%d",K)\nK=0\n'
        'SWRITE(S[],R,K,"%d",K)\nEND\n',
        "t=0.1 IN[1]=TRUE",
    ),
    "polling": (
        "DEF main()\nINT I\nI=0\nWHILE NOT $IN[1]\nI=I+1\nENDWHILE\nLOOP\nI=I+1\nEND_HERE:\n"
        "IF I>2500 THEN\nEXIT\nENDIF\nENDLOOP\nEND\n",
        "t=0.05 IN[1]=TRUE",
    ),
}
SUBMIT = {
    "sps.sub": "DEF SPS()\nINTERRUPT DECL 4 WHEN $OUT[1] DO SEEN()\nINTERRUPT ON 4\nLOOP\n"
    "COUNT=COUNT+1\nWAIT FOR $IN[1]\nWAIT FOR NOT $IN[1]\nENDLOOP\nEND\nDEF SEEN()\n"
    "$OUT[2]=TRUE\nEND\n",
    "$config.dat": "DEFDAT $CONFIG\nDECL INT COUNT=0\nENDDAT\n",
}
OTHERS = [name for name in available() if name != "tree"]


def same(left: Any, right: Any) -> None:
    """Both runs told the same and ended the same."""
    pairs = zip(left.events, right.events, strict=False)
    for place, (one, other) in enumerate(pairs):
        assert one.line() == other.line(), f"event {place}"
    assert len(left.events) == len(right.events)
    assert left.outcome == right.outcome


@pytest.mark.parametrize("name", PROGRAMS)
def test_same_trace(go: Go, name: str) -> None:
    """The machines tell what the tree interpreter tells, to the bit."""
    text, script = PROGRAMS[name]
    tree = go(text, script)
    assert "crash" != tree.outcome.ending
    for executor in OTHERS:
        same(tree, go(text, script, executor=executor))


def test_same_trace_with_submit(go: Go) -> None:
    """Two programs over the same data take turns in the same way."""
    text = (
        f"DEF main()\nINT I\n{HOME}$OUT[1]=TRUE\nWAIT SEC 0.5\nI=COUNT\nCOUNT=0\nWAIT SEC 1\n"
        "I=COUNT\nEND\n"
    )
    script = "\n".join(f"t={one / 10} IN[1]={'TRUE' if one % 2 else 'FALSE'}" for one in range(30))
    tree = go(text, script, files=SUBMIT, submit="SPS")
    assert ("end", 5) == (tree.outcome.ending, tree.last("I"))
    for executor in OTHERS:
        same(tree, go(text, script, files=SUBMIT, submit="SPS", executor=executor))
