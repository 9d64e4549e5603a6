"""The bytecode: an instruction set, programs in it, and what makes, checks and runs them.

A program in memory (`program`) has a byte form (`image`) and a text form (`assembly`). It comes
from KRL (`compiler`), is checked before it runs (`verifier`), and runs here (`vm`) or in C
(`interp.native`).
"""
