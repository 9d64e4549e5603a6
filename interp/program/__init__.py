"""A checked program as executors see it: files loaded, variables, statements."""
