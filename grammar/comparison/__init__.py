"""Two states of programs compared as a programmer wants it: routines, statements, points, data."""
