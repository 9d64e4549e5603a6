"""Setting out a text changes its layout and nothing else, and changes nothing the second time."""

import re
from collections.abc import Mapping
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.sentences import Sentences, Speller
from grammar.parser.tree import Tree
from grammar.syntax import ast
from grammar.syntax.build import builder, read_module
from grammar.syntax.formatter import Formatter, FormatterDefect, formatter
from grammar.syntax.source import Source
from grammar.syntax.walk import same

KRL = read_file(GRAMMAR)
SENTENCES, SPELLER = Sentences(KRL), Speller(KRL)


def laid_out(text: str) -> str:
    found = formatter().layout(text)
    assert isinstance(found, str), found
    return found


def in_routine(*lines: str) -> list[str]:
    """The lines of a routine, set out; its head and its end left out."""
    text = "\n".join(["DEF A()", *lines, "END", ""])
    return laid_out(text).split("\n")[1:-2]


# --------------------------------------------------------------------------- between tokens

SET = [
    ("if(a==b)and not c then|endif", "IF (a == b) AND NOT c THEN|ENDIF"),
    ("x=1", "x = 1"),
    ("x   =   y", "x = y"),
    ("x=a+b * c", "x = a+b * c"),
    ("x=a +b", "x = a + b"),
    ("x=a- -1", "x = a - -1"),
    ("x=- a", "x = -a"),
    ("x=not(a)", "x = NOT(a)"),
    ("x=a<>b", "x = a <> b"),
    ("x=a=<b", "x = a =< b"),
    ("x=a  :b", "x = a :b"),
    ("x=a . b [ 1 ]", "x = a.b [ 1 ]"),
    ("F (a ,b,  c )", "F (a,b, c )"),
    ("F()", "F()"),
    ("F(  )", "F( )"),
    ("x={x 1 ,y  2}", "x = {x 1,y 2}"),
    ("for i=1 to 3 step 2|endfor", "FOR i = 1 TO 3 STEP 2|ENDFOR"),
    ("lin{x 1}c_dis", "LIN {x 1} C_DIS"),
    ("trigger when distance = 1 delay=- 5 do x=1", "TRIGGER WHEN DISTANCE=1 DELAY=-5 DO x=1"),
    ("slin p with $vel=1", "SLIN p WITH $vel=1"),
    ("wait  sec\t0.5", "WAIT SEC 0.5"),
    ("x = 'hff' b_and 1e5", "x = 'hff' B_AND 1e5"),
    ("x=true", "x = TRUE"),
    ("x = #End", "x = #End"),
    ('x="A  ==b"', 'x = "A  ==b"'),
    ("Delay=Sec+Frame", "Delay = Sec+Frame"),
    ("halt   ", "HALT"),
]


@pytest.mark.parametrize(("text", "expected"), SET)
def test_tokens_of_a_statement(text: str, expected: str) -> None:
    """Keywords are in upper case; blanks stand where the style asks, else once as written."""
    assert expected.split("|") == in_routine(*text.split("|"))


DECLARED = [
    ("decl   Int a ,  b[ 2 ]", "DECL   INT a ,  b[ 2 ]"),
    ("e6pos  Frame", "E6POS  Frame"),
    ("decl frame f", "DECL FRAME f"),
    ("decl My_Frame  f", "DECL My_Frame  f"),
    ("ext  F(int :in,frame  :out )", "EXT  F(INT :IN,FRAME  :OUT )"),
    ("enum e End,stop", "ENUM e End,stop"),
]


@pytest.mark.parametrize(("text", "expected"), DECLARED)
def test_declarations_are_tables(text: str, expected: str) -> None:
    """In declarations only keywords and the names of predefined types change."""
    assert [expected] == in_routine(text)


def test_data_lists_are_tables() -> None:
    """In a data list nothing changes but keywords, indentation and blanks at the ends of lines."""
    text = "defdat  d  public\n  decl int  a = 1  \n\ta  = 2\n  ;c \nenddat"
    assert "DEFDAT  d  PUBLIC\nDECL INT  a = 1\na  = 2\n;c \nENDDAT" == laid_out(text)


def test_heads_of_routines_stay() -> None:
    """The templates of the controller write two blanks behind DEF, and they stay."""
    assert "GLOBAL DEF  a ( b:IN ,c )\nEND" == laid_out("global def  a ( b:in ,c )\nend")


# ------------------------------------------------------------------------------ indentation


def test_blocks_indent() -> None:
    """Two blanks a block; labels stand where the routine does; blank lines are empty."""
    expected = """\
IF a THEN
  HALT

  SWITCH b
    CASE 1
      LOOP
        EXIT
l:
      ENDLOOP
    DEFAULT
      REPEAT
        HALT
      UNTIL c
  ENDSWITCH
ELSE
  SPLINE
    SPL p
  ENDSPLINE
ENDIF""".split("\n")
    assert expected == in_routine(*[line.strip() or " \t" for line in expected])


def test_a_body_is_indented_where_its_first_statement_is() -> None:
    """Each routine keeps the way of its author; labels and what the pendant wrote do not count."""
    text = "DEF A()\n     HALT\nHALT\nEND\nDEF B()\n  l:\nHALT\n  HALT\n   END\nDEF C()\nEND\n"
    assert "DEF A()\n  HALT\n  HALT\nEND\nDEF B()\nl:\nHALT\nHALT\nEND\nDEF C()\nEND\n" == laid_out(
        text
    )
    fold = "   ;FOLD INI;%{PE}\n   HALT\n   ;ENDFOLD\n"
    text = f"DEF A()\n{fold}EXIT\n EXIT\nEND\n"
    assert f"DEF A()\n{fold}EXIT\nEXIT\nEND\n" == laid_out(text)


def test_comments_follow_the_next_line_of_code() -> None:
    """A comment is indented as what it stands before, blank lines and other comments between."""
    assert [";a", "", ";b", "IF a THEN", "  ;c", "  HALT", "ENDIF"] == in_routine(
        "   ;a", "", ";b", "IF a THEN", ";c", "HALT", "ENDIF"
    )


def test_comments_before_the_end_of_a_block() -> None:
    """Where one stood deeper than what ends a block or branch, it lies in the block."""
    lines = ["SWITCH a", "CASE 1", " ;in", "CASE 2", ";out", "CASE 3", ";deep", "  ENDSWITCH"]
    assert [
        "SWITCH a",
        "  CASE 1",
        "    ;in",
        "  CASE 2",
        "  ;out",
        "  CASE 3",
        ";deep",
        "ENDSWITCH",
    ] == in_routine(*lines)
    lines[6] = "\t;deep"
    assert "    ;deep" == in_routine(*lines)[6]
    assert ["IF a THEN", "  ;x", "ELSE", ";y", "ENDIF"] == in_routine(
        "IF a THEN", " ;x", "ELSE", ";y", "ENDIF"
    )


def test_comments_at_the_end_of_a_routine() -> None:
    """Before END they stand where the statements of the routine do, or where END does."""
    assert ["HALT", ";in"] == in_routine("HALT", "   ;in")
    assert ["  HALT", "  ;in", ";out"] == in_routine(" HALT", "   ;in", ";out")


def test_folds_do_not_indent() -> None:
    """What lies in a fold stands where it would without, and ENDFOLD where its FOLD does."""
    assert ["LOOP", "  ;FOLD a", "  HALT", "  ;ENDFOLD", "ENDLOOP"] == in_routine(
        "LOOP", ";FOLD a", "    HALT", "    ;ENDFOLD", "ENDLOOP"
    )
    assert [";FOLD a", "LOOP", ";ENDFOLD", "  HALT", "ENDLOOP"] == in_routine(
        " ;FOLD a", "LOOP", "   ;ENDFOLD", "HALT", "ENDLOOP"
    )


def test_what_the_teach_pendant_wrote_stays() -> None:
    """Nothing changes in a fold with parameters, on its own lines and on those between."""
    fold = [
        "   ;FOLD PTP P1 ;%{PE}%R 8.3,%P 1:PTP",
        " ;Params A=1;  B=2 ",
        "  x=1   ",
        "",
        "\t",
        "     ;FOLD inner",
        "ptp  xp1",
        "   ;ENDFOLD",
        "     ;ENDFOLD (PTP)",
    ]
    found = in_routine("LOOP", "x=1", *fold, "x=1", "ENDLOOP")
    assert ["LOOP", "  x = 1", *fold, "  x = 1", "ENDLOOP"] == found


# ----------------------------------------------------------------------- comments behind code


def test_comments_behind_code_keep_their_column() -> None:
    """A comment moves with its line, gives way where code grows, and never touches it."""
    assert [
        "LOOP       ;a",
        "  x = 1    ;b",
        "  yy = 12 ;c",
        "  HALT ;d",
        "  zz = 1\t;e",
        "ENDLOOP ;f ",
    ] == in_routine("LOOP       ;a", "x=1      ;b", "yy=12 ;c", "HALT;d", "zz=1\t;e", "ENDLOOP ;f ")


# -------------------------------------------------------------------------------- what stays


def test_lines_and_their_ends_stay() -> None:
    """Line ends, blank lines, header lines and the missing end of the last line stay."""
    text = "&ACCESS  rvp\r\n &REL 1 \r\ndef a()\n\n\rhalt\r\n\r\nend\r\n \r\n;x"
    assert "&ACCESS  rvp\r\n &REL 1 \r\nDEF a()\n\n\rHALT\r\n\r\nEND\r\n\r\n;x" == laid_out(text)


def test_syntax_errors_are_reported() -> None:
    """A text that is no program is not set out: its failures are given."""
    found = formatter().layout("DEF A()\nx=(\nEND\n", "a.src")
    assert isinstance(found, list)
    assert [("a.src", 2)] == [(failure.path, failure.line) for failure in found]


def test_what_would_say_something_else_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Were the formatter wrong, it would raise rather than give the text."""
    text = "DEF A()\nx=1 ;c\nEND\n"
    for wrong in (
        "DEF A()\nx=2 ;c\nEND\n",
        "DEF A()\nx=1 ;d\nEND\n",
        "DEF A()\nx=1 ;c\nEND",
        "END",
    ):
        monkeypatch.setattr(Formatter, "set_out", lambda _self, _tree, wrong=wrong: wrong)
        with pytest.raises(FormatterDefect):
            formatter().layout(text)


def test_deep_blocks() -> None:
    """Three thousand nested blocks are set out; the text grows in proportion only."""
    text = "DEF A()\n" + "loop\n" * 3_000 + "endloop\n" * 3_000 + "END\n"
    assert len(laid_out(text)) < 1_000_000


# -------------------------------------------------------------------------------------- laws


def keeps_its_laws(text: str) -> None:
    """Set out, a text says the same, has the same lines, comments and ends, and stays so."""
    found = laid_out(text)
    before, after = Source(text), Source(found)
    assert before.line_ends == after.line_ends
    assert [c.text for c in before.comments] == [c.text for c in after.comments]
    assert [(f.title, f.first, f.last) for f in before.folds] == [
        (f.title, f.first, f.last) for f in after.folds
    ]
    module, again = read_module(text), read_module(found)
    assert isinstance(module, ast.Module)
    assert isinstance(again, ast.Module)
    assert same(module, again)
    blanks = re.compile(r"[ \t]")
    assert blanks.sub("", text).upper() == blanks.sub("", found).upper()
    assert found == laid_out(found)


def test_own_programs_keep_their_laws(corpus: Mapping[Path, str]) -> None:
    """Every fourth own program that parses."""
    count = 0
    for path, text in list(corpus.items())[::4]:
        if "programs" in path.parts and isinstance(builder().parser.parse(text), Tree):
            keeps_its_laws(text)
            count += 1
    assert count > 25


BLANKS = st.sampled_from(["", "", " ", "  ", "\t", "     "])
COMMENTS = st.sampled_from(
    ["", "", "", ";c ", ";FOLD a", ";FOLD b;%{P}", ";ENDFOLD", '; "x', "\t;d", ";Params x=1"]
)


@given(data=st.data(), chance=st.randoms(use_true_random=True))
def test_random_programs_keep_their_laws(data: st.DataObject, chance: Random) -> None:
    """Any program of the grammar, with any blanks, comments, folds and letters."""
    lines = SPELLER.text(SENTENCES.random(chance, 60)).split("\n")
    written = []
    for line in lines:
        if data.draw(st.booleans()):
            written.append(data.draw(BLANKS) + data.draw(COMMENTS))
        if line.startswith("&"):
            written.append(line)
        else:
            shown = line.lower() if data.draw(st.booleans()) else line
            spread = (
                re.sub(" ", lambda _: data.draw(BLANKS) or " ", shown) if '"' not in line else line
            )
            written.append(data.draw(BLANKS) + spread + data.draw(BLANKS) + data.draw(COMMENTS))
    text = data.draw(st.sampled_from(["\n", "\r\n"])).join(written)
    keeps_its_laws(text)
