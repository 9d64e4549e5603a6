"""The ledger: constructs with their evidence; its replay is the grammar."""
