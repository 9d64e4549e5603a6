"""Constructs: their evidence, their acceptance, and the ledger whose replay is the grammar."""
