// The restrictive start of a small assembler: what its manual shows on the first page.
grammar Assembler;

options { caseInsensitive = true; }

source
    : line* EOF
    ;

line
    : instruction? EOL
    ;

instruction
    : MOV REGISTER ',' value
    | HLT
    ;

value
    : term (('+' | '-') term)*
    ;

term
    : REGISTER
    | WORD
    | DECIMAL
    | '(' value ')'
    ;

MOV : 'MOV' ;
HLT : 'HLT' ;

COMMA : ',' ;
COLON : ':' ;
PLUS : '+' ;
MINUS : '-' ;
OPEN : '(' ;
CLOSE : ')' ;
FROM : '[' ;
UPTO : ']' ;

REGISTER : 'R' [0-7] ;
DECIMAL : [0-9]+ ;
WORD : [A-Z_] [A-Z0-9_]* ;
EOL : '\r'? '\n' ;
REMARK : '#' ~[\r\n]* -> skip ;
BLANK : [ \t]+ -> skip ;
