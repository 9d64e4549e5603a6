"""Grammar induction: infers forms of lines, operands and blocks from all lines of a corpus."""
