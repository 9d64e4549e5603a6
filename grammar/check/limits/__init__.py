"""Limits of numbers, values and name lengths that a program must not exceed."""
