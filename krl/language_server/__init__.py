"""The language server: the checks of `krl check` and the layout of `krl format` in an editor."""
