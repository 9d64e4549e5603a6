"""Which words a grammar reserves, which it uses, and which are names all the same."""

from grammar.notation.edits import AddAlternative, AddToken
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Group
from grammar.parser.recognizer import Recognizer
from recovery.forms.keywords import Vocabulary

VOCABULARY = Vocabulary(
    Recognizer(
        read("""grammar S;
program : (statement NEWLINE)* EOF ;
statement : STOP | TURN name | (ON | OFF) name | word '=' value ;
value : name | truth ;
truth : TRUE | FALSE ;
name : NAME | IN ;
word : STOP | TURN | ON | OFF | TRUE | SPARE ;
FALSE : 'FALSE' ;
IN : 'IN' ;
OFF : 'OFF' ;
ON : 'ON' ;
SPARE : 'SPARE' ;
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


def test_a_rule_of_words_has_nothing_else() -> None:
    """Each alternative is one token, by itself or through rules that are no more."""
    assert VOCABULARY.is_set_of_words("truth")
    assert not VOCABULARY.is_set_of_words("value")
    assert {"TRUE", "FALSE", "NAME", "IN"} == VOCABULARY.words_of("value")
    assert frozenset() == VOCABULARY.words_of("statement")


def test_a_choice_of_reserved_words_is_a_keyword() -> None:
    """A token with a value is none, and no choice with one."""
    stop, turn, on_or_off, other = VOCABULARY.grammar.by_name["statement"].alternatives
    assert isinstance(on_or_off.elements[0], Group)
    assert [True, True, True, False] == [
        VOCABULARY.is_keyword(a.elements[0]) for a in (stop, turn, on_or_off, other)
    ]
    assert not VOCABULARY.is_keyword(turn.elements[1])


def test_to_be_listed_among_all_words_is_no_use() -> None:
    """A new word is entered in such a list; a word that is only there is free."""
    assert ("word",) == VOCABULARY.word_lists
    assert VOCABULARY.is_written("TURN")
    assert not VOCABULARY.is_written("SPARE")
    assert (
        AddToken("A"),
        AddAlternative("word", "A"),
        AddToken("B"),
        AddAlternative("word", "B"),
    ) == VOCABULARY.reserve(["B", "A", "B"])


def test_a_reserved_word_may_stay_a_name() -> None:
    """It is entered where words are that are names elsewhere, and in no list of other words."""
    edits = (*VOCABULARY.reserve(["NEW"]), AddAlternative("statement", "NEW name"))
    assert "name" == VOCABULARY.names
    assert (
        AddToken("NEW"),
        AddAlternative("name", "NEW"),
        AddAlternative("statement", "NEW name"),
    ) == VOCABULARY.still_names(edits)


def test_a_word_is_in_all_rules_like_the_one_it_is_in() -> None:
    """Rules that share two words list one kind of word; lists of all words and of names do not."""
    whole = Vocabulary(Recognizer(read_file(GRAMMAR)))
    edits = (*whole.reserve(["NEW"]), AddAlternative("predefinedType", "NEW"))
    found = whole.in_like_rules(edits)
    assert (*edits[:-1], AddAlternative("type", "NEW"), edits[-1]) == found
    assert whole.in_like_rules((*edits[:-1], AddAlternative("criterion", "NEW"))) is None
    assert whole.in_like_rules((AddAlternative("predefinedType", "HALT"),)) is None
