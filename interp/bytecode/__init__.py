"""The bytecode machine: programs as instructions, their text and byte forms, and the executor.

=============== ====================================================================================
module          what it is
=============== ====================================================================================
`isa`           the instruction set, read from ``instructions.tsv``; makes what follows from it
`program`       a program in memory: types, data, requests, code objects
`cells`         how values lie in cells
`crossing`      what the machine asks of the world, and how a request is made of cells
`assembler`     text form to program, with `syntax`; `disassembler` goes the other way
`image`         program to bytes and back; what is read is not trusted
`verify`        whether a program keeps the rules that executors rely on
`vm`            the executor; `operations` has what each instruction does
=============== ====================================================================================
"""
