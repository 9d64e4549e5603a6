"""Proposals: candidate edits for a failing line, from the grammar and the corpus."""
