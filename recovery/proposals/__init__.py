"""Edits that might mend a failing line, from the grammar and the corpus."""
