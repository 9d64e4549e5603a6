"""What ON_ERROR_PROCEED is about: the next line of the text, if its errors can be suppressed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from grammar.syntax import ast
from grammar.syntax.walk import BODIES


def suppressions(
    statements: Iterable[ast.Node], line: Callable[[ast.Node], int]
) -> Iterator[tuple[ast.OnErrorProceed, ast.Node, ast.Node | None, bool]]:
    """Yield each ON_ERROR_PROCEED, where it takes effect, on what, and whether it does.

    ``statements`` are in the order of the text: those of one list, or those of a block behind its
    first line. It takes effect behind itself, or behind CONTINUE on the next line, on the statement
    on the line behind that: not on a block, nor where there is no statement [FCT-12].
    """
    every = (*statements, None, None)
    for one, behind, second in zip(every, every[1:], every[2:], strict=False):
        if isinstance(one, ast.OnErrorProceed):
            last: ast.Node = one
            if isinstance(behind, ast.Continue) and line(behind) == line(one) + 1:
                last, behind = behind, second  # noqa: PLW2901
            following = behind if behind and line(behind) == line(last) + 1 else None
            is_exempt = isinstance(following, ast.Label) or type(following) in BODIES
            yield one, last, following, following is not None and not is_exempt
