"""Closed programs for the fuzzer: they run to their end alone and use much of the language."""
