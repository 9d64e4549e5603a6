"""A checked program in the form that executors need: loaded files, variables, statements."""
