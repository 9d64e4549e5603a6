"""A construct of the ledger as data: edits, evidence, examples, effect.

`recovery.ledger.construct_file` defines the file format, and `recovery.ledger.ledger` is the folder
of all constructs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from grammar.notation.edits import Edit
from support.input_error import InputError

PROPOSED, ACCEPTED, REJECTED = "proposed", "accepted", "rejected"
#: The grounds on which a construct can be accepted, the weakest first.
GROUNDS = ("recurring", "corroborated", "documented", "confirmed")
STATES = (PROPOSED, *GROUNDS, ACCEPTED, REJECTED)
_REFUSED = "refused:"


class LedgerError(InputError):
    """A construct, the ledger or a record is invalid; the message is one line."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The evidence for a construct.

    ``files``, ``origins`` and ``lines`` are counts in other people's files of what failed without
    the edits and does not with them (`recovery.ledger.evidence`). ``rules`` are IDs of documented
    rules, ``manual`` is a reference to a manual. ``verdict`` is that of an oracle (empty,
    ``accepted`` or ``refused: message``), and ``oracle`` says which one, asked by whom and when.
    ``seen`` are places, ``ORIGIN/path:line``.
    """

    files: int = 0
    origins: int = 0
    lines: int = 0
    rules: tuple[str, ...] = ()
    manual: str = ""
    verdict: str = ""
    oracle: str = ""
    seen: tuple[str, ...] = ()

    @property
    def objection(self) -> str:
        """Why the evidence is not enough for an acceptance; empty if it is."""
        if self.verdict.startswith(_REFUSED):
            return f"the oracle refused it: {self.verdict.removeprefix(_REFUSED).strip()}"
        if self.grounds:
            return ""
        shown = "only one file shows it" if self.origins else "no file shows it"
        return f"no ground: {shown}, no rule or manual says it, no oracle accepted it"

    @property
    def grounds(self) -> tuple[str, ...]:
        """The grounds that the evidence gives, the weakest first; one file alone gives none."""
        shown = {place.rpartition(":")[0] for place in self.seen}
        is_corroborated = self.origins >= 2
        held = (
            len(shown) >= 2 and not is_corroborated,
            is_corroborated,
            bool(self.rules or self.manual),
            self.verdict == ACCEPTED,
        )
        return tuple(ground for ground, holds in zip(GROUNDS, held, strict=True) if holds)


@dataclass(frozen=True, slots=True)
class Effect:
    """The effect of the construct on the corpora, measured when it was accepted.

    ``files`` to ``parsed_bytes`` are of the evidence corpus, copies included. ``restores`` is the
    number of files that parse with the construct and did not without it. ``own_files`` and
    ``own_parsed`` are of ``corpus/programs``. ``negatives`` is the number it newly accepts,
    ``ambiguities`` the number of newly readable texts with two readings. ``metrics`` are those of
    `recovery.ledger.metrics`.
    """

    files: int = 0
    parsed: int = 0
    bytes: int = 0
    parsed_bytes: int = 0
    restores: int = 0
    own_files: int = 0
    own_parsed: int = 0
    negatives: int = 0
    ambiguities: int = 0
    metrics: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Construct:
    """One file of the ledger.

    ``number`` is its place in the ledger, ``None`` for a file from elsewhere. ``accept`` and
    ``reject`` are whole programs. ``comment`` is the comment at the head of the file, ``file`` its
    path.
    """

    name: str
    title: str
    edits: tuple[Edit, ...]
    number: int | None = None
    state: str = PROPOSED
    summary: str = ""
    evidence: Evidence = Evidence()
    accept: tuple[str, ...] = ()
    reject: tuple[str, ...] = ()
    effect: Effect | None = None
    comment: str = ""
    file: Path | None = field(default=None, compare=False)

    @property
    def id(self) -> str:
        """The file name without its suffix, such as ``0012-for-step``."""
        return self.name if self.number is None else f"{self.number:04}-{self.name}"

    @property
    def is_accepted(self) -> bool:
        """Whether it is part of the grammar."""
        return self.state == ACCEPTED

    @property
    def earned_state(self) -> str:
        """The state that its evidence gives while it is neither accepted nor rejected."""
        return (PROPOSED, *self.evidence.grounds)[-1]
