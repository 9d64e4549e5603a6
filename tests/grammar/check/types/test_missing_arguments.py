"""A call with fewer arguments than all others, of a routine that is in no file [SCO-13]."""

from collections.abc import Callable

import pytest

Agrees = Callable[..., None]

OTHERS = "DEF OTHERS ( )\n" + "BAS (#BASE,2)\nBAS (#TOOL,1)\nP00 (#INIT,1,,0)\n" * 2 + "END\n"


def _cell(*lines: str) -> dict[str, str]:
    """A program with some lines beside one that calls BAS four times and P00 twice."""
    body = "".join(f"{line}\n" for line in lines)
    return {"cell.src": f"DEF CELL ( )\n{body}END\n", "others.src": OTHERS}


@pytest.mark.parametrize(
    "lines",
    [
        ["BAS (#TOOL) ;> KRL302?"],
        ["BAS () ;> KRL302?"],
        ["BAS (#TOOL) ;> KRL302?", "P00 (#INIT,1)"],  # P00 is called in two other places only
        ["BAS (#TOOL,)"],
        ["BAS (#TOOL)", "BAS (#BASE)"],  # two are no slip
        ["BAS (#TOOL,1,2)", "BAS (#TOOL)"],  # nor does the number vary for one alone
    ],
)
def test_one_call_with_fewer(agrees: Agrees, lines: list[str]) -> None:
    """It is told once at least three others agree, and only if it is the only exception."""
    agrees(_cell(*lines), is_complete=None, ignored=("KRL701",))


@pytest.mark.parametrize(
    "lines",
    [
        ["BAS (#TOOL,1,2) ;> KRL301-"],
        ["BAS (#TOOL,1,2)"] * 2,
        ["BAS (#PTP_PARAMS,1,2)"],  # another command may have more
    ],
)
def test_one_call_with_more(agrees: Agrees, lines: list[str]) -> None:
    """It is told where all calls with its command have one number, and three do."""
    agrees(_cell("BAS (#TOOL,4)", *lines), is_complete=None, ignored=("KRL701",))


def test_a_package_has_optional_arguments(agrees: Agrees) -> None:
    """What is known of a routine says more than its other calls."""
    cell = "DEF CELL ( )\n" + "RSI_MOVECORR ()\n" * 4 + "RSI_MOVECORR (1)\nEND\n"
    agrees({"cell.src": cell}, is_complete=None, packages=frozenset({"RSI"}))


def test_other_commands_may_have_fewer(agrees: Agrees) -> None:
    """With the same command, which is the first argument, all other calls have to agree."""
    lines = ["BAS (#INITMOV)"] * 2 + ["BAS (#TOOL,3)", "BAS (#TOOL) ;> KRL302?"]
    agrees(_cell(*lines), is_complete=None, ignored=("KRL701",))


def test_a_routine_at_hand_is_judged_by_what_it_reads(agrees: Agrees) -> None:
    """Its parameters are known, so the other calls say nothing."""
    files = _cell("BAS (#TOOL)")
    files["bas.src"] = "DEF BAS (C:IN,N:IN )\nDECL MODUS C\nINT N\nEND\n"
    agrees(files, is_complete=None, ignored=("KRL701", "KRL117"))
