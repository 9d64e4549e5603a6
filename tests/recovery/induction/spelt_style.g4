// Rows of a rule with their ends, words spelt letter by letter, left recursion, signs with names.
grammar Spelt;

prog : line* EOF ;

line : stat? NL ;

stat
    : ATTR
    | SUB ID LPAR RPAR
    | END
    | DECL type ID
    | IF expr THEN
    | ENDIF
    | FOR ID ASSIGN expr TO expr
    | ENDFOR
    | var ASSIGN expr
    | ID LPAR (expr (COMMA expr)*)? RPAR
    ;

type : INT | BOOL | ID ;

expr
    : MINUS expr
    | expr (TIMES | SLASH) expr
    | expr (PLUS | MINUS) expr
    | expr (EQ | LT | GT) expr
    | NUM
    | FLOAT
    | STR
    | TRUE
    | FALSE
    | var
    | LPAR expr RPAR
    ;

var : ID (LBRA expr RBRA)? (DOT ID)* ;

SUB : D E F ;
END : E N D ;
DECL : D E C L ;
INT : I N T ;
BOOL : B O O L ;
IF : I F ;
THEN : T H E N ;
ENDIF : E N D I F ;
FOR : F O R ;
TO : T O ;
ENDFOR : E N D F O R ;
TRUE : T R U E ;
FALSE : F A L S E ;

LPAR : '(' ;
RPAR : ')' ;
LBRA : '[' ;
RBRA : ']' ;
LBRC : '{' ;
RBRC : '}' ;
COMMA : ',' ;
COLON : ':' ;
DOT : '.' ;
ASSIGN : '=' ;
PLUS : '+' ;
MINUS : '-' ;
TIMES : '*' ;
SLASH : '/' ;
EQ : '==' ;
LT : '<' ;
GT : '>' ;

ID : [A-Za-z_$] [A-Za-z0-9_$]* ;
NUM : [0-9]+ ;
FLOAT : [0-9]+ '.' [0-9]+ ;
STR : '"' ~["\r\n]* '"' ;
ATTR : '&' ~[\r\n]* ;
REM : ';' ~[\r\n]* -> skip ;
NL : '\r'? '\n' ;
WS : [ \t]+ -> skip ;

fragment B : [Bb] ;
fragment C : [Cc] ;
fragment D : [Dd] ;
fragment E : [Ee] ;
fragment F : [Ff] ;
fragment H : [Hh] ;
fragment I : [Ii] ;
fragment A : [Aa] ;
fragment L : [Ll] ;
fragment N : [Nn] ;
fragment O : [Oo] ;
fragment R : [Rr] ;
fragment S : [Ss] ;
fragment T : [Tt] ;
fragment U : [Uu] ;
