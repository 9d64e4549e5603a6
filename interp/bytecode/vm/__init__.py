"""The bytecode machine in Python."""
