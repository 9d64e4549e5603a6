/*
 * A generous grammar of KRL, made for the tests of the generated negatives only. It takes every
 * program of the own corpus and a good deal more: any type and member, soft keywords as names,
 * statements in any order. What it refuses is hardly refused for want of a construct.
 */
grammar Permissive;

options { caseInsensitive = true; }

module : NEWLINE* (HEADER eol)* ((routine | dataList) eol)* (routine | dataList)? EOF ;
routine
    : 'GLOBAL'? 'DEF' name '(' parameters? ')' eol line* 'END'
    | 'GLOBAL'? 'DEFFCT' type size? name '(' parameters? ')' eol line* 'ENDFCT'
    ;
dataList : 'DEFDAT' name 'PUBLIC'? eol ((data | definition | external | assignment) eol)* 'ENDDAT' ;
data : 'DECL'? 'GLOBAL'? 'CONST'? type item (',' item)* ;
eol : NEWLINE+ ;

parameters : parameter (',' parameter)* ;
parameter : name size? (':' ('IN' | 'OUT'))? ;

line : (local | definition | external | statement) eol ;
local : 'DECL'? type name size? (',' name size?)* ;
external
    : ('EXT' | 'EXTP') name '(' formals? ')'
    | ('EXTFCT' | 'EXTFCTP') type size? name '(' formals? ')'
    ;
formals : formal (',' formal)* ;
formal : type? name size? (':' ('IN' | 'OUT'))? | type size? (':' ('IN' | 'OUT'))? ;
definition
    : 'DECL'? 'GLOBAL'? 'ENUM' name constant (',' constant)*
    | 'DECL'? 'GLOBAL'? 'STRUC' name type word size? (',' type? word size?)*
    | 'DECL'? 'GLOBAL'? 'SIGNAL' name (path ('TO' path)? | 'FALSE')
    | 'CHANNEL' ':' name ':' name path
    | 'DECL'? 'IMPORT' type name size? 'IS' '/' name '/' name '.' '.' name size?
    ;
item : name size? ('=' value)? ;
type : 'INT' | 'REAL' | 'BOOL' | 'CHAR' | name ;
size : '[' (expression? (',' expression?)*) ']' ;

statement
    : assignment
    | name ':'
    | call
    | motion
    | 'GOTO' name
    | 'HALT' | 'EXIT' | 'CONTINUE' | 'RESUME' | 'ON_ERROR_PROCEED'
    | 'BRAKE' ('F' | 'FF')?
    | 'CONFIRM' expression
    | 'MOVE_EMI' device device ('FLT' expression)?
    | 'RETURN' value?
    | 'WAIT' ('FOR' | 'SEC') expression
    | 'IF' expression 'THEN' eol line* ('ELSE' eol line*)? 'ENDIF'
    | 'FOR' path '=' expression 'TO' expression ('STEP' expression)? eol line* 'ENDFOR'
    | 'WHILE' expression eol line* 'ENDWHILE'
    | 'REPEAT' eol line* 'UNTIL' expression
    | 'LOOP' eol line* 'ENDLOOP'
    | 'SWITCH' expression eol branch+ 'ENDSWITCH'
    | 'GLOBAL'? 'INTERRUPT' 'DECL' expression 'WHEN' expression 'DO' action
    | 'INTERRUPT' ('ON' | 'OFF' | 'ENABLE' | 'DISABLE') expression?
    | 'TRIGGER' 'WHEN' ('PATH' | 'DISTANCE') '=' expression 'ONSTART'? 'DELAY' '=' expression
      'DO' action ('PRIO' '=' expression)?
    | ('SPLINE' | 'PTP_SPLINE') with? eol line* 'ENDSPLINE' approximation*
    | 'STOP' 'WHEN' 'PATH' '=' expression 'ONSTART'? 'IF' expression
    | 'TIME_BLOCK' ('START' | ('PART' | 'END') '=' expression)
    | 'CONST_VEL' ('START' | 'END') '=' expression 'ONSTART'?
    | ('ANIN' | 'ANOUT' | 'DIGIN') ('ON' | 'OFF') path ('=' expression (name '=' expression)*)?
    ;
branch : ('CASE' value (',' value)* | 'DEFAULT') eol line* ;
action : assignment | call | 'BRAKE' ('F' | 'FF')? ;
assignment : path '=' value ;
motion
    : ('PTP' | 'SPTP' | 'LIN' | 'SLIN' | 'CIRC' | 'SCIRC' | 'SPL' | 'PTP_REL' | 'SPTP_REL' | 'LIN_REL'
      | 'SLIN_REL' | 'CIRC_REL' | 'SCIRC_REL' | 'SPL_REL' | 'ASYPTP')
      value (',' value)* (',' 'CA' expression)? (approximation | with)*
    ;
approximation : 'C_PTP' | 'C_DIS' | 'C_VEL' | 'C_ORI' | 'C_SPL' | ENUM_CONSTANT ;
with : 'WITH' assignment (',' assignment)* ;

value : expression ;
expression : unary (operator unary)* ;
operator
    : '+' | '-' | '*' | '/' | ':' | '==' | '<>' | '<' | '>' | '<=' | '>=' | '=>' | '=<'
    | 'AND' | 'OR' | 'EXOR' | 'B_AND' | 'B_OR' | 'B_EXOR'
    ;
unary : ('NOT' | 'B_NOT' | '-' | '+')* operand ;
operand
    : NUMBER | STRING | BITS | ENUM_CONSTANT | 'TRUE' | 'FALSE'
    | path
    | call
    | '(' expression ')'
    | '{' (type ':')? member (',' member)* '}'
    ;
member : word size? value ;
path : name size? ('.' word size?)* ;
call : name '(' argument? (',' argument?)* ')' ;
argument : expression | ':' name ;
device : STRING | path ;

// Names, and the words that may be names as well.
name
    : NAME | 'STEP' | 'DELAY' | 'PATH' | 'DISTANCE' | 'PRIO' | 'ON' | 'OFF' | 'ENABLE' | 'DISABLE'
    | 'IN' | 'OUT' | 'WHEN' | 'DO' | 'SEC' | 'START' | 'PART' | 'IS' | 'F' | 'FF' | 'STOP'
    | 'ONSTART' | 'FLT'
    | 'PUBLIC' | 'WITH' | 'CA' | 'C_PTP' | 'C_DIS' | 'C_VEL' | 'C_ORI' | 'C_SPL' | 'BRAKE' | 'SIGNAL'
    | 'CHANNEL' | 'CONST' | 'ANIN' | 'ANOUT' | 'DIGIN'
    ;
word
    : name | 'END' | 'DEFAULT' | 'HALT' | 'EXIT' | 'CONTINUE' | 'RESUME' | 'CIRC' | 'LIN' | 'PTP'
    | 'LOOP' | 'REPEAT' | 'TO' | 'WAIT' | 'IF' | 'ELSE' | 'CASE' | 'SWITCH' | 'SPLINE' | 'INT' | 'REAL'
    ;
// Only enumerations have constants that are called so, behind a hash.
constant
    : word | 'AND' | 'ASYPTP' | 'BOOL' | 'B_AND' | 'B_EXOR' | 'B_NOT' | 'B_OR' | 'CHAR' | 'CIRC_REL'
    | 'CONFIRM' | 'CONST_VEL' | 'DECL' | 'DEF' | 'DEFDAT' | 'DEFFCT' | 'ENDDAT' | 'ENDFCT' | 'ENDFOR'
    | 'ENDIF' | 'ENDLOOP' | 'ENDSPLINE' | 'ENDSWITCH' | 'ENDWHILE' | 'ENUM' | 'EXOR' | 'EXT' | 'EXTFCT'
    | 'EXTFCTP' | 'EXTP' | 'FALSE' | 'FOR' | 'GLOBAL' | 'GOTO' | 'IMPORT' | 'INTERRUPT' | 'LIN_REL'
    | 'MOVE_EMI' | 'NOT' | 'ON_ERROR_PROCEED' | 'OR' | 'PTP_REL' | 'PTP_SPLINE' | 'RETURN' | 'SCIRC'
    | 'SCIRC_REL' | 'SLIN' | 'SLIN_REL' | 'SPL' | 'SPL_REL' | 'SPTP' | 'SPTP_REL' | 'STRUC' | 'THEN'
    | 'TIME_BLOCK' | 'TRIGGER' | 'TRUE' | 'UNTIL' | 'WHILE'
    ;

AND : 'AND' ;
ANIN : 'ANIN' ;
ANOUT : 'ANOUT' ;
ASYPTP : 'ASYPTP' ;
BOOL : 'BOOL' ;
BRAKE : 'BRAKE' ;
B_AND : 'B_AND' ;
B_EXOR : 'B_EXOR' ;
B_NOT : 'B_NOT' ;
B_OR : 'B_OR' ;
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
C_DIS : 'C_DIS' ;
C_ORI : 'C_ORI' ;
C_PTP : 'C_PTP' ;
C_SPL : 'C_SPL' ;
C_VEL : 'C_VEL' ;
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
MOVE_EMI : 'MOVE_EMI' ;
NOT : 'NOT' ;
OFF : 'OFF' ;
ON : 'ON' ;
ONSTART : 'ONSTART' ;
ON_ERROR_PROCEED : 'ON_ERROR_PROCEED' ;
OR : 'OR' ;
OUT : 'OUT' ;
PART : 'PART' ;
PATH : 'PATH' ;
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
SPLINE : 'SPLINE' ;
SPL_REL : 'SPL_REL' ;
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
AT_MOST : '<=' ;
AT_LEAST : '>=' ;
AT_LEAST_OLD : '=>' ;
AT_MOST_OLD : '=<' ;
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

NAME : '$'? [A-Z_] [A-Z0-9_$]* ;
ENUM_CONSTANT : '#' ' '? [A-Z_] [A-Z0-9_$]* ;
NUMBER : ([0-9]+ ('.' [0-9]*)? | '.' [0-9]+) ('E' [+\-]? [0-9]+)? ;
BITS : '\'B' [01 ]+ '\'' | '\'H' [0-9A-F ]+ '\'' ;
STRING : '"' ~["\r\n]* '"' ;
HEADER : '&' ~[\r\n]* ;
NEWLINE : '\r\n' | '\n' | '\r' ;
COMMENT : ';' ~[\r\n]* -> skip ;
SPACE : [ \t]+ -> skip ;
