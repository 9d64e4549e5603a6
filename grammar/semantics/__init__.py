"""What names and types mean: symbols, scopes, linking, types, what a controller predefines."""
