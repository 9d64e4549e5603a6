"""Findings as values: codes, messages, source context, SARIF."""
