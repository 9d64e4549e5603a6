"""Mutation testing of the cases: faults are put into the executors, one at a time, and noticed.

``survivors.tsv`` is what `krl bench conform --group none --survivors` left over of 1,000 mutants
that had not been seen: `--mutants 400 --seed 1796000382` and `--mutants 300 --seed 1796001702
--seed 1796001703`, of the code of November 30, 2026, and of 150 later that day: `--mutants 30` with
the seeds 1796011446 to 1796011450, values, tree and controller only, the last 125 with
`--most-cases 250`, of `--mutants 120 --seed 1796015536`, and of `--mutants 60 --seed 1796023123
--most-cases 250`, values, tree and controller. What cases notice by now is left out.

A case notices a fault if it passes without it and does not pass with it.
"""
