"""Differential testing: random programs on several executors, whose traces must be equal.

=============== ====================================================================================
module          what it is
=============== ====================================================================================
`choices`       where decisions come from: a seed, or hypothesis (`strategies`)
`kinds`         the types that programs use, their constants and parts
`scope`         what a place in a program can name
`code`          a routine in the making: its lines, and what it costs at most
`functions`     values from what the controller brings along
`expressions`   expressions, places, calls
`world`         statements that act on the world without moving the arm
`motions`       motions, triggers, interrupts
`statements`    control flow, assignments, calls
`programs`      whole programs: files, data lists, routines
`worlds`        a world that answers at random, and with faults
`traces`        what runs are compared by
`runs`          the executors, and a program run on one of them
`divergence`    the first fact that differs
`reduction`     programs made small
`coverage`      what of the language was executed
`campaign`      many programs, in processes
`planting`      ways for an instruction to be wrong
`wrongs`        what is wrong with single instructions
`mutants`       faults planted into the machine in Python, by the table of instructions
`hunt`          how many of them are found
=============== ====================================================================================

A program is valid and ends by construction. Each routine knows how many statements it executes at
most, loops are bounded by variables that only they count with, and routines call only those that
were made before them. Faults are provoked in some programs, and then seldom.
"""

from conformance.differential.campaign import Finding, Findings, fuzz
from grammar.generation.programs.code import Size
from grammar.generation.programs.programs import Sample, generate, seeded

__all__ = ["Finding", "Findings", "Sample", "Size", "fuzz", "generate", "seeded"]
