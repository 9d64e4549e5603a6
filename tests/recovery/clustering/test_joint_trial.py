"""A line read with edits as detours is read as a recogniser of the edited grammar reads it."""

from collections.abc import Callable, Sequence
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.addresses import sequences
from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, MakeOptional, Widen
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer, State
from grammar.parser.sentences import Sentences
from recovery.clustering.edit_merging import combined_edits
from recovery.clustering.edit_trial import edited
from recovery.clustering.joint_trial import DetourReader

RandomGrammar = Callable[[Random], Grammar]
Mutated = Callable[[Sequence[str], Random, Sequence[str]], list[str]]

TOKENS = ("A", "B", "C", "NEWLINE")
NEW = "D"


def agrees(grammar: Grammar, edits: Sequence[Edit], programs: Sequence[Sequence[str]]) -> None:
    """Both ways read as many tokens of each program that the grammar does not read."""
    recognizer = Recognizer(grammar)
    reader = DetourReader(grammar, recognizer.network)
    wider = edited(recognizer, edits)
    detours = reader.detours(edits)
    if detours is None or wider is None:
        assert detours is None  # what only the recogniser of the edited grammar can tell
        return
    kind_of = {NEW: reader.kind(NEW), **recognizer.lexer.kind_of}
    for tokens in programs:
        kinds = tuple(kind_of[token] for token in tokens)
        wide = [wider.lexer.kind_of[token] for token in tokens]
        if recognizer.run(recognizer.start, kinds)[1] is not None and has_few_readings(wider, wide):
            ((_, found),) = reader.read(detours, [kinds])
            assert wider.run(wider.start, wide)[1] == found, tokens


def has_few_readings(recognizer: Recognizer, kinds: Sequence[int]) -> bool:
    """Whether the tokens have so few readings that all of them are followed."""
    state: State | None = recognizer.start
    for kind in kinds:
        state = recognizer.step(state, kind) if state else None
        if state and len(recognizer.sites(state)) > 60:
            return False
    return True


def some_text(chance: Random, rules: Sequence[str], depth: int = 1) -> str:
    """A text that an edit adds."""
    kinds = chance.choices(("token", "rule", "group"), (3, 1, depth), k=chance.randint(1, 3))
    return " ".join(
        chance.choice((*TOKENS, NEW))
        if kind == "token"
        else chance.choice(rules)
        if kind == "rule"
        else f"({' | '.join(some_text(chance, rules, 0) for _ in 'ab')}){chance.choice('?*+')}"
        for kind in kinds
    )


def some_edit(chance: Random, grammar: Grammar) -> Edit:
    rules = [rule for rule in grammar.rules[1:] if not rule.is_lexer]
    rule, text = chance.choice(rules), some_text(chance, [rule.name for rule in rules])
    at, sequence = chance.choice(list(sequences(rule)))
    size = len(sequence.elements)
    if size:
        inside = (*at, chance.randint(1, size))
        match chance.choice(("insert", "widen", "optional", "alternative")):
            case "insert":
                return Insert(rule.name, (*at, chance.randint(1, size + 1)), f"({text})?")
            case "widen":
                return Widen(rule.name, inside, text)
            case "optional":
                return MakeOptional(rule.name, inside)
    return AddAlternative(rule.name, text)


@given(chance=st.randoms(use_true_random=True))
def test_detours_read_what_the_edited_grammar_reads(
    chance: Random, random_grammar: RandomGrammar, mutated: Mutated
) -> None:
    """The same for drawn edits, one or a few together, of drawn grammars."""
    grammar = random_grammar(chance)
    some = [some_edit(chance, grammar) for _ in range(chance.choice((1, 1, 2, 3)))]
    edits = [AddToken(NEW), *combined_edits(some, ())]
    wider = edited(Recognizer(grammar), edits)
    sentences = Sentences(wider.grammar if wider else grammar)
    drawn = [sentences.random(chance, chance.choice((4, 8))) for _ in range(8)]
    damaged = [mutated(tokens, chance, (*TOKENS, NEW)) for tokens in drawn]
    agrees(grammar, edits, [[*tokens, "EOF"] for tokens in drawn + damaged if len(tokens) < 14])


@pytest.mark.parametrize(
    ("rules", "edits", "tokens"),
    [
        # one detour behind another, with a line end between where they began
        ("r : A r NEWLINE | NEWLINE ;", [MakeOptional("r", (1, 3))], "A A A A NEWLINE NEWLINE"),
        # what is put before an element that may be left out, or be something else
        ("r : A ;", [Insert("r", (1, 2), "(B)?"), MakeOptional("r", (1, 1))], "B"),
        ("r : A A ;", [Insert("r", (1, 2), "(B)?"), Widen("r", (1, 1), "C")], "C B A"),
        # two texts at one place
        ("r : A ;", [Insert("r", (1, 1), "(B)?"), Insert("r", (1, 1), "(C)?")], "C B A"),
        # a text that begins with what may be left out
        ("r : A ;\nt : B ;", [MakeOptional("t", (1, 1)), Insert("r", (1, 1), "(t)*")], "B B A"),
    ],
)
def test_edits_together(rules: str, edits: Sequence[Edit], tokens: str) -> None:
    """The same where one edit leads to a place of another, or to its own once more."""
    words = "\n".join(f"{name} : '{name}' ;" for name in TOKENS[:-1])
    grammar = read(f"grammar T;\ns : r EOF ;\n{rules}\n{words}\nNEWLINE : '\\n' ;\n")
    agrees(grammar, edits, [[*tokens.split(), "EOF"]])


def test_an_edit_with_too_many_readings() -> None:
    """It reads neither a line that has too many nor any other behind that line."""
    words = "\n".join(f"{name} : '{name}' ;" for name in TOKENS[:-1])
    grammar = read(f"grammar T;\ns : r EOF ;\nr : A r | B ;\n{words}\nNEWLINE : '\\n' ;\n")
    recognizer = Recognizer(grammar)
    reader = DetourReader(grammar, recognizer.network)
    detours = reader.detours([AddAlternative("r", "A r r")])
    assert detours is not None
    kind_of = recognizer.lexer.kind_of
    lines = ("A B B EOF", "A " * 14 + "C")
    short, long = (tuple(kind_of[token] for token in text.split()) for text in lines)
    assert [None] == [found for _, found in reader.read(detours, [short])]
    assert [14, 2] == [found for _, found in reader.read(detours, [long, short])]


def test_a_sign_that_the_grammar_does_not_have(random_grammar: RandomGrammar) -> None:
    """An edit with a token that is not there fits no grammar."""
    agrees(random_grammar(Random(1)), [AddAlternative("r0", "'+' A")], [])
