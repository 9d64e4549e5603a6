"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --group none --survivors` left over of mutants that had
not been seen. On the code of December 1, 2026: `--mutants 334 --seed 1796092179`, of which 87 %
of those that a case could notice were red. On the last of November 30: `--mutants 100 --seed
1796025189 --seed 1796025190`, and most of `--mutants 150` with the seeds 1796018876 to 1796018878.
On earlier code: `--mutants 400 --seed 1796000382`, `--mutants 300 --seed 1796001702 --seed
1796001703`, `--mutants 120 --seed 1796015536`; and of values, tree and controller only `--mutants
30` with the seeds 1796011446 to 1796011450 and `--mutants 60 --seed 1796023123`, these mostly with
`--most-cases 250`. What cases are known to notice by now is left out.

A case notices a fault if it passes without it and does not pass with it.
"""
