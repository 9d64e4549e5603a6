"""Executors, arm and real programs measured and compared."""
