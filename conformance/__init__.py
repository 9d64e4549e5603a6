"""The judge: do executors agree with one another, and with the documented rules of KRL?

===================  =============================================================================
`registry`           the rules (``rules.toml``): how sure each is, whether a case may fail by it
`expectations`       what ``;> …`` can say, read strictly
`case`               case files: front matter, companions, selection (CASES.md)
`observation`        what was seen of a case: findings, a trace, a path
`observing`          how it is seen: read, checked, run on an executor with a robot
`judging`            whether expectations are met; `judging_trace`, `judging_path` and `shapes`
`comparison`         where two runs begin to differ, with the state of each
`verdicts`           pass, fail, unconfirmed, known-failure, skipped (``known_failures.toml``)
`runner`             executors times robots, in parallel, the same in any order
`lint`               what is wrong with cases, and which rules have none
`record`, `junit`    results for programs: the record of a run, JUnit XML
`recording`          what a real controller did, brought back
`kit`, `plugin`      somebody else's executor or robot proves itself; cases as pytest items
`semantics`          makes docs/semantics.md of the registry
`differential`       programs that are made up, run on all executors
`metamorphic`        changes of programs that must not matter
`sensitivity`        faults planted into the cell, which cases must find
===================  =============================================================================
"""

__all__: list[str] = []
