"""Bytecode as text: assembler and disassembler."""
