"""Closed programs for the fuzzer: they run without a cell and use much of the language."""
