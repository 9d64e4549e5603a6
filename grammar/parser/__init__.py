"""Parsing under any grammar: lexer, recogniser, parse trees, all failures of a file, ambiguity."""
