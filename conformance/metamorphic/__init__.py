"""Metamorphic checks: programs run before and after changes that must not be observable.

=============== ====================================================================================
`program`       a program with all it is run with: a case, or a generated one
`rewriting`     syntax trees changed
`comparing`     what of two runs has to be the same
`law`           what may be changed, and how it is tried
`of_text`       folds, letter case, names, the order of declarations
`of_control`    loops, branches, inlining, constants
`of_cell`       frames, override, lines, batches, executors, robots
`moving`        made up programs that move
`survey`        all laws on cases and on generated programs
=============== ====================================================================================

No expectation is needed: a law says what two runs have in common, whatever they do. So it finds
faults that all executors share.
"""

from conformance.metamorphic.law import Attempt, Law, run_law
from conformance.metamorphic.trial import Standing, laws, record_of, try_laws

__all__ = ["Attempt", "Law", "Standing", "laws", "record_of", "run_law", "try_laws"]
