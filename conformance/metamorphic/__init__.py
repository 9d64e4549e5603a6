"""Metamorphic testing: programs run before and after changes that must not be observable.

==================== ===============================================================================
`subject`            a program with everything needed to run it: a case, or a generated program
`tree_rewriting`     transformation of syntax trees
`comparison`         what must be equal in two runs
`law`                a permitted change, and how it is tried
`source_text_laws`   folds, letter case, names, the order of declarations, routines, components
`control_flow_laws`  loops, branches, inlining, constants
`motion_laws`        base, override, exact stops, lines, batches
`motion_programs`    generated programs that move
`trial`              all laws on cases and on generated programs
==================== ===============================================================================

A law needs no expectation: it says what two runs have in common, whatever they do. So it can find
defects that all executors share.
"""

from conformance.metamorphic.law import Attempt, Law, run_law
from conformance.metamorphic.trial import LAWS, Standing, record_of, try_laws

__all__ = ["LAWS", "Attempt", "Law", "Standing", "record_of", "run_law", "try_laws"]
