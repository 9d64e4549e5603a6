"""Words and texts that no shown file has, at places that are open to them."""

import pytest

from grammar.notation.edits import apply
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.notation.wellformed import misuse, problem
from grammar.parser.recognizer import Recognizer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.grammar_view import GrammarView
from recovery.induction.language import CorpusFile
from recovery.induction.open_classes import OPENINGS, open_choices, rare_words
from recovery.induction.rounds import Induction
from recovery.negatives.negatives import Negative, NegativeSet

_GRAMMAR = """grammar Toy;

program : (line NEWLINE)* EOF ;

line
    : GO expression (FAST | SLOW)?
    | TURN expression (',' expression)? (FAST | SLOW)?
    | MOVE expression
    | SAY (BITS | TEXT)
    | variable '=' expression
    ;

expression : primary (('+' | '-' | OVER | MOD) primary)* ;

primary : '-'? NUMBER | variable | '(' expression ')' ;

variable : name index? ;

name : NAME ;

index : '[' expression ']' ;

GO : 'GO' ;
TURN : 'TURN' ;
MOVE : 'MOVE' ;
SAY : 'SAY' ;
FAST : 'FAST' ;
SLOW : 'SLOW' ;
OVER : 'OVER' ;
MOD : 'MOD' ;
COMMA : ',' ;
ASSIGN : '=' ;
PLUS : '+' ;
MINUS : '-' ;
LPAREN : '(' ;
RPAREN : ')' ;
LBRACKET : '[' ;
RBRACKET : ']' ;
BITS : '\\'' [01]+ '\\'' ;
TEXT : '"' ~["\\n]* '"' ;
NAME : [A-Z]+ ;
NUMBER : [0-9]+ ;
NEWLINE : '\\n' ;
SPACE : ' '+ -> skip ;
"""

#: A word of a single origin, which says that more may stand in its place.
_RARE = frozenset({"SLOW"})


def _opened(text: str) -> Grammar:
    """Return a grammar with all that can be opened in it."""
    grammar = read(text)
    for kind in OPENINGS:
        for step in kind(GrammarView(Recognizer(grammar), ()), _RARE):
            grammar = apply(grammar, step.edits)
    return grammar


@pytest.fixture(scope="module")
def opened() -> Grammar:
    return _opened(_GRAMMAR)


@pytest.mark.parametrize(
    "text",
    [
        "GO A CREEP\n",
        "TURN A, B CREEP\n",
        "FLY A[1]\n",
        "FLY A SLOW\n",
        "FLY A, B + 1 CREEP\n",
        "SAY ' 1 01 '\n",
    ],
)
def test_what_no_file_shows(opened: Grammar, text: str) -> None:
    """New words beside words of a choice and at the head of a line; blanks in quotes."""
    both = (Recognizer(grammar).accepts(text) for grammar in (read(_GRAMMAR), opened))
    assert (False, True) == tuple(both)


@pytest.mark.parametrize(
    "text", ["GO A WITH B\n", "MOVE A B\n", "A = B BY C\n", "FLY 1\n", "A - 1\n", "SAY ' '\n"]
)
def test_what_stays_closed(opened: Grammar, text: str) -> None:
    """Words between operands, behind them where none is shown, ahead of values; empty texts."""
    assert not Recognizer(opened).accepts(text)


def test_what_is_open_is_opened_once(opened: Grammar) -> None:
    """An open grammar is well formed, and nothing is left to open."""
    assert (None, None) == (problem(opened), misuse(opened))
    assert opened == _opened(opened.text)


@pytest.mark.parametrize(("words", "accepted"), [("HOLD REST STOP", True), ("HOLD REST", False)])
def test_a_word_alone(words: str, accepted: bool) -> None:
    """Any word is a line where three are, once, whatever words are names too."""
    lines = "".join(f"    | {word}\n" for word in words.split())
    tokens = "".join(f"{word} : '{word}' ;\n" for word in [*words.split(), "FAR"])
    text = _GRAMMAR.replace("    | MOVE expression\n", f"    | MOVE expression\n{lines}")
    text = text.replace("name : NAME ;", "name : NAME | FAR ;").replace(
        "GO : 'GO'", f"{tokens}GO : 'GO'"
    )
    opened = _opened(text)
    assert (accepted, opened) == (Recognizer(opened).accepts("WAIT\n"), _opened(opened.text))


def test_blanks_need_an_example() -> None:
    """Without blanks between other quotes there are none."""
    text = _GRAMMAR.replace('~["\\n]*', "[A-Z]*")
    assert not Recognizer(_opened(text)).accepts("SAY '0 1'\n")


def test_two_words_are_few() -> None:
    """No statement of any word where only two words begin one with an operand."""
    text = _GRAMMAR.replace("MOVE expression", "MOVE NUMBER")
    assert not Recognizer(_opened(text)).accepts("FLY A\n")


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        (["GO A FAST\nTURN A\n", "SAY '1'\n"], {"GO", "FAST", "TURN", "SAY"}),
        (["GO A FAST\nTURN A\n", "GO A\nTURN A\nSAY '1'\n"], {"FAST", "SAY"}),
        (["GO A FAST\nTURN A\n"], set()),
    ],
)
def test_words_of_a_single_origin_are_rare(texts: list[str], expected: set[str]) -> None:
    """They say how many more there are, where there is another origin."""
    lexer = Recognizer(read(_GRAMMAR)).lexer
    files = [CorpusFile(f"{n}", text, frozenset({f"{n}"})) for n, text in enumerate(texts)]
    assert expected == rare_words(lexer, CorpusLines(files, lexer))


def test_a_choice_without_a_rare_word_stays_closed() -> None:
    """Words that several origins have each are all there are."""
    view = GrammarView(Recognizer(read(_GRAMMAR)), ())
    assert [] == list(open_choices(view, {"GO"}))
    assert len(list(open_choices(view, {"FAST"}))) == 1


@pytest.mark.parametrize(
    ("negative", "is_struck", "expected"),
    [
        ("GO\n", False, [0, 1, 2]),
        ("GO\n", True, [1, 2]),
        ("GO A BACK\n", False, [0, 2]),
        ("BACK A\n", False, [0, 1]),
    ],
)
def test_a_growth_ends_with_it(negative: str, is_struck: bool, expected: list[int]) -> None:
    """All is opened at the end but what was struck out and what accepts a negative."""
    texts = ["GO A FAST\nTURN B, C\n", "SAY '1'\nMOVE A\nGO B SLOW\n"]  # GO alone is of both
    files = [CorpusFile(f"{n}", text, frozenset({f"{n}"})) for n, text in enumerate(texts)]
    grammar = read(_GRAMMAR)
    view = GrammarView(Recognizer(grammar), ())
    wanted = [step for kind in OPENINGS for step in kind(view, _RARE)]
    rejected = NegativeSet([Negative(None, negative, "it is none", "parse", line=1)])
    struck = [wanted[0].edits] if is_struck else ()
    induction = Induction(grammar, files, (), rejected, struck=struck)
    *_, opened, last = induction.rounds()
    assert [wanted[n].title for n in expected] == [step.title for step in opened.taken]
    assert ((), True) == (last.taken, induction.is_finished)
