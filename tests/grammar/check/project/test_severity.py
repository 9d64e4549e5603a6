"""What is told as an error rests on more than recollection."""

from collections.abc import Callable
from pathlib import Path

from grammar.diagnostics.diagnostic import Diagnostic
from grammar.notation.generate import GRAMMAR
from grammar.semantics.rules import is_confirmed
from recovery.negatives.negatives import load

Find = Callable[..., list[Diagnostic]]


def test_errors_are_confirmed(finds: Find) -> None:
    """Every error in a negative has a rule that a source other than recollection confirms."""
    negatives = load(GRAMMAR.parents[1] / "corpus" / "negatives")
    for negative in (one for one in negatives if one.phase == "check"):
        assert negative.path is not None
        for found in finds({f"NEG{Path(negative.path).suffix}": negative.text}):
            assert found.severity != "error" or is_confirmed(found.rules), found
