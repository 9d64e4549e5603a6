"""Which rules read a few tokens, as a whole sentence or as the beginning of one."""

import pytest

from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.lexer import ERROR, SKIPPED
from grammar.parser.recognizer import Recognizer
from recovery.forms.rule_matcher import RuleMatcher

RECOGNIZER = Recognizer(read_file(GRAMMAR.with_name("preliminary.g4")))
READERS = RuleMatcher(RECOGNIZER)


def kinds_of(text: str) -> tuple[int, ...]:
    lexer = RECOGNIZER.lexer
    return tuple(kind for x in lexer.lexemes(text) if (kind := lexer.kinds[x]) != SKIPPED)


@pytest.mark.parametrize(
    ("text", "inside", "outside"),
    [
        ("1", {"literal", "primary", "factor", "sum", "expression"}, {"variable", "index", "call"}),
        ("A", {"variable", "target", "type", "expression"}, {"literal", "call", "relation"}),
        ("[ 1 ]", {"index"}, {"variable", "expression"}),
        ("F ( )", {"call", "expression", "interruptAction"}, {"variable", "statement"}),
        ("A 1", {"component"}, {"expression", "variable"}),
        ("1 +", set(), {"sum", "expression"}),
    ],
)
def test_rules_are_those_of_which_the_tokens_are_a_sentence(
    text: str, inside: set[str], outside: set[str]
) -> None:
    """A rule is found when the tokens are the whole of it, no more and no less."""
    found = READERS.rules_for(kinds_of(text))
    assert inside <= found
    assert not outside & found


def test_a_block_is_known_by_the_line_that_opens_it() -> None:
    """The rules of several lines that begin with a line, and no others."""
    opened = READERS.multi_line_rules(kinds_of("IF A THEN\n"))
    assert "ifStatement" in opened
    assert not {"forStatement", "simpleStatement", "expression"} & set(opened)
    assert "loopStatement" in READERS.multi_line_rules(kinds_of("LOOP\n"))
    assert "ifStatement" not in READERS.multi_line_rules(kinds_of("IF A\n"))
    assert "halt" not in READERS.multi_line_rules(kinds_of("HALT"))


def test_what_a_rule_writes_for_a_token() -> None:
    """Words and signs are written as such, values by the name of their token."""
    [name], [number], [word], [sign] = map(kinds_of, ("A", "1", "PTP", "="))
    tokens = [
        (name, None),
        (number, None),
        (word, None),
        (sign, None),
        (name, "NEW"),
        (ERROR, None),
    ]
    assert ["NAME", "INTEGER", "PTP", "'='", "NEW", None] == list(map(READERS.text, tokens))
    assert [None, None, "PTP", "'='", "NEW", None] == list(map(READERS.sign, tokens))


def test_rules_of_values_read_names_and_more() -> None:
    """A rule of names alone is none of them, nor one that reads no name."""
    assert {"expression", "primary"} <= READERS.value_rules
    assert not {"literal", "variable"} & READERS.value_rules


def test_a_list_of_all_words_decides_nothing() -> None:
    """That a rule which reads any keyword reads this one is no meaning of its own."""
    listed = RuleMatcher(
        Recognizer(
            read("""grammar S;
program : (word '=' value NEWLINE)* EOF ;
value : NAME | truth ;
truth : TRUE ;
word : OFF | ON | STOP | TRUE | TURN ;
OFF : 'OFF' ;
ON : 'ON' ;
STOP : 'STOP' ;
TRUE : 'TRUE' ;
TURN : 'TURN' ;
ASSIGN : '=' ;
NAME : [A-Z]+ ;
NEWLINE : '\\n' ;
SPACE : ' '+ -> skip ;
""")
        )
    )
    true, stop = (listed.recognizer.lexer.kind_of[word] for word in ("TRUE", "STOP"))
    assert {"word"} == listed.keyword_lists
    assert [True, False] == [listed.is_more_than_a_name((kind,)) for kind in (true, stop)]
    assert [True, False] == [listed.may_be_a_name(kind) for kind in (true, stop)]
