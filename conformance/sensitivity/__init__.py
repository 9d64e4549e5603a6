"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --survivors` left over of two draws that had not been
seen: 64 of the robot with seed 67336, 64 of values, tree and controller with seed 67343.

A case notices a fault if it passes without it and does not pass with it.
"""
