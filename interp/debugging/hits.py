"""Which hits of a breakpoint count."""

from __future__ import annotations

import operator
import re
from typing import Final

from interp.values.faults import LinkError

_HITS: Final = re.compile(r"(>=|<=|==?|[><%]|)([0-9]+)")
_COUNTS: Final = {">=": operator.ge, ">": operator.gt, "<=": operator.le, "<": operator.lt}


def is_hit(hits: str | None, count: int) -> bool:
    """Whether the hit of a number counts; raises `LinkError` for what says nothing about hits."""
    match = _HITS.fullmatch((hits or ">=1").replace(" ", ""))
    if match is None or (match[1] == "%" and not int(match[2])):
        raise LinkError(f"{hits}: hits are a number such as 3, >=3 or %3")
    number = int(match[2])
    return (
        not count % number if match[1] == "%" else _COUNTS.get(match[1], operator.eq)(count, number)
    )
