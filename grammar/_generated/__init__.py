"""Generated from grammar/KRL.g4 by ANTLR; do not edit (make grammar)."""
