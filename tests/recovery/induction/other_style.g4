/* KRL as somebody else would begin it: other names, flat blocks, labelled alternatives. */
grammar Robot;

options { caseInsensitive = true; }

file
    : (row? EOL)* row? EOF
    ;

row
    : KW_DEF ID '(' ')'                                  # routine
    | KW_END                                             # endOfRoutine
    | KW_IF test KW_THEN                                 # branch
    | KW_ENDIF                                           # endOfBranch
    | ID '=' test                                        # store
    | ID '(' (test (',' test)*)? ')'                     # invoke
    | KW_PTP ID                                          # move
    ;

test
    : sum (('==' | '<' | '>') sum)*
    ;

sum
    : atom (('+' | '-') atom)*
    ;

atom
    : INT_NUMBER
    | ID
    | ID '(' (test (',' test)*)? ')'
    | '(' test ')'
    ;

KW_DEF : 'DEF' ;
KW_END : 'END' ;
KW_IF : 'IF' ;
KW_THEN : 'THEN' ;
KW_ENDIF : 'ENDIF' ;
KW_PTP : 'PTP' ;

EQ : '==' ;
LT : '<' ;
GT : '>' ;
SET : '=' ;
ADD : '+' ;
SUB : '-' ;
MUL : '*' ;
DIV : '/' ;
OPEN : '(' ;
CLOSE : ')' ;
FROM : '[' ;
UPTO : ']' ;
BEGIN : '{' ;
FINISH : '}' ;
COMMA : ',' ;
COLON : ':' ;
DOT : '.' ;
HASH : '#' ;

INT_NUMBER : DIGIT+ ;
REAL_NUMBER : DIGIT+ '.' DIGIT+ ;
TEXT : '"' ~["\r\n]* '"' ;
ID : [A-Z_$] [A-Z0-9_$]* ;
ATTRIBUTE : '&' ~[\r\n]* ;
EOL : '\r'? '\n' ;
NOTE : ';' ~[\r\n]* -> channel(HIDDEN) ;
BLANK : [ \t]+ -> skip ;
fragment DIGIT : [0-9] ;
