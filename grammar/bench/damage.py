"""Typical damage of backups: files lost or cut, names misspelt, characters exchanged.

Each kind changes the text of a file depending on a seed and on the path of the file only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from random import Random
from typing import Final

from grammar.bench.slips import cut, lines_of_tokens, slip
from grammar.syntax.source import Source

#: Of the files that a kind concerns, the share that is damaged.
_FILES = 0.3
#: Of the lines of a damaged file, and of the characters, the share that is.
_LINES, _CHARACTERS = 0.05, 0.002
_SIGNS = "abcdefghijklmnopqrstuvwxyz0123456789 ()[]{},;:=.$#\n\x00"


def _lost(_source: Source, _chance: Random) -> str | None:
    return None


def _misspelt(source: Source, chance: Random) -> str:
    """Return the text with one name misspelt in some of the lines."""
    text = source.text
    for tokens in reversed(list(lines_of_tokens(source))):
        found = slip("name misspelt", tokens, chance) if chance.random() < _LINES else None
        if found is not None:
            start, end, new = found
            text = text[:start] + new + text[end:]
    return text


def _without_lines(source: Source, chance: Random) -> str:
    lines = source.text.splitlines(keepends=True)
    return "".join(line for line in lines if chance.random() >= _LINES)


def _exchanged(source: Source, chance: Random) -> str:
    characters = list(source.text)
    for place in range(len(characters)):
        if chance.random() < _CHARACTERS:
            characters[place] = chance.choice(_SIGNS)
    return "".join(characters)


def _wrongly_read(source: Source, _chance: Random) -> str:
    return source.text.encode("utf-8").decode("latin-1")


#: Each kind of damage: the new text of a damaged file, ``None`` where it is lost.
DAMAGES: Final[Mapping[str, Callable[[Source, Random], str | None]]] = {
    "files": _lost,
    "lists": _lost,
    "cut": lambda source, chance: cut(source.text, chance),
    "lines": _without_lines,
    "names": _misspelt,
    "characters": _exchanged,
    "latin": _wrongly_read,
}


def damaged_source(source: Source, kind: str, seed: int) -> Source | None:
    """Return a file after damage, unchanged if the seed spares it, or ``None`` if it is lost.

    ``files`` loses three of ten files, ``lists`` three of ten data lists. In three of ten files
    ``cut`` loses the end, ``lines`` one line in 20, ``names`` misspells one name in 20 lines,
    ``characters`` exchanges one in 500; ``latin`` decodes them with another encoding.
    """
    chance = Random(f"{seed} {kind} {source.path}")
    if chance.random() >= _FILES or (kind == "lists" and source.kind != "dat"):
        return source
    text = DAMAGES[kind](source, chance)
    return None if text is None else Source(text, source.path)
