"""Parse trees: what they consist of, where, and which one where there are several."""

import gc
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from random import Random

import pytest

from grammar.notation.g4 import read
from grammar.notation.model import Grammar, Repeat, walk
from grammar.notation.wellformed import shortest_length, shortest_lengths
from grammar.parser import parse as parsing
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.failures import FailureFinder
from grammar.parser.lazy_automaton import Stack
from grammar.parser.parse import Parser, Stop
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences
from grammar.parser.tree import ParseNode, Token, Tree
from tests.grammar.parser.readings import Plain, Readings, plain

WORDS = "".join(f"{word} : '{word}' ;\n" for word in "ABCDE")
SIGNS = "COMMA : ',' ;\nNEWLINE : '\\n' ;\nSPACE : ' ' -> skip ;\n"


def grammar_of(*rules: str) -> Grammar:
    return read("grammar T;\n" + "".join(f"{rule} ;\n" for rule in rules) + WORDS + SIGNS)


def parsed(parser: Parser, text: str) -> Tree:
    tree = parser.parse(text)
    assert isinstance(tree, Tree), tree
    return tree


def tree_of(rules: Sequence[str], text: str) -> Plain:
    return plain(parsed(Parser(Recognizer(grammar_of(*rules))), text).root)


@pytest.fixture(scope="module")
def parser(recognizer: Recognizer) -> Parser:
    """A parser of the restrictive start."""
    return Parser(recognizer)


@pytest.fixture(scope="module")
def krl_parser(krl_recognizer: Recognizer) -> Parser:
    """A parser of the grammar in force."""
    return Parser(krl_recognizer)


@pytest.fixture(scope="module")
def trees(krl_parser: Parser, corpus: Mapping[Path, str]) -> Mapping[Path, Tree]:
    """The trees of the programs of the own corpus that can be read."""
    programs = ((p, krl_parser.parse(t)) for p, t in corpus.items() if "programs" in p.parts)
    return {path: tree for path, tree in programs if isinstance(tree, Tree)}


# ----------------------------------------------------------------------------- what they are


def test_where_tokens_are(parser: Parser) -> None:
    """Lines and columns count from 1, offsets from 0, whatever the line ends are."""
    tree = parsed(parser, "\r\nDEF  A() ; x\r  \n\tX = 1\nEND")
    found = [(t.kind, t.text, t.line, t.column, t.offset) for t in tree.tokens]
    assert [
        ("NEWLINE", "\r\n", 1, 1, 0),
        ("DEF", "DEF", 2, 1, 2),
        ("NAME", "A", 2, 6, 7),
        ("LPAREN", "(", 2, 7, 8),
        ("RPAREN", ")", 2, 8, 9),
        ("NEWLINE", "\r", 2, 13, 14),
        ("NEWLINE", "\n", 3, 3, 17),
        ("NAME", "X", 4, 2, 19),
        ("ASSIGN", "=", 4, 4, 21),
        ("INTEGER", "1", 4, 6, 23),
        ("NEWLINE", "\n", 4, 7, 24),
        ("END", "END", 5, 1, 25),
        ("EOF", "", 5, 4, 28),
    ] == found
    assert [" ; x", "  "] == [tree.gap(5), tree.gap(6)]


def test_what_is_skipped_lies_between(trees: Mapping[Path, Tree]) -> None:
    """In every other own program gaps and tokens in turn are the text, each token once."""
    for path, tree in [*trees.items()][::2]:
        pieces = [tree.gap(token.index) + token.text for token in tree.tokens]
        assert tree.text == "".join(pieces), path
        leaves = [x.index for x in tree.root.walk() if isinstance(x, Token)]
        assert list(range(len(tree.kinds))) == leaves, path


def test_nodes_nest(trees: Mapping[Path, Tree]) -> None:
    """In every other own program the children of a node lie side by side, first token to last."""
    for tree in [*trees.values()][1::2]:
        for node in tree.root.walk():
            if isinstance(node, ParseNode):
                at = node.first
                for child in node.children:
                    assert at == (child.first if isinstance(child, ParseNode) else child.index)
                    at = child.stop if isinstance(child, ParseNode) else at + 1
                assert node.stop == at


def test_inner_passes_chains_of_rules(parser: Parser) -> None:
    """From an expression the way leads at once to the first rule that has more than a rule."""
    tree = parsed(parser, "DEF A()\nX=1+Y[2]\nEND\n")
    nodes = [node for node in tree.root.walk() if isinstance(node, ParseNode)]
    inner = [(n.inner.rule, n.inner.text) for n in nodes if n.rule == "expression"]
    assert [("sum", "1+Y[2]"), ("literal", "2")] == inner
    for node in nodes:
        while node.inner != node:
            (child,) = node.children
            assert isinstance(child, ParseNode)
            assert node.inner == child.inner
            node = child  # noqa: PLW2901 - one step down the chain


def test_skipped_tokens_the_lexer_cuts_are_not_in_the_tree() -> None:
    """Where a comment begins like a token the lexer cuts it too; the tree is the same."""
    lexer = "A : 'a' ;\nDIVIDE : '/' ;\nNEWLINE : '\\n' ;\nCOMMENT : '//' ~[\\n]* -> skip ;\n"
    recognizer = Recognizer(read(f"grammar T;\ns : (A | '/' | NEWLINE)* EOF ;\n{lexer}"))
    assert not recognizer.lexer.leaves_out_skipped
    tree = parsed(Parser(recognizer), "a/a//a\n//\na")
    assert ["a", "/", "a", "\n", "\n", "a", ""] == [t.text for t in tree.tokens]
    assert ["", "", "", "//a", "//", "", ""] == [tree.gap(i) for i in range(7)]
    assert (3, 1) == (tree.tokens[5].line, tree.tokens[5].column)


# ------------------------------------------------------------------------------- no program


def test_it_stops_where_the_recogniser_does(
    krl_parser: Parser, krl_recognizer: Recognizer, corpus: Mapping[Path, str]
) -> None:
    """Texts have a tree when they are accepted, and else the first failure is where it stops."""
    finder = FailureFinder(krl_recognizer)
    stopped = 0
    for text in corpus.values():
        result = krl_parser.parse(text)
        assert krl_recognizer.accepts(text) == isinstance(result, Tree)
        if isinstance(result, Stop) and len(text) < 2000:
            stopped += 1
            first = finder.find(text)[0]
            assert (first.line, first.column, first.text) == (
                result.line,
                result.column,
                result.text,
            )
    assert stopped > 300


# ------------------------------------------------------------------------- several readings


@pytest.mark.parametrize(
    ("rules", "text", "expected"),
    [
        # the dangling ELSE belongs to the inner IF
        (
            ["s : i EOF", "i : A i (B i)? | C"],
            "AACBC",
            ("s", ("i", "A", ("i", "A", ("i", "C"), "B", ("i", "C"))), "EOF"),
        ),
        # the alternative written first, seen from outside
        (["s : (x | y) EOF", "x : A", "y : A"], "A", ("s", ("x", "A"), "EOF")),
        (["s : (y | x) EOF", "x : A", "y : A"], "A", ("s", ("y", "A"), "EOF")),
        # only if the rest can be read then
        (["s : x B EOF | y C EOF", "x : A", "y : A"], "AC", ("s", ("y", "A"), "C", "EOF")),
        # optional parts and loops take what they can get
        (["s : x* y EOF", "x : A", "y : A*"], "A", ("s", ("x", "A"), ("y",), "EOF")),
        (["s : x? y EOF", "x : A", "y : A?"], "A", ("s", ("x", "A"), ("y",), "EOF")),
        # the choice at the left counts first, whatever is lost at the right
        (
            ["s : (x | x y) z EOF", "x : A", "y : B", "z : (y | C)*"],
            "AB",
            ("s", ("x", "A"), ("z", ("y", "B")), "EOF"),
        ),
        # an earlier alternative wins although it shows later that it is one
        (
            ["s : (A x | A y) EOF", "x : B", "y : B"],
            "AB",
            ("s", "A", ("x", "B"), "EOF"),
        ),
        (
            ["s : (x C | y C | x D) EOF", "x : A", "y : A"],
            "AC",
            ("s", ("x", "A"), "C", "EOF"),
        ),
    ],
)  # fmt: skip
def test_the_reading_that_antlr_takes(rules: Sequence[str], text: str, expected: Plain) -> None:
    """Of several readings the one is taken whose first decision that differs is written first."""
    assert expected == tree_of(rules, text)


def endless_loops(grammar: Grammar) -> bool:
    """Whether a loop may go round without reading, which ANTLR refuses."""
    lengths = shortest_lengths(grammar)
    elements = (e for r in grammar.parser_rules for e in walk(r))
    return any(
        isinstance(e, Repeat) and e.operator != "?" and shortest_length(e.item, lengths) == 0
        for e in elements
    )


@pytest.mark.parametrize("seed", range(4))
def test_random_grammars(random_grammar: Callable[[Random], Grammar], seed: int) -> None:
    """The tree is the first of all that trying everything gives; a unique one is not ambiguous."""
    chance = Random(seed)
    several = 0
    for _ in range(30):
        grammar = random_grammar(chance)
        if endless_loops(grammar):
            continue
        recognizer = Recognizer(grammar)
        parser = Parser(recognizer)
        sentences = Sentences(grammar)
        for _ in range(12):
            tokens = sentences.random(chance, chance.randint(1, 10))
            if len(tokens) > 9:
                continue
            text = "".join(tokens).replace("NEWLINE", "\n")
            tree = parsed(parser, text)
            first = next(iter(Readings(grammar, [*tokens, "EOF"])))
            assert first == plain(tree.root), (grammar.text, text)
            ambiguous = is_ambiguous(recognizer, recognizer.start, recognizer.kinds(text))
            several += ambiguous
            assert not (ambiguous and tree.is_unique), (grammar.text, text)
    assert several > 10


@pytest.mark.parametrize(
    ("rules", "text", "expected"),
    [
        (["s : i EOF", "i : A i (B i)? | C"], "AACBC", False),
        (["s : i EOF", "i : A i (B i)? | C"], "AAC", True),
        (["s : (x | y) EOF", "x : A B", "y : A C"], "AB", True),
        (["s : x C EOF | y C EOF | y D EOF", "x : A", "y : A"], "AC", False),
        (["s : x C EOF | y C EOF | y D EOF", "x : A", "y : A"], "AD", True),
        (["s : x x A EOF", "x : B?"], "BA", False),
        (["s : x x A EOF", "x : B?"], "BBA", True),
        (["s : x? A EOF", "x : B?"], "A", False),
    ],
)
def test_whether_the_reading_was_unique(rules: Sequence[str], text: str, expected: bool) -> None:
    """A tree tells whether a second one was met, whichever part of the text has two readings."""
    assert expected == parsed(Parser(Recognizer(grammar_of(*rules))), text).is_unique


def test_own_programs_have_one_reading(trees: Mapping[Path, Tree]) -> None:
    """No program of the own corpus has a second reading under the grammar in force."""
    assert [] == [path.name for path, tree in trees.items() if not tree.is_unique]


# ------------------------------------------------------------------------- depth and memory


@pytest.mark.parametrize(
    ("text", "rule", "depth"),
    [
        ("DEF A()\n" + "LOOP\n" * 5000 + "ENDLOOP\n" * 5000 + "END\n", "loopStatement", 5000),
        (f"DEF A()\nX={'(' * 2000}1{')' * 2000}\nEND\n", "primary", 2001),
        (f"DEF A()\nX={'A[' * 2000}1{']' * 2000}\nEND\n", "index", 2000),
        (f"DEF A()\nF({'1,' * 2000}1)\nEND\n", "expression", 2001),
        (f"DEF A()\nX={'NOT ' * 2000}A\nEND\n", "factor", 2001),
    ],
    ids=["blocks", "brackets", "indices", "arguments", "signs"],
)
def test_deep_nesting_is_parsed(parser: Parser, text: str, rule: str, depth: int) -> None:
    """Depth and length meet no limit of Python's, neither in making a tree nor in walking it."""
    tree = parsed(parser, text)
    todo, found = [tree.outline], 0
    while todo:
        outline = todo.pop()
        found += outline.rule == rule
        todo += [child for child in outline.children if not isinstance(child, int)]
    assert depth == found
    assert sum(1 for _ in tree.root.walk()) > depth


def test_nesting_beyond_measure_leaves_little_behind(recognizer: Recognizer) -> None:
    """The frames of a hostile text go with its tree: a process that reads many does not grow."""
    parser = Parser(recognizer)
    before = stacks()
    parsed(parser, f"DEF A()\nB={'(' * 9_000}1{')' * 9_000}\nEND\n")
    assert stacks() - before < 20_000


def stacks() -> int:
    """How many stacks of an automaton there are in this process."""
    gc.collect()
    return sum(isinstance(one, Stack) for one in gc.get_objects())


def test_right_recursion_leaves_little_to_remember(recognizer: Recognizer) -> None:
    """Ten times the depth adds no set of configurations and no action, and lengthens none."""
    found = set()
    for depth in (200, 2_000):
        parser = Parser(recognizer)
        parsed(parser, "DEF A()\nX=" + "NOT " * depth + "A\nEND\n")
        deriver = parser._deriver
        longest = max(len(action.steps) for action in deriver.actions)
        found.add((deriver.size, len(deriver.actions), longest))
        assert 1 == len(found), depth


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("AABD", ("s", ("r", "A", ("r", "A", ("r", "B"))), "D", "EOF")),
        ("A\nBD", ("s", ("r", "A", "NEWLINE", ("r", "B")), "D", "EOF")),
        (
            "A\nAA\nC\nD",
            ("s", ("r", "A", "NEWLINE", ("r", "A", ("r", "A", "NEWLINE",
             ("e", "C", ("t", "NEWLINE"))))), "D", "EOF"),
        ),
        ("AED", ("s", ("r", "A", ("e", "E", ("t",))), "D", "EOF")),
    ],
)  # fmt: skip
def test_rules_that_end_as_one(text: str, expected: Plain) -> None:
    """What is the last thing in a rule ends with it, on the line where it began or later."""
    rules = [
        "s : r D EOF",
        "r : A r | A NEWLINE (r | e) | A e | B",
        "e : (C | E) t",
        "t : NEWLINE?",
    ]
    assert expected == tree_of(rules, text)


def test_an_automaton_that_is_too_large_is_built_again(
    recognizer: Recognizer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Trees are the same with a new automaton for each text, and no states of old ones stay."""
    texts = [f"DEF A()\n{line}\nEND\n" for line in ("HALT", "RETURN", "EXIT", "X=1", "X=Y+1")]
    parser, small = Parser(recognizer), Parser(recognizer)
    monkeypatch.setattr(parsing, "_MOST_STATES", sys.maxsize)
    expected = [plain(parsed(parser, text).root) for text in texts]
    monkeypatch.setattr(parsing, "_MOST_STATES", 0)
    assert expected == [plain(parsed(small, text).root) for text in texts]
    assert 0 < small._deriver.size < parser._deriver.size


def test_what_is_forgotten_is_worked_out_again(
    recognizer: Recognizer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Trees are the same where no line, or only two, can be remembered."""
    blocks = "IF X THEN\n" * 3 + "ELSE\nENDIF\n" * 3
    texts = [f"DEF A()\n{blocks}END\n", "DEF A()\nX=1\nY=2\nX=Y+1\nWAIT SEC 1\nX=1\nEND\n"]
    expected = [plain(parsed(Parser(recognizer), text).root) for text in texts]
    for name, value in (("_MOST_REMEMBERED", 2), ("_LONGEST_REMEMBERED", 0)):
        monkeypatch.setattr(parsing, name, value)
        parser = Parser(recognizer)
        assert expected == [plain(parsed(parser, text).root) for text in texts]
        assert len(parser._changes) <= (2 if name == "_MOST_REMEMBERED" else 0)
