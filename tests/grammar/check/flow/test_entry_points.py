"""BRAKE and RESUME outside of interrupts, and first motions of programs; by rule."""

from collections.abc import Callable

import pytest

from grammar.check.project.project_check import CheckOptions, Content, found_in_project, recheck

Agrees = Callable[..., None]

WORK = """DEF WORK()
  BRAKE{mark5}
  RESUME{mark6}
END
"""
BAS = "DEF BAS(CMD:IN, VALUE:IN)\nDECL BAS_COMMAND CMD\nDECL REAL VALUE\nEND\n"
NOTED = WORK.format(mark5=" ;> KRL505-", mark6=" ;> KRL506-")
MARKED = WORK.format(mark5=" ;> KRL505?", mark6=" ;> KRL506?")
PLAIN = WORK.format(mark5="", mark6="")


@pytest.mark.parametrize(
    ("main", "is_complete", "work"),
    [
        ("WORK()", True, MARKED),
        ("WORK()", False, NOTED),
        ("HALT", False, MARKED),
        ("INTERRUPT DECL 5 WHEN $IN[1] DO WORK()", True, PLAIN),
        ("INTERRUPT DECL 5 WHEN $IN[1] DO STEP_IN()", True, PLAIN),
    ],
)
def test_what_no_interrupt_calls(agrees: Agrees, main: str, is_complete: bool, work: str) -> None:
    """A routine that no interrupt leads to is told, where all that calls it is known [INT-11]."""
    text = f"DEF NEG()\n{main}\nEND\n{work}DEF STEP_IN()\nWORK()\nEND\n"
    agrees(text.replace("STEP_IN", "STEPIN"), is_complete=is_complete)


@pytest.mark.parametrize(
    ("work", "other"),
    [
        (NOTED, "HALT"),
        (PLAIN, "WORK()"),
        ("GLOBAL " + PLAIN, "HALT"),
        (PLAIN.replace("()", "(N :IN)", 1).replace("BRAKE", "INT N\nBRAKE"), "HALT"),
    ],
)
def test_a_program_that_only_missing_files_may_call(agrees: Agrees, work: str, other: str) -> None:
    """In a backup with gaps it is possible that an interrupt calls it, so that it is a note."""
    files = {"NEG.src": f"DEF NEG()\n{other}\nEND\n", "WORK.src": work}
    agrees(files, is_complete=False)


def test_an_interrupt_of_another_module_may_call(agrees: Agrees) -> None:
    """What another module calls, by interrupt or not, is left alone."""
    agrees(
        {
            "NEG.src": "DEF NEG()\nINTERRUPT DECL 5 WHEN $IN[1] DO WORK()\nEND\n",
            "WORK.src": PLAIN,
        }
    )
    agrees({"NEG.src": "DEF NEG()\nEND\n", "WORK.src": MARKED})


@pytest.mark.parametrize(
    "files",
    [
        {"neg.src": "DEF NEG()\n{}END\n" + PLAIN},
        {"neg.src": "DEF NEG()\n{}END\n", "work.src": PLAIN},
    ],
)
def test_a_line_that_cannot_be_read_may_declare_an_interrupt(files: dict[str, str]) -> None:
    """Its syntax error is the only finding; the routine that it names is not outside interrupts."""
    for line, codes in (
        ("INTERRUPT DECL 20 WHEN $IN[6]=TRUE DO WORK()\n", ["KRL001"]),
        ("INTERRUPT DECL 20 WHEN $IN[6]=TRUE DO PLAY()\n", ["KRL001", "KRL505", "KRL506"]),
    ):
        given = [Content(path, "", text.format(line).encode()) for path, text in files.items()]
        options = CheckOptions(is_complete=True)
        found = found_in_project(given, recheck(given, options, {}))
        assert codes == [one.code for one in found if one.severity != "note"]


@pytest.mark.parametrize(
    "lines",
    [
        ("PTP $POS_ACT", "LIN $POS_ACT"),
        ("SPTP $POS_ACT",),
        ("PTP {A1 0, A2 -90, A3 90, A4 0, A5 0, A6 0}",),
        ("PTP {X 500, Y 0, Z 600, A 0, B 0, C 0, S 2, T 10}",),
        ("PTP {X 500, Y 0, Z 600, A 0, B 0, C 0} ;> KRL514?",),
        ("LIN $POS_ACT ;> KRL514?", "PTP $POS_ACT"),
        ("$OUT[1] = TRUE", "BAS(#VEL_PTP, 50)", "SLIN $POS_ACT ;> KRL514?"),
        (
            "IF $IN[1] THEN",
            "LIN $POS_ACT ;> KRL514?",
            "ENDIF",
            "CIRC $POS_ACT, $POS_ACT ;> KRL514?",
        ),
        ("WORK()", "LIN $POS_ACT"),
        ("SPLINE", "SPL $POS_ACT", "ENDSPLINE", "LIN $POS_ACT"),
    ],
)
def test_first_motions(agrees: Agrees, lines: tuple[str, ...]) -> None:
    """A program that nobody calls begins with a complete PTP [MOT-10]."""
    text = "\n".join(
        ["DEF NEG()", "BAS(#INITMOV, 0)", *lines, "END", "DEF WORK()", "PTP $POS_ACT", "END", ""]
    )
    agrees({"NEG.src": text, "BAS.src": BAS})


def test_called_programs_may_begin_with_anything(agrees: Agrees) -> None:
    """What another module calls, or sets nothing up, begins where its caller stood."""
    main = "DEF NEG()\nPTP $POS_ACT\nOTHER()\nEND\n"
    other = "DEF OTHER()\nBAS(#INITMOV, 0)\nLIN $POS_ACT\nEND\n"
    agrees({"NEG.src": main, "OTHER.src": other, "BAS.src": BAS})
    agrees({"NEG.src": "DEF NEG()\nLIN $POS_ACT\nEND\n"})
