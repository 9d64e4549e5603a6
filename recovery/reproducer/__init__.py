"""The shortest program that fails in the same way."""
