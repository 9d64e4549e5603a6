// A grammar of two statements, which is damaged and surveyed in no time.
grammar S;
options { caseInsensitive = true; }
program : DEF NAME '(' ')' eol statement* END eol* EOF ;
eol : NEWLINE+ ;
statement : HALT eol | WAIT NAME eol ;
DEF : 'DEF' ;
END : 'END' ;
HALT : 'HALT' ;
WAIT : 'WAIT' ;
LPAREN : '(' ;
RPAREN : ')' ;
NAME : [A-Z]+ ;
NEWLINE : '\n' ;
SPACE : ' ' -> skip ;
