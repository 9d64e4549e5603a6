"""Grammars as data: reading ``.g4`` files, editing rules, generating the ANTLR parser."""
