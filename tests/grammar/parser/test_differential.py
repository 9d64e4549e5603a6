"""The recogniser and ANTLR's generated parser accept the same texts.

ANTLR's parser is the reference for what the grammar means. A difference is a defect of one of the
two, or an alternative that ANTLR's prediction hides, which has to be mended in the grammar.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from random import Random

import pytest

from grammar.parser import antlr_reference
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from grammar.parser.shortest_paths import Paths

Mutated = Callable[[Sequence[str], Random, Sequence[str]], list[str]]


def difference(recognizer: Recognizer, text: str) -> str | None:
    """What the two parsers say where they do not say the same."""
    refusal = antlr_reference.refusal(text)
    accepted = recognizer.accepts(text)
    if accepted == (refusal is None):
        return None
    return f"ours {'accepts' if accepted else 'refuses'}, ANTLR: {refusal}\n{text}"


def walk(recognizer: Recognizer, chance: Random, size: int) -> list[str]:
    """A program found by taking any expected token ``size`` times and then the shortest way out."""
    kinds: list[int] = []
    state = recognizer.start
    for _ in range(size):
        kind = chance.choice(sorted(recognizer.expected(state)))
        after = recognizer.step(state, kind)
        assert after is not None
        if kind == 0:
            break
        kinds.append(kind)
        state = after
    kinds += Paths(recognizer.network).completion(recognizer.frames(state))
    return [recognizer.lexer.names[kind] for kind in kinds[:-1]]


def test_own_corpus(krl_recognizer: Recognizer, corpus: Mapping[Path, str]) -> None:
    """Both say the same of every program that has no tree, and every negative of the own corpus."""
    assert len(corpus) > 500
    found = {
        path.name: difference(krl_recognizer, text)
        for path, text in corpus.items()
        if "programs" not in path.parts or not krl_recognizer.accepts(text)
    }
    assert {} == {name: what for name, what in found.items() if what}


@pytest.mark.parametrize("seed", range(2))
def test_random_walks_and_their_mutants(
    krl_recognizer: Recognizer, mutated: Mutated, seed: int
) -> None:
    """Both accept 100 programs found by a random walk, and agree on 200 damaged copies."""
    chance = Random(seed)
    speller = Speller(krl_recognizer.grammar)
    found = []
    for _ in range(100):
        tokens = walk(krl_recognizer, chance, chance.randint(5, 60))
        text = speller.text(tokens)
        assert krl_recognizer.accepts(text)
        names = list(speller.samples)
        damaged = [speller.text(mutated(tokens, chance, names)) for _ in range(2)]
        found += [difference(krl_recognizer, t) for t in [text, *damaged]]
    assert [] == [what for what in found if what]


@pytest.mark.parametrize("seed", range(2))
def test_random_sentences_and_their_mutants(
    krl_recognizer: Recognizer, mutated: Mutated, seed: int
) -> None:
    """Both accept 100 random sentences, and agree on 200 damaged copies."""
    chance = Random(seed)
    speller, sentences = Speller(krl_recognizer.grammar), Sentences(krl_recognizer.grammar)
    found = []
    for _ in range(100):
        tokens = sentences.random(chance, 80)
        names = list(speller.samples)
        programs = [tokens, *(mutated(tokens, chance, names) for _ in range(2))]
        found += [difference(krl_recognizer, speller.text(p)) for p in programs]
    assert [] == [what for what in found if what]


def test_every_alternative_and_its_mutants(krl_recognizer: Recognizer, mutated: Mutated) -> None:
    """Both accept the shortest program through each part of each rule, and agree on its mutants."""
    chance = Random(9)
    grammar = krl_recognizer.grammar
    speller, sentences = Speller(grammar), Sentences(grammar)
    names = list(speller.samples)
    found = []
    for rule in sentences.reachable:
        for tokens in sentences.through(rule):
            programs = [tokens, *(mutated(tokens, chance, names) for _ in range(2))]
            found += [difference(krl_recognizer, speller.text(p)) for p in programs]
    assert [] == [what for what in found if what]
