"""Metamorphic checks: programs run before and after changes that must not be observable.

==================== ===============================================================================
`subject`            a program with all it is run with: a case, or a generated one
`tree_rewriting`     syntax trees changed
`comparison`         what of two runs has to be the same
`law`                what may be changed, and how it is tried
`source_text_laws`   folds, letter case, names, the order of declarations, routines, components
`control_flow_laws`  loops, branches, inlining, constants
`motion_laws`        base, override, exact stops, lines, batches
`motion_programs`    generated programs that move
`trial`              all laws on cases and on generated programs
==================== ===============================================================================

No expectation is needed: a law says what two runs have in common, whatever they do. So it finds
faults that all executors share.
"""

from conformance.metamorphic.law import Attempt, Law, run_law
from conformance.metamorphic.trial import LAWS, Standing, record_of, try_laws

__all__ = ["LAWS", "Attempt", "Law", "Standing", "record_of", "run_law", "try_laws"]
