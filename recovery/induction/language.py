"""Description of a language for recovery; everything else comes from grammar and corpus.

The lexer of the grammar says which token is a name, which one ends a line, what is a comment, and
which words are reserved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative
from recovery.negatives.tokens import RESERVED, RESERVED_FIRST, line
from support.files.decode import digest
from support.files.discovery import IngestError, source_files
from support.files.untrusted import read_bytes


@dataclass(frozen=True, slots=True)
class CorpusFile:
    """A distinct content: the first of its places, its text, and the origins it comes from."""

    path: str
    text: str
    origins: frozenset[str]


@dataclass(frozen=True, slots=True)
class Language:
    """How a language is found on a disk, and the facts that are known of it without a grammar.

    ``source`` gives (path, origin, content, text) of each file below some roots and raises
    `support.files.discovery.IngestError` where there is none. ``negatives`` gives up to so many
    programs of a seed that no grammar may accept, ``reserved_in`` the words of a line without its
    end that cannot be names there.
    """

    source: Callable[[Sequence[Path]], Iterable[tuple[str, str, bytes, str]]] = lambda _roots: ()
    negatives: Callable[[int, int], Iterable[Negative]] = lambda _count, _seed: ()
    reserved_in: Callable[[str], frozenset[str]] = lambda _line: frozenset()

    def files(self, roots: Sequence[Path]) -> tuple[CorpusFile, ...]:
        """All source below ``roots``, each content once, in the order in which it is found.

        Raises `support.files.discovery.IngestError` where there is nothing.
        """
        found: dict[str, CorpusFile] = {}
        for path, origin, data, text in self.source(roots):
            known = found.get(key := digest(data))
            origins = known.origins | {origin} if known else frozenset({origin})
            found[key] = CorpusFile(known.path if known else path, text, origins)
        return tuple(found.values())


def _krl_source(roots: Sequence[Path]) -> Iterable[tuple[str, str, bytes, str]]:
    return ((one.path, one.found.origin, one.data, one.text) for one in source_files(roots))


KRL = Language(
    _krl_source,
    lambda count, seed: generate(count=count, seed=seed),
    lambda text: (RESERVED | RESERVED_FIRST).intersection(line(text).kinds),
)


def language_of(suffix: str) -> Language:
    """Return a language of which only the suffix of its files is known.

    Each folder in a root is an origin; files in the root itself belong to the root.
    """

    def source(roots: Sequence[Path]) -> Iterable[tuple[str, str, bytes, str]]:
        is_empty = True
        for root in roots:
            if not root.exists():
                raise IngestError(f"{root}: no such file or folder")
            for path in sorted(root.rglob("*")) if root.is_dir() else [root]:
                if path.is_file() and path.name.lower().endswith(suffix.lower()):
                    is_empty = False
                    inside = path.relative_to(root).parts
                    data = read_bytes(path)
                    origin = inside[0] if len(inside) > 1 else root.absolute().name
                    yield path.as_posix(), origin, data, data.decode("utf-8-sig", "replace")
        if is_empty:
            raise IngestError(f"{', '.join(map(str, roots))}: no file ends in {suffix}")

    return Language(source)
