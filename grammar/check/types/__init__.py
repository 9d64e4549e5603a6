"""Type checks of expressions, declarations, data lists and statements."""
