"""The rules of KRL by their IDs, with how well each is known.

``system/rules.tsv`` lists them with their tiers: P a manual page or a file written by KUKA, T a
transcription of one, F practitioners, D measured on real controller files, R recollection of a
manual, X a page of unknown origin. A statement that rests on R or X alone is *unconfirmed*: it may
be reported, but not as an error.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache

from support.files.tables import read_table

_UNCONFIRMED = frozenset("RX")


@cache
def tiers() -> Mapping[str, str]:
    """Return the tier of each rule: a letter, or letters joined by ``+``."""
    return dict(read_table("grammar", "system/rules.tsv")[1:])


def is_confirmed(rules: Iterable[str]) -> bool:
    """Return whether at least one of the rules rests on more than tiers R and X.

    Returns ``True`` if there are no rules: the finding then follows from the grammar. Raises
    `KeyError` for an unknown rule ID.
    """
    ways = [tiers()[rule] for rule in rules]
    return not ways or any(not _UNCONFIRMED.issuperset(way.split("+")) for way in ways)
