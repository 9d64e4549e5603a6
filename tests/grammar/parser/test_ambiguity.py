"""A text is ambiguous when it has two derivations, counted one by one."""

from collections.abc import Callable, Sequence
from itertools import islice
from random import Random

import pytest

from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences
from tests.grammar.parser.readings import Readings

HEAD = "grammar T;\n"
WORDS = "IF THEN ELSE END A B C".split()
TOKENS = "".join(f"{word} : '{word}' ;\n" for word in WORDS)
SIGNS = "PLUS : '+' ;\nCOMMA : ',' ;\nNEWLINE : '\\n' ;\nSPACE : ' ' -> skip ;\n"


def grammar_of(*rules: str) -> Grammar:
    return read(HEAD + "\n".join(f"{rule} ;" for rule in rules) + "\n" + TOKENS + SIGNS)


def ambiguous(grammar: Grammar, text: str) -> bool:
    recognizer = Recognizer(grammar)
    assert recognizer.accepts(text)
    return is_ambiguous(recognizer, recognizer.start, recognizer.kinds(text))


# ------------------------------------------------------------------------- known by heart


@pytest.mark.parametrize(
    ("rules", "text", "expected"),
    [
        # the dangling ELSE, and what mends it
        (["s : i EOF", "i : IF A THEN i (ELSE i)? | B"], "IF A THEN IF A THEN B ELSE B", True),
        (["s : i EOF", "i : IF A THEN i (ELSE i)? | B"], "IF A THEN B ELSE B", False),
        (["s : i EOF", "i : IF A THEN i (ELSE i)? END | B"], "IF A THEN B ELSE B END", False),
        (["s : i EOF", "i : IF i (ELSE i)? END | B"], "IF IF B ELSE B END END", False),
        # operators of one level and of two
        (["s : e EOF", "e : A ('+' e)* "], "A + A", False),
        (["s : e EOF", "e : A ('+' e)* "], "A + A + A", True),
        (["s : e EOF", "e : t ('+' t)*", "t : A (',' A)*"], "A + A , A + A , A", False),
        # two rules for the same tokens
        (["s : (a | b) EOF", "a : A", "b : A"], "A", True),
        (["s : (a | b) EOF", "a : A B", "b : A C"], "A B", False),
        (["s : a B EOF", "a : A | b", "b : A"], "A B", True),
        # where one loop ends and the next begins
        (["s : a* b EOF", "a : A", "b : A*"], "A", True),
        (["s : a* b EOF", "a : A", "b : B A*"], "A A B A", False),
        (["s : a a EOF", "a : A? B?"], "A B", True),
        (["s : a a EOF", "a : A? B?"], "B A", False),
        # what may be empty
        (["s : a? A EOF", "a : B?"], "A", True),
        (["s : a A EOF", "a : B?"], "A", False),
        (["s : a* A EOF", "a : B?"], "A", True),
        # the same tokens twice in one rule are one reading
        (["s : A EOF | A EOF"], "A", False),
        (["s : A? A? EOF"], "A", False),
        (["s : (A | A B) B? EOF"], "A B", False),
    ],
)  # fmt: skip
def test_textbook_cases(rules: Sequence[str], text: str, expected: bool) -> None:
    """Two ways to derive a text are an ambiguity; two ways to write one rule are not."""
    assert expected == ambiguous(grammar_of(*rules), text)


def test_reading_may_begin_anywhere() -> None:
    """From a state in the middle only what is read from there on counts."""
    recognizer = Recognizer(grammar_of("s : t (IF t)? EOF", "t : (a | b) C? | B", "a : A", "b : A"))
    kinds = recognizer.kinds("A IF B")
    assert is_ambiguous(recognizer, recognizer.start, kinds)
    state, _ = recognizer.run(recognizer.start, kinds[:2])
    assert not is_ambiguous(recognizer, state, kinds[2:])
    assert is_ambiguous(recognizer, state, recognizer.kinds("A"))


def test_deep_nesting_is_looked_through() -> None:
    """An ambiguity a hundred brackets deep is found, and none is made up on the way."""
    rules = ("s : e EOF", "e : IF e THEN | x | y", "x : A B", "y : A C? B")
    for inner, expected in (("A C B", False), ("A B", True)):
        text = "IF " * 100 + inner + " THEN" * 100
        assert expected == ambiguous(grammar_of(*rules), text)


# ------------------------------------------------------------------- counted independently


@pytest.mark.parametrize("seed", range(40))
def test_it_is_what_counting_derivations_says(
    seed: int, random_grammar: Callable[[Random], Grammar]
) -> None:
    """On random grammars and sentences of them: ambiguous means two derivations or more."""
    chance = Random(seed)
    grammar = random_grammar(chance)
    recognizer = Recognizer(grammar)
    for _ in range(6):
        sentence = [*Sentences(grammar).random(chance, 6), "EOF"][-9:]
        kinds = [recognizer.lexer.kind_of[name] for name in sentence]
        count = len(list(islice(Readings(grammar, sentence), 3)))
        assert (count > 1) == is_ambiguous(recognizer, recognizer.start, kinds), sentence
