"""Selection of findings by their codes, for a whole run."""

from __future__ import annotations

from collections.abc import Iterable

from grammar.diagnostics.codes import by_code
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Selection:
    """Findings chosen by prefixes of their codes; the longest prefix that fits decides.

    If ``select`` is empty, everything is selected. On a tie ``ignore`` wins.
    """

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()

    @staticmethod
    def of(select: Iterable[str] = (), ignore: Iterable[str] = ()) -> Selection:
        """Return a selection from words of a command line, each one or more codes with commas.

        Raises `ValueError` for a word that is no prefix of a code.
        """
        return Selection(_codes(select), _codes(ignore))

    def keeps(self, code: str) -> bool:
        """Return whether findings of a code are selected."""
        chosen = _longest(code, self.select) if self.select else 0
        return chosen > _longest(code, self.ignore)


def _codes(words: Iterable[str]) -> tuple[str, ...]:
    codes = [code.strip().upper() for word in words for code in word.split(",") if code.strip()]
    for code in codes:
        if not is_known(code):
            raise ValueError(f"no code begins with {code}; krl explain lists them")
    return tuple(codes)


def is_known(prefix: str) -> bool:
    """Return whether a code begins with ``prefix``."""
    return any(code.startswith(prefix) for code in by_code())


def _longest(code: str, prefixes: tuple[str, ...]) -> int:
    return max((len(prefix) for prefix in prefixes if code.startswith(prefix)), default=-1)
