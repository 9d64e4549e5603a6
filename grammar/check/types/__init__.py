"""Types: of expressions, in declarations, data lists and statements."""
