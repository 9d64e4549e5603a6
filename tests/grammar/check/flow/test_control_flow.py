"""EXIT, GOTO and labels, the end of functions, what is never reached; by rule."""

from collections.abc import Callable
from typing import Any

import pytest

Agrees = Callable[..., None]


def routine(*lines: str) -> str:
    return "\n".join(["DEF NEG()", *lines, "END"])


def function(*lines: str, mark: str = "") -> str:
    """A program with a function whose findings stand at its name."""
    body = ["DEF NEG()", "END", f"DEFFCT INT F(){mark}", *lines, "ENDFCT"]
    return "\n".join(body)


@pytest.mark.parametrize("opener", ["LOOP", "WHILE $IN[1]", "REPEAT", "FOR I = 1 TO 2"])
def test_exit_leaves_any_loop(agrees: Agrees, opener: str) -> None:
    """EXIT stands in loops of every kind, in blocks inside them too [CTL-02]."""
    closer = {"LOOP": "ENDLOOP", "WHILE": "ENDWHILE", "REPEAT": "UNTIL $IN[2]", "FOR": "ENDFOR"}
    agrees(
        routine(
            "DECL INT I",
            opener,
            "  IF $IN[3] THEN",
            "    EXIT",
            "  ENDIF",
            closer[opener.split(maxsplit=1)[0]],
            "IF $IN[4] THEN",
            "  EXIT ;> KRL401?",
            "ENDIF",
        )
    )


def test_labels_are_known_in_their_routine_only(agrees: Agrees) -> None:
    """A label stands once in a routine, and each routine may have one of that name [CTL-07]."""
    agrees(
        "\n".join(
            [
                "DEF NEG()",
                "  GOTO DONE",
                "  DONE:",
                "  $OUT[1] = TRUE",
                "  Done: ;> KRL404?",
                "  OTHER()",
                "END",
                "DEF OTHER()",
                "  IF $IN[1] THEN",
                "    GOTO DON ;> KRL402?",
                "  ENDIF",
                "  DONE:",
                "END",
            ]
        )
    )


def test_a_label_that_is_nearly_there_is_offered(finds: Callable[..., list[Any]]) -> None:
    """For an unknown label one that looks alike is offered."""
    (found,) = finds({"NEG.src": routine("GOTO FINSH", "FINISH:")})
    assert "did you mean FINISH?" == found.fix.text


def test_a_misspelt_label_is_reported_in_its_place(finds: Callable[..., list[Any]]) -> None:
    """A label that no GOTO leads to, one slip from where two go, is the one that is wrong."""
    found = finds({"NEG.src": routine("GOTO FINISH", "GOTO FINISH", "FINSH:")})
    assert [4] == [one.region.line for one in found if one.code == "KRL402"]


@pytest.mark.parametrize(
    "lines",
    [
        ("RETURN 1",),
        ("IF $IN[1] THEN", "RETURN 1", "ELSE", "RETURN 2", "ENDIF"),
        ("LOOP", "IF $IN[1] THEN", "RETURN 1", "ENDIF", "ENDLOOP"),
        ("WHILE TRUE", "IF $IN[1] THEN", "RETURN 1", "ENDIF", "ENDWHILE"),
        ("REPEAT", "RETURN 1", "UNTIL $IN[1]"),
        ("SWITCH $ACT_TOOL", "CASE 1", "RETURN 1", "DEFAULT", "RETURN 2", "ENDSWITCH"),
        ("SWITCH $ORI_TYPE", "CASE #VAR,#CONSTANT,#JOINT,#IGNORE", "RETURN 1", "ENDSWITCH"),
        ("GOTO LAST", "FIRST:", "RETURN 1", "LAST:", "GOTO FIRST"),
    ],
)
def test_function_that_ends_with_return(agrees: Agrees, lines: tuple[str, ...]) -> None:
    """Where every way comes to a RETURN there is nothing to say [CTL-09]."""
    agrees(function(*lines))


@pytest.mark.parametrize(
    "lines",
    [
        (),
        ("DECL INT I",),
        ("IF $IN[1] THEN", "RETURN 1", "ENDIF"),
        ("LOOP", "IF $IN[1] THEN", "RETURN 1", "ENDIF", "EXIT", "ENDLOOP"),
        ("WHILE $IN[1]", "RETURN 1", "ENDWHILE"),
        ("FOR $ACT_TOOL = 1 TO 2", "RETURN 1", "ENDFOR"),
        ("SWITCH $ACT_TOOL", "CASE 1", "RETURN 1", "ENDSWITCH"),
        ("SWITCH $ORI_TYPE", "CASE #VAR", "RETURN 1", "ENDSWITCH"),
        ("IF $IN[1] THEN", "RETURN 1", "ENDIF", "GOTO LAST", "LAST:"),
    ],
)
def test_function_that_can_end_without_return(agrees: Agrees, lines: tuple[str, ...]) -> None:
    """A way to ENDFCT is told as a note, for controllers accept it [CTL-09]."""
    agrees(function(*lines, mark=" ;> KRL306-"))


@pytest.mark.parametrize("lines", [("LOOP", "EXIT", "ENDLOOP"), ("GOTO LAST", "LAST:")])
def test_function_without_any_return(agrees: Agrees, lines: tuple[str, ...]) -> None:
    """A function that nowhere has a RETURN never has a result, which is a warning [CTL-09]."""
    agrees(function(*lines, mark=" ;> KRL306?"))


def test_what_is_never_reached_is_reported_once(agrees: Agrees) -> None:
    """The first statement behind an end is told, not all that follow; blocks in it neither."""
    agrees(
        routine(
            "DECL INT I",
            "I = 1",
            "LOOP",
            "  I = I + 1",
            "ENDLOOP",
            "IF $IN[1] THEN ;> KRL407-",
            "  I = 2",
            "ENDIF",
            "I = 3",
        )
    )


def test_what_a_goto_leads_to_is_reached(agrees: Agrees) -> None:
    """A label behind RETURN is reached by its GOTO."""
    agrees(routine("IF $IN[1] THEN", "GOTO LAST", "ENDIF", "RETURN", "LAST:", "$OUT[1] = TRUE"))


def test_depth_meets_no_limit(finds: Callable[..., list[Any]]) -> None:
    """Blocks may nest as deep as a file is long."""
    depth = 3_000
    text = routine(*["IF $IN[1] THEN"] * depth, "EXIT", *["ENDIF"] * depth)
    assert [depth + 2] == [found.region.line for found in finds({"NEG.src": text})]
