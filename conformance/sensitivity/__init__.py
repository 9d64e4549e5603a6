"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --mutants 334 --group none --survivors` left over of
1,002 mutants that had not been seen, seeds 1795965412, 1795965419 and 1795965424, of the code of
November 29, 2026. Its lines are those of that code; cases were added after it.

A case notices a fault if it passes without it and does not pass with it.
"""
