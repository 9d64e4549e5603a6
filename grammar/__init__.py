"""The language: text to checked program. Knows nothing of running it."""

from grammar.notation.g4 import Grammar, GrammarError, read, read_file
from grammar.parser.recognizer import Recognizer

__all__ = ["Grammar", "GrammarError", "Recognizer", "read", "read_file"]
