"""Metamorphic testing: programs run before and after changes that must not be observable.

A law needs no expectation: it says what two runs have in common, whatever they do. So it can find
defects that all executors share.
"""

from conformance.metamorphic.law import Attempt, Law, run_law
from conformance.metamorphic.law_trials import LAWS, LawResult, record_of, try_laws

__all__ = ["LAWS", "Attempt", "Law", "LawResult", "record_of", "run_law", "try_laws"]
