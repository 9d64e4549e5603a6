"""What ON_ERROR_PROCEED is about: the next line of the text, if its errors can be suppressed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise

from grammar.syntax import ast
from grammar.syntax.walk import BODIES


def suppressions(
    statements: Iterable[ast.Node], line: Callable[[ast.Node], int]
) -> Iterator[tuple[ast.OnErrorProceed, ast.Node | None, bool]]:
    """Yield each ON_ERROR_PROCEED, the statement behind it, and whether it has an effect there.

    ``statements`` are in the order of the text, those in blocks behind the first line of the block.
    It has none on blocks, and on what is not on the next line [FCT-12].
    """
    for one, behind in pairwise((*statements, None)):
        if isinstance(one, ast.OnErrorProceed):
            is_next = behind is not None and line(behind) == line(one) + 1
            is_exempt = isinstance(behind, ast.Label) or type(behind) in BODIES
            yield one, behind, is_next and not is_exempt
