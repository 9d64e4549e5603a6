"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --survivors` left over of a draw that had not been
seen: 300 mutants of seed 25082226.

A case notices a fault if it passes without it and does not pass with it.
"""
