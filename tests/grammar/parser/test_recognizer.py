"""The recogniser reads as far as some program goes, and knows exactly what could come next."""

import gc
from collections.abc import Callable, Sequence
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser import lazy_automaton
from grammar.parser.lexer import EOF
from grammar.parser.recognizer import Recognizer, State
from grammar.parser.sentences import Sentences
from grammar.parser.shortest_paths import Paths
from support.gc_pause import gc_paused

Parse = Callable[[Grammar, Sequence[str]], tuple[bool, list[frozenset[str]]]]
RandomGrammar = Callable[[Random], Grammar]
Mutated = Callable[[Sequence[str], Random, Sequence[str]], list[str]]

OWN = {
    path.stem: Recognizer(read_file(path))
    for path in (GRAMMAR, GRAMMAR.with_name("preliminary.g4"))
}
MANY = st.randoms(use_true_random=True)


def tokens_of(grammar: Grammar) -> list[str]:
    return [r.name for r in grammar.rules if r.is_lexer and not r.is_fragment and not r.is_skipped]


def kinds_of(recognizer: Recognizer, tokens: Sequence[str]) -> list[int]:
    return [recognizer.lexer.kind_of[name] for name in tokens]


def names_of(recognizer: Recognizer, kinds: frozenset[int]) -> frozenset[str]:
    return frozenset(recognizer.lexer.names[kind] for kind in kinds)


def some_tokens(grammar: Grammar, chance: Random, size: int, mutated: Mutated) -> list[str]:
    """A program of the grammar, as it is or damaged."""
    tokens = Sentences(grammar).random(chance, size)
    if chance.random() < 0.7:
        tokens = mutated(tokens, chance, tokens_of(grammar))
    return [*tokens, "EOF"]


def agrees(recognizer: Recognizer, tokens: list[str], parse: Parse) -> None:
    """The recogniser says of the tokens what trying all readings says."""
    accepted, following = parse(recognizer.grammar, tokens)
    state = recognizer.start
    for index, (name, kind) in enumerate(zip(tokens, kinds_of(recognizer, tokens), strict=True)):
        if len(recognizer.sites(state)) > 300:
            return  # a random grammar of so many readings is none that anyone would write
        assert following[index] == names_of(recognizer, recognizer.expected(state)), tokens[:index]
        after = recognizer.step(state, kind)
        assert (after is not None) == (name in following[index])
        if after is None:
            found = recognizer.run(recognizer.start, kinds_of(recognizer, tokens))
            assert (state, index) == found
            assert not accepted
            return
        state = after
    assert accepted
    assert (state, None) == recognizer.run(recognizer.start, kinds_of(recognizer, tokens))


# --------------------------------------------------------------------------------- laws


@given(chance=MANY)
def test_it_reads_as_all_readings_together_do(
    chance: Random, random_grammar: RandomGrammar, mutated: Mutated, parse: Parse
) -> None:
    """At every token of a random grammar's text: exactly what a search of all readings expects."""
    recognizer = Recognizer(random_grammar(chance))
    names = recognizer.lexer.names
    for rule in recognizer.network.entry:  # what was read of a rule alone changes nothing after
        recognizer.run(recognizer.at_rule(rule), [chance.randrange(len(names)) for _ in range(4)])
    for _ in range(6):
        agrees(recognizer, some_tokens(recognizer.grammar, chance, 14, mutated), parse)


@given(chance=MANY)
def test_of_frames_that_pass_a_return_on_one_is_enough(
    chance: Random, random_grammar: RandomGrammar, mutated: Mutated, parse: Parse
) -> None:
    """The same where stacks keep as few of these frames in a row as they can."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lazy_automaton, "_LONGEST_RUN", 1)
        recognizer = Recognizer(random_grammar(chance))
        for _ in range(4):
            agrees(recognizer, some_tokens(recognizer.grammar, chance, 14, mutated), parse)


@pytest.mark.parametrize("name", OWN)
@given(chance=MANY)
def test_it_reads_programs_as_all_readings_together_do(
    name: str, chance: Random, mutated: Mutated, parse: Parse
) -> None:
    """The same for programs of the project's grammars, damaged or not."""
    recognizer = OWN[name]
    agrees(recognizer, some_tokens(recognizer.grammar, chance, 40, mutated), parse)


@pytest.mark.parametrize("name", OWN)
@given(chance=MANY)
def test_what_was_read_is_the_start_of_a_program(
    name: str, chance: Random, mutated: Mutated
) -> None:
    """Before the failing token a program can end, and with any expected token one can go on."""
    recognizer = OWN[name]
    paths = Paths(recognizer.network)
    kinds = kinds_of(recognizer, some_tokens(recognizer.grammar, chance, 40, mutated))
    state, index = recognizer.run(recognizer.start, kinds)
    if index is None:
        return
    whole = kinds[:index] + paths.completion(recognizer.frames(state))
    assert recognizer.run(recognizer.start, whole)[1] is None
    expected = recognizer.expected(state)
    assert kinds[index] not in expected
    for kind in range(-2, len(recognizer.lexer.names)):
        after = recognizer.step(state, kind)
        assert (kind in expected) == (after is not None)
        if after is not None and kind != EOF:
            whole = [*kinds[:index], kind, *paths.completion(recognizer.frames(after))]
            assert recognizer.run(recognizer.start, whole)[1] is None


@given(chance=MANY)
def test_reading_in_pieces(chance: Random, mutated: Mutated) -> None:
    """Tokens read in pieces, or from a state described as data, are read as in one go."""
    recognizer = OWN["preliminary"]
    kinds = kinds_of(recognizer, some_tokens(recognizer.grammar, chance, 40, mutated))
    state, index = recognizer.run(recognizer.start, kinds)
    cut = chance.randint(0, len(kinds) if index is None else index)
    middle, _ = recognizer.run(recognizer.start, kinds[:cut])
    rest = None if index is None else index - cut
    assert (state, rest) == recognizer.run(middle, kinds[cut:])
    fresh = Recognizer(recognizer.grammar)
    restored = fresh.restore(recognizer.frames(middle))
    assert recognizer.frames(middle) == fresh.frames(restored)
    last, found = fresh.run(restored, kinds[cut:])
    assert rest == found
    assert recognizer.frames(state) == fresh.frames(last)
    assert recognizer.expected(state) == fresh.expected(last)


@given(chance=MANY)
def test_configurations_are_what_a_state_is_made_of(chance: Random, mutated: Mutated) -> None:
    """What a state expects is what its configurations, each on its own, expect together."""
    recognizer = OWN["preliminary"]
    tokens = some_tokens(recognizer.grammar, chance, 30, mutated)
    state, _ = recognizer.run(recognizer.start, kinds_of(recognizer, tokens)[:-1])
    together: set[int] = set()
    for configuration in recognizer.sites(state):
        alone = recognizer.at(configuration, state)
        together |= recognizer.expected(alone)
        for kind in recognizer.expected(alone):
            after, whole = recognizer.step(alone, kind), recognizer.step(state, kind)
            assert after is not None
            assert whole is not None
            assert recognizer.expected(after) <= recognizer.expected(whole)
    assert recognizer.expected(state) == together


# ------------------------------------------------------------------------------ texts


def test_one_rule_alone(recognizer: Recognizer) -> None:
    """A rule is read on its own from its start, and `ends` says where it may be complete."""
    variable = ["NAME", "LBRACKET", "INTEGER", "RBRACKET", "DOT", "NAME"]
    state: State | None = recognizer.at_rule("variable")
    ends = []
    for kind in kinds_of(recognizer, variable):
        assert state is not None
        ends.append(recognizer.ends(state))
        state = recognizer.step(state, kind)
    assert state is not None
    assert [False, True, False, False, True, False, True] == [*ends, recognizer.ends(state)]
    assert {"LBRACKET", "DOT"} == names_of(recognizer, recognizer.expected(state))
    assert recognizer.step(state, EOF) is None


def test_a_rule_alone_teaches_nothing_wrong() -> None:
    """What a rule read on its own could go on with is not taken for all there is around it."""
    rules = "s : r (A B)? EOF ;\nr : NEWLINE B A? ;\nA : 'a' ;\nB : 'b' ;\nNEWLINE : '\\n' ;\n"
    recognizer = Recognizer(read(f"grammar T;\n{rules}"))
    alone = recognizer.at_rule("r")
    assert recognizer.run(alone, kinds_of(recognizer, ["NEWLINE", "B", "A"]))[1] is None
    texts = ["ba", "bab", "baab", "bb"]
    assert [True, True, True, False] == [recognizer.accepts(f"\n{text}") for text in texts]
    assert recognizer.run(alone, kinds_of(recognizer, ["NEWLINE", "B", "A", "A"]))[1] == 3


# ------------------------------------------------------------------------------- depth


def nested_ifs(depth: int) -> str:
    return "DEF A()\n" + "IF X THEN\n" * depth + "ELSE\nENDIF\n" * depth + "END\n"


def test_deep_nesting_is_read() -> None:
    """Blocks 300 deep, parentheses 5,000 deep and lists 5,000 long meet no limit of Python's."""
    recognizer = Recognizer(OWN["preliminary"].grammar)
    depth = 5_000
    lines = [
        "X=" + "(" * depth + "1" + ")" * depth,
        "X=" + "A[" * depth + "1" + "]" * depth,
        "F(" + "1," * depth + "1)",
        "X=A" + ".B" * depth,
    ]
    assert recognizer.accepts(nested_ifs(300))
    assert not recognizer.accepts(nested_ifs(300).replace("ENDIF\n", "", 1))
    for line in lines:
        assert recognizer.accepts(f"DEF A()\n{line}\nEND\n")
        kinds = recognizer.kinds(f"DEF A()\n{line} ?\nEND\n")
        state, index = recognizer.run(recognizer.start, kinds)
        assert index == len(kinds) - 5
        assert len(recognizer.frames(state)) > 0


def test_depth_adds_no_sets_of_configurations() -> None:
    """The inside of a block is the same set of configurations however deep the block is nested."""
    recognizer = Recognizer(OWN["preliminary"].grammar)
    sizes = []
    for depth in (50, 100, 1000):
        assert recognizer.accepts(nested_ifs(depth))
        assert not recognizer.accepts(nested_ifs(depth) + "END\n")
        sizes.append(recognizer.size)
    assert len(set(sizes)) == 1
    for depth in (1000, 8000):
        line = "X=" + "(" * depth + "1" + ")" * depth
        assert recognizer.accepts(f"DEF A()\n{line}\nEND\n")
    assert recognizer.size < sizes[0] + 200


RIGHT_RECURSION = {
    "one rule": ("s : r EOF ;\nr : A r | B ;\n", "a"),
    "two rules": ("s : r EOF ;\nr : A t | B ;\nt : A r A? | C r | B ;\n", "ac"),
    "over lines": ("s : r EOF ;\nr : (A | NEWLINE) r | B ;\n", "a\n"),
}
LETTERS = "A : 'a' ;\nB : 'b' ;\nC : 'c' ;\nNEWLINE : '\\n' ;\n"


@pytest.mark.parametrize("name", RIGHT_RECURSION)
def test_right_recursion_adds_no_sets_of_configurations(name: str) -> None:
    """A rule that ends with itself is read as a loop would be: ten times the depth costs no set."""
    rules, repeated = RIGHT_RECURSION[name]
    grammar = read(f"grammar T;\n{rules}{LETTERS}")
    found = set()
    for depth in (200, 2_000):
        recognizer = Recognizer(grammar)
        assert recognizer.accepts(repeated * depth + "b")
        assert not recognizer.accepts(repeated * depth + "bb")
        state, _ = recognizer.run(recognizer.start, recognizer.kinds(repeated * depth)[:-1])
        deepest = max(map(len, recognizer.frames(state)))
        found.add((recognizer.size, deepest))
        assert 1 == len(found), depth
        assert deepest < 40


def test_frames_that_read_something_are_counted() -> None:
    """Between frames that only pass a return on each of the others is kept."""
    rules = f"s : r EOF ;\nr : A r | B r C | D ;\n{LETTERS}D : 'd' ;\n"
    recognizer = Recognizer(read(f"grammar T;\n{rules}"))
    for depth in (1, 7, 8, 9, 200):
        text = ("b" + "a" * 20) * depth + "d"
        assert recognizer.accepts(text + "c" * depth)
        assert not recognizer.accepts(text + "c" * (depth - 1))
        assert not recognizer.accepts(text + "c" * (depth + 1))


def test_deep_blocks_fail_where_they_should() -> None:
    """A set shared by all depths still knows how many blocks are open."""
    recognizer = Recognizer(OWN["preliminary"].grammar)
    openers = {"IF X THEN": "ENDIF", "LOOP": "ENDLOOP", "WHILE X": "ENDWHILE", "REPEAT": "UNTIL X"}
    chance = Random(1)
    for _ in range(30):
        opened = [chance.choice(list(openers)) for _ in range(chance.randint(2, 40))]
        closers = [openers[o] for o in reversed(opened)]
        lines = ["DEF A()", *opened, "X=1", *closers, "END"]
        assert recognizer.accepts("\n".join(lines))
        place = chance.randrange(len(opened) + 2, len(lines))
        wrong = chance.choice([c for c in [*openers.values(), "END"] if c != lines[place]])
        broken = [*lines[:place], wrong, *lines[place + 1 :]]
        kinds = recognizer.kinds("\n".join(broken))
        _, index = recognizer.run(recognizer.start, kinds)
        ahead = recognizer.kinds("\n".join([*broken[:place], ""]))
        assert index == len(ahead) - 1


def test_ways_to_read_can_be_limited() -> None:
    """Where the ways to read double with each token, a limit ends it; without, all are followed."""
    grammar = read(
        "grammar T;\ns : x EOF ;\nx : A y B | A z C | B ;\ny : x ;\nz : x ;\n"
        "A : 'a' ;\nB : 'b' ;\nC : 'c' ;\n"
    )
    text = "a" * 10 + "b" + "bc" * 5
    assert Recognizer(grammar).accepts(text)
    limited = Recognizer(grammar)
    limited.most_ways = 100
    _, failed = limited.run(limited.start, limited.kinds(text))
    assert failed is not None
    assert 3 < failed < 10
    assert limited.accepts("aabbc")


def test_a_released_recogniser_waits_for_no_garbage_collector() -> None:
    """Cores and stacks refer to each other; released ones go with the last reference."""

    def cores() -> int:
        return sum(isinstance(each, lazy_automaton.Core) for each in gc.get_objects())

    gc.collect()
    before = cores()
    with gc_paused():
        recognizer = Recognizer(OWN["KRL"].grammar)
        kinds = recognizer.kinds("DEF A()\nIF B THEN\nC=1\nENDIF\nEND\n")
        for _ in range(2):  # it still reads
            assert recognizer.run(recognizer.start, kinds)[1] is None
            assert cores() > before
            recognizer.release()
        del recognizer
        assert before == cores()
