"""Forms of lines: lists, and names with an index."""

import pytest

from grammar.notation.g4 import read, read_rule
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.forms.loose import is_loose
from recovery.forms.operand_rules import OperandRules
from recovery.forms.samples import samples_of
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import Operand, Symbol
from recovery.forms.writer import FormWriter

_GRAMMAR = """grammar Toy;

program : line* EOF ;

line : (list | marks | pair | inside | assignment) NEWLINE ;

list : LIST NAME (',' NAME)* ;

marks : MARKS NAME (LEFT | RIGHT)* ;

pair : PAIR NAME index? ;

inside : INSIDE '(' NAME index? ':' NAME ')' ;

assignment : variable '=' expression ;

expression : primary ('+' primary)* ;

primary : NUMBER | ON | OFF | variable | '(' expression ')' ;

variable : NAME index? ('.' NAME index?)* ;

index : '[' expression ']' ;

LIST : 'LIST' ;
MARKS : 'MARKS' ;
LEFT : 'LEFT' ;
RIGHT : 'RIGHT' ;
PAIR : 'PAIR' ;
ON : 'ON' ;
OFF : 'OFF' ;
INSIDE : 'INSIDE' ;
COMMA : ',' ;
ASSIGN : '=' ;
COLON : ':' ;
PLUS : '+' ;
DOT : '.' ;
LPAREN : '(' ;
RPAREN : ')' ;
LBRACKET : '[' ;
RBRACKET : ']' ;
NAME : [A-Z]+ ;
NUMBER : [0-9]+ ;
NEWLINE : '\\n' ;
SPACE : ' '+ -> skip ;
"""


@pytest.fixture(scope="module")
def grammar() -> Grammar:
    """Lines with lists, marks that recur, and operands."""
    return read(_GRAMMAR)


@pytest.fixture(scope="module")
def writer(grammar: Grammar) -> FormWriter:
    """Writes forms for it, in a corpus whose operands are numbers too."""
    recognizer = Recognizer(grammar)
    number = tuple(kind for kind in recognizer.kinds("1") if kind)
    return FormWriter(SymbolReader(OperandRules(recognizer)), [number])


@pytest.fixture(scope="module")
def typed() -> FormWriter:
    """Writes forms for a grammar with types, some of which are words."""
    text = _GRAMMAR.replace("| assignment)", "| assignment | declaration)")
    rules = "declaration : DIM type NAME ;\n\ntype : INT | NAME ;\n\n"
    words = "DIM : 'DIM' ;\nINT : 'INT' ;\nEXT : 'EXT' ;\nIN : 'IN' ;\n"
    text = text.replace("LIST : 'LIST'", f"{rules}{words}LIST : 'LIST'")
    return FormWriter(SymbolReader(OperandRules(Recognizer(read(text)))), [])


def _symbols(writer: FormWriter, text: str) -> tuple[Symbol, ...]:
    kinds = writer.rules.recognizer.kinds(text)
    return writer.reader.symbols([(kind, None) for kind in kinds if kind])


def test_no_statement_is_an_operand(writer: FormWriter) -> None:
    """What a reserved word begins that is no value is not written for an operand."""
    assert ["assignment", "expression", "index", "variable"] == sorted(writer.rules.usual)


@pytest.mark.parametrize("rule", ["list", "marks", "pair", "inside"])
def test_a_rule_gives_itself(grammar: Grammar, writer: FormWriter, rule: str) -> None:
    """The form of what a rule reads is the rule: what recurs goes on to, an index stays one."""
    elements = grammar.by_name[rule].alternatives[0].elements
    form = writer.form(samples_of(writer.rules, elements))
    assert " ".join(grammar.by_name[rule].text.split()) == f"{rule} : {form} ;"


@pytest.mark.parametrize(
    ("lines", "form"),
    [(["PAIR A", "PAIR B[1]"], "PAIR NAME index?"), (["PAIR A", "PAIR B.C[1]"], "PAIR variable")],
)
def test_a_name_with_an_index(writer: FormWriter, lines: list[str], form: str) -> None:
    """What is a name, with an index or without, is not written as a whole variable."""
    assert form == writer.form([_symbols(writer, line) for line in lines])


@pytest.mark.parametrize(
    ("count", "form"),
    [
        (7, "LIST expression? NAME (',' expression? NAME)*"),
        (8, "LIST expression NAME (',' expression? NAME)*"),
    ],
)
def test_a_first_item_of_its_own(writer: FormWriter, count: int, form: str) -> None:
    """What many lists begin with their first item has, and the others may."""
    lines = [f"LIST 1 A, B{', 1 C, D' * n}" for n in range(count)]
    assert form == writer.form([_symbols(writer, line) for line in lines])


@pytest.mark.parametrize(
    ("lines", "form"),
    [
        (["PAIR A", "PAIR A LEFT B", "PAIR ON"], "PAIR (NAME (LEFT NAME)? | ON)"),
        (["PAIR A LEFT B", "PAIR ON"], "PAIR (NAME LEFT NAME | ON)"),
        (["PAIR A LEFT ON", "PAIR B LEFT OFF"], "PAIR NAME LEFT expression"),
        (["PAIR A", "PAIR A LEFT B", "PAIR ON LEFT B"], "PAIR (NAME | ON) (LEFT NAME)?"),
    ],
)
def test_a_word_that_ends_a_line(writer: FormWriter, lines: list[str], form: str) -> None:
    """Behind a word that stands for an operand nothing follows that no line shows there."""
    assert form == writer.form([_symbols(writer, line) for line in lines])


def test_an_index_behind_a_type(typed: FormWriter) -> None:
    """A name that is a type is taken apart from its index, as words for types are."""
    lines = ("EXT A(INT:IN, INT[1]:IN)", "EXT A(B:IN, B[1]:IN)")
    form = "EXT NAME '(' type index? ':' IN (',' type index? ':' IN)* ')'"
    assert form == typed.form([_symbols(typed, line) for line in lines])


def test_what_stands_between_brackets_behind_types(typed: FormWriter) -> None:
    """Forms with a type, an index and a name, each in some, become one in which all may stand."""
    form = "'(' type NAME? index? ':' IN ')'"
    sequences = read_rule("all : '(' type ':' IN ')' | '(' type NAME? index ':' IN ')' ;")
    lines = [s for a in sequences.alternatives for s in samples_of(typed.rules, a.elements)]
    assert form == typed.form(lines)


def test_a_single_word_beside_names(writer: FormWriter) -> None:
    """A reserved word that alone stands beside names is written as it is."""
    assert "PAIR (NAME | ON)" == writer.form(
        [_symbols(writer, line) for line in ("PAIR A", "PAIR ON")]
    )


def test_words_beside_names_with_an_index(writer: FormWriter) -> None:
    """Reserved words that are no values, as operands of a list, say nothing of other values."""
    kinds = writer.rules.lexer.kind_of
    words = (Symbol("", Operand((kinds[word],))) for word in ("LEFT", "RIGHT"))
    lines = [_symbols(writer, text)[1:] for text in ("PAIR A", "PAIR A[1]")]
    assert "(NAME index? | LEFT | RIGHT)" == writer.form([*lines, *((word,) for word in words)])


def test_a_word_between_a_word_and_operands(writer: FormWriter) -> None:
    """What some lines have ahead of the same operands may be missing, however the lines end."""
    lines = ("PAIR INSIDE A B", "PAIR LIST A B[1]", "PAIR A B = 1", "PAIR INSIDE LIST A B = 1")
    form = writer.form([_symbols(writer, line) for line in lines])
    assert "PAIR INSIDE? LIST? NAME NAME index? ('=' expression)?" == form


def test_names_with_a_sign_between(writer: FormWriter) -> None:
    """An operand that is never anything but two names and a sign is written so."""
    assert "PAIR NAME '+' NAME" == writer.form([_symbols(writer, "PAIR A + B")])


def test_a_list_that_a_line_lacks(writer: FormWriter) -> None:
    """A list is missing where a line has none."""
    lines = ("LIST", "LIST A, B")
    assert "LIST (NAME (',' NAME)*)?" == writer.form([_symbols(writer, line) for line in lines])


def test_an_item_that_is_set_to_nothing(writer: FormWriter) -> None:
    """It is an item where the items of other lists are set to something."""
    lines = ("LIST A = 1, B = 2", "LIST INSIDE ON A")
    form = "LIST (INSIDE expression)? NAME ('=' expression)? (',' NAME ('=' expression)?)*"
    assert form == writer.form([_symbols(writer, line) for line in lines])


@pytest.mark.parametrize(
    ("form", "loose"),
    [
        ("PAIR (LEFT NAME)? (LIST expression index?)?", True),
        ("PAIR (LEFT NAME | LIST expression index?)", False),
        ("PAIR LEFT? LIST? expression index?", False),
        ("PAIR '(' NAME? ')'", True),
    ],
)
def test_a_loose_form(writer: FormWriter, form: str, loose: bool) -> None:
    """Its operands may all be left out, where each line has one."""
    lines = [_symbols(writer, line) for line in ("PAIR LEFT A", "PAIR LIST 1", "PAIR LIST A[1]")]
    assert loose == is_loose(form, lines)


@pytest.mark.parametrize(
    ("form", "loose"),
    [
        ("PAIR LEFT? LIST? expression", True),
        ("PAIR (LEFT | LIST) expression", False),
        ("PAIR '+' expression", False),
        ("PAIR LEFT+ '+'? LIST?", True),
    ],
)
def test_a_form_that_is_shorter_than_its_lines(writer: FormWriter, form: str, loose: bool) -> None:
    """With words and signs counted, a form must not read less than the shortest line."""
    lines = [_symbols(writer, line) for line in ("PAIR LEFT A", "PAIR LIST 1")]
    assert loose == is_loose(form, lines, counts_words=True)


def test_a_list_may_hold_itself() -> None:
    """Samples of a rule that is a list of itself come to an end: the inner one is an operand."""
    nested = _GRAMMAR.replace(
        "inside : INSIDE '(' NAME index? ':' NAME ')' ;",
        "inside : INSIDE set ;\n\nset : '(' (NAME | set) (',' (NAME | set))* ')' ;",
    )
    rules = OperandRules(Recognizer(read(nested)))
    elements = rules.grammar.by_name["set"].alternatives[0].elements
    operands = {s.operand for sample in samples_of(rules, elements) for s in sample[0].inside or ()}
    assert "set" in {operand.rule for operand in operands if operand}


@pytest.mark.parametrize(
    ("text", "form"),
    [
        ("INSIDE (INT A, REAL B, T C)", "INSIDE '(' kind NAME (',' kind NAME)* ')'"),
        ("PAIR (INT A:LEFT, T B:RIGHT)", "PAIR '(' kind NAME ':' (RIGHT | LEFT) (',' "),
    ],
)
def test_types_in_brackets(text: str, form: str) -> None:
    """What is in brackets begins no line: a type is one there, and the first item one of all."""
    typed = _GRAMMAR.replace(
        "NAME index? ':' NAME ')' ;", "kind ')' ;\n\nkind : INT | REAL | NAME ;"
    )
    words = "".join(f"{w} : '{w}' ;\n" for w in ("INT", "REAL"))
    grammar = read(typed.replace("LIST : 'LIST' ;\n", f"LIST : 'LIST' ;\n{words}"))
    writer = FormWriter(SymbolReader(OperandRules(Recognizer(grammar))), [])
    assert (writer.form([_symbols(writer, text)]) or "").startswith(form)


def test_what_is_no_call() -> None:
    """A word that only other rules write in brackets tells that these brackets are of no call."""
    text = _GRAMMAR.replace("':' NAME ')'", "':' ON ')'").replace("| '(' expr", "| NAME? '(' expr")
    rules = OperandRules(Recognizer(read(text)))
    writer = FormWriter(SymbolReader(rules), [])
    forms = [
        writer.form([_symbols(writer, f"PAIR A({inside})") for inside in (first, "1")])
        for first in ("C", "ON")
    ]
    assert ["PAIR expression", "PAIR NAME '(' (ON | NUMBER) ')'"] == forms


@pytest.mark.parametrize(
    ("inside", "words"),
    [
        ("LEFT", {"LEFT"}),
        ("side", {"LEFT", "RIGHT"}),  # by a rule of its own
        ("expression", set()),  # which has ON
        ("sort", set()),  # words beside names
    ],
)
def test_words_that_only_other_rules_have_in_brackets(inside: str, words: set[str]) -> None:
    """Words beside names, and those of operands, are left out."""
    text = _GRAMMAR.replace("':' NAME ')'", f"':' {inside} ')'")
    more = "side : LEFT | RIGHT ;\n\nsort : NAME | LIST ;\n\nLIST :"
    rules = OperandRules(Recognizer(read(text.replace("LIST :", more, 1))))
    lexer = rules.lexer
    found = rules.words_in_brackets[lexer.kind_of["LPAREN"]]
    assert words == {lexer.names[kind] for kind in found}


def test_samples_nest_brackets_as_they_are_written() -> None:
    """Each bracket is closed by its own, also behind a group of the same kind."""
    grammar = read(_GRAMMAR.replace("'(' NAME index? ':' NAME ')'", "'(' '(' NAME ')' NAME ')'"))
    rules = OperandRules(Recognizer(grammar))
    (line,) = samples_of(rules, grammar.by_name["inside"].alternatives[0].elements)
    (inner, name) = line[1].inside or ()
    assert ("INSIDE", "'('") == tuple(symbol.text for symbol in line)
    assert name.is_operand
    assert 1 == len(inner.inside or ())
