/*
 * KRL, the KUKA Robot Language, as real controller source and the manuals show it.
 *
 * This file is made, not written: preliminary.g4 plus every accepted construct in constructs/,
 * replayed in the order of their numbers. Each construct holds its evidence. To change the
 * language, add a construct (krl construct propose, try, accept); `krl construct replay --check`
 * tells whether this file still is what the ledger says.
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
    : routine (eol routine)*
    ;

routine
    : procedure
    | function
    ;

// That declarations come before instructions is the checker's affair [SCO-09].
procedure
    : GLOBAL? DEF name '(' parameters? ')' eol statement* END
    ;

// The type of the result stands before the name [TYP-17].
function
    : GLOBAL? DEFFCT type index? name '(' parameters? ')' eol statement* ENDFCT
    ;

parameters
    : parameter (',' parameter)*
    ;

// By reference where nothing is said; whole arrays with empty brackets [SCO-06, SCO-07].
parameter
    : name index? (':' parameterMode)?
    ;

parameterMode
    : IN
    | OUT
    ;

dataList
    : DEFDAT name PUBLIC? eol initialisation* ENDDAT
    ;

// KRL is a language of lines: a statement ends where its line ends.
eol
    : NEWLINE+
    ;

// --------------------------------------------------------------------------------- declarations

declaration
    : DECL type declarator (',' declarator)* eol
    | predefinedType declarator (',' declarator)* eol
    | definition eol
    ;

// What declares more than a variable.
definition
    : enumeration
    | structure
    | signal
    | external
    | channel
    | importation
    ;

// [TYP-16]
enumeration
    : GLOBAL? ENUM name enumerator (',' enumerator)*
    ;

enumerator
    : name
    | keyword
    ;

// [TYP-14, TYP-15]
structure
    : GLOBAL? STRUC name memberGroup (',' memberGroup)*
    ;

memberGroup
    : type declarator (',' declarator)*
    ;

// A predefined signal may be connected to nothing [IOT-03].
signal
    : DECL? GLOBAL? SIGNAL name variable (TO variable)?
    | DECL? GLOBAL? SIGNAL name FALSE
    ;

// Routines of other modules, and the types of their parameters [SCO-10].
external
    : (EXT | EXTP) name '(' externalParameters? ')'
    | (EXTFCT | EXTFCTP) type index? name '(' externalParameters? ')'
    ;

externalParameters
    : externalParameter (',' externalParameter)*
    ;

externalParameter
    : type name? index? (':' parameterMode)?
    ;

channel
    : CHANNEL ':' name ':' name variable
    ;

// [ADV-05]
importation
    : DECL? IMPORT type declarator IS ('/' name)+ '.' '.' variable
    ;

declarator
    : name index?
    ;

initialisation
    : DECL GLOBAL? CONST? type initialisedDeclarator (',' initialisedDeclarator)* eol
    | GLOBAL? CONST? predefinedType initialisedDeclarator (',' initialisedDeclarator)* eol
    | variable '=' initialValue eol
    | definition eol
    ;

// Only a data list may give initial values [TYP-10, SCO-03].
initialisedDeclarator
    : declarator ('=' initialValue)?
    ;

initialValue
    : constant
    | aggregate
    ;

type
    : INT
    | REAL
    | BOOL
    | CHAR
    | name
    ;

// Types that need no DECL [TYP-06].
predefinedType
    : INT
    | REAL
    | BOOL
    | CHAR
    | positionType
    ;

// Names like any other, but for their use without DECL [TYP-15, FCT-03, FCT-05].
positionType
    : FRAME
    | POS
    | E3POS
    | E6POS
    | AXIS
    | E3AXIS
    | E6AXIS
    ;

// ----------------------------------------------------------------------------------- statements

statement
    : simpleStatement eol
    | ifStatement eol
    | forStatement eol
    | whileStatement eol
    | repeatStatement eol
    | loopStatement eol
    | declaration
    | switchStatement eol
    | splineBlock eol
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
    | goto
    | label
    | onErrorProceed
    | cyclicSignal
    | splineMotion
    | emilyMotion
    | confirm
    | approximatedSplineMotion
    ;

assignment
    : variable '=' expression
    ;

call
    : name '(' arguments ')'
    ;

// An argument may be left out [SCO-13].
arguments
    : argument? (',' argument?)*
    ;

// A channel is named with a colon in front.
argument
    : expression
    | ':' name
    ;

// --------------------------------------------------------------------------------- control flow

ifStatement
    : IF expression THEN eol statement* (ELSE eol statement*)? ENDIF
    ;

// [CTL-05]
forStatement
    : FOR name '=' expression TO expression (STEP expression)? eol statement* ENDFOR
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

// DEFAULT is the last branch [CTL-03, CTL-04].
switchStatement
    : SWITCH expression eol caseBranch+ defaultBranch? ENDSWITCH
    ;

caseBranch
    : CASE caseValue (',' caseValue)* eol statement*
    ;

caseValue
    : constant
    | variable
    ;

defaultBranch
    : DEFAULT eol statement*
    ;

exit
    : EXIT
    ;

// The target lies in the same routine [CTL-07].
goto
    : GOTO name
    ;

label
    : name ':'
    ;

// Statements that hold the advance run, or let it go on [ADV-04, ADV-08].
halt
    : HALT
    ;

continue
    : CONTINUE
    ;

onErrorProceed
    : ON_ERROR_PROCEED
    ;

confirm
    : CONFIRM expression
    ;

wait
    : WAIT FOR expression
    | WAIT SEC expression
    ;

// Read or written again and again until switched off [IOT-04, IOT-05, IOT-09].
cyclicSignal
    : (ANIN | DIGIN) ON assignment
    | ANOUT ON assignment (DELAY '=' expression)? (MINIMUM '=' expression)? (MAXIMUM '=' expression)?
    | (ANIN | ANOUT | DIGIN) OFF variable
    ;

return
    : RETURN expression?
    ;

// -------------------------------------------------------------------------------------- motions

motion
    : (PTP | PTP_REL) target approximation?
    | LIN target approximation?
    | CIRC target ',' target (',' CA expression)? approximation?
    | LIN_REL target approximation? reference?
    | CIRC_REL target ',' target (',' CA expression)? approximation? reference?
    | ASYPTP target
    ;

// #BASE or #TOOL [MOT-14].
reference
    : ENUM_CONSTANT
    ;

// The second criterion is of use where the two motions are of different kinds [BLD-06].
approximation
    : criterion criterion?
    ;

criterion
    : C_PTP
    | C_DIS
    | C_ORI
    | C_VEL
    ;

// Alone or in a spline block [SPL-01, SPL-02]; only these take values of their own [SPL-08].
splineMotion
    : (SPTP | SLIN | SPL) target with? C_SPL?
    | SCIRC target ',' target (',' CA expression)? with? C_SPL?
    | (SPTP_REL | SLIN_REL | SPL_REL) target with? C_SPL? reference?
    | SCIRC_REL target ',' target (',' CA expression)? with? C_SPL? reference?
    ;

// Alone, with a criterion of the older planner [SPL-02]; none stands in a block [SPL-04].
approximatedSplineMotion
    : (SPTP | SLIN) target with? approximation
    | SCIRC target ',' target (',' CA expression)? with? approximation
    | (SPTP_REL | SLIN_REL) target with? approximation reference?
    | SCIRC_REL target ',' target (',' CA expression)? with? approximation reference?
    ;

emilyMotion
    : MOVE_EMI emilyName emilyName (FLT expression)?
    ;

emilyName
    : STRING
    | variable
    ;

with
    : WITH assignment (',' assignment)*
    ;

// What else cannot stand in a block is the checker's affair where it is a motion [SPL-04].
splineBlock
    : (SPLINE | PTP_SPLINE) with? eol (splineItem eol)* ENDSPLINE C_SPL?
    ;

// [SPL-05, SPL-06, SPL-07, SPL-10]
splineItem
    : motion
    | splineMotion
    | trigger
    | CONST_VEL (START | END) '=' expression ONSTART?
    | TIME_BLOCK START
    | TIME_BLOCK (PART | END) '=' expression
    | STOP WHEN PATH '=' expression ONSTART? IF expression
    ;

target
    : frame (':' frame)*
    ;

// What can give a position: no number, no truth value, no text.
frame
    : variable
    | call
    | aggregate
    | '(' expression ')'
    ;

// ---------------------------------------------------------------------- interrupts and triggers

// [INT-01, INT-07]
interrupt
    : GLOBAL? INTERRUPT DECL expression WHEN expression DO interruptAction
    | INTERRUPT (ON | OFF | ENABLE | DISABLE) expression?
    ;

interruptAction
    : call
    | brake
    ;

brake
    : BRAKE (F | FF)?
    ;

resume
    : RESUME
    ;

trigger
    : TRIGGER WHEN place DELAY '=' expression DO triggerAction (PRIO '=' expression)?
    ;

// DISTANCE 0 refers to the start of the next motion, 1 to its end; PATH counts millimetres from its
// end or, with ONSTART, from its start [TRG-01, TRG-04, SPL-07].
place
    : DISTANCE '=' expression
    | PATH '=' expression ONSTART?
    ;

// [TRG-05]
triggerAction
    : assignment
    | call
    ;

// ---------------------------------------------------------------------------------- expressions

// From the weakest to the tightest: relations, OR, EXOR, AND, sums, products, NOT and signs, the
// geometric operator [ARI-05, ARI-08; docs/adr/0011].
expression
    : disjunction (relation disjunction)*
    ;

relation
    : '=='
    | '<>'
    | '<'
    | '>'
    | AT_MOST
    | AT_LEAST
    ;

disjunction
    : exclusion ((OR | B_OR) exclusion)*
    ;

exclusion
    : conjunction ((EXOR | B_EXOR) conjunction)*
    ;

conjunction
    : sum ((AND | B_AND) sum)*
    ;

sum
    : product (('+' | '-') product)*
    ;

product
    : factor (('*' | '/') factor)*
    ;

factor
    : (NOT | B_NOT) factor
    | composition
    | ('+' | '-') factor
    ;

// Frames, composed from left to right [ARI-08].
composition
    : primary (':' primary)*
    ;

primary
    : literal
    | variable
    | call
    | '(' expression ')'
    | aggregate
    ;

variable
    : name index? ('.' name index?)*
    ;

// Keywords that mean something in one place only are names everywhere else [TYP-05].
name
    : NAME
    | DELAY
    | DISTANCE
    | SEC
    | IN
    | OUT
    | positionType
    | IS
    | STEP
    | ENABLE
    | DISABLE
    | F
    | FF
    | PRIO
    | PATH
    | ONSTART
    | MINIMUM
    | MAXIMUM
    | CA
    | START
    | PART
    | STOP
    | FLT
    ;

// Every other keyword: only a constant of an enumeration can be called so, as a hash marks its use.
keyword
    : AND
    | B_AND
    | B_EXOR
    | B_NOT
    | B_OR
    | BOOL
    | BRAKE
    | C_DIS
    | C_PTP
    | CHAR
    | CIRC
    | CONST
    | CONTINUE
    | DECL
    | DEF
    | DEFDAT
    | DEFFCT
    | DO
    | ELSE
    | END
    | ENDDAT
    | ENDFCT
    | ENDFOR
    | ENDIF
    | ENDLOOP
    | ENDWHILE
    | ENUM
    | EXIT
    | EXOR
    | FALSE
    | FOR
    | GLOBAL
    | HALT
    | IF
    | INT
    | INTERRUPT
    | LIN
    | LOOP
    | NOT
    | OFF
    | ON
    | OR
    | PTP
    | PUBLIC
    | REAL
    | REPEAT
    | RESUME
    | RETURN
    | THEN
    | TO
    | TRIGGER
    | TRUE
    | UNTIL
    | WAIT
    | WHEN
    | WHILE
    | STRUC
    | SIGNAL
    | EXT
    | EXTFCT
    | EXTP
    | EXTFCTP
    | CHANNEL
    | IMPORT
    | SWITCH
    | CASE
    | DEFAULT
    | ENDSWITCH
    | GOTO
    | ON_ERROR_PROCEED
    | ANIN
    | ANOUT
    | DIGIN
    | C_ORI
    | C_VEL
    | PTP_REL
    | LIN_REL
    | CIRC_REL
    | SPTP
    | SLIN
    | SCIRC
    | SPL
    | SPTP_REL
    | SLIN_REL
    | SCIRC_REL
    | SPL_REL
    | C_SPL
    | WITH
    | SPLINE
    | PTP_SPLINE
    | ENDSPLINE
    | CONST_VEL
    | TIME_BLOCK
    | ASYPTP
    | MOVE_EMI
    | CONFIRM
    ;

// One to three dimensions; an index left out means all of the dimension [TYP-08, TYP-11].
index
    : '[' expression? (',' expression? (',' expression?)?)? ']'
    ;

literal
    : number
    | TRUE
    | FALSE
    | BIT_STRING
    | STRING
    | ENUM_CONSTANT
    ;

number
    : INTEGER
    | REAL_NUMBER
    ;

constant
    : ('+' | '-') number
    | literal
    ;

// The type in front may be left out [TYP-19].
aggregate
    : '{' (name ':')? component (',' component)* '}'
    ;

component
    : name index? (constant | aggregate)
    ;

// --------------------------------------------------------------------------------------- tokens

AND : 'AND' ;
ANIN : 'ANIN' ;
ANOUT : 'ANOUT' ;
ASYPTP : 'ASYPTP' ;
AXIS : 'AXIS' ;
B_AND : 'B_AND' ;
B_EXOR : 'B_EXOR' ;
B_NOT : 'B_NOT' ;
B_OR : 'B_OR' ;
BOOL : 'BOOL' ;
BRAKE : 'BRAKE' ;
C_DIS : 'C_DIS' ;
C_ORI : 'C_ORI' ;
C_PTP : 'C_PTP' ;
C_SPL : 'C_SPL' ;
C_VEL : 'C_VEL' ;
CA : 'CA' ;
CASE : 'CASE' ;
CHANNEL : 'CHANNEL' ;
CHAR : 'CHAR' ;
CIRC : 'CIRC' ;
CIRC_REL : 'CIRC_REL' ;
CONFIRM : 'CONFIRM' ;
CONST : 'CONST' ;
CONST_VEL : 'CONST_VEL' ;
CONTINUE : 'CONTINUE' ;
DECL : 'DECL' ;
DEF : 'DEF' ;
DEFAULT : 'DEFAULT' ;
DEFDAT : 'DEFDAT' ;
DEFFCT : 'DEFFCT' ;
DELAY : 'DELAY' ;
DIGIN : 'DIGIN' ;
DISABLE : 'DISABLE' ;
DISTANCE : 'DISTANCE' ;
DO : 'DO' ;
E3AXIS : 'E3AXIS' ;
E3POS : 'E3POS' ;
E6AXIS : 'E6AXIS' ;
E6POS : 'E6POS' ;
ELSE : 'ELSE' ;
ENABLE : 'ENABLE' ;
END : 'END' ;
ENDDAT : 'ENDDAT' ;
ENDFCT : 'ENDFCT' ;
ENDFOR : 'ENDFOR' ;
ENDIF : 'ENDIF' ;
ENDLOOP : 'ENDLOOP' ;
ENDSPLINE : 'ENDSPLINE' ;
ENDSWITCH : 'ENDSWITCH' ;
ENDWHILE : 'ENDWHILE' ;
ENUM : 'ENUM' ;
EXIT : 'EXIT' ;
EXOR : 'EXOR' ;
EXT : 'EXT' ;
EXTFCT : 'EXTFCT' ;
EXTFCTP : 'EXTFCTP' ;
EXTP : 'EXTP' ;
F : 'F' ;
FALSE : 'FALSE' ;
FF : 'FF' ;
FLT : 'FLT' ;
FOR : 'FOR' ;
FRAME : 'FRAME' ;
GLOBAL : 'GLOBAL' ;
GOTO : 'GOTO' ;
HALT : 'HALT' ;
IF : 'IF' ;
IMPORT : 'IMPORT' ;
IN : 'IN' ;
INT : 'INT' ;
INTERRUPT : 'INTERRUPT' ;
IS : 'IS' ;
LIN : 'LIN' ;
LIN_REL : 'LIN_REL' ;
LOOP : 'LOOP' ;
MAXIMUM : 'MAXIMUM' ;
MINIMUM : 'MINIMUM' ;
MOVE_EMI : 'MOVE_EMI' ;
NOT : 'NOT' ;
OFF : 'OFF' ;
ON : 'ON' ;
ON_ERROR_PROCEED : 'ON_ERROR_PROCEED' ;
ONSTART : 'ONSTART' ;
OR : 'OR' ;
OUT : 'OUT' ;
PART : 'PART' ;
PATH : 'PATH' ;
POS : 'POS' ;
PRIO : 'PRIO' ;
PTP : 'PTP' ;
PTP_REL : 'PTP_REL' ;
PTP_SPLINE : 'PTP_SPLINE' ;
PUBLIC : 'PUBLIC' ;
REAL : 'REAL' ;
REPEAT : 'REPEAT' ;
RESUME : 'RESUME' ;
RETURN : 'RETURN' ;
SCIRC : 'SCIRC' ;
SCIRC_REL : 'SCIRC_REL' ;
SEC : 'SEC' ;
SIGNAL : 'SIGNAL' ;
SLIN : 'SLIN' ;
SLIN_REL : 'SLIN_REL' ;
SPL : 'SPL' ;
SPL_REL : 'SPL_REL' ;
SPLINE : 'SPLINE' ;
SPTP : 'SPTP' ;
SPTP_REL : 'SPTP_REL' ;
START : 'START' ;
STEP : 'STEP' ;
STOP : 'STOP' ;
STRUC : 'STRUC' ;
SWITCH : 'SWITCH' ;
THEN : 'THEN' ;
TIME_BLOCK : 'TIME_BLOCK' ;
TO : 'TO' ;
TRIGGER : 'TRIGGER' ;
TRUE : 'TRUE' ;
UNTIL : 'UNTIL' ;
WAIT : 'WAIT' ;
WHEN : 'WHEN' ;
WHILE : 'WHILE' ;
WITH : 'WITH' ;

EQUALS : '==' ;
NOT_EQUAL : '<>' ;
AT_MOST : '<=' | '=<' ;
AT_LEAST : '>=' | '=>' ;
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
REAL_NUMBER : [0-9]+ '.' [0-9]+ ([E] [+\-]? [0-9]+)? | [0-9]+ [E] [+\-]? [0-9]+ ;

// [TYP-04]
BIT_STRING : '\'B' ' '* [01] [01 ]* '\'' | '\'H' ' '* [0-9A-F] [0-9A-F ]* '\'' ;

STRING : '"' ~["\r\n]* '"' ;

// A header line of the controller's file system: &ACCESS, &REL, &PARAM …
HEADER : '&' ~[\r\n]* ;

NEWLINE : '\r\n' | '\n' | '\r' ;

// FOLD lines are comments to the controller too.
COMMENT : ';' ~[\r\n]* -> skip ;
SPACE : [ \t]+ -> skip ;
