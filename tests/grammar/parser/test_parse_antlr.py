"""Trees are those of ANTLR's parser, rule by rule and token by token."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from random import Random
from typing import Any

import pytest
from antlr4 import CommonTokenStream, InputStream
from antlr4.error.ErrorStrategy import BailErrorStrategy

from grammar._generated.KRLLexer import KRLLexer
from grammar._generated.KRLParser import KRLParser
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from grammar.parser.tree import ParseNode, Tree

#: A rule and how many children it has, or a token: kind, text, line, column, offset.
Item = tuple[object, ...]


@pytest.fixture(scope="module")
def parser(krl_recognizer: Recognizer) -> Parser:
    return Parser(krl_recognizer)


def antlr_items(text: str) -> Iterator[Item]:
    """The tree that ANTLR makes of a program, in the order of the text."""
    parser: Any = KRLParser(CommonTokenStream(KRLLexer(InputStream(text))))
    parser.removeErrorListeners()
    parser._errHandler = BailErrorStrategy()
    todo: list[Any] = [getattr(parser, parser.ruleNames[0])()]
    while todo:
        here = todo.pop()
        symbol = getattr(here, "symbol", None)
        if symbol is None:
            yield parser.ruleNames[here.getRuleIndex()], here.getChildCount()
            todo += reversed(list(here.getChildren()))
        elif symbol.type == -1:
            yield "EOF", "", symbol.line, symbol.column + 1, len(text)
        else:
            name = parser.symbolicNames[symbol.type]
            yield name, symbol.text, symbol.line, symbol.column + 1, symbol.start


def items(tree: Tree) -> Iterator[Item]:
    """Our tree in the same form."""
    for x in tree.root.walk():
        if isinstance(x, ParseNode):
            yield x.rule, len(x.children)
        else:
            yield x.kind, x.text, x.line, x.column, x.offset


def differences(parser: Parser, texts: Iterable[str]) -> list[tuple[str, Item, Item]]:
    """For each text whose trees differ its beginning, and what ANTLR and we have there first."""
    found = []
    for text in texts:
        tree = parser.parse(text)
        assert isinstance(tree, Tree), text
        pairs = zip([*antlr_items(text), ()], [*items(tree), ()], strict=False)
        differing = next(((a, b) for a, b in pairs if a != b), None)
        if differing is not None:
            found.append((text[:200], *differing))
    return found


def test_own_programs(parser: Parser, corpus: Mapping[Path, str]) -> None:
    """An eighth of the own corpus that parses, with line ends as ANTLR counts them."""
    # ANTLR ends lines at \n only
    texts = (text for path, text in corpus.items() if "programs" in path.parts)
    programs = [text for text in texts if "\r" not in text.replace("\r\n", "\n")]
    readable = [text for text in programs if parser.recognizer.accepts(text)]
    assert len(readable) > 100
    assert [] == differences(parser, Random(3).sample(readable, len(readable) // 8))


def test_every_alternative(parser: Parser) -> None:
    """The shortest program through each part of each rule."""
    grammar = parser.recognizer.grammar
    speller, sentences = Speller(grammar), Sentences(grammar)
    texts = {speller.text(t) for rule in sentences.reachable for t in sentences.through(rule)}
    assert len(texts) > 100
    assert [] == differences(parser, sorted(texts))


def test_random_sentences(parser: Parser) -> None:
    """200 random programs."""
    chance = Random(0)
    grammar = parser.recognizer.grammar
    speller, sentences = Speller(grammar), Sentences(grammar)
    texts = [speller.text(sentences.random(chance, chance.randint(5, 120))) for _ in range(200)]
    assert [] == differences(parser, texts)
