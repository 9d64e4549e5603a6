"""Regressions: files that parse now and would not if a word were reserved.

A word that is a keyword in one line may be a name in another file. If the grammar has a list of
words that are also names, the word can remain a name. So an edit that reserves words is tried on
some files that parse and contain these words.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable
from functools import cached_property
from itertools import accumulate

from grammar.parser.recognizer import Recognizer
from recovery.tuning import FILES_PER_WORD, MOST_SEARCHED_TEXT

#: A file that parses: its length in characters, and a function that returns its text.
ParsedFile = tuple[int, Callable[[], str]]

_WORDS = re.compile(r"\w+")


class ParsedFiles:
    """Files that parse, indexed by the words in them; read again when they are needed."""

    def __init__(self, files: Iterable[ParsedFile], words: Collection[str]) -> None:
        """Create it; ``words`` are all words that an edit may reserve, in upper case."""
        self._files = _smallest(files) if words else []
        self._wanted = frozenset(words)

    @cached_property
    def _texts(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = defaultdict(list)
        for _, text_of in self._files:
            text = text_of()
            for word in sorted(self._wanted.intersection(_WORDS.findall(text.upper()))):
                if len(found[word]) < FILES_PER_WORD:
                    found[word].append(text)
        return dict(found)

    def breaks(self, wider: Recognizer, words: Iterable[str]) -> bool:
        """Return whether a file with one of the words cannot be read by ``wider``."""
        texts = dict.fromkeys(text for word in words for text in self._texts.get(word, ()))
        return not all(map(wider.accepts, texts))


def _smallest(files: Iterable[ParsedFile]) -> list[ParsedFile]:
    """Return the smallest files, the smallest first: as many as are searched at most."""
    kept: list[ParsedFile] = []
    size = 0
    for file in files:
        kept.append(file)
        size += file[0]
        if size > 2 * MOST_SEARCHED_TEXT:
            kept = _within(kept)
            size = sum(length for length, _ in kept)
    return _within(kept)


def _within(files: list[ParsedFile]) -> list[ParsedFile]:
    files.sort(key=lambda file: file[0])
    sizes = accumulate(length for length, _ in files)
    return [file for file, size in zip(files, sizes, strict=True) if size <= MOST_SEARCHED_TEXT]


no_parsed_files = ParsedFiles((), ())
