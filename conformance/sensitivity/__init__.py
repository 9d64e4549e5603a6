"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --mutants 70 --group none --survivors` left over of
draws that had not been seen, seeds 1795952032, 1795952033 and 1795952035, of the code of
November 29, 2026. Its lines are those of that code.

A case notices a fault if it passes without it and does not pass with it.
"""
