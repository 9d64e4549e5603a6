"""Bytecode: instruction set, compiler, verifier, images, assembly, and the machine in Python."""
