"""A small language of lines that is no KRL, and programs in it."""

import pytest

from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from recovery.induction.language import CorpusFile

_START = """grammar Toy;

program
    : NEWLINE* statement* EOF
    ;

eol
    : NEWLINE+
    ;

statement
    : simpleStatement eol
    ;

simpleStatement
    : assignment
    | call
    | halt
    ;

assignment
    : NAME ':=' expression
    ;

call
    : NAME '(' arguments? ')'
    ;

arguments
    : expression (',' expression)*
    ;

halt
    : HALT
    ;

expression
    : product ('+' product)*
    ;

product
    : factor ('*' factor)*
    ;

factor
    : primary
    ;

primary
    : NUMBER
    | NAME
    | call
    | '(' expression ')'
    ;

HALT : 'HALT' ;

ASSIGN : ':=' ;
PLUS : '+' ;
TIMES : '*' ;
SLASH : '/' ;
COMMA : ',' ;
LPAREN : '(' ;
RPAREN : ')' ;

NAME : [A-Z] [A-Z0-9]* ;
NUMBER : [0-9]+ ;
NEWLINE : '\\n' ;
SPACE : [ \\t]+ -> skip ;
"""


@pytest.fixture(scope="session")
def toy() -> Grammar:
    """The start: assignments, calls and HALT."""
    return read(_START)


@pytest.fixture(scope="session")
def toy_files() -> tuple[CorpusFile, ...]:
    """Programs of three origins with statements, a block and an operator the start lacks."""
    texts = [
        ("one", "REPEATN 3\n MOVE A\n B := C / 2\nDONE\nMOVE F(1) SLOW\n"),
        ("one", "X := 1\nMOVE X\nREPEATN X + 1\n Y := Y / X\nDONE\nHALT\n"),
        ("two", "REPEATN N\n REPEATN 2\n  MOVE Q SLOW\n DONE\nDONE\nMOVE B\n"),
        ("two", "MOVE Z SLOW\nMOVE G\nZ := (A / B) * 3\n"),
        ("three", "REPEATN 10\n MOVE P\n P := P / 3\n MOVE P SLOW\nDONE\n"),
        ("three", "MOVE K\nMOVE L SLOW\nREPEATN K\n L := L + 1\nDONE\n"),
    ]
    return tuple(
        CorpusFile(f"{origin}/{n}.toy", text, frozenset({origin}))
        for n, (origin, text) in enumerate(texts)
    )
