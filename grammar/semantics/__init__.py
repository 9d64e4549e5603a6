"""Semantic analysis: symbol tables, scopes, linking, name resolution, types, predefined names."""
