/* KRL as somebody else would begin it: other names, flat routines, labelled alternatives. */
grammar Robot;

options { caseInsensitive = true; }

file
    : (row? EOL)* row? EOF
    ;

row
    : ATTRIBUTE                                          # attribute
    | KW_DEF ID '(' ')'                                  # routine
    | KW_END                                             # endOfRoutine
    | KW_DECL kind ID                                    # variable
    | KW_IF test KW_THEN                                 # branch
    | KW_ENDIF                                           # endOfBranch
    | place '=' test                                     # store
    | ID '(' (test (',' test)*)? ')'                     # invoke
    | KW_PTP place                                       # move
    ;

kind
    : KW_INT
    | KW_REAL
    | KW_BOOL
    | ID
    ;

test
    : sum (('==' | '<>' | '<=' | '>=' | '<' | '>') sum)*
    ;

sum
    : product (('+' | '-') product)*
    ;

product
    : atom (('*' | '/') atom)*
    ;

atom
    : INT_NUMBER
    | REAL_NUMBER
    | TEXT
    | BITS
    | NAMED
    | KW_TRUE
    | KW_FALSE
    | place
    | ID '(' (test (',' test)*)? ')'
    | '(' test ')'
    | KW_NOT atom
    ;

place
    : ID subscript? ('.' ID subscript?)*
    ;

subscript
    : '[' test ']'
    ;

KW_BOOL : 'BOOL' ;
KW_DECL : 'DECL' ;
KW_DEF : 'DEF' ;
KW_END : 'END' ;
KW_ENDIF : 'ENDIF' ;
KW_FALSE : 'FALSE' ;
KW_IF : 'IF' ;
KW_INT : 'INT' ;
KW_NOT : 'NOT' ;
KW_PTP : 'PTP' ;
KW_REAL : 'REAL' ;
KW_THEN : 'THEN' ;
KW_TRUE : 'TRUE' ;

EQ : '==' ;
NE : '<>' ;
LE : '<=' ;
GE : '>=' ;
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

INT_NUMBER : DIGIT+ ;
REAL_NUMBER : DIGIT+ '.' DIGIT+ ;
TEXT : '"' ~["\r\n]* '"' ;
ID : [A-Z_$] [A-Z0-9_$]* ;
BITS : '\'' [BH] [0-9A-F]+ '\'' ;
NAMED : '#' [A-Z_$] [A-Z0-9_$]* ;
ATTRIBUTE : '&' ~[\r\n]* ;
EOL : '\r'? '\n' ;
NOTE : ';' ~[\r\n]* -> channel(HIDDEN) ;
BLANK : [ \t]+ -> skip ;
fragment DIGIT : [0-9] ;
