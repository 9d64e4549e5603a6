"""What ON_ERROR_PROCEED is about: the next line of the text, if its errors can be suppressed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise

from grammar.syntax import ast
from grammar.syntax.walk import BODIES


def suppressions(
    statements: Iterable[ast.Node], line: Callable[[ast.Node], int]
) -> Iterator[tuple[ast.OnErrorProceed, ast.Node | None, bool]]:
    """Yield each ON_ERROR_PROCEED, the statement on the next line, and whether it has an effect.

    ``statements`` are in the order of the text: those of one list, or those of a block behind its
    first line. It has no effect on a block, nor where the next line has no statement [FCT-12].
    """
    for one, behind in pairwise((*statements, None)):
        if isinstance(one, ast.OnErrorProceed):
            following = behind if behind and line(behind) == line(one) + 1 else None
            is_exempt = isinstance(following, ast.Label) or type(following) in BODIES
            yield one, following, following is not None and not is_exempt
