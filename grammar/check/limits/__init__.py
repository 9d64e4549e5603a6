"""Limits: numbers, values and lengths of names that a program may not exceed."""
