"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --mutants 40 --survivors` left over of five draws that
had not been seen, of the code of November 29, 2026: seeds 1795917060736020948, 1795917699148148418,
1795918043197192374, 1795918357628661046 and 1795918926944825120. Its lines are those of that code.

A case notices a fault if it passes without it and does not pass with it.
"""
