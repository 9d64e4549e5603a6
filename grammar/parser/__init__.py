"""Reading text under any grammar: lexer, recogniser, parse trees, failures, ambiguity."""
