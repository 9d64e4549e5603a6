"""Meaning of names and types: symbols, scopes, linking, types, predefined names."""
