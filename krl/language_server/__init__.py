"""The language server: what `krl check` and `krl format` know, in an editor, while one types."""
