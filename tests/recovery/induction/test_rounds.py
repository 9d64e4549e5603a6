"""A grammar that grows by itself, in a language that is no KRL."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    AddToken,
    MakeOptional,
    RemoveAlternative,
    RemoveRule,
    Replace,
    apply,
)
from grammar.notation.foreign import read_foreign
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar, Reference
from grammar.parser.recognizer import Recognizer
from recovery.induction import folding, list_lengths, rounds
from recovery.induction.corpus_lines import drawn_origins, held_out
from recovery.induction.grammar_view import GrammarView
from recovery.induction.induced_ledger import InducedLedger, without
from recovery.induction.language import CorpusFile
from recovery.induction.names_rule import with_names
from recovery.induction.objections import EditReview
from recovery.induction.rounds import Induction
from recovery.induction.steps import AcceptedStep, InferredStep, RefusedStep, described
from recovery.ledger.ledger import in_force
from recovery.negatives.negatives import Negative, NegativeSet


def _grown(
    start: Grammar,
    files: tuple[CorpusFile, ...],
    negatives: tuple[Negative, ...] = (),
    begun: Grammar | None = None,
) -> InducedLedger:
    growth = InducedLedger(start, start)
    induction = Induction(start, files, (), NegativeSet(negatives), start=begun)
    for done in induction.rounds():
        growth.add(done)
    return growth


@pytest.fixture(scope="module")
def growth(toy: Grammar, toy_files: tuple[CorpusFile, ...]) -> InducedLedger:
    """The growth over all programs."""
    return _grown(toy, toy_files)


def test_every_program_is_read(growth: InducedLedger, toy_files: tuple[CorpusFile, ...]) -> None:
    """Statements, blocks and operators that several origins show are found."""
    recognizer = Recognizer(growth.grammar)
    assert [] == [file.path for file in toy_files if not recognizer.accepts(file.text)]


@pytest.mark.parametrize(("closer", "accepted"), [("DONE\n", True), ("", False)])
def test_a_word_closes_what_the_grammar_leaves_open(
    toy: Grammar, closer: str, accepted: bool
) -> None:
    """A line behind the lines of a rule, in which it goes on, becomes the end of that rule."""
    routines = "(routine eol)* EOF\n    ;\n\nroutine\n    : HALT NAME eol statement*"
    start = read(toy.text.replace("NEWLINE* statement* EOF", routines).replace("| halt", ""))
    routine = "HALT F\n{0} := 1\nDONE\nHALT G\n{0} := 2\nG({0})\nDONE\n"
    files = tuple(CorpusFile(n, routine.format(n), frozenset({n})) for n in "ABCD")
    grown = Recognizer(_grown(start, files).grammar)
    assert grown.accepts(f"HALT H\nX := 3\n{closer}HALT G\nDONE\n") is accepted


@pytest.mark.parametrize(("line", "count"), [("X := HALT\n", 1), ("X := HALT := 2\n", 0)])
def test_a_word_is_a_name_where_lines_are_read_then(toy: Grammar, line: str, count: int) -> None:
    """Lines that only fail further on with a reserved word as a name do not make it one."""
    start = apply(toy, with_names(toy, "NAME").edits)
    texts = [f"{name} := {name} / 2\n{line}" for name in "ABCD"]
    files = tuple(CorpusFile(f"{n}.toy", t, frozenset({f"{n}"})) for n, t in enumerate(texts))
    taken = [construct.title for construct in _grown(start, files).constructs]
    assert count == taken.count("HALT as a name")


@pytest.mark.parametrize(
    ("text", "accepted"),
    [
        ("MOVE NEW SLOW\n", True),
        ("REPEATN 1 / 2\nDONE\n", True),
        ("REPEATN 1\nMOVE A\n", False),
        ("DONE\n", False),
        ("MOVE := 1\n", False),
        ("SLOW A\n", False),
    ],
)
def test_unseen_lines(growth: InducedLedger, text: str, accepted: bool) -> None:
    """Forms hold for lines that were not looked at, blocks have to be closed, words are words."""
    assert accepted == Recognizer(growth.grammar).accepts(text)


def test_a_word_of_one_statement_is_no_operator(
    toy: Grammar, toy_files: tuple[CorpusFile, ...]
) -> None:
    """Between operands a word of several kinds of line is an operator, that of one is its own."""
    more = tuple(
        CorpusFile(
            f"{o}/more.toy", f"COUNT {o} UPTO 3\nMOVE {o} OVER 2\nY := {o} OVER 4\n", frozenset({o})
        )
        for o in ("A", "B", "C")
    )
    recognizer = Recognizer(_grown(toy, (*toy_files, *more)).grammar)
    texts = ("COUNT D UPTO 4\n", "Y := 1 OVER D\n", "Y := 1 UPTO D\n")
    assert [True, True, False] == [recognizer.accepts(text) for text in texts]


def test_the_lines_within_a_block_grow(toy: Grammar) -> None:
    """What a line within a block may be is found where the block is known, and only there."""
    block = "PICK expression eol (WHEN NUMBER eol statement*)+ ENDPICK eol"
    words = tuple(AddToken(word) for word in ("PICK", "WHEN", "ENDPICK"))
    start = apply(toy, (*words, AddAlternative("statement", block)))
    files = tuple(
        CorpusFile(f"{o}/a.toy", f"PICK {o}\nWHEN 1\nHALT\nWHEN {o}\nENDPICK\n", frozenset({o}))
        for o in ("A", "B", "C")
    )
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = ("PICK 1\nWHEN D\nENDPICK\n", "WHEN D\n")
    assert [True, False] == [recognizer.accepts(text) for text in texts]


def test_the_last_line_of_a_block_is_no_line_of_its_own(toy: Grammar) -> None:
    """Nor is a first line that the grammar cannot read yet: the block has to be there."""
    routines = (
        "(routine eol)* EOF\n    ;\n\nroutine\n    : proc\n    | func\n    ;\n\nproc\n"
        "    : HALT NAME eol statement* ENDP\n    ;\n\nfunc\n    : FUNC NAME eol statement*"
    )
    start = _with(
        toy,
        "NEWLINE* statement* EOF",
        routines,
        "    | halt\n",
        "",
        "halt\n    : HALT\n    ;\n\n",
        "",
        "HALT :",
        "ENDP : 'ENDP' ;\nFUNC : 'FUNC' ;\nHALT :",
    )
    both = "HALT F\n{0} := 1\nENDP\nFUNC G\n{0} := 2\nG({0})\nDONE\n"
    texts = (both, f"{both}FUNC J\nDONE\n", "FUNC H ODD {0}\n{0} := 2\nDONE\n")
    files = tuple(
        CorpusFile(f"{origin}/{n}.toy", text.format(origin), frozenset({origin}))
        for origin in "ABCD"
        for n, text in enumerate(texts)
    )
    grown = Recognizer(_grown(start, files).grammar)
    lines = ("DONE\n", "FUNC A\nDONE\n", "FUNC A ODD B\n", "FUNC A ODD B\nX := 1\nDONE\n")
    assert [False, True, False, True] == [grown.accepts(line) for line in lines]


@pytest.mark.parametrize(
    ("word", "count", "wrong", "accepted"),
    [
        ("GLIDE", 1, "", False),
        ("GLIDE", 2, "", True),
        ("GLIDE", 2, "= =\n", False),
        ("GLIDE", 3, "= =\n", True),
        ("HALT", 1, "", True),
        ("HALT", 1, "= =\n", False),
        ("HALT", 2, "= =\n", True),
    ],
)
def test_one_file_shows_what_it_has_often(
    toy: Grammar, word: str, count: int, wrong: str, accepted: bool
) -> None:
    """Three different lines of one file are trusted, where the word is known two places are.

    Where nothing else is wrong in the file two lines are, and with a known word a single one.
    """
    more = "".join(f"{word} {name} {n}\n" for n, name in enumerate("ABC"[:count]))
    files = (
        CorpusFile("one/a.toy", f"HALT\n{more}{wrong}", frozenset({"one"})),
        CorpusFile("two/a.toy", "HALT\n", frozenset({"two"})),
    )
    assert accepted == Recognizer(_grown(toy, files).grammar).accepts(f"{word} D 7\n")


@pytest.mark.parametrize(("others", "accepted"), [(10, True), (30, False)])
def test_one_line_shows_enough_where_few_files_are_read(
    toy: Grammar, others: int, accepted: bool
) -> None:
    """Of many files that are read one more may be damaged."""
    odd = CorpusFile("one", "GLIDE 7 TO A\nGLIDE + 8 = A\n", frozenset({"one"}))
    halts = (CorpusFile(f"{n}", "HALT\n" * n, frozenset({f"{n}"})) for n in range(1, others))
    grown = Recognizer(_grown(toy, (odd, *halts)).grammar)
    assert accepted == grown.accepts("GLIDE 9 TO B\n")


@pytest.mark.parametrize(("inside", "accepted"), [("HALT", False), ("7", True), ("", True)])
def test_a_word_for_a_name(toy: Grammar, inside: str, accepted: bool) -> None:
    """That a line of one file has a reserved word where a name stands tells nothing.

    A number there, or nothing at all, does.
    """
    start = _with(toy, "    | halt\n", "    | halt\n    | HALT '(' NAME ')'\n")
    files = (
        CorpusFile("one/a.toy", f"HALT({inside})\n", frozenset({"one"})),
        CorpusFile("two/a.toy", "HALT\n", frozenset({"two"})),
    )
    found = Recognizer(_grown(start, files).grammar).accepts(f"HALT({inside})\n")
    assert accepted == found


def _with(toy: Grammar, *changes: str) -> Grammar:
    """The start with other texts, each behind the one that it replaces and that is there once."""
    text = toy.text
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert 1 == text.count(old)
        text = text.replace(old, new)
    return read(text)


def test_words_beside_names(toy: Grammar) -> None:
    """A reserved word that is a name in two lines of one file is one in that place only."""
    grown = toy.text.replace("    | halt\n", "    | halt\n    | KIND NAME FAST NAME\n")
    words = "".join(f"{w} : '{w}' ;\n" for w in ("KIND", "FAST"))
    start = read(grown.replace("HALT : 'HALT' ;\n", f"HALT : 'HALT' ;\n{words}"))
    start = apply(start, with_names(start, "NAME").edits)
    files = (
        CorpusFile("a/a.toy", "KIND A FAST HALT\nKIND B FAST HALT\n", frozenset({"a"})),
        CorpusFile("b/b.toy", "KIND B FAST X\n", frozenset({"b"})),
    )
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = ("KIND C FAST HALT\n", "KIND HALT FAST X\n", "HALT := 1\n")
    assert [True, False, False] == [recognizer.accepts(text) for text in texts]


def test_a_word_ahead_of_a_form(toy: Grammar) -> None:
    """A word that may be missing at the head of other lines leaves the rest of a form as it is."""
    kinds = "    | halt\n    | OPEN NAME (NAME | OPEN)\n    | SHUT NAME\n"
    grown = toy.text.replace("    | halt\n", kinds)
    words = "".join(f"{w} : '{w}' ;\n" for w in ("OPEN", "SHUT"))
    start = read(grown.replace("HALT : 'HALT' ;\n", f"HALT : 'HALT' ;\n{words}"))
    text = "OPEN P{0} Q{0}\nOPEN R{0} OPEN\nWIDE OPEN S{0} T{0}\nSHUT U{0}\nWIDE SHUT V{0}\n"
    files = tuple(CorpusFile(o, text.format(o), frozenset({o})) for o in "ABCDE")
    assert "WIDE? OPEN NAME (NAME | OPEN)" in _grown(start, files).grammar.text


def test_a_form_without_its_first_word(toy: Grammar) -> None:
    """The words behind it, which may be missing, cannot be missing too."""
    grown = toy.text.replace("    | halt\n", "    | halt\n    | SHUT OPEN* NAME\n")
    words = "".join(f"{w} : '{w}' ;\n" for w in ("OPEN", "SHUT"))
    start = read(grown.replace("HALT : 'HALT' ;\n", f"HALT : 'HALT' ;\n{words}"))
    files = tuple(CorpusFile(o, f"OPEN P{o}\nOPEN OPEN Q{o}\n", frozenset({o})) for o in "ABCDE")
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = ("OPEN OPEN P\n", "SHUT OPEN P\n", "SHUT P\n", "P\n")
    assert [True, True, True, False] == [recognizer.accepts(text) for text in texts]


def test_what_comes_once_or_more_may_be_missing(toy: Grammar) -> None:
    """It may come as often as before then."""
    start = _with(toy, "'(' arguments? ')'", "'(' NAME '+' primary+ ')'")
    text = "F(A + )\nF(A + 1)\n"
    files = tuple(CorpusFile(f"{o}/a.toy", text, frozenset({o})) for o in ("A", "B", "C"))
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = ("F(A + )\n", "F(A + 1 2 3 4 5)\n", "F()\n")
    assert [True, True, False] == [recognizer.accepts(text) for text in texts]


_FLAT = (
    "    : product ('+' product)*\n    ;\n\nproduct\n    : factor ('*' factor)*\n    ;\n\n"
    "factor\n    : primary\n    ;\n\nprimary\n    : NUMBER\n    | NAME\n    | call\n"
    "    | '(' expression ')'\n"
)


def _drawn(random: Random) -> str:
    """Return a program with operators, signs, brackets and calls at any depth."""

    def operand(depth: int) -> str:
        match random.randrange(6 if depth < 4 else 2):
            case 0:
                return random.choice("ABCD")
            case 1:
                return str(random.randrange(99))
            case 2:
                return f"({operand(depth + 1)})"
            case 3:
                return f"- {random.choice('ABCD')}"
            case 4:
                row = ", ".join(operand(depth + 1) for _ in range(random.randrange(3)))
                return f"{random.choice('ABCD')}({row})"
            case _:
                return f"{operand(depth + 1)} {random.choice('+*/')} {operand(depth + 1)}"

    return "".join(f"{random.choice('ABCD')} := {operand(0)}\n" for _ in range(8))


@pytest.mark.parametrize("seed", [1796034300, 1796034301])
@pytest.mark.parametrize("is_rule", [True, False])
def test_operators_where_there_is_no_level_of_them(toy: Grammar, seed: int, is_rule: bool) -> None:
    """A choice of names and numbers becomes a rule of expressions; no line gets a tail instead."""
    minus = ("PLUS :", "MINUS : '-' ;\nPLUS :")
    start = _with(toy, _FLAT, "    : NAME\n    | NUMBER\n", *minus)
    if not is_rule:
        text = start.text.replace("expression\n    : NAME\n    | NUMBER\n    ;\n\n", "")
        start = read(text.replace("expression", "(NAME | NUMBER)"))
    random = Random(seed)
    files = tuple(CorpusFile(o, _drawn(random), frozenset({o})) for o in "ABCDEFG")
    grown = _grown(start, files).grammar
    recognizer, more = Recognizer(grown), [_drawn(random) for _ in range(50)]
    assert [] == [text for text in more if not recognizer.accepts(text)]
    operand = "expression" if is_rule else "operand"
    assert f"NAME ':=' {operand} ;" in " ".join(grown.by_name["assignment"].text.split())
    assert not recognizer.accepts("A := B C\n")


def test_an_operator_may_be_missing(toy: Grammar, toy_files: tuple[CorpusFile, ...]) -> None:
    """A level of operators with an empty alternative is no obstacle."""
    start = _with(toy, "('+' product)*", "(( | '+') product)*")
    recognizer = Recognizer(_grown(start, toy_files).grammar)
    assert [] == [file.path for file in toy_files if not recognizer.accepts(file.text)]


def test_a_lone_operator(toy: Grammar) -> None:
    """A word between operands in brackets needs one line, if nothing else in its file is wrong."""
    start = _with(toy, "HALT : 'HALT' ;", "HALT : 'HALT' ;\nAND : 'AND' ;")
    start = _with(start, "factor\n    : primary\n", "factor\n    : primary (AND primary)*\n")
    texts = {"one": "X := (A MOD B)\n", "two": "HALT\n"}
    files = tuple(CorpusFile(f"{o}/a.toy", t, frozenset({o})) for o, t in texts.items())
    grown = Recognizer(_grown(start, files).grammar)
    texts_after = ("Y := 1 + (C MOD D)\n", "X := (A B)\n")
    assert [True, False] == [grown.accepts(text) for text in texts_after]


def test_lone_words_of_one_file(toy: Grammar) -> None:
    """Known forms that grow by one line each, so that nothing is left wrong in their file."""
    start = _with(
        toy,
        "HALT : 'HALT' ;",
        "HALT : 'HALT' ;\nAND : 'AND' ;\nMOVE : 'MOVE' ;\nEQUALS : '=' ;",
        "factor\n    : primary\n",
        "factor\n    : primary (AND primary)*\n",
        "    | halt\n",
        "    | halt\n    | MOVE NAME '=' expression\n",
    )
    texts = {"one": "X := (A MOD B)\nMOVE A = 1 UPTO 3\n", "two": "HALT\n"}
    files = tuple(CorpusFile(f"{o}/a.toy", t, frozenset({o})) for o, t in texts.items())
    grown = Recognizer(_grown(start, files).grammar)
    texts_after = ("Y := 1 + (C MOD D)\n", "MOVE C = A + 1 UPTO 5\n", "MOVE A = 1 3\n")
    assert [True, True, False] == [grown.accepts(text) for text in texts_after]


def test_a_literal_of_one_origin(toy: Grammar) -> None:
    """What touches a number is part of it wherever it is found."""
    texts = {"one": "X := 15E3\n", "two": "HALT\n"}
    files = tuple(CorpusFile(f"{o}/a.toy", t, frozenset({o})) for o, t in texts.items())
    assert Recognizer(_grown(toy, files).grammar).accepts("Y := 2E7\n")


def test_each_file_with_a_literal_has_a_line(toy: Grammar) -> None:
    """The same literal in two origins is evidence that a ledger can hold."""
    texts = {"one": "X := 15E3\n", "two": "Y := 15E3\n"}
    files = tuple(CorpusFile(f"{o}/a.toy", t, frozenset({o})) for o, t in texts.items())
    (step,) = (c for c in _grown(toy, files).constructs if c.title == "15E3 is one literal")
    assert (2, 2, 2) == (step.evidence.files, step.evidence.origins, step.evidence.lines)


@pytest.mark.parametrize("line", ["WIDE DARK OPEN A B 1", "OPEN A B 1", "DARK SHUT A", "HALT A"])
def test_one_line_with_one_word_more_or_less(toy: Grammar, line: str) -> None:
    """It shows enough, whatever else is wrong in its file: the form and the word are known."""
    more = "DARK OPEN NAME NAME NUMBER\n    | SHUT NAME\n    | WIDE HALT? NAME"
    start = _with(
        toy,
        "HALT : 'HALT' ;",
        "".join(f"{w} : '{w}' ;\n" for w in ("HALT", "DARK", "OPEN", "SHUT", "WIDE")),
        "    | halt\n",
        f"    | halt\n    | {more}\n",
    )
    files = (
        CorpusFile("a", f"{line}\n= =\n", frozenset("a")),
        CorpusFile("b", "HALT\n", frozenset("b")),
    )
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = (line, f"{line} {line}", "A")
    assert [True, False, False] == [recognizer.accepts(f"{text}\n") for text in texts]


def test_a_name_behind_a_name_may_be_a_word(toy: Grammar) -> None:
    """What two origins have at the same place is one if it is always the same."""
    start = _with(
        toy,
        "HALT : 'HALT' ;",
        "HALT : 'HALT' ;\nSHUT : 'SHUT' ;",
        "    | halt\n",
        "    | halt\n    | SHUT NAME\n",
    )
    files = tuple(CorpusFile(o, f"SHUT {o} FAST\nSHUT {o}\n", frozenset({o})) for o in "AB")
    assert "SHUT NAME FAST?" in _grown(start, files).grammar.text


def test_a_block_of_one_file(toy: Grammar) -> None:
    """Several in balance are no slip; a word ahead of some of them is part of their first line."""
    block = "AGAIN {}\nA := 1\nDONE\n"
    text = "".join("WIDE " * (n == "B") + block.format(n) for n in "ABC")
    files = (
        CorpusFile("a", text, frozenset("a")),
        CorpusFile("b", "HALT\n", frozenset("b")),
    )
    recognizer = Recognizer(_grown(toy, files).grammar)
    texts = (block.format("D"), f"WIDE {block.format('D')}", "AGAIN D\nA := 1\n")
    assert [True, True, False] == list(map(recognizer.accepts, texts))


def test_a_reserved_word_is_a_type(toy: Grammar) -> None:
    """Where one is expected, ahead of a name: not only in the form that shows it."""
    start = _with(
        toy,
        "HALT : 'HALT' ;",
        "".join(f"{w} : '{w}' ;\n" for w in ("HALT", "DIM", "GIVE", "INT", "FIX")),
        "    | halt\n",
        "    | halt\n    | FIX NAME\n    | DIM kind NAME\n    | GIVE kind NAME ':=' NAME\n",
        "halt\n    : HALT\n",
        "kind\n    : INT\n    | NAME\n    ;\n\nhalt\n    : HALT\n",
    )
    files = tuple(CorpusFile(o, f"DIM FIX {o}\n", frozenset({o})) for o in "AB")
    assert Recognizer(_grown(start, files).grammar).accepts("GIVE FIX A := B\n")


def test_a_form_has_what_its_place_shows(toy: Grammar) -> None:
    """A sign that lines have in one place is not read where they lack it."""
    rules = (
        "entry\n    : NAME ':=' NUMBER eol\n    | kind\n    ;\n\n"
        "kind\n    : DIM NAME eol\n    | FIX NAME eol\n    ;\n"
    )
    start = _with(
        toy,
        "NEWLINE* statement* EOF",
        "NEWLINE* entry* HALT eol statement* EOF",
        "    : simpleStatement eol\n",
        "    : simpleStatement eol\n    | kind\n",
        "    | halt\n",
        "",
        "halt\n    : HALT\n    ;\n",
        rules,
        "HALT : 'HALT' ;",
        "HALT : 'HALT' ;\nDIM : 'DIM' ;\nFIX : 'FIX' ;",
    )
    text = "KIND A{0} := 1\nKIND B{0} := {0}\nHALT\nKIND C{0}\nKIND D{0}\n"
    files = tuple(CorpusFile(o, text.format(o), frozenset({o})) for o in "ABC")
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = ("KIND E := 2\nHALT\nKIND F\n", "HALT\nKIND F := 2\n")
    assert [True, False] == [recognizer.accepts(text) for text in texts]


def test_what_reads_furthest_grows(toy: Grammar) -> None:
    """Of two forms that begin alike only the one is extended that reads the line until it fails."""
    entry = "entry\n    : DIM NAME ':=' NUMBER eol\n    | kind\n    ;\n\n"
    start = _with(
        toy,
        "NEWLINE* statement* EOF",
        "NEWLINE* entry* HALT eol statement* EOF",
        "    : simpleStatement eol\n",
        "    : simpleStatement eol\n    | kind\n",
        "    | halt\n",
        "",
        "halt\n    : HALT\n    ;\n",
        f"{entry}kind\n    : DIM NAME eol\n    ;\n",
        "HALT : 'HALT' ;",
        "HALT : 'HALT' ;\nDIM : 'DIM' ;",
    )
    text = "DIM A := 1\nDIM B := F(A)\nHALT\nDIM C\nODD WORD 1\n"
    rounds = _grown(start, (CorpusFile("a/a.toy", text, frozenset({"a"})),)).rounds
    titles = {step["title"] for done in rounds for step in done["taken"] + done["refused"]}
    assert "DIM … in entry" in titles
    assert "DIM … in kind" not in titles


def test_a_choice_of_words_stays_one(toy: Grammar) -> None:
    """What is read behind one of several words is read behind the others."""
    start = _with(toy, "HALT : 'HALT' ;", "HALT : 'HALT' ;\nINT : 'INT' ;\nREAL : 'REAL' ;")
    start = _with(start, "    | halt\n", "    | halt\n    | (INT | REAL) NAME\n")
    files = tuple(
        CorpusFile(f"{o}/a.toy", f"INT 5\nREAL Q\nINT {o}\n", frozenset({o}))
        for o in ("A", "B", "C")
    )
    assert Recognizer(_grown(start, files).grammar).accepts("REAL 2\n")


def test_a_rule_that_a_form_calls_is_kept() -> None:
    """Parts may go missing, items grow and tails are added where they are: nothing is rewritten.

    What ends one line behind an operand may end the others that have it there.
    """
    start = read_file(GRAMMAR.with_name("preliminary.g4"))
    lines = ("X={P 1,Q 2}", "Y={S: P 1,Q -A}", "CIRC P,Q,CA 30", "CIRC P,Q,CA 9 C_DIS")
    files = tuple(
        CorpusFile(f"{o}/a.src", "\n".join(("DEF A()", *lines, "END", "")), frozenset({o}))
        for o in ("A", "B", "C")
    )
    rules = _grown(start, files).grammar.by_name
    written = " ".join(rules["aggregate"].text.split())
    assert "aggregate : '{' (NAME ':')? component (',' component)* '}' ;" == written
    circ = "CIRC target ',' target (',' CA expression)? (C_DIS | C_PTP)?"
    assert circ in rules["motion"].text


def test_a_start_in_another_style_grows() -> None:
    """Tokens of other names, labelled alternatives: new words are reserved there too.

    Rows in any order become blocks, in which kinds of row are in the order that files show.
    """
    block = "WHILE X>1\nLIN P C_DIS\nENDWHILE\n"
    ends = ("RETURN X\n", "RETURN X\nRETURN Y\nHALT\n", "HALT\nHALT\n")
    texts = [
        f"DEF A()\nDECL INT B\nDECL INT C\nX=1\n{block}LIN Q C_DIS\nX=2\n{end}END\n" for end in ends
    ]
    files = tuple(
        CorpusFile(f"{o}/a.src", t, frozenset(o)) for o, t in zip("ABC", texts, strict=True)
    )
    inner = ("RETURN Z", "WHILE A==B\nENDWHILE", "ENDWHILE", "HALT LIN", "X=1\nDECL INT B")
    more = (
        *(f"DEF B()\n{some}\nEND\n" for some in inner),
        "X=1\n",
        "DEF B()\n",
        (texts[0] * 2).strip(),
    )
    for name in ("other", "spelt", "nested"):
        start = read_file(Path(__file__).with_name(f"{name}_style.g4"), read_foreign)
        recognizer = Recognizer(_grown(start, files).grammar)
        assert [True, True, *[False] * 5, True] == [recognizer.accepts(text) for text in more]


def test_a_block_has_the_lines_that_it_is_seen_with() -> None:
    """Others that a block beside it has behind them are none of it."""
    texts = ("DEF A()\nDECL INT B\nX=1\nEND\n", "DEFDAT A\nDECL INT B\nDECL INT C\nENDDAT\n")
    files = tuple(
        CorpusFile(f"{o}/{n}", text, frozenset(o)) for o in "ABC" for n, text in enumerate(texts)
    )
    start = read_file(Path(__file__).with_name("nested_style.g4"), read_foreign)
    recognizer = Recognizer(_grown(start, files).grammar)
    more = (*texts, "DEFDAT A\nX=1\nENDDAT\n")
    assert [True, True, False] == [recognizer.accepts(text) for text in more]


@pytest.mark.parametrize("end", ["NEWLINE", "NEWLINE+", "eol"])
def test_a_start_that_is_a_loop_of_lines_grows(
    toy: Grammar, toy_files: tuple[CorpusFile, ...], end: str
) -> None:
    """However few kinds of line it has, and where it reads no blank lines."""
    start = _with(toy, "NEWLINE* statement*", f"(simpleStatement {end})*")
    files = [CorpusFile(f.path, f"\n{f.text}\n", f.origins) for f in toy_files]
    recognizer = Recognizer(_grown(start, tuple(files)).grammar)
    assert [] == [file.path for file in files if not recognizer.accepts(file.text)]


def test_the_ledger_replays(growth: InducedLedger) -> None:
    """The constructs, replayed on the start, give the grammar byte for byte."""
    assert growth.grammar.text == in_force(growth.start, growth.constructs).text


def test_what_is_there_is_not_added_again(
    toy: Grammar, toy_files: tuple[CorpusFile, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else the grammar has an alternative twice, and its ledger has it once."""
    again = InferredStep("again", (AddAlternative("simpleStatement", "call"),), (), breadth=9)
    monkeypatch.setattr(rounds, "folds_of", lambda _: iter([again]))
    induction = Induction(toy, toy_files, (), NegativeSet(()))
    ledger = InducedLedger(toy, toy)
    for done in induction.rounds():
        ledger.add(done)
    assert ledger.grammar.text == induction.grammar.text
    assert "again" not in {construct.title for construct in ledger.constructs}


def test_no_line_is_lost(growth: InducedLedger) -> None:
    """From round to round no more lines fail."""
    failing = [done["shown"]["failing"] for done in growth.rounds]
    assert sorted(failing, reverse=True) == failing


def test_the_same_every_time(
    growth: InducedLedger, toy: Grammar, toy_files: tuple[CorpusFile, ...]
) -> None:
    """The same files give the same grammar."""
    assert growth.grammar.text == _grown(toy, toy_files).grammar.text


def test_a_negative_is_an_objection(toy: Grammar, toy_files: tuple[CorpusFile, ...]) -> None:
    """An edit that accepts what must be rejected is refused, with the reason."""
    slash = Negative(None, "X := A / B\n", "a slash divides nothing", "parse", line=1)
    grown = _grown(toy, toy_files, (slash,))
    reasons = [refused["reason"] for done in grown.rounds for refused in done["refused"]]
    assert (False, True) == (
        Recognizer(grown.grammar).accepts(slash.text),
        any("a slash divides nothing" in reason for reason in reasons),
    )


@pytest.mark.parametrize(("most", "is_taken"), [(1, False), (2, True)])
def test_damaged_lines_are_an_objection(toy: Grammar, most: int, is_taken: bool) -> None:
    """An edit that reads more lines that have lost or doubled a token than it may is refused."""
    edits = (MakeOptional("assignment", (1, 2)),)  # the sign of an assignment
    review = EditReview(
        Recognizer(toy), NegativeSet(()), lambda _line: frozenset(), ["A := 1\nB := 2\n"]
    )
    assert not review.objection(toy, edits, edits)
    assert is_taken == (not review.objection(toy, edits, edits, most_damaged=most))


def test_folds_that_undo_each_other_end(toy: Grammar, monkeypatch: pytest.MonkeyPatch) -> None:
    """A round that would lead back to an earlier grammar takes nothing."""

    def folded(
        self: Induction, *_: object, **_more: object
    ) -> tuple[list[AcceptedStep], list[RefusedStep]]:
        there = len(self.grammar.by_name["halt"].alternatives)
        edit = RemoveAlternative("halt", 2) if there > 1 else AddAlternative("halt", "NAME")
        return [AcceptedStep("back and forth", (edit,))], []

    monkeypatch.setattr(Induction, "_folded", folded)
    files = (CorpusFile("a.toy", "HALT\n", frozenset({"a"})),)
    induction = Induction(toy, files, (), NegativeSet(()))
    taken = [step for done in induction.rounds() for step in done.taken]
    assert (1, True) == (len(taken), induction.is_finished)


def test_a_step_is_struck_out(growth: InducedLedger) -> None:
    """A step that is struck out goes, with those that need it; the others stay in order."""
    block = next(c for c in growth.constructs if "REPEATN" in c.title)
    left, gone = without(growth.start, growth.constructs, [block.id])
    assert block in gone
    assert list(range(1, len(left) + 1)) == [construct.number for construct in left]
    assert not Recognizer(in_force(growth.start, left)).accepts("REPEATN 2\nDONE\n")


def test_what_is_struck_is_not_taken_again(
    growth: InducedLedger, toy: Grammar, toy_files: tuple[CorpusFile, ...]
) -> None:
    """Edits that were struck out are not tried again."""
    struck = [construct.edits for construct in growth.constructs]
    first = next(iter(Induction(toy, toy_files, (), NegativeSet(()), struck=struck).rounds()))
    assert growth.constructs[0].edits not in [step.edits for step in first.taken]


@pytest.mark.parametrize(("is_struck", "accepted"), [(False, False), (True, True)])
def test_a_bound_can_be_struck_out(
    toy: Grammar, monkeypatch: pytest.MonkeyPatch, is_struck: bool, accepted: bool
) -> None:
    """A list is bounded at the end, unless that step was struck out."""
    monkeypatch.setattr(list_lengths, "SHORT_LIST_EXAMPLES", 1)
    text = "LINK A{0}\nLINK A{0}, B{0}\nLINK A{0}, B{0}, C{0}\n"
    files = [CorpusFile(f"{o}/a.toy", text.format(o), frozenset({o})) for o in "ABC"]
    steps = [s for done in Induction(toy, files, (), NegativeSet(())).rounds() for s in done.taken]
    bound = next(step.edits for step in steps if "at most 3 items" in step.title)
    again = Induction(toy, files, (), NegativeSet(()), struck=[bound] if is_struck else ())
    for _ in again.rounds():
        pass
    assert accepted == Recognizer(again.grammar).accepts("LINK A, B, C, D\n")


def test_a_growth_goes_on_where_it_stopped(toy: Grammar, monkeypatch: pytest.MonkeyPatch) -> None:
    """After any round it ends as an uninterrupted one: what lists are bounded tells its start."""
    monkeypatch.setattr(list_lengths, "SHORT_LIST_EXAMPLES", 1)
    text = "LINK A{0}\nLINK A{0}, B{0}\nLINK A{0}, B{0}, C{0}\n"
    files = [CorpusFile(f"{o}/a.toy", text.format(o), frozenset({o})) for o in "ABC"]
    whole = Induction(toy, files, (), NegativeSet(()))
    for most in range(1, len([*whole.rounds()])):
        begun = Induction(toy, files, (), NegativeSet(()))
        assert most == len([*begun.rounds(most)])
        resumed = Induction(begun.grammar, files, (), NegativeSet(()), start=toy)
        assert [*resumed.rounds()]
        assert whole.grammar.text == resumed.grammar.text


def test_lists_are_bounded_in_a_round_of_their_own(
    toy: Grammar, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While something can be folded no list is bounded: a fold may yet be dropped."""
    monkeypatch.setattr(list_lengths, "SHORT_LIST_EXAMPLES", 1)
    monkeypatch.setattr(rounds, "LEAST_FILES_ALONE", 1)  # what is folded first is folded at the end
    start = apply(toy, (AddRule("halt", "spare\n    : HALT\n    ;"),))
    none = NegativeSet(())
    files = (CorpusFile("a.toy", "LINK A\nLINK A, B\nLINK A, B, C\n", frozenset({"a"})),)
    titles = [
        [step.title for step in done.taken] for done in Induction(start, files, (), none).rounds()
    ]
    folds = [["nothing calls spare"], ["at most 3 items in statement"]]
    assert folds == [some for some in titles if some][-2:]


def test_origins_are_held_out_whole(toy_files: tuple[CorpusFile, ...]) -> None:
    """A fraction of the origins is held out, with all of their files, the same for a seed."""
    origins = drawn_origins(toy_files, 1 / 3, 4)
    shown, held = held_out(toy_files, origins)
    assert (2, 4, 1) == (len(held), len(shown), len(origins))
    assert origins == drawn_origins(toy_files, 1 / 3, 4)
    assert {frozenset(origins)} == {file.origins for file in held}


@pytest.mark.parametrize(("least", "held"), [(2, 2), (3, 4), (5, 6)])
def test_so_many_files_are_held_out_at_least(
    toy_files: tuple[CorpusFile, ...], least: int, held: int
) -> None:
    """Each origin of the toy has two files, and no origin is divided."""
    assert held == len(held_out(toy_files, drawn_origins(toy_files, least, 4))[1])


def test_a_limit_of_rounds_is_no_end(toy: Grammar, toy_files: tuple[CorpusFile, ...]) -> None:
    """Induction is finished once nothing more is worth taking, not where it was stopped."""
    induction = Induction(toy, toy_files, (), NegativeSet(()))
    ends = []
    for most in (1, 60):
        list(induction.rounds(most))
        ends.append(induction.is_finished)
    assert [False, True] == ends


def test_a_step_that_mends_nothing_is_refused(growth: InducedLedger) -> None:
    """A round that takes steps for lines that fail leaves fewer of them or more files read."""
    standing = [(d["shown"]["parsed"], -d["shown"]["failing"]) for d in growth.rounds]
    idle = [
        step["title"]
        for done, before, after in zip(growth.rounds, standing, standing[1:], strict=False)
        if after <= before
        for step in done["taken"]
        if step["lines"]
    ]
    assert [] == idle


_GROWN = """
import json, sys
from grammar.notation.g4 import read
from recovery.induction.language import CorpusFile
from recovery.induction.rounds import Induction
from recovery.negatives.negatives import NegativeSet
start, files = json.load(sys.stdin)
shown = [CorpusFile(path, text, frozenset(origins)) for path, text, origins in files]
for done in Induction(read(start), shown, (), NegativeSet(())).rounds():
    print(done)
"""


def test_the_same_over_hash_seeds(toy: Grammar, toy_files: tuple[CorpusFile, ...]) -> None:
    """Rounds, with all that was taken and refused, do not depend on the hashes of Python.

    Nor does it matter that two rules have the same brackets.
    """
    start = _with(toy, "'(' expression ')'", "nested\n    ;\n\nnested\n    : '(' expression ')'")
    start = _with(start, "'(' arguments? ')'", "row\n    ;\n\nrow\n    : '(' arguments? ')'")
    given = json.dumps([start.text, [(f.path, f.text, sorted(f.origins)) for f in toy_files]])
    rounds = {
        subprocess.run(
            [sys.executable, "-c", _GROWN],
            env=os.environ | {"PYTHONHASHSEED": str(seed)},
            input=given,
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        ).stdout
        for seed in range(3)
    }
    assert (1, True) == (len(rounds), "REPEATN" in min(rounds))


def test_a_line_with_an_open_bracket_shows_nothing(toy: Grammar) -> None:
    """A form is learnt from lines with brackets in pairs, and not from others."""
    texts = [f"SEND ({name})\nPUT ({name} SLOW\nPUT ({name} 1 SLOW\n" for name in "ABCD"]
    files = tuple(
        CorpusFile(n, text, frozenset({n})) for n, text in zip("ABCD", texts, strict=True)
    )
    titles = [construct.title for construct in _grown(toy, files).constructs]
    assert [] == [title for title in titles if "PUT" in title]


def _two_folds(view: GrammarView) -> Iterator[InferredStep]:
    """Yield a fold that loses lines, and one written for what that leaves."""
    called = [a.elements for a in view.grammar.by_name["simpleStatement"].alternatives]
    names = [e.name for (e,) in called if isinstance(e, Reference)]
    if "assignment" in names:
        gone = RemoveAlternative("simpleStatement", 1), RemoveRule("assignment")
        yield InferredStep("no assignment", gone, ())
    if "call" in names:
        edits = (RemoveAlternative("simpleStatement", names.index("call") + 1),)
        yield InferredStep("no call", edits, ())


def test_brackets_behind_names_are_of_operands(toy: Grammar) -> None:
    """Names elsewhere, as those that are assigned to, get none."""
    start = _with(toy, _FLAT, "    : NAME\n    | NUMBER\n", "    : HALT\n", "    : HALT NAME\n")
    start = apply(start, with_names(start, "NAME").edits)
    text = "{0} := {0}(1)\nHALT {0}(2)\nHALT {0}(3)\n"
    files = tuple(CorpusFile(n, text.format(n), frozenset({n})) for n in "ABC")
    recognizer = Recognizer(_grown(start, files).grammar)
    texts = ("D := E(F(2))\n", "HALT D(4)\n", "D(1) := 2\n")
    assert [True, True, False] == [recognizer.accepts(text) for text in texts]


def test_operands_of_one_origin(toy: Grammar) -> None:
    """What may be an operand everywhere needs more than two files of one origin among many."""
    texts = [f"{n} := -{n}\n" for n in "ABCDE"]
    start = _with(toy, "PLUS :", "MINUS : '-' ;\nPLUS :")
    for count in (2, 5):
        files = [CorpusFile(f"o/{n}", t, frozenset("o")) for n, t in enumerate(texts[:count])]
        halts = ("HALT\n" * n for n in range(1, 100))
        files += (CorpusFile(f"p/{n}", text, frozenset("p")) for n, text in enumerate(halts))
        grown = _grown(start, tuple(files)).grammar
        assert (count == 5) == Recognizer(grown).accepts("A := B * -C\n")


def test_what_no_step_changes_is_not_folded(toy: Grammar) -> None:
    """A rule of the start that was right stays as it is, however much shorter it could be."""
    rules = "halt\n    : HALT NAME\n    | HALT NUMBER\n"
    start = _with(toy, "halt\n    : HALT\n", rules)
    texts = [f"HALT {n}\nHALT 1\n{n} := 1 / {n}\n" for n in "ABC"]
    files = tuple(CorpusFile(t, t, frozenset({t})) for t in texts)
    grown = _grown(start, files)
    assert start.by_name["halt"].text == grown.grammar.by_name["halt"].text
    other = _grown(start, files, begun=toy).grammar.by_name["halt"]
    assert start.by_name["halt"].text != other.text


def test_folds_behind_one_that_is_lost(toy: Grammar, monkeypatch: pytest.MonkeyPatch) -> None:
    """They were written for other places and are sought anew."""
    monkeypatch.setattr(folding, "FOLDS", (_two_folds,))
    monkeypatch.setattr(rounds, "FOLD_FILES", 0)  # only whole files show what is lost
    files = tuple(CorpusFile(n, f"{n} := 1\nHALT\n", frozenset({n})) for n in "AB")
    grown = _grown(toy, files, begun=_with(toy, "    | halt\n", ""))
    assert ["no call"] == [construct.title for construct in grown.constructs]
    assert all(Recognizer(grown.grammar).accepts(file.text) for file in files)


def _rotation(view: GrammarView) -> Iterator[InferredStep]:
    """Yield a fold that moves the first alternative of a rule to its end."""
    rule = view.grammar.by_name["simpleStatement"]
    text = rule.source_of(rule.alternatives[0])
    edits = (RemoveAlternative(rule.name, 1), AddAlternative(rule.name, text))
    yield InferredStep("rotated", edits, (), breadth=1)


def test_folds_come_to_an_end(toy: Grammar, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without end a fold could be taken that leads back to a grammar of the same round."""
    monkeypatch.setattr(folding, "FOLDS", (_rotation,))
    files = tuple(CorpusFile(n, f"{n} := 1\nHALT\n", frozenset({n})) for n in "AB")
    last = _grown(toy, files, begun=_with(toy, "    | halt\n", "")).rounds[-2]["refused"]
    assert ["has been so before"] == [refused["reason"] for refused in last]


def _refused_and_taken(view: GrammarView) -> Iterator[InferredStep]:
    """Yield a fold that makes the grammar no shorter, named by its place, and one that moves it."""
    rule = view.grammar.by_name["simpleStatement"]
    texts = [rule.source_of(alternative) for alternative in rule.alternatives]
    at = texts.index("halt")
    yield InferredStep(f"call in {at}", (Replace(rule.name, (at + 1, 1), "call"),), (), breadth=1)
    if "call" in texts[:at]:
        yield InferredStep("no call", (RemoveAlternative(rule.name, 2),), (), breadth=1)


def test_a_refused_fold_is_not_tried_again(toy: Grammar, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not even when a fold that was taken since has changed the numbers of alternatives."""
    monkeypatch.setattr(folding, "FOLDS", (_refused_and_taken,))
    files = tuple(CorpusFile(n, f"{n} := 1\nHALT\n", frozenset({n})) for n in "AB")
    first = next(
        done
        for done in _grown(toy, files, begun=_with(toy, "    | halt\n", "")).rounds
        if done["taken"]
    )
    titles = [[step["title"] for step in first[key]] for key in ("taken", "refused")]
    assert [["no call"], ["call in 2"]] == titles


def test_edits_are_described_without_their_address() -> None:
    """A fold that was refused is known again after others have changed the numbers."""
    whole, rest = (
        read(f"grammar G;\nr\n    : {rows}\n    ;\nA : 'A' ;\nB : 'B' ;\n")
        for rows in ("A B | B | A", "B | A")
    )
    edits = (Replace("r", (2, 1), "A"), RemoveAlternative("r", 3))
    later = (Replace("r", (1, 1), "A"), RemoveAlternative("r", 2))
    assert described(whole, edits) == described(rest, later)
    assert described(whole, edits) != described(whole, later)
