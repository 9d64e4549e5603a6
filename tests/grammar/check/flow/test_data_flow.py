"""What becomes of data: values, counters, waits, and what other files rely on."""

from collections.abc import Callable
from pathlib import Path

import pytest

from grammar.check.analysis.context import Context
from grammar.check.analysis.likely_names import LikelyNames
from grammar.check.project.batch import CheckOptions, check_paths
from grammar.diagnostics.diagnostic import Diagnostic

Agrees = Callable[..., None]
Finds = Callable[..., list[Diagnostic]]


def routine(*lines: str) -> str:
    return "\n".join(["DEF NEG()", "DECL INT I, N", "DECL BOOL B", *lines, "END"])


USED = ("$ANOUT[1] = I + N", "$FLAG[1] = B")


@pytest.mark.parametrize(
    "lines",
    [
        ["N = 1", "B = TRUE", "I = N + 1"],
        ["N = I ;> KRL409?", "I = 1", "B = TRUE"],
        ["I = I + 1 ;> KRL409?", "N = 1", "B = I > 1"],
        ["N = 1", "B = TRUE", "IF $IN[1] THEN", "I = 2", "ELSE", "I = 3", "ENDIF"],
        ["N = 1", "IF B THEN ;> KRL409?", "I = 2", "ENDIF", "B = TRUE", "I = 3"],
        [
            "N = 1",
            "B = TRUE",
            "LOOP",
            "IF N > 5 THEN",
            "EXIT",
            "ENDIF",
            "N = I ;> KRL415-",
            "I = N",
            "ENDLOOP",
        ],
        ["FOR I = 1 TO N ;> KRL409?", "B = I > 1", "ENDFOR", "N = 1"],
        ["SET(I, N)", "B = TRUE"],
        ["DECL STATE_T S", "N = 0", "B = TRUE", 'SREAD("1", S, N, "%d", I)'],
        [
            "DECL STATE_T S",
            "DECL CHAR T[9]",
            "N = 0",
            "B = TRUE",
            'SWRITE(T[], S, N, "%d", I) ;> KRL409?',
        ],
        ["REPEAT", "I = 1", "N = 2", "B = I == N", "UNTIL B"],
    ],
)
def test_values(agrees: Agrees, lines: list[str]) -> None:
    """A variable is read too early where no way to the place gives it a value [SCO-03]."""
    text = routine(*lines, *USED) + "\nDEF SET(A:OUT, B:OUT)\nDECL INT A, B\nA = 1\nB = A\nEND"
    agrees(text, with_data=True)


@pytest.mark.parametrize(
    "lines",
    [
        ["IF $IN[1] THEN", "I = 2", "ENDIF", "N = I ;> KRL415-"],
        ["IF $IN[1] THEN", "I = 2", "ELSE", "I = 3", "ENDIF", "N = I"],
        ["IF $IN[1] THEN", "I = 2", "ELSE", "HALT", "RETURN", "ENDIF", "N = I"],
        ["SWITCH $MODE_OP", "CASE #T1", "I = 2", "ENDSWITCH", "N = I ;> KRL415-"],
        ["SWITCH $MODE_OP", "CASE #T1", "I = 2", "DEFAULT", "I = 1", "ENDSWITCH", "N = I"],
        ["IF $IN[1] THEN", "I = 2", "ENDIF", "IF $IN[1] THEN", "N = I", "ENDIF"],
        [
            "B = FALSE",
            "IF $IN[1] THEN",
            "B = TRUE",
            "I = 2",
            "ENDIF",
            "IF B THEN",
            "N = I",
            "ENDIF",
        ],
        ["FOR N = 1 TO 2", "I = N", "ENDFOR", "N = I"],
        ["N = 0", "WHILE N < 2", "N = N + 1", "I = N", "ENDWHILE", "N = I"],
        ["IF $IN[1] THEN", "GOTO BEHIND", "ENDIF", "I = 1", "BEHIND:", "N = I ;> KRL415-"],
        ["IF $IN[1] THEN", "I = 1", "GOTO BEHIND", "ENDIF", "I = 2", "BEHIND:", "N = I"],
        ["LOOP", "IF $IN[1] THEN", "EXIT", "ENDIF", "I = 1", "ENDLOOP", "N = I ;> KRL415-"],
        ["LOOP", "IF $IN[1] THEN", "I = 1", "EXIT", "ENDIF", "ENDLOOP", "N = I"],
    ],
)
def test_values_on_some_ways(agrees: Agrees, lines: list[str]) -> None:
    """Where a way leads past each assignment, and no condition rules it out, there is a note."""
    text = routine("B = TRUE", "N = 1", *lines, "$ANOUT[1] = N", "$FLAG[1] = B")
    agrees(text, with_data=True)


def test_names_in_texts(agrees: Agrees) -> None:
    """A variable that VARSTATE is asked for may have no value."""
    line = 'IF VARSTATE("I") == #INITIALIZED THEN'
    agrees(routine("N = 1", "B = TRUE", line, "N = I", "ENDIF", *USED), with_data=True)


def test_unused(agrees: Agrees) -> None:
    """Variables and parameters that nothing reads are noted at their declarations."""
    text = """DEF NEG()
  DECL INT A ;> KRL117-
  DECL INT B ;> KRL117-
  B = 1
  WORK(1, 2)
END
DEF WORK(C:IN, D:IN) ;> KRL117-
  DECL INT C, D
  $ANOUT[1] = C
END"""
    agrees(text, with_data=True)


def test_counters(agrees: Agrees) -> None:
    """A counter belongs to its loop until that ends [CTL-05]."""
    agrees(
        routine(
            "FOR I = 1 TO 5",
            "IF $IN[1] THEN",
            "I = 7 ;> KRL410?",
            "ENDIF",
            "FOR I = 1 TO 2 ;> KRL410?",
            "ENDFOR",
            "ENDFOR",
            "I = 3",
        )
    )


def test_itself(agrees: Agrees) -> None:
    """What is assigned to itself is a slip; behind ON_ERROR_PROCEED a question."""
    agrees(routine("I = 1", "I = (i) ;> KRL411?", "ON_ERROR_PROCEED", "I = I", "$BASE = $BASE"))


def test_waits(agrees: Agrees) -> None:
    """Nothing changes the variables of a routine while it waits."""
    agrees(
        routine(
            "B = $IN[1]",
            "WAIT FOR B ;> KRL412?",
            "WAIT FOR FALSE ;> KRL412-",
            "WAIT FOR 2<1 ;> KRL412?",
            "WAIT FOR 1>2 ;> KRL412?",
            "WAIT FOR NOT ((1==1) OR $IN[1]) ;> KRL412?",
            "WAIT FOR (1<=1) EXOR (1>=1) ;> KRL412?",
            "WAIT FOR $IN[1] AND (1<>1) ;> KRL412?",
            "WAIT FOR $IN[1] AND (#T1==#T2) ;> KRL412?",
            "WAIT FOR $IN[1] OR (#T1==#T2)",
            "WAIT FOR 0.1<>0.1",
            "WAIT FOR TRUE",
            "WAIT FOR B OR $IN[2]",
            "WAIT FOR $FLAG[1]",
            "WAIT FOR $FLAG[2] AND $IN[1] ;> KRL413-",
            "WAIT FOR $IN[1] AND $FLAG[2] AND $IN[2] ;> KRL413-",
            "WAIT FOR $IN[1] OR $FLAG[2]",
            "WAIT FOR $IN[1] EXOR $FLAG[2]",
            "WAIT FOR $CYCFLAG[2] ;> KRL413-",
            "WAIT FOR $CYCFLAG[1]",
            "WAIT FOR $FLAG[2] == TRUE ;> KRL413-",
            "WAIT FOR NOT $FLAG[2]",
            "$FLAG[1] = TRUE",
            "$CYCFLAG[1] = $IN[1]",
        )
    )


INTERRUPTS = """DEF NEG()
  INTERRUPT DECL 10 WHEN $IN[1] DO WORK() {mark}
  INTERRUPT DECL 11 WHEN $IN[2] DO WORK()
  INTERRUPT DECL 300 WHEN $IN[3] DO WORK() ;> KRL503
  INTERRUPT ON 11
END
DEF WORK()
  HALT
END
"""


@pytest.mark.parametrize("switch", ["INTERRUPT ON 10", "INTERRUPT ON", "INTERRUPT ON N"])
def test_interrupts_of_a_project(agrees: Agrees, switch: str) -> None:
    """An interrupt may be switched on in another file, by number, with all, or by a variable."""
    agrees(INTERRUPTS.format(mark=";> KRL516?"), with_data=True)
    other = f"DEF OTHER()\n{switch}\nEND\n"
    data = "DEFDAT OTHER\nDECL INT N=10\nENDDAT\n"
    agrees({"NEG.src": INTERRUPTS.format(mark=""), "OTHER.src": other, "OTHER.dat": data})


@pytest.mark.parametrize(
    ("switch", "fix"),
    [
        ("INTERRUPT ON 12", "did you mean 10?"),  # 11 is on
        ("INTERRUPT OFF 34", None),
        ("INTERRUPT DISABLE 34", None),
    ],
)
def test_an_interrupt_that_nothing_declares(finds: Finds, switch: str, fix: str | None) -> None:
    """The number is told where it is switched, with a declared one that is near and never on."""
    files = {"NEG.src": INTERRUPTS.format(mark=""), "OTHER.src": f"DEF OTHER()\n{switch}\nEND\n"}
    found = [one for one in finds(files) if one.path == "OTHER.src"]
    assert [("KRL517", "warning", 2, fix)] == [
        (one.code, one.severity, one.region.line, one.fix and one.fix.text) for one in found
    ]
    never_on = [one.code for one in finds(files)].count("KRL516")
    assert (0 if fix else 1) == never_on


@pytest.mark.parametrize("declared", ["12", "N"])
def test_an_interrupt_that_may_be_declared(agrees: Agrees, declared: str) -> None:
    """Any file may declare it, by its number or by a variable; the system has its own numbers."""
    other = "DEF OTHER()\nINTERRUPT ON 12\nINTERRUPT OFF 3\nEND\n"
    third = f"DEF THIRD(N)\nINT N\nINTERRUPT DECL {declared} WHEN $IN[1] DO OTHER()\nEND\n"
    agrees({"OTHER.src": other, "THIRD.src": third})


@pytest.mark.parametrize(
    ("other", "mark"),
    [
        ("HALT", ";> KRL515-"),
        ("$OUT[5] = FALSE", ""),
        ("$OUT[5] = $IN[1]", ""),
        ("$OUT[$ADVANCE] = FALSE", ""),
        ("$OUT[6] = FALSE", ";> KRL515-"),
        ("PULSE($OUT[5], TRUE, 0.5)", ""),
        ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[5] = FALSE", ""),
        ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[5] = TRUE ;> KRL515-", ";> KRL515-"),
    ],
)
def test_outputs_of_a_project(agrees: Agrees, other: str, mark: str) -> None:
    """An output may be reset in another file, and under the name of a signal."""
    files = {
        "NEG.src": f"DEF NEG()\nSIGNAL LAMP $OUT[5]\nLAMP = TRUE {mark}\nEND\n",
        "OTHER.src": f"DEF OTHER()\n{other}\nEND\n",
    }
    agrees(files, with_data=True)


@pytest.mark.parametrize(
    ("body", "mark"),
    [
        ("$OUT[1] = N > 0", ";> KRL302?"),
        ("IF $IN[1] THEN\n$OUT[1] = N > 0\nENDIF", ""),
        ("N = 1\n$OUT[1] = N > 0", ""),
        ('IF VARSTATE("N") == #INITIALIZED THEN\n$OUT[1] = N > 0\nENDIF', ""),
        ("IF $IN[1] THEN\nRETURN\nENDIF\n$OUT[1] = N > 0", ""),
        ("IF $IN[1] THEN\nHALT\nENDIF\n$OUT[1] = N > 0", ";> KRL302?"),
        ("SWITCH M\nCASE 1\n$OUT[1] = N > 0\nDEFAULT\nHALT\nENDSWITCH", ";> KRL302?"),
        ("OTHER(N)", ";> KRL302?"),
        ("IF $IN[1] THEN\nOTHER(N)\nELSE\n$OUT[1] = N > 0\nENDIF", ";> KRL302?"),
        ("IF $IN[1] THEN\nOTHER(N)\nENDIF", ""),
        ("ASKS(N)", ""),
    ],
)
def test_arguments_left_out(agrees: Agrees, body: str, mark: str) -> None:
    """An argument may be left out where the routine can do without it [SCO-13]."""
    called = f"DEF CALLED(M:IN, N:IN)\nDECL INT M, N\n{body}\n$OUT[2] = M > 0\nEND\n"
    text = "DEF OTHER(N:IN)\nDECL INT N\n$OUT[3] = N > 0\nEND\n"
    text += "GLOBAL DEF ASKS(N:IN)\nDECL INT N\n"
    text += 'IF VARSTATE("N") == #INITIALIZED THEN\n$OUT[3] = N > 0\nENDIF\nEND\n'
    files = {"NEG.src": f"DEF NEG()\nCALLED(1) {mark}\nCALLED(1, 2)\nEND\n", "CALLED.src": called}
    agrees({**files, "OTHER.src": text})


def test_folds(agrees: Agrees) -> None:
    """Every fold is closed, and nothing is closed that is no fold."""
    agrees("DEF NEG()\n;FOLD A ;> KRL705?\nHALT\n;FOLD B\n;ENDFOLD\nEND")
    agrees("DEF NEG()\n;FOLD A\nHALT\nENDFOLD (A) ;> KRL705? KRL102 KRL101\nEND")
    agrees("DEF NEG()\n;ENDFOLD ;> KRL705?\nHALT\n;FOLD B\n;ENDFOLD\nEND")
    agrees("DEF NEG()\nINT FOLD\n;FOLD A ;> KRL705?\nFOLD = 5\n$ANOUT[1] = FOLD\nEND")


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_a_fold_without_its_semicolon(tmp_path: Path, ending: str) -> None:
    """What cannot be read for a semicolon that is missing is one finding."""
    lines = ("DEF NEG()", ";FOLD A", "HALT", "ENDFOLD", "END", "")
    (tmp_path / "neg.src").write_bytes(ending.join(lines).encode())
    found = check_paths([tmp_path], CheckOptions(), jobs=1).diagnostics
    assert [("KRL001", 4)] == [(one.code, one.region.line) for one in found]


@pytest.mark.parametrize(
    ("lines", "mark"),
    [
        (["A = TRUE", "IF A == FALSE THEN", "HALT", "ENDIF", "A = 1.5"], True),
        (["A = TRUE", "A = 1"], False),
        (["A = 1", "A = 2.5", "A = 3"], False),
        (["A = TRUE", "A = FALSE", "A = 1", "A = 2"], False),
        (["A = 1", "A = -2", 'A = "X"'], True),
        (["CELL[1].N = 1", "CELL[2].N = 2", 'CELL[3].N = "x"'], True),
        (["CELL.N = 1", "CELL.M = 2", "CELL.DONE = TRUE"], False),
        (["TEXT[1] = 65", "TEXT[2] = 66", 'TEXT[3] = "C"'], False),
    ],
)
def test_undeclared_variables_of_two_kinds(
    finds: Callable[..., list[Diagnostic]], lines: list[str], mark: bool
) -> None:
    """An undeclared variable is one kind of value in all places: one that differs is a slip."""
    found = finds({"NEG.src": "\n".join(["DEF NEG()", *lines, "END"])}, is_complete=None)
    assert mark == any(one.code == "KSS1446" for one in found)


def test_a_variable_without_a_value_because_of_a_slip(agrees: Agrees) -> None:
    """It is told at the misspelt assignment alone."""
    text = routine("INT COUNTER", "COUNTRE = 1 ;> KRL101?", "$OV_PRO = COUNTER")
    agrees({"neg.src": text}, is_complete=None, with_data=True, ignored=("KRL117", "KRL702"))


def test_slips_are_sought_once_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However many routines read too early, the names of the file are collected as often."""
    collected: list[Context] = []
    init = LikelyNames.__init__

    def counted(self: LikelyNames, context: Context) -> None:
        collected.append(context)
        init(self, context)

    monkeypatch.setattr(LikelyNames, "__init__", counted)
    works = []
    for count in (10, 20):
        collected.clear()
        texts = [f"DEF A{i}()\nINT I\nU{i}=1\n$OV_PRO=I\nEND\n" for i in range(count)]
        (tmp_path / "a.src").write_text("".join(texts), encoding="ascii")
        found = check_paths([tmp_path], CheckOptions(), jobs=1).diagnostics
        assert count == sum(one.code == "KRL409" for one in found)
        works.append(len(collected))
    assert works[0] == works[1]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("DEFFCT INT NEG()\nHALT\nRETUR 1\nENDFCT\n", "KRL306"),
        ("DEF NEG()\nINTERRUPT DECL 21 WHEN $IN[1] DO NEG()\nINTERRUPTT ON 21\nEND\n", "KRL516"),
    ],
)
def test_a_misspelt_keyword_is_told_alone(text: str, code: str, tmp_path: Path) -> None:
    """What the line is meant to do is not missed as well."""
    (tmp_path / "neg.src").write_text(text, encoding="utf-8")
    result = check_paths([tmp_path], CheckOptions(), jobs=1)
    found = [one for one in result.diagnostics if one.severity != "note"]
    assert ["KRL001"] == [one.code for one in found], code
