"""Spelling: programs that lex to the tokens asked for and look as people write them."""

from collections.abc import Callable
from pathlib import Path

import pytest

from grammar.notation.edits import AddToken
from grammar.notation.g4 import read_file
from grammar.parser.lexer import EOF
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.reproducer.rendering import AbstractToken, TokenRenderer

PRELIMINARY = Path(__file__).parents[3] / "grammar" / "preliminary.g4"
Respell = Callable[..., str | None]


@pytest.fixture(scope="module")
def recognizer() -> Recognizer:
    return Recognizer(read_file(PRELIMINARY))


@pytest.fixture(scope="module")
def respell(recognizer: Recognizer) -> Respell:
    """Spells a text anew, the words given being meant as keywords."""
    spelling = TokenRenderer(recognizer)

    def respelled(text: str, *meant: str) -> str | None:
        lexemes = [t for t in recognizer.lexer.lexemes(text) if t]
        kinds = [kind for kind in recognizer.kinds(text) if kind != EOF]
        return spelling.text(
            [
                AbstractToken(kind, word.upper(), word.upper() if word.upper() in meant else None)
                for kind, word in zip(kinds, lexemes, strict=True)
            ]
        )

    return respelled


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("speed[3]=max(speed[3],limit)", "A[1] = B(A[1], C)"),
        ("home={Pos:x 10,y -2.5,s 'B10'}", "A = {B: C 1, D -1.0, E 'B0'}"),
        ("part.grip.$On = NOT(a AND b)", "A.B.C = NOT (D AND E)"),
        ("w = -1 + - z - 2", "A = -1 + -B - 2"),
        ("m = base:tool", "A = B : C"),
        ("again:", "A:"),
        ("DEF move ( p:in , q : out )", "DEF A(B :C, D :E)"),
        ("CHAR[8] n", "CHAR[1] A"),
        ('say ( "one" , "two" , "one" , #ON , TRUE )', 'A("A", "B", "A", #A, TRUE)'),
        ("x = 1 == 1 OR y<>'H0F'", "A = 1 == 1 OR B <> 'B0'"),
    ],
)
def test_blanks_stand_where_people_put_them(respell: Respell, text: str, expected: str) -> None:
    """Names and values get short texts, the same where they were, and signs their blanks."""
    assert respell(text) == expected


def test_blocks_are_indented(respell: Respell) -> None:
    """The body of a block stands two blanks in, the word that parts it does not."""
    text = "DEF p()\nIF a THEN\nLOOP\nb=1\nENDLOOP\nELSE\n\nREPEAT\nHALT\nUNTIL a\nENDIF\nEND\n"
    assert respell(text) == (
        "DEF A()\n"
        "  IF B THEN\n"
        "    LOOP\n"
        "      C = 1\n"
        "    ENDLOOP\n"
        "  ELSE\n"
        "\n"
        "    REPEAT\n"
        "      HALT\n"
        "    UNTIL B\n"
        "  ENDIF\n"
        "END\n"
    )


def test_words_that_are_meant_stay(respell: Respell) -> None:
    """A name that is meant as a keyword is written as it was, and opens its block."""
    text = "DEF p()\nswitch mode\ncase 1\nhalt\nendswitch\nEND"
    assert respell(text, "SWITCH", "CASE", "ENDSWITCH") == (
        "DEF A()\n  SWITCH B\n  CASE 1\n    HALT\n  ENDSWITCH\nEND"
    )


def test_an_unknown_character_stays(respell: Respell) -> None:
    """What no rule of the lexer knows is written as it was."""
    assert respell("x = ? 1") == "A = ? 1"


def test_tokens_that_would_grow_together_stand_apart(respell: Respell) -> None:
    """Where the usual blanks would make other tokens, there is one between any two."""
    assert respell("x = 1 . 2 + f ( y )") == "A = 1 . 2 + B ( C )"


def test_keywords_of_another_grammar_are_no_names(recognizer: Recognizer) -> None:
    """A name is called so that a wider grammar takes it for a name too."""
    wider = edited(recognizer, [AddToken("A"), AddToken("C")])
    name = recognizer.lexer.kind_of["NAME"]
    tokens = [AbstractToken(name, "SPEED"), AbstractToken(recognizer.lexer.kind_of["ASSIGN"], "=")]
    assert TokenRenderer(recognizer).text([*tokens, AbstractToken(name, "LIMIT")], wider) == "B = D"


def test_tokens_that_nothing_spells(recognizer: Recognizer) -> None:
    """There is no text for two names of which the first has to swallow the second."""
    header, name = (recognizer.lexer.kind_of[kind] for kind in ("HEADER", "NAME"))
    assert (
        TokenRenderer(recognizer).text([AbstractToken(header, "&"), AbstractToken(name, "X")])
        is None
    )
