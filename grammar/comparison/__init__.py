"""Comparison of two states of programs, by routines, statements, taught points and data."""
