"""Folding: alternatives that say nearly the same become one."""

from collections.abc import Callable, Iterator
from random import Random

import pytest

from grammar.notation.edits import apply
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.notation.wellformed import problem
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from recovery.induction.folding import FOLDS, folds_of
from recovery.induction.folds_of_declarations import (
    heads,
    kinds,
    types,
    undeclared_elsewhere,
    words_of_a_kind,
)
from recovery.induction.folds_of_operands import (
    any_operands,
    behind_signs,
    closed_choices,
    heads_of_blocks,
)
from recovery.induction.grammar_view import GrammarView
from recovery.induction.steps import InferredStep

_GRAMMAR = """grammar Toy;

program : (line NEWLINE)* EOF ;

line
    : INT NAME (',' NAME)*
    | REAL NAME index?
    | DIM kind NAME
    | DIM kind NAME index
    | GO NAME
    | MOVE NAME (FAST | SLOW)?
    | TURN NAME SLOW*
    | NAME '=' expression
    | later
    ;

later
    : DIM kind ':' NAME (',' NAME)*
    | DIM FAST NUMBER
    | GO ':'
    ;

kind : INT | REAL | BOOL | NAME ;

expression : primary (('+' | '-') primary)* ;

primary : '-'? NUMBER | NAME index? | '(' expression ')' ;

index : '[' expression ']' ;

idle : NUMBER NUMBER ;

INT : 'INT' ;
REAL : 'REAL' ;
BOOL : 'BOOL' ;
DIM : 'DIM' ;
GO : 'GO' ;
MOVE : 'MOVE' ;
TURN : 'TURN' ;
FAST : 'FAST' ;
SLOW : 'SLOW' ;
COLON : ':' ;
COMMA : ',' ;
ASSIGN : '=' ;
PLUS : '+' ;
MINUS : '-' ;
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
    """Two declarations without DIM and two with it, and a rule that nothing calls."""
    return read(_GRAMMAR)


@pytest.fixture(scope="module")
def folds(grammar: Grammar) -> dict[str, InferredStep]:
    """All folds of it, by their titles."""
    recognizer = Recognizer(grammar)
    return {fold.title: fold for fold in folds_of(GrammarView(recognizer, ()))}


def test_what_may_be_folded(folds: dict[str, InferredStep]) -> None:
    """Words of a kind have one form, as the alternatives of one word have; GO is of no kind.

    All that begins with DIM has none: it would read ``DIM A``, which is shorter than any of it.
    """
    assert {
        "nothing calls idle",
        "one form for kindWord in line",
        "one form for DIM in line",
        "one form for DIM in later",
        "line reads what GO begins in later",
        "later reads what GO begins in line",
        "a list behind DIM in line",
        "FAST, SLOW at the end of lines",
        "one form for what follows a name in line",
        "'+' ahead of operands in primary",
    } == folds.keys()


_KINDS = _GRAMMAR.replace(
    _GRAMMAR[_GRAMMAR.index("line\n") : _GRAMMAR.index("later\n    :")],
    """line
    : kindWord NAME (',' NAME)*
    | MOVE kind NAME
    | AXIS NAME
    | INT NAME '=' NUMBER
    | MOVE DIM (kindWord NAME '=' (NUMBER | NAME) | FRAME NAME)
    | INT NAME ':' FAST
    | later
    | other
    ;

other
    : MOVE (kind NAME index | kind NAME ':' SLOW)
    | TURN NAME (',' NAME)?
    | SLOW expression
    ;

kindWord : INT | REAL ;

""",
).replace("INT : 'INT' ;", "INT : 'INT' ;\nAXIS : 'AXIS' ;\nFRAME : 'FRAME' ;")


@pytest.mark.parametrize(
    ("text", "accepted"),
    [
        ("REAL A = 1\n", True),
        ("AXIS A, B\n", True),
        ("MOVE AXIS A\n", True),
        ("MOVE DIM FRAME A = 1\n", True),
        ("FRAME A\n", True),
        ("INT FRAME\n", True),
        ("INT A = B\n", True),
        ("INT A : SLOW\n", True),
        ("REAL A[1]\n", True),
        ("REAL A[1], B\n", False),
        ("MOVE A[1]\n", False),
        ("FAST A\n", False),
        ("GO A\n", False),
    ],
)
def test_what_stands_where_a_kind_does_is_of_the_kind(text: str, accepted: bool) -> None:
    """Words ahead of declared names, operands and words behind a sign."""
    grammar = read(_KINDS)
    some = (words_of_a_kind, kinds, behind_signs, undeclared_elsewhere)
    while fold := next((f for k in some for f in _of(k, grammar)), None):
        grammar = apply(grammar, fold.edits)
    assert (False, accepted) == (
        Recognizer(read(_KINDS)).accepts(text),
        Recognizer(grammar).accepts(text),
    )


def _of(
    kind: Callable[[GrammarView], Iterator[InferredStep]], grammar: Grammar
) -> Iterator[InferredStep]:
    return (fold for fold in kind(GrammarView(Recognizer(grammar), ())) if fold.edits)


def test_a_name_is_no_first_word() -> None:
    """Lines that begin with a name are of no family."""
    view = GrammarView(Recognizer(read(_GRAMMAR)), ())
    assert "NAME" not in {word for _, word, _ in view.families}


@pytest.mark.parametrize(
    ("text", "accepted"),
    [("BOOL A[1], B\n", True), ("REAL A, B\n", True), ("GO A, B\n", False), ("INT 1\n", False)],
)
def test_what_one_word_shows_holds_for_its_kind(
    grammar: Grammar, folds: dict[str, InferredStep], text: str, accepted: bool
) -> None:
    """A list and an index, each seen with one word, are read with all words of the kind."""
    folded = apply(grammar, folds["one form for kindWord in line"].edits)
    assert accepted == Recognizer(folded).accepts(text)


@pytest.mark.parametrize(
    ("title", "text"),
    [
        ("FAST, SLOW at the end of lines", "MOVE A SLOW FAST\nTURN B FAST\n"),
        ("a list behind DIM in line", "DIM INT A, B, C, D, E\n"),
        ("one form for what follows a name in line", "REAL A[1], B\n"),
        ("'+' ahead of operands in primary", "A = +1\n"),
    ],
)
def test_what_holds_in_one_place_holds_in_another(
    grammar: Grammar, folds: dict[str, InferredStep], title: str, text: str
) -> None:
    """Words that end lines, lists, what follows a name, and signs ahead of operands."""
    folded = apply(grammar, folds[title].edits)
    assert (False, True) == tuple(Recognizer(g).accepts(text) for g in (grammar, folded))


def test_signs_that_an_operand_has(grammar: Grammar) -> None:
    """A sign ahead of an operand that an alternative of its own reads is not added again."""
    text = grammar.text.replace(
        "primary : '-'? NUMBER", "primary : '-' primary | '+' primary | NUMBER"
    )
    folds = folds_of(GrammarView(Recognizer(read(text)), ()))
    assert [] == [fold.title for fold in folds if "ahead of operands" in fold.title]


_LIKE = """grammar Like;

program : (line NEWLINE)* EOF ;

line
    : (INT | REAL | FRAME) name index?
    | DECL type name index?
    | GLOBAL? ENUM name name
    | GLOBAL? STRUC name type name
    | SIGNAL name index
    | MOVE target (FAST | SLOW)*
    | MOVE_REL name
    | STEP expression (BY NUMBER)?
    | waiting
    | declared
    | GLOBAL INT name '=' expression
    | START FAST '=' NUMBER SLOW '=' expression MOVE name
    ;

declared : DECL GLOBAL (FRAME | type) name ;

waiting : WAIT FAST NUMBER | WAIT SLOW variable ;

type : INT | REAL | name ;

target : variable | '(' expression ')' ;

expression : primary ('+' primary)* ;

primary : NUMBER | variable | '(' expression ')' ;

variable : name index? ('.' name index?)* ;

index : '[' expression ']' ;

name : NAME ;

INT : 'INT' ;
REAL : 'REAL' ;
FRAME : 'FRAME' ;
DECL : 'DECL' ;
GLOBAL : 'GLOBAL' ;
ENUM : 'ENUM' ;
STRUC : 'STRUC' ;
SIGNAL : 'SIGNAL' ;
MOVE : 'MOVE' ;
MOVE_REL : 'MOVE_REL' ;
STEP : 'STEP' ;
START : 'START' ;
BY : 'BY' ;
WAIT : 'WAIT' ;
FAST : 'FAST' ;
SLOW : 'SLOW' ;
PLUS : '+' ;
ASSIGN : '=' ;
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


@pytest.mark.parametrize(
    ("title", "text"),
    [
        ("GLOBAL ahead of other lines in line", "GLOBAL SIGNAL A [1]\n"),
        ("variables beside values in line 8", "STEP 1 BY A[2]\n"),
        ("MOVE_REL goes on as MOVE does", "MOVE_REL A[1] FAST SLOW\n"),
        ("variables beside values in waiting 1", "WAIT FAST A\n"),
        ("one form for what follows a name in line", "DECL INT A = 1\n"),
        ("an argument of any name in line 12", "START FAST=1 SLOW=1 MOVE A NEW=1+1\n"),
    ],
)
def test_what_is_alike_goes_on_alike(title: str, text: str) -> None:
    """What follows a name, a word ahead of two lines, values, a derived word, an argument."""
    grammar = read(_LIKE)
    folds = {fold.title: fold for fold in folds_of(GrammarView(Recognizer(grammar), ()))}
    folded = apply(grammar, folds[title].edits)
    assert (False, True) == tuple(Recognizer(g).accepts(text) for g in (grammar, folded))


_ARGUMENTS = """grammar Toy;
program : (line NEWLINE)* EOF ;
line
    : MOVE NAME place SLOW '=' any
    | TURN name place
    ;
place : FAST '=' any | FIX '=' any ;
any : NUMBER | OPEN any ;
name : NAME | SLOW ;
"""


def test_words_that_name_arguments() -> None:
    """They may be in a rule of their own, and names elsewhere; two are needed in a line."""
    grammar = read(_declared(_ARGUMENTS))
    (fold,) = (f for f in folds_of(GrammarView(Recognizer(grammar), ())) if "argument" in f.title)
    after = Recognizer(apply(grammar, fold.edits))
    texts = ("MOVE A FAST=1 SLOW=2 NEW=3\n", "TURN A FAST=1 NEW=3\n")
    assert [True, False] == list(map(after.accepts, texts))


def test_a_fold_is_offered_once(grammar: Grammar, folds: dict[str, InferredStep]) -> None:
    """What has been folded is not to be folded again, so that folding comes to an end."""
    again = [
        title
        for title, fold in folds.items()
        for after in folds_of(GrammarView(Recognizer(apply(grammar, fold.edits)), ()))
        if after.edits == fold.edits
    ]
    assert [] == again


_DECLARED = """grammar Toy;
program : (line NEWLINE)* EOF ;
line
    : DIM OPEN? FIX? kind NAME
    | OPEN FIX? kind NAME ('=' NUMBER)?
    | base NAME
    | MOVE NAME SLOW?
    | TURN NAME FAST?
    ;
kind : INT | REAL | NAME ;
base : INT | REAL ;
"""


def _declared(rules: str = _DECLARED) -> str:
    words = "".join(f"{w} : '{w}' ;\n" for w in "INT REAL DIM OPEN FIX MOVE TURN FAST SLOW".split())
    tokens = (
        "ASSIGN : '=' ;\nNAME : [A-Z]+ ;\nNUMBER : [0-9]+ ;\nNEWLINE : '\\n' ;\nWS : ' ' -> skip ;"
    )
    return f"{rules}{words}{tokens}\n"


@pytest.mark.parametrize(
    ("title", "accepted", "rejected"),
    [
        ("OPEN, FIX without DIM in line", "FIX INT A", "FIX A B"),
        ("FAST, SLOW at the end of lines", "MOVE A FAST", "MOVE A NAME"),
    ],
)
def test_what_holds_beside_alike(title: str, accepted: str, rejected: str) -> None:
    """Words behind a first one stand without it too; what ends a line behind a name others do."""
    grammar = read(_declared())
    (fold,) = (f for f in folds_of(GrammarView(Recognizer(grammar), ())) if f.title == title)
    after = Recognizer(apply(grammar, fold.edits))
    assert [True, False] == [after.accepts(f"{line}\n") for line in (accepted, rejected)]


_HEADS = """grammar Toy;
program : (line NEWLINE)* EOF ;
line
    : DIM NAME NUMBER
    | DIM? OPEN NAME NUMBER
    | (DIM | OPEN) FIX NAME NUMBER
    ;
"""


def test_words_that_lines_begin_with() -> None:
    """What may be missing in some lines may in all that go on alike, but not all of it."""
    grammar = read(_declared(_HEADS))
    (fold,) = heads(GrammarView(Recognizer(grammar), ()))
    after = Recognizer(apply(grammar, fold.edits))
    texts = ("FIX A 1\n", "DIM OPEN FIX A 1\n", "FIX OPEN A 1\n", "A 1\n")
    assert [True, True, False, False] == [after.accepts(text) for text in texts]
    assert 1 == len(after.grammar.by_name["line"].alternatives)


_TYPES = """grammar Toy;
program : (line NEWLINE)* EOF ;
line
    : (DIM OPEN? | OPEN) kind NAME
    | DIM? OPEN? FIX base NAME
    | DIM SLOW TURN NAME
    | DIM FAST TURN NAME NAME
    | MOVE FAST base NAME
    | base NAME
    ;
kind : INT | REAL | NAME ;
base : INT | REAL ;
"""


def test_types_behind_other_words() -> None:
    """With a word that all types follow any type follows the next word, too; without it none.

    Of two names side by side the first is such a type.
    """
    grammar = read(_declared(_TYPES))
    folds = list(types(GrammarView(Recognizer(grammar), ())))
    after = Recognizer(apply(grammar, [edit for fold in folds for edit in fold.edits]))
    wider = (
        "DIM FIX A B\n",
        "DIM OPEN FIX A B\n",
        "DIM SLOW A B\n",
        "DIM TURN B\n",
        "DIM FAST TURN INT B\n",
    )
    same = ("FIX INT B\n", "OPEN FIX INT B\n", "DIM FIX INT B\n", "DIM SLOW TURN B\n")
    never = ("FIX A B\n", "OPEN FIX A B\n", "MOVE FAST A B\n", "DIM FAST A B C\n", "A B\n")
    assert not any(map(Recognizer(grammar).accepts, wider))
    assert [True] * 9 + [False] * 5 == list(map(after.accepts, wider + same + never))
    assert [] == list(types(GrammarView(after, ())))


_BLOCKS = """grammar Toy;
program : (block NEWLINE)* EOF ;
statement : (MOVE NAME)? NEWLINE | block NEWLINE ;
block
    : IF any NEWLINE statement* DONE
    | WHILE any NEWLINE statement* DONE
    | CASE NAME NEWLINE statement* DONE
    | SUB NAME '(' (NAME (IN | OUT))? ')' NEWLINE
    | FUN NAME '(' NAME IN ')' NEWLINE
    | DIM NAME '=' (NUMBER | set) NEWLINE
    | FIX NAME '=' set NEWLINE
    ;
any : one ('+' one)* ;
one : NUMBER | NAME | '(' any ')' ;
number : NUMBER ;
set : '{' number (',' number)* '}' ;
"""


def test_what_routines_have_in_brackets() -> None:
    """It is the same in all lines of a rule."""
    grammar = read(_blocks())
    title = "one form between ( and ) in block"
    (fold,) = (f for f in folds_of(GrammarView(Recognizer(grammar), ())) if f.title == title)
    after = Recognizer(apply(grammar, fold.edits))
    texts = ("FUN F(A OUT)\n\n", "FUN F(A)\n\n")
    assert [True, False] == [after.accepts(text) for text in texts]
    assert not Recognizer(grammar).accepts(texts[0])


@pytest.mark.parametrize("kind", FOLDS, ids=lambda kind: kind.__name__)
def test_a_fold_reads_all_that_was_read(
    kind: Callable[[GrammarView], Iterator[InferredStep]],
) -> None:
    """Each kind of fold is offered, well formed, and reads the sentences of the grammar."""
    offered = 0
    for text in (
        _GRAMMAR,
        _LIKE,
        _KINDS,
        _declared(),
        _declared(_HEADS),
        _declared(_TYPES),
        _blocks(),
        _values(),
    ):
        grammar = read(text)
        sentences, speller, random = Sentences(grammar), Speller(grammar), Random(3)
        texts = [speller.text(sentences.random(random)) for _ in range(100)]
        view = GrammarView(Recognizer(grammar), ())
        for fold in (fold for fold in kind(view) if fold.edits):
            folded = apply(grammar, fold.edits)
            recognizer = Recognizer(folded)
            assert (None, []) == (problem(folded), [t for t in texts if not recognizer.accepts(t)])
            offered += 1
    assert offered


def test_any_operand_in_place_of_variables_and_values() -> None:
    """A choice of a variable and a value reads any operand, be it a group or a rule."""
    grammar = read(_values())
    folds = {fold.title: fold.edits for fold in any_operands(GrammarView(Recognizer(grammar), ()))}
    title = "any operand in {} in place of variables and values"
    for rule, text in (("line", "WAIT 1 + 1\n"), ("target", "MOVE A + 1\n")):
        after = apply(grammar, folds[title.format(rule)])
        assert (False, True) == tuple(Recognizer(g).accepts(text) for g in (grammar, after))
        assert not Recognizer(after).accepts("TURN 1\n")


@pytest.mark.parametrize(
    ("seen", "accepted"), [("number", [False, False]), ("variable", [True, True])]
)
def test_what_a_sign_has_behind_it(seen: str, accepted: list[bool]) -> None:
    """Variables beside other operands make it any operand, constants of two kinds do not."""
    lines = f"line : SET NAME '=' text | TURN NAME '=' {seen} | WAIT sum |"
    rules = _values().replace("line : SET NAME '=' sum |", lines)
    text = rules.replace("one : number", "text : TEXT ;\none : text | number")
    grammar = read(text.replace("NAME : [A-Z]+", "TEXT : '\"' [A-Z]* '\"' ;\nNAME : [A-Z]+"))
    recognizer = Recognizer(grammar)
    operands = [(recognizer.lexer.kind_of[name],) for name in ("NAME", "NUMBER", "TEXT")]
    for fold in behind_signs(GrammarView(recognizer, operands)):
        grammar = apply(grammar, fold.edits)
    texts = ("SET A = B\n", "TURN A = 1 + 1\n", 'TURN A = "B"\n')
    assert [*accepted, True] == [Recognizer(grammar).accepts(text) for text in texts]


def _values() -> str:
    rules = """
line : SET NAME '=' sum | WAIT (number | variable)? | MOVE target | TURN (NAME | variable) ;
target : variable | number ;
sum : one ('+' one)* ;
one : number | variable | '(' sum ')' ;
number : NUMBER ;
variable : NAME ('.' NAME)* ;
"""
    words = "".join(f"{word} : '{word}' ;\n" for word in ("WAIT", "MOVE", "TURN", "SET"))
    tokens = f"DOT : '.' ;\n{words}{_BLOCK_TOKENS}"
    return f"grammar Toy;\nprogram : (line NEWLINE)* EOF ;\n{rules}{tokens}"


_BLOCK_WORDS = "IF WHILE CASE SUB FUN DIM FIX IN OUT MOVE DONE"
_BLOCK_TOKENS = """COMMA : ',' ;
PLUS : '+' ;
ASSIGN : '=' ;
LPAREN : '(' ;
RPAREN : ')' ;
LBRACE : '{' ;
RBRACE : '}' ;
NAME : [A-Z]+ ;
NUMBER : [0-9]+ ;
NEWLINE : '\\n' ;
WS : ' ' -> skip ;
"""


@pytest.mark.parametrize(("modes", "accepted"), [("IN", [True, False]), ("IN | OUT", [False] * 2)])
def test_words_in_place_of_names(modes: str, accepted: list[bool]) -> None:
    """Words behind a sign may be where lines have a name there; several are all that may be."""
    text = _blocks().replace("NAME (IN | OUT)", "NAME '-' NAME")
    text = text.replace("NAME IN", f"NAME '-' ({modes})").replace("PLUS :", "MINUS : '-' ;\nPLUS :")
    grammar = read(text)
    for kind in (behind_signs, closed_choices):
        folds = kind(GrammarView(Recognizer(grammar), ()))
        grammar = apply(grammar, [edit for fold in folds for edit in fold.edits])
    recognizer = Recognizer(grammar)
    assert recognizer.accepts("SUB F(A-IN)\n\n")
    assert accepted == [recognizer.accepts(f"{w} F(A-B)\n\n") for w in ("SUB", "FUN")]


def test_heads_of_blocks() -> None:
    """A name alone behind the first word of a block is any operand, but not where it has a sign."""
    grammar = read(_blocks())
    (fold,) = heads_of_blocks(GrammarView(Recognizer(grammar), ()))
    after = Recognizer(apply(grammar, fold.edits))
    texts = ("CASE A + 1\nDONE\n", "CASE A\nDONE\n", "DIM 1 = 1\n\n")
    assert [True, True, False] == [after.accepts(text) for text in texts]


def _blocks() -> str:
    words = "".join(f"{w} : '{w}' ;\n" for w in _BLOCK_WORDS.split())
    return f"{_BLOCKS.replace('NUMBER | set', 'number | set')}{words}{_BLOCK_TOKENS}"


def test_a_bracketed_rule_stays_one() -> None:
    """A fold writes the rule of what is in brackets, and not what is in it."""
    lines = "MOVE NAME '=' (set | number) | MOVE FIX NAME '=' set"
    text = _BLOCKS.replace("SUB NAME '(' (NAME (IN | OUT))? ')'", "SUB").replace(
        "program : (block NEWLINE)* EOF ;", f"program : (line NEWLINE)* EOF ;\nline : {lines} ;"
    )
    words = "".join(f"{w} : '{w}' ;\n" for w in _BLOCK_WORDS.split())
    folds = folds_of(GrammarView(Recognizer(read(f"{text}{words}{_BLOCK_TOKENS}")), ()))
    (fold,) = (f for f in folds if f.title == "one form for MOVE in line")
    assert "MOVE FIX? NAME '=' (number | set)" in {getattr(e, "text", "") for e in fold.edits}
