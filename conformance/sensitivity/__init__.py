"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --mutants 240 --seed 1795991311 --group none
--survivors` left over of 240 mutants that had not been seen, of the code of November 29, 2026.

A case notices a fault if it passes without it and does not pass with it.
"""
