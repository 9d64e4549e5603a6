"""The facts of KRL, and the cutting of lines they rest on."""

from itertools import pairwise
from pathlib import Path

import pytest

from grammar.parser.syntax_cases import read_cases
from recovery.negatives.language_facts import adjacent, violation
from recovery.negatives.negatives import load
from recovery.negatives.tokens import lines
from support.files.decode import Decoded, decode
from support.files.tables import read_table

CORPUS = Path(__file__).parents[3] / "corpus"
SYNTAX = Path(__file__).parents[2] / "grammar" / "syntax_cases"
SPELLINGS = {
    "name": "COUNT",
    "number": "7",
    "string": '"A"',
    "bits": "'B1'",
    "enum": "#ON",
    "truth": "TRUE",
    "type": "INT",
    "any": "COUNT",
    "start": "",
    "end": "",
}


def in_routine(body: str) -> str:
    return f"DEF NEG()\n{body}\nEND\n"


def test_own_programs_break_no_fact() -> None:
    """The facts hold for every program of the own corpus."""
    broken = {}
    checked = 0
    for path in (CORPUS / "programs").rglob("*"):
        if path.suffix.lower() in (".src", ".dat", ".sub"):
            source = decode(path.read_bytes())
            assert isinstance(source, Decoded), path
            checked += 1
            if found := violation(source.text):
                broken[path.name] = found
    assert {} == broken
    assert checked > 50


def test_grammatical_negatives_break_no_fact() -> None:
    """What only the checker or the run can reject breaks no fact of the syntax."""
    grammatical = [n for n in load(CORPUS / "negatives") if n.phase != "parse"]
    assert len(grammatical) > 50
    assert [] == [(n.path, violation(n.text)) for n in grammatical if violation(n.text)]


def test_syntax_cases_break_no_fact() -> None:
    """Nor does what the grammar is known to read: soft keywords, old spellings, rare forms."""
    texts = (path.read_text("utf-8") for path in SYNTAX.glob("*.txt"))
    valid = [case for text in texts for case in read_cases(text) if not case.is_error]
    assert len(valid) > 100
    assert {} == {case.title: found for case in valid if (found := violation(f"{case.source}\n"))}


def test_files_may_hold_little_or_much() -> None:
    """Empty files, headers, comments, several routines and any line ends break no fact."""
    assert violation("") is None
    assert violation("&ACCESS RVP\n&REL 3 ) = (\n; nothing (\n") is None
    assert violation("GLOBAL DEF A ( )\rEND\r\r\nDEFFCT INT[] B(X:IN)\r\nENDFCT") is None
    assert violation('DEFDAT A PUBLIC\nINT I = 3, J = 4\nTEXT[] = "x"\nENDDAT\n') is None


@pytest.mark.parametrize(
    ("body", "line", "fact"),
    [
        ("X = 1 * / 2", 2, "an operator has an operand behind it"),
        ("X = 1\nX = (1", 3, "a bracket is closed on its line"),
        ("X = [1)", 2, "a closing bracket belongs to an opening one"),
        ('X = "1', 2, "a string is closed on its line"),
        ("IF X = 1 THEN\nENDIF", 2, "an expression has no equals sign"),
        ("IF X == 1\nENDIF", 2, "THEN ends the line of IF"),
        ("IF X THEN Y = 1\nENDIF", 2, "nothing follows this word"),
        ("WHILE X THEN\nENDWHILE", 2, "THEN ends the line of IF"),
        ("WHILE X DO\nENDWHILE", 2, "two operands have an operator"),
        ("FOR I = 1 STEP 2\nENDFOR", 2, "FOR has TO"),
        ("FOR I == 1 TO 2\nENDFOR", 2, "an equals sign gives the counter"),
        ("FOR I = 1 TO 2 STEP = 2\nENDFOR", 2, "an expression has no equals sign"),
        ("FOR I = 1 TO 2 BY 2\nENDFOR", 2, "two operands have an operator"),
        ("WAIT X", 2, "FOR or SEC follows WAIT"),
        ("WAIT SEC", 2, "WAIT waits for something"),
        ("INTERRUPT 5 ON", 2, "INTERRUPT is followed by"),
        ("INTERRUPT DECL 5 DO X()", 2, "INTERRUPT DECL has WHEN"),
        ("INTERRUPT ON = 5", 2, "an equals sign has no place"),
        ("TRIGGER DISTANCE = 0 DELAY = 0 DO X()", 2, "WHEN follows TRIGGER"),
        ("TRIGGER WHEN DISTANCE = 0 DELAY = 0 X()", 2, "TRIGGER has DO"),
        ("GOTO A B", 2, "GOTO names one label"),
        ("PTP P X = 1", 2, "a motion gives values only behind WITH"),
        ("A = B = C", 2, "an expression has no equals sign"),
        ("A = B HALT", 2, "two operands have an operator"),
        ("A = 1 + ENDIF", 2, "a reserved word is no operand"),
        ("A = INT", 2, "a predefined type is no operand"),
        ("A = MAX(REAL)", 2, "a reserved word is no operand"),
        ("A[1] TRUE", 2, "a line that begins with a variable"),
        ("A[1] 'B1'", 2, "a line that begins with a variable"),
        ("$OUT[1]", 2, "a line that begins with a variable"),
        ("A.B + 1", 2, "a line that begins with a variable"),
        ("A == 1", 2, "an expression is no statement"),
        ("A() B()", 2, "a call is followed by nothing"),
        ("A(1) = 2", 2, "a call is followed by nothing"),
        ("IF X THEN\nLOOP\nENDIF\nENDLOOP", 4, "ENDLOOP closes its block"),
        ("IF X THEN\nELSE\nELSE\nENDIF", 4, "ELSE stands once"),
        ("LOOP\nELSE\nENDLOOP", 3, "ELSE stands once"),
        ("CASE 1", 2, "CASE stands in a SWITCH"),
        ("SWITCH X\nA = 1\nCASE 1\nENDSWITCH", 3, "SWITCH is followed by its first CASE"),
        ("SPLINE\nEND", 3, "ENDSPLINE closes its block"),
        ("END\nA = 1", 3, "nothing stands outside"),
        ("DEF B()\nEND", 2, "END closes its block before the next DEF"),
        ("END\nDEF B", 3, "the head of a routine ends with its parentheses"),
        ("END\nDEF B()\nREPEAT", 5, "UNTIL closes its block"),
        ("END\nDEFDAT B\nLOOP\nENDLOOP\nENDDAT\nDEF C()", 4, "a data list has no statements"),
        ("END\nDEF B()\nEND\nDEFDAT C", 6, "ENDDAT closes its block"),
    ],
)
def test_broken_facts_are_named(body: str, line: int, fact: str) -> None:
    """Every kind of fact is noticed, at its line and by its name."""
    found = violation(in_routine(body))
    assert found is not None
    assert line == found.line
    assert found.fact.startswith(fact)


@pytest.mark.parametrize(
    ("text", "fact"),
    [
        ("DEFDAT NEG\n HALT\nENDDAT\n", "a data list has no statements"),
        ("DEFDAT NEG\n LIN P\nENDDAT\n", "a data list has no statements"),
        ("DEFDAT NEG\n WORK()\nENDDAT\n", "a data list has no statements"),
        ("DEFDAT NEG\n EXT WORK()\n SPTP=3\n CONTINUE=1\n INT I=3\nENDDAT\n", None),
        ("DEF NEG()\n INT I=3\nEND\n", "only a data list gives initial values"),
        ("DEF NEG()\n E6POS P={X 1}\nEND\n", "only a data list gives initial values"),
        ("DEF NEG()\n E6POS P\n E6POS={X 1}\nEND\n", None),
        ("DEF NEG()\n DECL E6POS P={X 1}\nEND\n", "only a data list gives initial values"),
        (
            "DEF NEG()\n DECL GLOBAL INT I\nEND\n",
            "the variables of a routine are neither global nor constant",
        ),
        (
            "DEF NEG()\n DECL CONST INT I=3\nEND\n",
            "the variables of a routine are neither global nor constant",
        ),
        ("DEF NEG()\n GLOBAL INTERRUPT DECL 3 WHEN A DO B()\n DECL INT I\n I=3\nEND\n", None),
        ("DEF NEG(7)\nEND\n", "a parameter is a name with its size and mode"),
        ("DEF NEG(INT A)\nEND\n", "a parameter is a name with its size and mode"),
        ("DEF NEG(A,)\nEND\n", "a parameter is a name with its size and mode"),
        ("DEF NEG(A:IN,B[,]:OUT,C)\nEND\n", None),
    ],
)
def test_routines_and_data_lists_differ(text: str, fact: str | None) -> None:
    """Statements are of routines, initial values and constants of data lists."""
    found = violation(text)
    assert fact == (found and found.fact)


def test_the_last_line_shows_that_a_block_is_open() -> None:
    """A program that ends too early breaks a fact."""
    found = violation("DEF A()\nX = 1\n")
    assert found is not None
    assert "END closes its block" == found.fact


def test_every_pair_of_the_table_can_occur() -> None:
    """Each pair of kinds is met when its tokens are written side by side, and breaks a fact."""
    for left, right in adjacent():
        text = f"{SPELLINGS.get(left, left)} {SPELLINGS.get(right, right)}".strip()
        (line,) = lines(text)
        kinds = ["start", *line.kinds, "end"]
        wanted = (left, "name" if right == "any" else right)
        assert wanted in pairwise(kinds), text
        assert violation(in_routine(text)) is not None, text


def test_table_is_in_its_form() -> None:
    """The table has three columns, a reason in every row, and no pair twice."""
    head, *rows = read_table("recovery.negatives", "adjacent.tsv")
    assert ["left", "right", "reason"] == head
    assert [] == [row for row in rows if not row[2]]
    pairs = [(a, b) for left, right, _ in rows for a in left.split() for b in right.split()]
    assert len(pairs) == len(set(pairs))


@pytest.mark.parametrize(
    ("text", "lead", "kinds"),
    [
        ("", "", ""),
        ("  ; IF", "", ""),
        (" &ACCESS RVP", "", ""),
        ('x = "a;b" ; c', "X", "name = string"),
        ("global interrupt decl 3", "INTERRUPT", "name name DECL number"),
        ("DECL GLOBAL ENUM E IF, END", "ENUM", "DECL name name name name , name"),
        ("R = {IF 1, X: THEN 'B1'}", "R", "name = { name number , name : name bits }"),
        ("A.ENDIF=#IF", "A", "name . name = enum"),
        ("END END", "END", "END name"),
        ("a=<b<>c>=1.5E-3", "A", "name =< name <> name >= number"),
        ("True int", "TRUE", "truth type"),
        ('("', "", "( other"),
    ],
)
def test_lines_are_cut_into_kinds(text: str, lead: str, kinds: str) -> None:
    """Words are reserved only where they cannot be names; comments and headers have no tokens."""
    (line,) = lines(text)
    assert lead == line.lead
    assert kinds == " ".join(line.kinds)
