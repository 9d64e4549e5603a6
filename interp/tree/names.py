"""Look-up of variables by their name as text, as VARSTATE and VARTYPE receive it [TYP-18]."""

from __future__ import annotations

import re
from collections.abc import Callable

from interp.tree.places import LocalPlace, Place, element, member
from interp.values.faults import Fault, LinkError

_WRITTEN = re.compile(
    r"\s*([A-Z_]\w*(?:\.\w+|\[\s*\d{1,9}(?:\s*,\s*\d{1,9}){0,2}\s*\])*)(?:\[[\s,]*\])?\s*",
    re.IGNORECASE | re.ASCII,
)
_STEP = re.compile(r"(\.?)(\w+)|\[([\s\d,]*)\]", re.ASCII)


def find_text(text: str, find: Callable[[str], Place | None]) -> LocalPlace | None:
    """Return the place of the variable, or part of one, that ``text`` names; ``None`` if unknown.

    The name of an array may end in empty brackets. ``find`` returns the place of a variable by its
    name in upper case. System variables are not looked up.
    """
    match = _WRITTEN.fullmatch(text)
    if match is None:
        return None
    place: Place | None = None
    try:
        for _, name, indices in _STEP.findall(match[1].upper()):
            if place is None:
                place = find(name)
            elif indices:
                place = element(place, [int(one) for one in indices.split(",")])
            else:
                place = member(place, name)
            if not isinstance(place, LocalPlace):
                return None
    except (Fault, LinkError):  # there is no such part
        return None
    return place if isinstance(place, LocalPlace) else None
