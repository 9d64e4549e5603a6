"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

==================== ===============================================================================
`mutation_operators` small changes of a syntax tree
`mutants`            changes drawn by chance from what decides semantics, put in place
`line_reach`         which cases run which lines
`mutant_trial`       mutants against the cases that run their lines
`planted_faults`     faults that no such change makes
`trial`              planted faults against cases
`removed_features`   what the titles of cases name, taken out of them: which still pass
`bench`              how many are noticed, and cases a second
==================== ===============================================================================

``survivors.tsv`` is what `krl bench conform --survivors` left over of two draws that had not been
seen: 64 of the robot with seed 67336, 64 of values, tree and controller with seed 67343.

A case notices a fault if it passes without it and does not pass with it.
"""
