"""The lines at which a program can continue by block selection: those of the current routine.

The limit of a FOR is private to it, so its body can be entered only from inside. No rule says what
else the official implementation allows (unconfirmed).
"""

from __future__ import annotations

from grammar.syntax import ast
from interp.program.load import Routine
from interp.program.statement_paths import way_to


def reason_against(routine: Routine, here: int, line: int) -> str:
    """Return why a program cannot continue at ``line`` when it is at ``here``; "" if it can."""
    way = way_to(routine, line)
    if not way:
        return f"no statement of {routine.name} begins in line {line}"
    open_blocks = way_to(routine, here)[:-1]
    for block in way[:-1]:
        if isinstance(block, ast.For) and block not in open_blocks:
            first = routine.unit.line(block)
            return f"line {line} is inside the FOR of line {first}, which has not begun"
    return ""
