"""What calls can rely on, however far the routine that decides is away."""

from collections.abc import Callable
from pathlib import Path

import pytest

from grammar.check.project.batch import CheckOptions, check_paths
from grammar.diagnostics.diagnostic import Diagnostic

Agrees = Callable[..., None]


def files(*texts: str) -> dict[str, str]:
    """Programs by path, each called as its first routine."""
    return {f"{text.split('(')[0].split()[-1]}.src": text for text in texts}


@pytest.mark.parametrize(
    ("body", "passed", "read"),
    [
        ("$ANOUT[1] = N", ";> KRL409?", ""),
        ("N = 1", "", ""),
        ("IF $IN[1] THEN\nN = 1\nENDIF", "", ""),
        ("IF $IN[1] THEN\n$ANOUT[1] = N\nENDIF", "", ";> KRL409?"),
        ("$ANOUT[1] = N\nN = 1", ";> KRL409?", ""),
        ("HALT", "", ";> KRL409?"),
        ("INNER(N)", ";> KRL409?", ""),
        ("IF $IN[1] THEN\nINNER(N)\nENDIF", "", ""),
        ("FILL(N)", "", ""),
        ("AGAIN(N)", "", ";> KRL409?"),
        ("INTERRUPT DECL 10 WHEN $IN[1] DO FILL(N)", "", ""),
        ("N = N + 1", ";> KRL409?", ""),
    ],
)
def test_a_variable_without_a_value_is_passed(
    agrees: Agrees, body: str, passed: str, read: str
) -> None:
    """The called routine has to give it one before anybody reads it [SCO-03, SCO-06, SCO-08]."""
    main = f"DEF NEG()\nDECL INT I\nWORK(I) {passed}\n$ANOUT[2] = I {read}\nEND"
    work = f"DEF WORK(N:OUT)\nDECL INT N\n{body}\nEND"
    inner = "DEF INNER(N:OUT)\nDECL INT N\n$ANOUT[1] = N\nN = 2\nEND"
    fill = "DEF FILL(N)\nDECL INT N\nN = 2\nEND"
    again = "DEF AGAIN(N:OUT)\nDECL INT N\nIF $IN[1] THEN\nAGAIN(N)\nENDIF\nEND"
    agrees(files(main, work, inner, fill, again), with_data=True, ignored=("KRL117", "KRL516"))


BOUNDS = """DEF NEG()
  SPEED(2.0)
  SPEED(3.5) {speed}
  SPEED(-0.1) {speed}
  $ANOUT[1] = SHARE(4)
  $ANOUT[1] = SHARE(0) {share}
  PICK(5)
  PICK(6) {pick}
  PICK(0) {pick}
END"""
MACHINE = "DEFDAT $MACHINE PUBLIC\nDECL CP $VEL_MA={CP 3.0,ORI1 400.0,ORI2 400.0}\nENDDAT"


@pytest.mark.parametrize(
    ("before", "is_reported"),
    [
        ("", True),
        ("HALT", True),
        ("IF $IN[1] THEN\nRETURN {0}\nENDIF", False),
        ("IF {0} <= 0 THEN\n{0} = 1\nENDIF", False),
    ],
)
@pytest.mark.parametrize("is_direct", [True, False])
def test_constants_that_a_routine_cannot_use(
    agrees: Agrees, before: str, *, is_reported: bool, is_direct: bool
) -> None:
    """Limits of the machine, divisors and indices, also where the argument is handed on."""
    marks = {"speed": ";> KSS1422?", "share": ";> KRL416?", "pick": ";> KSS1444?"}
    main = BOUNDS.format(**{name: mark if is_reported else "" for name, mark in marks.items()})
    speed = f"DEF SPEED(V:IN)\nREAL V\n{before.format('V').replace('RETURN V', 'RETURN')}\n"
    speed += "$VEL.CP = V\nEND" if is_direct else "SET(V)\nEND"
    speed += "\nDEF SET(W:IN)\nREAL W\n$VEL.CP = (W)\nEND"
    share = f"DEFFCT REAL SHARE(P:IN)\nREAL P\n{before.format('P')}\n"
    share += "RETURN 1.0 / P\nENDFCT" if is_direct else "RETURN 2 * PART(P)\nENDFCT"
    share += "\nDEFFCT REAL PART(Q:IN)\nREAL Q\nRETURN 1.0 / Q\nENDFCT"
    pick = (
        f"DEF PICK(N:IN)\nINT N\nINT ALL[5]\n{before.format('N').replace('RETURN N', 'RETURN')}\n"
    )
    pick += "ALL[N] = 1\nEND"
    found = files(main, speed, share, pick)
    agrees({**found, "$machine.dat": MACHINE})


def test_nothing_is_known_of_a_routine_that_cannot_be_read_whole(tmp_path: Path) -> None:
    """The line that cannot be read may be a guard."""
    for line, expected in (("HALT", ["KRL302", "KRL416"]), ("IF N THEN(", [])):
        text = f"DEF NEG()\nWORK(0)\nWORK(1)\nEND\nDEF WORK(N:IN, M:IN)\nINT N, M\n{line}\n"
        text += "$ANOUT[1] = M / N\nEND\n"
        (tmp_path / "NEG.src").write_text(text, encoding="utf-8")
        found = check_paths([tmp_path], CheckOptions(), jobs=1).diagnostics
        assert expected == sorted({one.code for one in found} & {"KRL302", "KRL416"})


def test_a_division_by_a_constant_zero(agrees: Agrees) -> None:
    """As in 1 / (2 - 2); TRUE is no number."""
    agrees("DEF NEG()\n$ANOUT[1] = 1.0 / (2 - 2) ;> KRL416?\n$ANOUT[1] = 1.0 / 2\nEND")


@pytest.mark.parametrize(
    ("body", "mark"),
    [
        ("LOOP\nHALT\nENDLOOP", ";> KRL407-"),
        ("WHILE TRUE\nHALT\nENDWHILE", ";> KRL407-"),
        ("INNER()", ";> KRL407-"),
        ("LOOP\nIF $IN[1] THEN\nEXIT\nENDIF\nENDLOOP", ""),
        ("LOOP\nIF $IN[1] THEN\nRETURN\nENDIF\nENDLOOP", ""),
        ("IF $IN[1] THEN\nINNER()\nENDIF", ""),
        ("IF $IN[1] THEN\nRETURN\nENDIF\nINNER()", ""),
        ("WORK()", ""),
        ("MISSING()", ""),
    ],
)
def test_behind_a_routine_that_does_not_return(agrees: Agrees, body: str, mark: str) -> None:
    """Nothing is reached, unless RESUME may leave the routine [INT-11]."""
    main = "DEF NEG()\nHALT\nWORK()\nHALT {}\nHALT\nEND"
    work = f"DEF WORK()\nEXT MISSING()\n{body}\nEND"
    inner = "DEF INNER()\nLOOP\nHALT\nENDLOOP\nEND"
    agrees(files(main.format(mark), work, inner), ignored=("KRL701",))
    resume = "DEF STOP()\nBRAKE\nRESUME\nEND"
    agrees(files(main.format(""), work, inner, resume), ignored=("KRL701", "KRL505", "KRL506"))


@pytest.mark.parametrize(
    ("declared", "body", "is_reported"),
    [
        ("INT N {}", "$ANOUT[1] = N", True),
        ("INT N=1", "$ANOUT[1] = N", False),
        ("INT N[2]\nN[1]=1", "$ANOUT[1] = N[1]", False),
        ("INT N", "HALT", False),
        ("INT N", "OWN(1)\nEND\nDEF OWN(N:IN)\nINT N\n$ANOUT[1] = N", False),
        ("INT K, N=1", "HALT", False),
        ("INT N", "N = 1", False),
        ("INT N", "$ANOUT[1] = N\nFILL(N)", False),
        ("REAL N", "ANIN ON N = 1.0 * $ANIN[1]", False),
        ("GLOBAL INT N {}", "$ANOUT[1] = N", None),
    ],
)
@pytest.mark.parametrize("is_complete", [True, None])
def test_variables_that_nothing_gives_a_value(
    agrees: Agrees, declared: str, body: str, *, is_reported: bool | None, is_complete: bool | None
) -> None:
    """A missing file may set what is GLOBAL, and an IMPORT what it stands for."""
    is_known = is_reported or (is_reported is None and is_complete)
    data = f"DEFDAT NEG PUBLIC\nDECL {declared}\nENDDAT"
    given = {
        "NEG.src": f"DEF NEG()\n{body}\nEND",
        "FILL.src": "DEF FILL(M:OUT)\nINT M\nM = 1\nEND",
        "USES.src": "DEF USES(K:IN)\nINT K\n$ANOUT[1] = K\nEND",
        "NEG.dat": data.format(";> KRL417?" if is_known else ""),
    }
    ignored = ("KRL111", "KRL117", "KRL7")
    agrees(given, with_data=True, is_complete=is_complete, ignored=ignored)
    other = "DEFDAT OTHER\nIMPORT INT M IS /R1/NEG..N\nENDDAT"
    given |= {"NEG.dat": data.format(""), "OTHER.dat": other}
    agrees(given, with_data=True, is_complete=is_complete, ignored=ignored)


def test_the_routine_is_named(finds: Callable[..., list[Diagnostic]]) -> None:
    """The reason says which routine reads a variable, or which ones give it no value."""
    given = files(
        "DEF NEG()\nINT I, J, K\nREADS(I)\nLEAVES(J)\n$ANOUT[1] = J\nLEAVES(K)\nSKIPS(K)\n"
        "$ANOUT[1] = K\nEND",
        "DEF READS(N)\nINT N\nIF N > 1 THEN\nN = 1\nENDIF\nEND",
        "DEF LEAVES(N)\nINT N\nHALT\nEND",
        "DEF SKIPS(N)\nINT N\nHALT\nEND",
    )
    found = [(one.region.line, one.reason) for one in finds(given) if one.code == "KRL409"]
    assert found == [
        (3, "READS reads it before it assigns to it"),
        (5, "LEAVES gives it none"),
        (8, "LEAVES and SKIPS give it none"),
    ]
