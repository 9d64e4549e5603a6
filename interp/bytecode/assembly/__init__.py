"""The text form of bytecode: assembler and disassembler."""
