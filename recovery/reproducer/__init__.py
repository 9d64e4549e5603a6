"""Reproducers: the shortest program that fails in the same way as a line."""
