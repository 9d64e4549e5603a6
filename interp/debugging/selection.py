"""Lines at which a program can continue: those of the statements of the current routine.

A FOR keeps its limit privately, so its body can be entered only from inside. What
the official implementation allows beyond that is not stated by any rule (unconfirmed).
"""

from __future__ import annotations

from grammar.syntax import ast
from interp.program.load import Routine
from interp.program.statement_paths import way_to


def reason_against(routine: Routine, here: int, line: int) -> str:
    """Why a program cannot continue at a line when it is at another; empty where it can."""
    way = way_to(routine, line)
    if not way:
        return f"no statement of {routine.name} begins in line {line}"
    around = way_to(routine, here)[:-1]
    for block in way[:-1]:
        if isinstance(block, ast.For) and block not in around:
            first = routine.unit.line(block)
            return f"line {line} is inside the FOR of line {first}, which has not begun"
    return ""
