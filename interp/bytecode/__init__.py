"""The bytecode machine: programs as instructions, their text and byte forms, and the executor.

=============== ====================================================================================
module          what it is
=============== ====================================================================================
`isa`           the instruction set, read from ``instructions.tsv``; makes what follows from it
`program`       a program in memory: types, data, requests, code objects
`cells`         how values lie in cells
`crossing`      what the machine asks of the world, and how a request is made of cells
`syntax`        the words of the text form; `disassembler` writes it
`assembler`     text form to program, with its symbol table in `symbols`, instructions in `operands`
`image`         the format of the bytes; `image_writer`, and `image_reader`, which trusts nothing
`verify`        whether a program keeps the rules that executors rely on
`wellformed`    of these the rules for tables: numbers name something, constants are of their kind
`flow`          of these the rules for the stack, followed along all ways. `stack_effects` has what
                each instruction does to it, `stack_types` and `cell_types` what lies in it and in
                cells, `successors` the ways
`vm`            the executor, with `state`, `counting`, `services`, `transfer`, `telling`
`threads`       code objects made ready; `control`, `moving`, `arrays`, `computing` have what each
                instruction does
=============== ====================================================================================
"""
