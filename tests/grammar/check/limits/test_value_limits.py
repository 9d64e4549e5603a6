"""Numbers of interrupts, limits of triggers, cyclical flags, lengths of names; by rule."""

from collections.abc import Callable

import pytest

from grammar.semantics.predefined import is_priority

Agrees = Callable[..., None]


def routine(*lines: str) -> str:
    return "\n".join(["DEF NEG()", *lines, "END", "DEF WORK()", "END"])


def test_priorities() -> None:
    """Programs have 1, 2, 4 to 39 and 81 to 128, the system has the others [INT-02]."""
    own = {number for number in range(-5, 200) if is_priority(number)}
    assert {1, 2, *range(4, 40), *range(81, 129)} == own


@pytest.mark.parametrize(
    ("seconds", "said"),
    [("0.1", ""), ("3", ""), ("I", ""), ("0.05", "?"), ("30", "?"), ("-1", "?")],
)
def test_pulses(agrees: Agrees, seconds: str, said: str) -> None:
    """A pulse lasts 0.1 to 3 seconds, also as the action of a trigger [IOT-07]."""
    expected = f";> KRL518{said}" if said else ""
    pulse = f"PULSE($OUT[1], TRUE, {seconds})"
    agrees(routine("DECL INT I", "I = 5", f"{pulse} {expected}"))
    agrees(routine("DECL INT I", "I = 5", f"TRIGGER WHEN DISTANCE=0 DELAY=0 DO {pulse} {expected}"))


@pytest.mark.parametrize(
    "line",
    [
        "INTERRUPT DECL 1 WHEN $IN[1] DO WORK()",
        "INTERRUPT DECL 128 WHEN $IN[1] DO WORK()",
        "INTERRUPT DECL I WHEN $IN[1] DO WORK()",
        "INTERRUPT DECL 3 WHEN $STOPMESS == TRUE DO WORK()",
        "INTERRUPT DECL 3 WHEN $STOPMES == TRUE DO WORK() ;> KRL113?",
        "INTERRUPT DECL 3 WHEN $IN[1] DO WORK() ;> KRL503?",
        "INTERRUPT DECL 40 WHEN $IN[1] DO WORK() ;> KRL503",
        "INTERRUPT DECL 38 + 2 WHEN $IN[1] DO WORK() ;> KRL503",
        "INTERRUPT DECL -1 WHEN $IN[1] DO WORK() ;> KRL503",
    ],
)
def test_numbers_of_interrupts(agrees: Agrees, line: str) -> None:
    """A number that is known is judged; 3 belongs to the stop that every program sets up."""
    agrees(routine("DECL INT I", "I = 5", line))


PATH = "TRIGGER WHEN PATH=-5 DELAY=0 DO $OUT[1]=TRUE"


@pytest.mark.parametrize(
    "lines",
    [
        (PATH, "LIN $POS_ACT"),
        (f"{PATH} ;> KRL512", "PTP $POS_ACT"),
        (f"{PATH} ;> KRL512", f"{PATH} ;> KRL512", "$OUT[2] = TRUE", "PTP_REL {{A1 5}}"),
        (PATH, "SLIN $POS_ACT", "PTP $POS_ACT"),
        (PATH, "WORK()", "PTP $POS_ACT"),
        (PATH, "IF $IN[1] THEN", "LIN $POS_ACT", "ENDIF", "PTP $POS_ACT"),
        (PATH, "SPLINE", "SPL $POS_ACT", "ENDSPLINE", "PTP $POS_ACT"),
    ],
)
def test_path_needs_a_path(agrees: Agrees, lines: tuple[str, ...]) -> None:
    """PATH before PTP is told where it is certain which motion is the next [TRG-04]."""
    agrees(routine(*(line.replace("{{", "{").replace("}}", "}") for line in lines)))


LONG = "A234567890123456789012345"


def test_names_in_programs(agrees: Agrees) -> None:
    """Routines, labels and parameters too; a parameter is told once [TYP-05]."""
    agrees(
        "\n".join(
            [
                "DEF NEG()",
                f"{LONG}: ;> KRL105",
                "END",
                f"DEF B{LONG}(C{LONG}:IN) ;> KRL105 KRL105",
                f"DECL INT C{LONG}",
                f"$OUT[1] = C{LONG} == 1",
                "END",
            ]
        )
    )


def test_name_of_a_module(agrees: Agrees) -> None:
    """The name of the file is that of its first routine, so the fault is told once [TYP-05]."""
    agrees({f"{LONG}.src": f"DEF {LONG}() ;> KSS3157\nEND"})


@pytest.mark.parametrize(("count", "mark"), [(255, ""), (256, " ;> KSS2710")])
def test_number_of_local_routines(agrees: Agrees, count: int, mark: str) -> None:
    """A module has 255 local routines at most [SCO-02]."""
    routines = [f"DEF R{number}()\nEND" for number in range(1, count)]
    agrees("\n".join(["DEF NEG()\nEND", *routines, f"DEF LAST(){mark}", "END"]))
