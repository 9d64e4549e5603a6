"""The project's grammars, its corpus, and slow plain readings of grammar data as a measure."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import (
    CharSet,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
)
from grammar.parser.recognizer import Recognizer

CORPUS = GRAMMAR.parents[1] / "corpus"
SUFFIXES = frozenset({".src", ".dat", ".sub"})

#: Where a match that begins at an index can end.
Ends = frozenset[int]
Step = Callable[[Element, int], Ends]


@pytest.fixture(scope="session")
def krl() -> Grammar:
    """The grammar of the day, which grows: only laws that hold for any grammar are asked of it."""
    return read_file(GRAMMAR)


@pytest.fixture(scope="session")
def preliminary() -> Grammar:
    """The restrictive start, which stays: facts are read from it."""
    return read_file(GRAMMAR.with_name("preliminary.g4"))


@pytest.fixture(scope="session")
def krl_recognizer(krl: Grammar) -> Recognizer:
    return Recognizer(krl)


@pytest.fixture(scope="session")
def recognizer(preliminary: Grammar) -> Recognizer:
    """A recogniser of the restrictive start."""
    return Recognizer(preliminary)


@pytest.fixture(scope="session")
def corpus() -> Mapping[Path, str]:
    """The text of every file of the own corpus, the negatives among them, in a fixed order."""
    return {path: _decoded(path.read_bytes()) for path in sorted(_corpus_files())}


def _corpus_files() -> Iterable[Path]:
    for folder in (CORPUS / "programs", CORPUS / "negatives"):
        yield from (p for p in folder.rglob("*") if p.suffix.lower() in SUFFIXES)


def _decoded(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


# ------------------------------------------------------------------------- slow readings


def _sequence_ends(elements: Sequence[Element], start: int, step: Step) -> Ends:
    reached = frozenset([start])
    for element in elements:
        reached = frozenset(end for i in reached for end in _element_ends(element, i, step))
    return reached


def _element_ends(element: Element, start: int, step: Step) -> Ends:
    match element:
        case Group(alternatives=alternatives):
            return frozenset(
                end for a in alternatives for end in _sequence_ends(a.elements, start, step)
            )
        case Repeat(item=item, operator="?"):
            return _element_ends(item, start, step) | {start}
        case Repeat(item=item, operator=operator):
            reached = _element_ends(item, start, step)
            grown = reached
            while grown:
                grown = frozenset(e for i in grown for e in _element_ends(item, i, step)) - reached
                reached |= grown
            return reached | {start} if operator == "*" else reached
        case _:
            return step(element, start)


def _lexer_ends(grammar: Grammar, rule: Rule, text: str, start: int) -> Ends:
    def cases(code: int) -> set[int]:
        letter = chr(code)
        folded = grammar.case_insensitive and letter.isascii()
        return {ord(letter.upper()), ord(letter.lower())} if folded else {code}

    def step(element: Element, i: int) -> Ends:
        match element:
            case Reference(name=name):
                return frozenset(
                    end
                    for a in grammar.by_name[name].alternatives
                    for end in _sequence_ends(a.elements, i, step)
                )
            case Literal(text=wanted):
                found = text[i : i + len(wanted)]
                same = len(found) == len(wanted) and all(
                    ord(c) in cases(ord(w)) for c, w in zip(found, wanted, strict=True)
                )
                return frozenset([i + len(wanted)] if same else [])
            case CharSet(ranges=ranges):
                fits = i < len(text) and any(
                    low <= code <= high for code in cases(ord(text[i])) for low, high in ranges
                )
                return frozenset([i + 1] if fits else [])
            case _:
                raise AssertionError(element)

    return _sequence_ends((Reference(rule.name, (0, 0)),), start, step)


@pytest.fixture(scope="session")
def lexer_ends() -> Callable[[Grammar, Rule, str, int], Ends]:
    """``lexer_ends(grammar, rule, text, start)``: where a match of a lexer rule can end."""
    return _lexer_ends


def _parse(grammar: Grammar, tokens: Sequence[str]) -> tuple[bool, list[frozenset[str]]]:
    tried: list[set[str]] = [set() for _ in range(len(tokens) + 1)]

    def step(element: Element, i: int) -> Ends:
        assert isinstance(element, Reference | Literal)
        name = grammar.token_of(element)
        rule = grammar.by_name.get(name)
        if rule is not None and not rule.is_lexer:
            return of_rule(name, i)
        tried[i].add(name)
        return frozenset([i + 1] if i < len(tokens) and tokens[i] == name else [])

    @cache
    def of_rule(name: str, i: int) -> Ends:
        alternatives = grammar.by_name[name].alternatives
        return frozenset(end for a in alternatives for end in _sequence_ends(a.elements, i, step))

    return len(tokens) in of_rule(grammar.start, 0), [frozenset(names) for names in tried]


@pytest.fixture(scope="session")
def parse() -> Callable[[Grammar, Sequence[str]], tuple[bool, list[frozenset[str]]]]:
    """``parse(grammar, tokens)``: every reading tried from the top down, with no automaton at all.

    Returns whether the tokens are a sentence, and for each index the tokens that were looked for
    there, which are those that can follow the tokens before it, as long as some reading gets there.
    """
    return _parse
