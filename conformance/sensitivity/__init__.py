"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

==================== ===============================================================================
`mutation_operators` small changes of a syntax tree
`mutants`            changes drawn by chance from what decides semantics, put in place
`line_reach`         which cases run which lines
`mutant_trial`       mutants against the cases that run their lines
`planted_fault`      a fault that no such change makes, thought up and planted
`…_faults`           these faults: of the clock and outputs, the advance run, interrupts, paths
`trial`              planted faults against cases
`removed_features`   what the titles of cases name, taken out of them: which still pass
`bench`              how many are noticed, and cases a second
==================== ===============================================================================

``survivors.tsv`` is what `krl bench conform` left over with ``--mutants 100 --seed 52101`` and
``--mutants 60 --seed 52202``, the last time that it was written (``--survivors``), without 14 that
cases written since make red: what cases are still missing for.

A case notices a fault if it passes without it and does not pass with it.
"""
