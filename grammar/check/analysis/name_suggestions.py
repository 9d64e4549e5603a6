"""Suggestions for misspelt names: similar names, or names with the same beginning."""

from __future__ import annotations

from collections.abc import Iterable

from grammar.diagnostics.diagnostic import Fix
from grammar.diagnostics.did_you_mean import did_you_mean, one_of

# A word of fewer letters is the beginning of too much.
_SHORTEST = 3
# A suggestion costs a look at every name that is known, so only the first faults of a file get one.
_MOST_SUGGESTIONS = 20


class NameSuggestions:
    """Suggests names for the first unknown names of a file."""

    def __init__(self) -> None:
        self._left = _MOST_SUGGESTIONS

    def suggest(self, name: str, names: Iterable[str], mark: str = "") -> Fix | None:
        """Return those of ``names`` that are similar to ``name``, each after ``mark``."""
        if not self._left:
            return None
        self._left -= 1
        known = list(names)
        fix = did_you_mean(name, known, mark)
        if fix is None and len(name) >= _SHORTEST:
            key = name.upper()
            fix = one_of((one for one in known if one.upper().startswith(key)), mark)
        return fix
