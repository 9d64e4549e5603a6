"""Growth: the ledger replayed over a corpus, step by step."""
