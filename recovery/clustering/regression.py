"""Regressions: files that parse now, and would not if a word were reserved.

A word that one line has as a keyword may be a name in another file, and stays one where the grammar
lists words that are names elsewhere. So an edit that reserves words is tried on some of the files
that have these words and can be read.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable
from functools import cached_property

from grammar.parser.recognizer import Recognizer
from recovery.tuning import FILES_PER_WORD, MOST_SEARCHED_TEXT

#: A file that can be read: its length in characters, and what gives its text.
ParsedFile = tuple[int, Callable[[], str]]

_WORDS = re.compile(r"\w+")


class ParsedFiles:
    """Files that parse, by the words in them; read again when they are needed."""

    def __init__(self, files: Iterable[ParsedFile], words: Collection[str]) -> None:
        """``words`` are all that an edit may reserve, in capitals."""
        self._files = sorted(files, key=lambda file: file[0])
        self._wanted = frozenset(words)

    @cached_property
    def _texts(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = defaultdict(list)
        length = 0
        for size, text_of in self._files:
            length += size
            if length > MOST_SEARCHED_TEXT:
                break
            text = text_of()
            for word in sorted(self._wanted.intersection(_WORDS.findall(text.upper()))):
                if len(found[word]) < FILES_PER_WORD:
                    found[word].append(text)
        return dict(found)

    def breaks(self, wider: Recognizer, words: Iterable[str]) -> bool:
        """Whether a file with one of the words can no longer be read by ``wider``."""
        texts = dict.fromkeys(text for word in words for text in self._texts.get(word, ()))
        return not all(map(wider.accepts, texts))


no_parsed_files = ParsedFiles((), ())
