"""Diagnostics as values: codes, messages, suggestions, source excerpts, SARIF."""
