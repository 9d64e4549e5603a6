"""Syntax failures as findings: what is said, where, and what would mend it."""

from pathlib import Path

import pytest

from grammar.check.project.project_check import read_source
from grammar.diagnostics.diagnostic import Diagnostic, Fix
from grammar.diagnostics.expected_tokens import in_words
from grammar.diagnostics.open_blocks import lead, open_blocks
from grammar.diagnostics.syntax_errors.findings import MOST_LISTED, syntax_findings
from grammar.notation.generate import GRAMMAR
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from recovery.negatives.negatives import Negative, load

NEGATIVES = GRAMMAR.parents[1] / "corpus" / "negatives"
TO_PARSE = [negative for negative in load(NEGATIVES) if negative.phase == "parse"]


def findings(text: str, path: str = "A.src") -> list[Diagnostic]:
    failures = read_module(text, path)
    assert isinstance(failures, list), "the text can be read"
    return syntax_findings(failures, Source(text, path))


def only(*lines: str, path: str = "A.src") -> Diagnostic:
    """The one finding of a routine of these lines."""
    (found,) = findings("\n".join(["DEF A()", *lines, "END", ""]), path)
    return found


@pytest.mark.parametrize(
    ("line", "message", "new"),
    [
        ("ENDFOLD (INI)x", "; is missing before ENDFOLD", ";ENDFOLD"),
        ("FOLD INI;%{PE}", "; is missing before FOLD", ";FOLD"),
        ("moves slowly home", "a comment begins with a semicolon", None),
    ],
)
def test_a_comment_that_lost_its_sign(line: str, message: str, new: str | None) -> None:
    """Words that cannot be read are told as what they were, not as a statement gone wrong."""
    found = only(line)
    assert (message, new) == (found.message, found.fix and found.fix.replacement)


def mended(text: str, fix: Fix | None) -> str:
    """A text with a fix applied."""
    assert fix is not None
    assert fix.is_edit
    assert fix.region is not None
    source = Source(text)
    start = source.offset(fix.region.line, fix.region.column)
    end = source.offset(fix.region.end_line, fix.region.end_column)
    return f"{text[:start]}{fix.replacement}{text[end:]}"


def name_of(negative: Negative) -> str:
    assert negative.path is not None
    return negative.path.relative_to(NEGATIVES).as_posix()


#: Where the indentation says that a closer is missing, before the line that cannot be read.
BY_INDENTATION = {"control_flow/inner_if_not_closed.src": 9}


def test_first_finding_is_on_the_line_of_the_negative() -> None:
    """Every written negative of the phase ``parse`` is told first where it says."""
    told = {}
    for name, negative in zip(map(name_of, TO_PARSE), TO_PARSE, strict=True):
        first = next(iter(findings(negative.text, f"NEG{Path(name).suffix}")), None)
        wanted = ("error", BY_INDENTATION.get(name, negative.line))
        found = first and (first.severity, first.region.line)
        if found != wanted:
            told[name] = found, wanted
    assert len(TO_PARSE) > 500
    assert {} == told


@pytest.mark.parametrize(
    ("line", "message", "better"),
    [
        ("IF $IN[1] = TRUE THEN", "a comparison is written ==", "IF $IN[1] == TRUE THEN"),
        ("WHILE N = = 5", "a comparison is written ==", "WHILE N == 5"),
        ("N == 5", "an assignment is written =", "N = 5"),
        ("N := 5", "an assignment is written =", "N = 5"),
        ("IF N != 5 THEN", "KRL has no !=", "IF N <> 5 THEN"),
        ("IF $IN[1] && $IN[2] THEN", "KRL has no &&", "IF $IN[1] AND $IN[2] THEN"),
        ("B = !$IN[1]", "KRL has no !", "B = NOT $IN[1]"),
        ("IF $IN[1]  ; both", "THEN is missing", "IF $IN[1] THEN  ; both"),
        ("IF $IN[1] DO", "IF has THEN and no DO", "IF $IN[1] THEN"),
        ("WHILE $IN[1] DO", "WHILE has no DO", "WHILE $IN[1] "),
        ("FOR N = 1 TO 9 STEP=2", "STEP has no =", "FOR N = 1 TO 9 STEP 2"),
        ("INTERRUPT 5 ON", "the number stands behind ON", "INTERRUPT ON 5"),
        ("N = (1 + 2", ") is missing", "N = (1 + 2)"),
        ("$OUT[1 = TRUE", None, None),
        ("// a comment", "a comment begins with a semicolon", "; a comment"),
        ("X = -.5", "a number needs a digit before its point", "X = -0.5"),
        ("E = # OPEN", "no blank may stand between # and the constant", "E = #OPEN"),
        ("GLOBAL DECL INT N", "GLOBAL stands behind DECL", "DECL GLOBAL INT N"),
        ("PART_T LAST", "DECL is missing before PART_T", "DECL PART_T LAST"),
        ("ELSEIF $IN[2] THEN", "KRL has no ELSEIF", None),
        ("N = 7 MOD 2", "KRL has no MOD", None),
        ("WORK", "WORK alone is not a statement", None),
        ("HALT $OUT[1] = TRUE", "a second statement on this line", None),
        ("DECL INT WHILE", "WHILE is a keyword and cannot be a name", None),
        ('TEXT[] = "OPEN', "the text is not closed", None),
        ("DECL INT N = 5", "a routine has no initial values", None),
    ],
)
def test_usual_mistakes(line: str, message: str | None, better: str | None) -> None:
    """Mistakes that people make again and again are told by name, some with an edit."""
    text = f"DEF A()\n{line}\nEND\n"
    first = findings(text)[0]
    assert 2 == first.region.line
    if message is not None:
        assert message == first.message
    if better is not None:
        assert f"DEF A()\n{better}\nEND\n" == mended(text, first.fix)


@pytest.mark.parametrize("line", ["X = .5", "E = # OPEN"])
def test_a_spelling_of_one_program_alone_is_no_error(line: str) -> None:
    """What one program has and nothing confirms or refutes is a warning."""
    assert ["warning"] == [one.severity for one in findings(f"DEF A()\n{line}\nEND\n")]


def test_a_lost_beginning_is_one_finding() -> None:
    """However many lines stand outside for want of a header, that is told once, and what it is."""
    lost = [*(f"DECL INT N{n}" for n in range(4)), "END", "DEF B()", "END", "DECL INT M", ""]
    found = findings("\n".join(lost))
    assert [(1, "a routine begins with DEF"), (8, "a routine begins with DEF")] == [
        (one.region.line, one.fix.text if one.fix else "") for one in found
    ]


@pytest.mark.parametrize(
    ("opener", "closer"),
    [
        ("IF $IN[1] THEN", "ENDIF"),
        ("FOR N = 1 TO 2", "ENDFOR"),
        ("WHILE $IN[1]", "ENDWHILE"),
        ("REPEAT", "UNTIL"),
        ("LOOP", "ENDLOOP"),
        ("SPLINE", "ENDSPLINE"),
    ],
)
def test_a_block_that_is_not_closed_is_named(opener: str, closer: str) -> None:
    """The opener is told with its line; a LOOP has the controller's own number [CTL-10]."""
    first = findings(f"DEF A()\nHALT\n{opener}\nEND\n")[0]
    assert f"{opener.split(maxsplit=1)[0]} on line 3 is not closed" == first.message
    assert f"{closer} is missing" == first.reason
    assert ("KSS2144" if opener == "LOOP" else "KRL001") == first.code


@pytest.mark.parametrize(
    ("wrong", "message", "right"),
    [
        ("WAIT WAIT SEC 1", "WAIT stands twice", "WAIT SEC 1"),
        ("N = = 1", "= stands twice", "N = 1"),
        ("CALL_IT(1 1)", "1 stands twice", "CALL_IT(1)"),
        ("P[1={X 1}", "] is missing", "P[1]={X 1}"),
        ("N = (1 + 2 * 3", ") is missing", "N = (1 + 2 * 3)"),
        ("CALL_IT1)", "( is missing", "CALL_IT1()"),
        ("TOOL_DATA[2] SPINDLE", "= is missing", "TOOL_DATA[2]=SPINDLE"),
        ("FRAMES[2]X = 1", ". is missing", "FRAMES[2].X = 1"),
        ("PTP {A1 0 A2 0}", ", is missing", "PTP {A1 0, A2 0}"),
        ("WIAT SEC 1", "WIAT is not a word of KRL", "WAIT SEC 1"),
        ("N INT", "the type INT stands before the name", "INT N"),
        ("IF N == 1 TEN", "TEN is not a word of KRL", "IF N == 1 THEN"),
        ("GLOBAL INTERUPT DECL 3 WHEN N == 1 DO F()", "INTERUPT is not a word of KRL",
         "GLOBAL INTERRUPT DECL 3 WHEN N == 1 DO F()"),
        ("PTP {A1 0., A2 0}", "a number needs a digit behind its point", "PTP {A1 0.0, A2 0}"),
    ],
)  # fmt: skip
def test_the_token_that_mends_a_line_is_reported(wrong: str, message: str, right: str) -> None:
    """A token too many, too few or misspelt is named, and the edit is what makes the line right."""
    closer = "\nENDIF" if wrong.startswith("IF") else ""
    text = f"DEF A()\nHALT\n{wrong}{closer}\nEND\n"
    found = next(one for one in findings(text) if one.region.line == 3)
    assert message == found.message
    assert found.fix is not None
    assert found.fix.region is not None
    start = found.fix.region.column - 1
    line = wrong[:start] + str(found.fix.replacement) + wrong[found.fix.region.end_column - 1 :]
    assert "".join(right.split()) == "".join(line.split())


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("CIRC P1", "CIRC needs two points"),
        ("CIRC P1 C_DIS", "CIRC needs two points"),
        ("SCIRC", "SCIRC needs two points"),
        ("CIRC P1,", "CIRC needs two points"),
        ("LIN", "LIN needs a point"),
        ("PTP C_PTP", "PTP needs a point"),
        ("CASE", "a value is missing behind CASE"),
        ("INT", "a name is missing behind INT"),
        ("N = A B", "an operator is missing between A and B"),
        ("TRIGGER WHEN DISTANCE=0 DO $OUT[1]=TRUE", "DELAY is missing before DO"),
        ("TRIGGER WHEN PATH=-5 DO WORK() PRIO=5", "DELAY is missing before DO"),
        ("FOR N = 1 10", "TO is missing before 10"),
        ("WAIT SEC 0,5", "a number has a decimal point and no comma"),
        ("HALT 5", "5 is too much on this line"),
    ],
)
def test_what_is_missing_is_named(line: str, message: str) -> None:
    """What a statement needs is said in words of the robot, and not as a list of tokens."""
    text = f"SWITCH N\n{line}\nENDSWITCH" if line == "CASE" else line
    assert message == findings(f"DEF A()\nINT N\n{text}\nEND\n")[0].message


@pytest.mark.parametrize(
    ("line", "column"),
    [("INT zähler", 6), ("Ärger = 1", 1), ("größe(1)", 3), ("N = Maß + 1", 7), ("DEF größe()", 7)],
)
def test_a_letter_that_no_name_has(line: str, column: int) -> None:
    """A letter outside A to Z is told; a line of words is rather a comment."""
    found = findings(f"DEF A()\nEND\n{line}\nEND\n" if "DEF" in line else f"DEF A()\n{line}\nEND")
    letter = line[column - 1]
    assert (f"{letter} is not allowed in a name", column) == (
        found[0].message,
        found[0].region.column,
    )
    assert "a comment begins with a semicolon" == only("Den Greifer öffnen").message


@pytest.mark.parametrize(("wrong", "right"), [("ED", "END"), ("EDN", "END"), ("NED", "END")])
def test_a_closer_that_is_misspelt_is_found(wrong: str, right: str) -> None:
    """The line that was to close the file is told, and not the line that it opens with."""
    found = findings(f"DEF A()\nHALT\n{wrong}\n")[0]
    assert (f"{wrong} is not a word of KRL", 3) == (found.message, found.region.line)
    assert f"did you mean {right}?" == (found.fix and found.fix.text)


def test_crossed_blocks() -> None:
    """Of two blocks that cross it is the inner one that is not closed."""
    first = findings("DEF A()\nLOOP\nIF $IN[1] THEN\nENDLOOP\nENDIF\nEND\n")[0]
    assert ("IF on line 3 is not closed", 4) == (first.message, first.region.line)


def test_the_end_of_the_file() -> None:
    """What is missing at the very end is told on the last line that says something."""
    (found,) = findings("DEF A()\nHALT\n\n\n")
    assert ("DEF on line 1 is not closed", 2, 5) == (
        found.message,
        found.region.line,
        found.region.column,
    )


def test_expected_is_reported_in_words() -> None:
    """Without a name for the mistake, what could have stood there is told."""
    assert "FOR or SEC is missing before 5" == only("WAIT 5").message
    assert "a value is missing behind +" == only("N = 1 +").message


@pytest.mark.parametrize(
    ("line", "code", "message"),
    [
        ("N = M + 1", "KSS2039", "M is no constant"),
        ("N[2] = 1 + 2", "KSS2039", 'a data list cannot calculate: "+"'),
        ("INT N = M", "KRL001", "M is no constant"),
        ("REAL N = SQRT(2)", "KRL001", "SQRT is no constant"),
        ("FRAME F = {X M,Y 0}", "KRL001", "M is no constant"),
        ("BOOL B = TRU", "KRL001", "TRU is not a word of KRL"),
        ("INT N = 12 M", "KRL001", ", is missing"),
    ],
)
def test_a_data_list_works_nothing_out(line: str, code: str, message: str) -> None:
    """A value that is no constant is named; a line that only assigns it is an instruction."""
    (found,) = findings(f"DEFDAT A\n{line}\nENDDAT\n")
    assert (code, message) == (found.code, found.message)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("= 5", 'no line begins with "="'),
        ("XHOME PTP", "PTP stands at the beginning of its line"),
        ("N 5 =", "= is missing before 5"),
        ("N[1]X . = 5", '"." or "=" is missing before X'),
        ("DECL INT N 5", "5 is too much on this line"),
        ("I N THEN", "THEN belongs to IF, and this line begins with I"),
        ("N = {X 1,Y ,Z 3}", "Y has no value"),
        ("N = {X 1,Y 2Z 3}", '"," or "}" is missing before Z'),
        ("WAIT FOR N == 1 )", '")" closes nothing'),
    ],
)
def test_what_is_out_of_place(line: str, message: str) -> None:
    """What is in the wrong place, or lacks something before it, is told as such."""
    assert message == only(line).message


@pytest.mark.parametrize(
    ("expected", "words"),
    [
        ((), ""),
        (("NEWLINE",), "the end of the line"),
        ((",", "NEWLINE"), '"," or the end of the line'),
        (("ENDIF", "HALT", "IF", "LIN", "NAME", "NEWLINE"), "ENDIF or a statement"),
        (("INTEGER", "NAME", "REAL_NUMBER", "STRING", "("), "a value"),
        (("INTEGER", "REAL_NUMBER", "STRING", "{"), "a constant"),
        (("BOOL", "INT", "NAME", "REAL"), "a type"),
        (("AT_MOST", "==", "*", "THEN"), "THEN or an operator"),
        (("EOF", "HEADER"), "the end of the file"),
    ],
)
def test_words_for_tokens(expected: tuple[str, ...], words: str) -> None:
    """Tokens that people have one word for are told by it."""
    assert words == in_words(expected)


def test_what_follows_is_left_out() -> None:
    """An opener that cannot be read makes its closer fail, which is not told."""
    assert ["a comparison is written =="] == [
        found.message for found in findings("DEF A()\nIF N = 1 THEN\nHALT\nENDIF\nEND\n")
    ]


def test_only_so_many_are_reported() -> None:
    """A file of which no line can be read is told in bounded length."""
    found = findings("DEF A()\n" + "5 5\n" * (MOST_LISTED + 50) + "END\n")
    assert MOST_LISTED + 1 == len(found)
    assert "50 more unreadable lines" in found[-1].message


def test_too_deep_is_no_error() -> None:
    """What only we cannot do is a warning, and says so."""
    (found,) = findings("DEF A()\nN = " + "(" * 500 + "1" + ")" * 500 + "\nEND\n")
    assert ("KRL003", "warning") == (found.code, found.severity)


def test_failures_far_out_on_a_line() -> None:
    """On an enormous line only what was expected is told."""
    (found,) = findings("DEF A()\nN = " + "1 + " * 20_000 + "\nEND\n")
    assert ("a value is missing behind +", 80_005) == (found.message, found.region.column)


def test_open_blocks() -> None:
    """Lines know the blocks around them, whatever is not closed in between."""
    text = "DEF A()\nLOOP\nIF X THEN\nENDLOOP\nGLOBAL DEF B()\nEND\nWAIT FOR X\n"
    found = open_blocks(Source(text), range(1, 9))
    assert [None, "DEF", "LOOP", "IF", "DEF", "DEF", "DEF", "DEF"] == [
        block and block.word for _, block in sorted(found.items())
    ]


@pytest.mark.parametrize(
    ("line", "word"),
    [("  endif ; done", "ENDIF"), ("global def A()", "DEF"), ("; IF", ""), ("$OUT[1]", "")],
)
def test_lead(line: str, word: str) -> None:
    """The word that says what a line is."""
    assert word == lead(line)


@pytest.mark.parametrize(
    ("lines", "opener", "place"),
    [
        (["IF A THEN", "  IF B THEN", "    HALT", "ENDIF", "HALT"], 4, 6),
        (["IF A THEN", "  IF B THEN", "    HALT", "  ENDIF", "HALT"], 3, 7),
        (["IF A THEN", "  HALT", "ELSE", "  HALT", "HALT"], 3, 7),
        (["FOR I = 1 TO 2", "  WHILE B", "    HALT", "ENDFOR", "HALT"], 4, 6),
        (["LOOP", "  SWITCH I", "    CASE 1", "      HALT", "ENDLOOP"], 4, 7),
        (["LOOP", "  LOOP", "    HALT", "  ENDLOOP", "  HALT"], 3, 8),
        (["FOR I = 1 TO 2", "HALT", "FOR i = 1 TO 2", "HALT", "ENDFOR"], 3, 5),
        (["IF A THEN", "HALT", "HALT"], 3, 6),
        (["IF A THEN", "  ; nothing", "HALT", "HALT"], 3, 5),
        (["IF A THEN", "  IF B THEN", "    HALT", "ELSE", "  HALT", "ENDIF"], 4, 6),
        (["IF A THEN", "  IF B THEN", "    HALT", "  ELSE", "    HALT", "ELSE", "ENDIF"], 4, 8),
    ],
)
def test_block_by_indentation(lines: list[str], opener: int, place: int) -> None:
    """The block that is not closed, and where, follow from how its lines are indented."""
    text = "\n".join(["DEF NEG()", "DECL INT I", *lines, "END", ""])
    source = Source(text, "NEG.src")
    (found,) = read_source(source).diagnostics
    assert f"on line {opener} is not closed" in found.message
    assert place == found.region.line
