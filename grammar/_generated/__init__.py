"""Generated from grammar/KRL.g4 by ANTLR; do not edit (python -m grammar.generate)."""
