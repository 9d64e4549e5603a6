"""Which lines a program can go on at: those of the statements of the routine that runs.

A FOR keeps its limit where nobody else sees it, so its body can be entered only from inside. What
the official implementation allows beyond that is not told by any rule (unconfirmed).
"""

from __future__ import annotations

from grammar.syntax import ast
from interp.program.load import Routine
from interp.program.statement_paths import way_to


def reason_against(routine: Routine, here: int, line: int) -> str:
    """Why a program cannot go on at a line when it is at another; empty where it can."""
    way = way_to(routine, line)
    if not way:
        return f"no statement of {routine.name} begins in line {line}"
    around = way_to(routine, here)[:-1]
    for block in way[:-1]:
        if isinstance(block, ast.For) and block not in around:
            first = routine.unit.line(block)
            return f"line {line} stands in the FOR of line {first}, which has not begun"
    return ""
