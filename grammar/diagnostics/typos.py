"""Whether a name is another one with a slip of the finger, among many names at once.

Stricter than `grammar.diagnostics.did_you_mean`, which only words a hint: here a finding rests on
it. One slip is a letter too many, too few or wrong, or two that changed places. Names that people
make in series are no slips of one another: those that differ in a digit, in a letter that stands
alone (``PickA``, ``PickB``) or in a prefix (``XHOME`` of ``HOME``).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

__all__ = ["Typos"]

_SHORTEST = 4
_LONGEST = 64
# A word of a name: letters of one kind, a run of digits.
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+|[^A-Za-z0-9_]+")


class Typos:
    """Names that can be meant, indexed so that a look-up costs the length of the name.

    Each name is entered under itself without each of its letters, as SymSpell does: names that are
    one slip apart meet in such a key.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self._names: dict[str, str] = {}
        self._keys: dict[str, list[str]] = {}
        for name in names:
            self.add(name)

    def add(self, name: str) -> None:
        """Enter a name; letter case makes no difference, the first spelling counts."""
        key = name.upper()
        if key in self._names or not _SHORTEST <= len(key) <= _LONGEST:
            return
        self._names[key] = name
        for shorter in _shortened(key):
            self._keys.setdefault(shorter, []).append(key)

    def meant(self, name: str) -> tuple[str, ...]:
        """The names that ``name`` may be a slip of, in the order of the alphabet."""
        wrong = name.upper()
        if not _SHORTEST <= len(wrong) <= _LONGEST:
            return ()
        near = {
            right
            for shorter in _shortened(wrong)
            for right in self._keys.get(shorter, ())
            if right != wrong and _is_slip(name, self._names[right])
        }
        return tuple(self._names[right] for right in sorted(near))


def _shortened(key: str) -> Iterator[str]:
    yield key
    for index in range(len(key)):
        yield key[:index] + key[index + 1 :]


def _is_slip(wrong: str, right: str) -> bool:
    """Whether two names that share a key are one slip apart, and in no series."""
    a, b = wrong.upper(), right.upper()
    start = next(
        (i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b))
    )
    rest_a, rest_b = a[start:], b[start:]
    if len(a) == len(b):
        is_swap = rest_a[:2] == rest_b[1::-1] and rest_a[2:] == rest_b[2:] and len(rest_a) > 1
        if not is_swap and rest_a[1:] != rest_b[1:]:
            return False
        if is_swap:
            return not (rest_a[0].isdigit() or rest_a[1].isdigit())
        return not (_is_serial(wrong, start) or _is_serial(right, start))
    longer, shorter = (wrong, right) if len(a) > len(b) else (right, wrong)
    if longer.upper()[start + 1 :] != shorter.upper()[start:]:
        return False
    return start > 0 and not _is_serial(longer, start)


def _is_serial(name: str, index: int) -> bool:
    """Whether the letter at an index numbers the name: a digit, or a word of one letter."""
    for word in _WORD.finditer(name):
        if word.start() <= index < word.end():
            return word.group()[0].isdigit() or len(word.group()) == 1
    return True
