"""The hit conditions of breakpoints."""

from __future__ import annotations

import operator
import re
from typing import Final

from interp.values.faults import LinkError

_HITS: Final = re.compile(r"(>=|<=|==?|[><%]|)([0-9]+)")
_COUNTS: Final = {">=": operator.ge, ">": operator.gt, "<=": operator.le, "<": operator.lt}


def is_hit(hits: str | None, count: int) -> bool:
    """Return whether hit number ``count`` counts; raise `LinkError` if ``hits`` is invalid.

    ``hits`` is a number with an optional ``=``, ``==``, ``>``, ``>=``, ``<``, ``<=`` or ``%``.
    """
    match = _HITS.fullmatch((hits or ">=1").replace(" ", ""))
    if match is None or (match[1] == "%" and not int(match[2])):
        raise LinkError(f"{hits}: hits are a number such as 3, >=3 or %3")
    number = int(match[2])
    return (
        not count % number if match[1] == "%" else _COUNTS.get(match[1], operator.eq)(count, number)
    )
