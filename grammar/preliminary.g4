/*
 * KRL, the KUKA Robot Language: the deliberately restrictive start.
 *
 * Written from documented facts only and in their narrowest reading: one form a statement, no
 * optional part without proof, every keyword reserved. It is meant to fail on real programs: what
 * it refuses is what the survey shows, and what enters afterwards enters with evidence
 * (constructs/NNNN-name.toml). KRL.g4 is this file plus those constructs, replayed in order.
 *
 * Style, on which our own reader of grammars relies: no actions, no predicates, no left recursion,
 * no lexer modes; keywords are named tokens, punctuation is quoted; one alternative a line.
 * IDs in brackets name rules of docs/semantics.md.
 */
grammar KRL;

options { caseInsensitive = true; }

// ---------------------------------------------------------------------------------------- files

module
    : NEWLINE* (HEADER eol)* (program | dataList) NEWLINE* EOF
    ;

// The first routine carries the name of the file; local ones follow it [SCO-01, SCO-02].
program
    : procedure (eol procedure)*
    ;

// Declarations come before instructions [SCO-09].
procedure
    : DEF NAME '(' ')' eol declaration* statement* END
    ;

// Only a data list may give initial values [TYP-10, SCO-03].
dataList
    : DEFDAT NAME eol initialisation* ENDDAT
    ;

// KRL is a language of lines: a statement ends where its line ends.
eol
    : NEWLINE+
    ;

// --------------------------------------------------------------------------------- declarations

declaration
    : DECL type NAME eol
    ;

initialisation
    : DECL type NAME '=' literal eol
    ;

// Predefined structures (POS, AXIS …) are names like any other type [TYP-14, TYP-15].
type
    : INT
    | REAL
    | BOOL
    | CHAR
    | NAME
    ;

// ----------------------------------------------------------------------------------- statements

statement
    : simpleStatement eol
    | ifStatement eol
    | forStatement eol
    | whileStatement eol
    | repeatStatement eol
    | loopStatement eol
    ;

simpleStatement
    : assignment
    | call
    | motion
    | interrupt
    | trigger
    | wait
    | brake
    | exit
    | halt
    | continue
    | resume
    | return
    ;

assignment
    : variable '=' (expression | aggregate)
    ;

call
    : NAME '(' arguments? ')'
    ;

arguments
    : expression (',' expression)*
    ;

// --------------------------------------------------------------------------------- control flow

ifStatement
    : IF expression THEN eol statement* (ELSE eol statement*)? ENDIF
    ;

// Without STEP, whose form only recollection documents [CTL-05].
forStatement
    : FOR NAME '=' expression TO expression eol statement* ENDFOR
    ;

whileStatement
    : WHILE expression eol statement* ENDWHILE
    ;

repeatStatement
    : REPEAT eol statement* UNTIL expression
    ;

loopStatement
    : LOOP eol statement* ENDLOOP
    ;

exit
    : EXIT
    ;

// Statements that hold the advance run, or let it go on [ADV-04, ADV-08].
halt
    : HALT
    ;

continue
    : CONTINUE
    ;

wait
    : WAIT FOR expression
    | WAIT SEC expression
    ;

return
    : RETURN
    ;

// -------------------------------------------------------------------------------------- motions

// Axis space takes C_PTP, Cartesian space C_DIS [BLD-01, BLD-12].
motion
    : PTP target C_PTP?
    | LIN target C_DIS?
    | CIRC target ',' target C_DIS?
    ;

target
    : variable
    | aggregate
    ;

// ---------------------------------------------------------------------- interrupts and triggers

// [INT-01, INT-07]
interrupt
    : INTERRUPT DECL INTEGER WHEN expression DO interruptAction
    | INTERRUPT ON INTEGER
    | INTERRUPT OFF INTEGER
    ;

interruptAction
    : call
    | brake
    ;

brake
    : BRAKE
    ;

resume
    : RESUME
    ;

// DISTANCE 0 refers to the start of the next motion, 1 to its end [TRG-01].
trigger
    : TRIGGER WHEN DISTANCE '=' INTEGER DELAY '=' INTEGER DO triggerAction
    ;

// [TRG-05]
triggerAction
    : assignment
    | call
    ;

// ---------------------------------------------------------------------------------- expressions

// Relations bind weakest [ARI-05].
expression
    : disjunction (relation disjunction)?
    ;

relation
    : '=='
    | '<>'
    | '<'
    | '>'
    | '<='
    | '>='
    ;

disjunction
    : conjunction (OR conjunction)*
    ;

conjunction
    : sum (AND sum)*
    ;

sum
    : product (('+' | '-') product)*
    ;

product
    : factor (('*' | '/') factor)*
    ;

factor
    : NOT factor
    | primary
    ;

primary
    : literal
    | variable
    | call
    | '(' expression ')'
    ;

variable
    : NAME index? ('.' NAME index?)*
    ;

index
    : '[' expression ']'
    ;

literal
    : '-'? (INTEGER | REAL_NUMBER)
    | TRUE
    | FALSE
    | BIT_STRING
    | STRING
    | ENUM_CONSTANT
    ;

// The type in front is proven; leaving it out is not [TYP-19].
aggregate
    : '{' NAME ':' component (',' component)* '}'
    ;

component
    : NAME literal
    ;

// --------------------------------------------------------------------------------------- tokens

AND : 'AND' ;
BOOL : 'BOOL' ;
BRAKE : 'BRAKE' ;
C_DIS : 'C_DIS' ;
C_PTP : 'C_PTP' ;
CHAR : 'CHAR' ;
CIRC : 'CIRC' ;
CONTINUE : 'CONTINUE' ;
DECL : 'DECL' ;
DEF : 'DEF' ;
DEFDAT : 'DEFDAT' ;
DELAY : 'DELAY' ;
DISTANCE : 'DISTANCE' ;
DO : 'DO' ;
ELSE : 'ELSE' ;
END : 'END' ;
ENDDAT : 'ENDDAT' ;
ENDFOR : 'ENDFOR' ;
ENDIF : 'ENDIF' ;
ENDLOOP : 'ENDLOOP' ;
ENDWHILE : 'ENDWHILE' ;
EXIT : 'EXIT' ;
FALSE : 'FALSE' ;
FOR : 'FOR' ;
HALT : 'HALT' ;
IF : 'IF' ;
INT : 'INT' ;
INTERRUPT : 'INTERRUPT' ;
LIN : 'LIN' ;
LOOP : 'LOOP' ;
NOT : 'NOT' ;
OFF : 'OFF' ;
ON : 'ON' ;
OR : 'OR' ;
PTP : 'PTP' ;
REAL : 'REAL' ;
REPEAT : 'REPEAT' ;
RESUME : 'RESUME' ;
RETURN : 'RETURN' ;
SEC : 'SEC' ;
THEN : 'THEN' ;
TO : 'TO' ;
TRIGGER : 'TRIGGER' ;
TRUE : 'TRUE' ;
UNTIL : 'UNTIL' ;
WAIT : 'WAIT' ;
WHEN : 'WHEN' ;
WHILE : 'WHILE' ;

EQUALS : '==' ;
NOT_EQUAL : '<>' ;
AT_MOST : '<=' ;
AT_LEAST : '>=' ;
LESS : '<' ;
GREATER : '>' ;
ASSIGN : '=' ;
PLUS : '+' ;
MINUS : '-' ;
TIMES : '*' ;
DIVIDE : '/' ;
LPAREN : '(' ;
RPAREN : ')' ;
LBRACKET : '[' ;
RBRACKET : ']' ;
LBRACE : '{' ;
RBRACE : '}' ;
COMMA : ',' ;
COLON : ':' ;
DOT : '.' ;

// Letters, digits, _ and $, no leading digit; the length is the checker's affair [TYP-05].
NAME : '$'? [A-Z_] [A-Z0-9_$]* ;

// #NAME, resolved by the type of the target [TYP-16].
ENUM_CONSTANT : '#' [A-Z_] [A-Z0-9_$]* ;

INTEGER : [0-9]+ ;
REAL_NUMBER : [0-9]+ '.' [0-9]+ ;

// [TYP-04]
BIT_STRING : '\'B' [01]+ '\'' | '\'H' [0-9A-F]+ '\'' ;

STRING : '"' ~["\r\n]* '"' ;

// A header line of the controller's file system: &ACCESS, &REL, &PARAM …
HEADER : '&' ~[\r\n]* ;

NEWLINE : '\r\n' | '\n' | '\r' ;

// FOLD lines are comments to the controller too.
COMMENT : ';' ~[\r\n]* -> skip ;
SPACE : [ \t]+ -> skip ;
