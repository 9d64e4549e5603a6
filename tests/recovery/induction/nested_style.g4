// Blocks with bodies of rows, separators between routines, labels and actions, quoted words.
grammar Nested;

options { caseInsensitive = true; }

unit : NL* (head+=HEAD NL+)* routine (NL+ routine)* NL* ;

routine
    : 'DEF' name=IDENT '(' ')' NL+ declared body 'END'
    ;

declared : ('DECL' typ IDENT NL+)* ;

body : (instruction NL+)* ;

typ : 'INT' | 'REAL' | 'BOOL' | IDENT ;

instruction
    : 'IF' cond=value 'THEN' NL+ body ('ELSE' NL+ body)? 'ENDIF'   # branch
    | 'LOOP' NL+ body 'ENDLOOP'                                    # endless
    | target=access '=' value                                      # assign
    | IDENT '(' list? ')'                                          # call
    | 'PTP' access                                                 # move
    | 'HALT'                                                       # stop
    ;

list : value (',' value)* ;

value
    : <assoc=left> value ('*' | '/') value
    | value ('+' | '-') value
    | value ('==' | '<' | '>') value
    | ('-' | 'NOT') value
    | INTEGER
    | DECIMAL
    | CONSTANT
    | 'TRUE'
    | 'FALSE'
    | access
    | IDENT '(' list? ')'
    | '(' value ')'
    ;

access : IDENT ('[' value ']')? ('.' IDENT ('[' value ']')?)* ;

IDENT : [A-Z_$] [A-Z0-9_$]* ;
INTEGER : [0-9]+ ;
DECIMAL : [0-9]+ '.' [0-9]+ ;
CONSTANT : '#' [A-Z_]+ ;
HEAD : '&' ~[\r\n]* ;
COMMENT : ';' ~[\r\n]* -> channel(HIDDEN) ;
NL : '\r\n' | '\n' ;
BLANKS : [ \t]+ -> skip ;
