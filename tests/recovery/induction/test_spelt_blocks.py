"""Blocks whose closing words are spelt like those of others."""

import pytest

from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.language import CorpusFile
from recovery.induction.rounds import Induction
from recovery.induction.spelt_blocks import spelt_blocks
from recovery.negatives.negatives import NegativeSet

_WORDS = ("IF", "ENDIF", "FOR", "ENDFOR", "LOOP", "ENDLOOP")


@pytest.fixture(scope="module")
def blocks(toy: Grammar) -> Grammar:
    """The start with three blocks."""
    rules = "".join(
        f"    | {opener} eol statement* {closer} eol\n"
        for opener, closer in zip(_WORDS[::2], _WORDS[1::2], strict=True)
    )
    tokens = "".join(f"{word} : '{word}' ;\n" for word in _WORDS)
    text = toy.text.replace("    : simpleStatement eol\n", f"    : simpleStatement eol\n{rules}")
    return read(text.replace("HALT : 'HALT' ;\n", f"{tokens}HALT : 'HALT' ;\n"))


@pytest.mark.parametrize(
    ("text", "pairs"),
    [
        ("PICK A\nENDPICK\n", {("PICK", "ENDPICK")}),
        ("GLOBAL PICK A\nENDPICK\n", {("PICK", "ENDPICK")}),
        ("PREPICK A\nENDPICK\n", {("PREPICK", "ENDPICK")}),
        ("PICK A\nPICK B\nENDPICK\n", set()),  # not in balance
        ("PICK A\nOUTPICK\n", set()),  # no block of the start ends so
        ("PICK A\nEND\n", set()),
    ],
)
def test_closers_are_spelt_alike(blocks: Grammar, text: str, pairs: set[tuple[str, str]]) -> None:
    """One block shows its words, as three of the start have closers that are spelt so."""
    lexer = Recognizer(blocks).lexer
    corpus = CorpusLines([CorpusFile("a", text, frozenset("a"))], lexer)
    assert pairs == spelt_blocks(corpus, lexer)


def test_two_pairs_of_words_are_few(toy: Grammar) -> None:
    """Without three pairs of reserved words nothing is known of how closers are spelt."""
    lexer = Recognizer(toy).lexer
    corpus = CorpusLines([CorpusFile("a", "PICK A\nENDPICK\n", frozenset("a"))], lexer)
    assert set() == spelt_blocks(corpus, lexer)


def test_a_single_block_is_learnt(blocks: Grammar) -> None:
    """It stands wherever other blocks do, with any lines within, and with what divides it."""
    texts = (
        "PICK A\nWHEN 1\nHALT\nWHEN 2\nHALT\nWHEN 3\nHALT\nENDPICK\n",
        "HALT\n",
        "HALT\nHALT\n",
    )
    files = [CorpusFile(f"{n}", text, frozenset({f"{n}"})) for n, text in enumerate(texts)]
    induction = Induction(blocks, files, (), NegativeSet(()))
    for _ in induction.rounds():
        pass
    grown = Recognizer(induction.grammar)
    inner = "PICK B\nWHEN 7\nENDPICK\n"
    assert grown.accepts(f"LOOP\nPICK A\nWHEN 1\n{inner}ENDPICK\nENDLOOP\n")
    assert not grown.accepts("PICK A\nWHEN 1\nHALT\n")
