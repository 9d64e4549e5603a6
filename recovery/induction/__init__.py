"""Induction of a grammar: forms of whole lines, operands and blocks from all lines of a corpus."""
