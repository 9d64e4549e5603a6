"""The ledger: a folder of constructs whose edits, replayed in order, give the current grammar.

The restrictive start and every accepted construct, in the order of their numbers, give ``KRL.g4``
byte for byte. Numbers run from 1 without a gap.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from grammar.notation.edits import apply
from grammar.notation.g4 import read_file
from grammar.notation.model import Grammar, GrammarError
from grammar.notation.wellformed import problem
from grammar.parser.recognizer import Recognizer
from recovery.ledger.construct import Construct, LedgerError
from recovery.ledger.construct_file import read
from support.files.atomic_write import JournalError, finish
from support.files.kept_values import kept

#: The journal in the ledger's folder with which a killed acceptance is completed.
UNFINISHED = ".unfinished.json"
#: What a replay is computed with.
_CODE = ("grammar.notation", "recovery.ledger")


@dataclass(frozen=True, slots=True)
class Ledger:
    """A folder of constructs, in the order of their numbers."""

    folder: Path
    constructs: tuple[Construct, ...]

    @classmethod
    def read(cls, folder: Path) -> Ledger:
        """Return the ledger in a folder; a missing folder is a ledger without constructs.

        If an acceptance was killed while writing, it is completed first. Raises `LedgerError` for
        the first invalid file, for a duplicate number and for a gap.
        """
        try:
            finish(folder / UNFINISHED)
        except JournalError as error:
            raise LedgerError(str(error)) from None
        files = sorted(folder.glob("*.toml")) if folder.is_dir() else []
        constructs = []
        for number, file in enumerate(files, 1):
            construct = read(file)
            if construct.number is None:
                raise LedgerError(f"{file}: the name has no number, such as 0001-{file.name}")
            if construct.number != number:
                twice = construct.number < number
                what = "is given twice" if twice else f"stands here, and there is no {number}"
                raise LedgerError(f"{file}: number {construct.number} {what}")
            constructs.append(construct)
        return cls(folder, tuple(constructs))

    @property
    def accepted(self) -> tuple[Construct, ...]:
        """The constructs that are part of the grammar."""
        return tuple(c for c in self.constructs if c.is_accepted)

    def ahead_of(self, construct: Construct) -> tuple[Construct, ...]:
        """Return the accepted constructs before its place; all if it is not accepted itself."""
        accepted = self.accepted
        files = [c.file for c in accepted]
        return accepted[: files.index(construct.file)] if construct.file in files else accepted

    def take(self, file: Path) -> Construct:
        """Return the construct in a file, inside or outside of the ledger.

        Raises `LedgerError`.
        """
        if file.resolve().parent == self.folder.resolve():
            file = self.folder / file.name
        return next((c for c in self.constructs if c.file == file), None) or read(file)

    def find(self, wanted: str) -> Construct:
        """Return the construct with a number, an ID or the beginning of one.

        Raises `LedgerError` if there is none or more than one.
        """
        if wanted.isdecimal():
            found = [c for c in self.constructs if c.number == int(wanted)]
        else:
            found = [c for c in self.constructs if wanted in (c.id, c.name)]
            found = found or [c for c in self.constructs if c.id.startswith(wanted)]
        if len(found) != 1 or not wanted:
            what = "more than one construct" if found else "no construct"
            raise LedgerError(f"{wanted!r} is {what} of {self.folder.as_posix()}")
        return found[0]


def grown(grammar: Grammar, construct: Construct) -> Grammar:
    """Return the grammar with one more construct; raises `LedgerError` if an edit does not fit."""
    where = construct.file or construct.id
    try:
        after = apply(grammar, construct.edits)
    except GrammarError as error:
        raise LedgerError(f"{where}: edit: {error}") from None
    wrong = problem(after)
    if wrong:
        raise LedgerError(f"{where}: edit: the grammar after it is ill formed: line {wrong}")
    return after


def replay(
    preliminary: Grammar, constructs: Sequence[Construct]
) -> list[tuple[Construct, Grammar]]:
    """Return each construct with the grammar after it, whose text is exact to the byte.

    A replay that was made before comes from the cache (`support.files.kept_values`). Raises
    `LedgerError` if an edit does not fit or the result is not well-formed.
    """
    edits = (repr(one.edits) for one in constructs)
    made = kept(_CODE, (preliminary.text, *edits), lambda: list(_replayed(preliminary, constructs)))
    return list(zip(constructs, made, strict=True))


def _replayed(grammar: Grammar, constructs: Sequence[Construct]) -> Iterator[Grammar]:
    for construct in constructs:
        grammar = grown(grammar, construct)
        yield grammar


def in_force(preliminary: Grammar, constructs: Sequence[Construct]) -> Grammar:
    """Return the grammar after all of the constructs; raises `LedgerError` as `replay` does."""
    steps = replay(preliminary, constructs)
    return steps[-1][1] if steps else preliminary


def findings(ledger: Ledger, preliminary: Grammar, grammar: Path) -> Iterator[str]:
    """Yield the errors of an accepted ledger, one line each.

    Its replay has to be the file ``grammar`` byte for byte. The final grammar has to accept every
    accept example and reject every reject example, and every accepted construct needs grounds.
    """
    try:
        steps = replay(preliminary, ledger.accepted)
    except LedgerError as error:
        yield str(error)
        return
    grammars = [preliminary, *(after for _, after in steps)]
    difference = _difference(grammars[-1].text, grammar)
    if difference:
        yield difference
    recognizer = Recognizer(grammars[-1])
    for before, (construct, after) in zip(grammars, steps, strict=False):
        where = construct.file or construct.id
        if not is_wording(before, after):
            if construct.evidence.objection:
                yield f"{where}: evidence: {construct.evidence.objection}"
            yield from (f"{where}: {part}" for part in missing_parts(construct))
        if construct.effect is None:
            yield f"{where}: effect: is missing; krl construct accept measures it"
        yield from (f"{where}: {wrong}" for wrong in broken_examples(construct, recognizer))


def is_wording(before: Grammar, after: Grammar) -> bool:
    """Return whether two grammars differ only in comments and layout, which needs no evidence."""
    return before.rules == after.rules


def missing_parts(construct: Construct) -> Iterator[str]:
    """Yield what a construct that changes rules has to say and does not."""
    if not construct.summary.strip():
        yield "summary: does not say what it is"
    if not construct.accept:
        yield "examples.accept: there is no program that shows it"
    if not construct.reject:
        yield "examples.reject: there is no similar program that stays rejected"


def broken_examples(construct: Construct, recognizer: Recognizer) -> Iterator[str]:
    """Yield the examples on which a grammar with the construct is wrong."""
    for number, text in enumerate(construct.accept, 1):
        if not recognizer.accepts(text):
            yield f"examples.accept: number {number} is not accepted"
    for number, text in enumerate(construct.reject, 1):
        if recognizer.accepts(text):
            yield f"examples.reject: number {number} is accepted"


def _difference(text: str, file: Path) -> str:
    """Return where a file differs from a text, in one line; empty if it does not."""
    try:
        found = file.read_bytes()
    except OSError as error:
        return f"{file}: {error.strerror or error}"
    wanted = text.encode()
    if found == wanted:
        return ""
    lines = enumerate(zip(found.splitlines(True), wanted.splitlines(True), strict=False), 1)
    first = next((n for n, (old, new) in lines if old != new), None)
    where = f"from line {first} on" if first else "in length"
    return f"{file}: differs from the replay of the ledger {where}"


def preliminary_of(path: Path) -> Grammar:
    """Return the restrictive start; raises `LedgerError`."""
    try:
        return read_file(path)
    except GrammarError as error:
        raise LedgerError(str(error)) from None
