"""Types of the JSON records that `krl recover` and `krl growth` write.

Fields are documented in docs/survey-record.md. Others read them, so fields are added and never
changed. Lines and columns count from 1; counts of files include copies, but for ``distinct``.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NotRequired, TypedDict


class SkippedRecord(TypedDict):
    """A file that was not read, and why."""

    path: str
    reason: str
    origin: str


class OriginRecord(TypedDict):
    """The files of one origin."""

    name: str
    files: int
    parsed: int
    failed: int


class CopyRecord(TypedDict):
    """A file with the content of another."""

    path: str
    same_as: str


class OrderRecord(TypedDict):
    """A cluster in the order of mending, and the files that parse after it."""

    cluster: str
    parsed: int


class WordRecord(TypedDict):
    """A word that is read as a name everywhere and bound nowhere."""

    word: str
    files: int
    origins: int


class _FailingLine(TypedDict):
    path: str
    line: int
    column: int
    token: str
    text: str


class FailureRecord(_FailingLine):
    """A failing line."""

    kind: str
    expected: list[str]
    rule: str
    cluster: str
    follows: bool


class LineRecord(TypedDict):
    """A numbered source line."""

    line: int
    text: str


class ExampleRecord(_FailingLine):
    """A failing line with the lines around it."""

    context: list[LineRecord]


class PlaceRecord(TypedDict):
    """A file, and its first line that fails."""

    path: str
    line: int


class FilesRecord(TypedDict):
    """The files of an origin; ``more`` is how many were left out."""

    origin: str
    files: list[PlaceRecord]
    more: NotRequired[int]


class ReproducerRecord(TypedDict):
    """See `recovery.reproducer.reduce.Reproducer`."""

    text: str
    line: int
    column: int
    tokens: int
    beyond: int


class ProposalRecord(TypedDict):
    """A proposed edit, what it mends, and what it costs."""

    edit: str
    kind: str
    restores: int
    mends: int
    advances: int
    accepts_negatives: int
    ambiguities: int
    breaks: int
    edits: list[dict[str, str | int | list[int]]]
    diff: str


class ClusterRecord(TypedDict):
    """Failing lines with one cause; ``answered_by`` is only in the record of the start."""

    id: str
    signature: str
    title: str
    failures: int
    lines: int
    follows: int
    files: int
    distinct: int
    origins: int
    unlocks: int
    rule: str
    rule_stack: list[str]
    expected: list[str]
    token: str
    example: ExampleRecord
    examples: list[ExampleRecord]
    files_by_origin: list[FilesRecord]
    reproducer: ReproducerRecord | None
    proposals: list[ProposalRecord]
    answered_by: NotRequired[str | None]


class ConstructRecord(TypedDict):
    """A construct of the ledger; ``edits`` are in words."""

    number: int
    id: str
    title: str
    state: str
    summary: str
    grounds: list[str]
    evidence: dict[str, object]
    edits: list[str]
    diff: str
    accept: list[str]
    reject: list[str]


class _Counts(TypedDict):
    grammar: str
    grammar_sha256: str
    files: int
    distinct: int
    parsed: int
    bytes: int
    parsed_bytes: int
    seconds: float
    analysis_seconds: NotRequired[float]
    greedy: list[OrderRecord]  # the mending order
    clusters: list[ClusterRecord]


class StartRecord(_Counts):
    """The survey under the restrictive start, and the constructs that answered its clusters."""

    constructs: list[ConstructRecord]


class SurveyRecord(_Counts):
    """A survey; ``version``, ``generated`` and ``start`` are added by `krl recover`.

    ``pending`` says what is still being computed; only the page that comes first has it.
    """

    skipped: list[SkippedRecord]
    origins: list[OriginRecord]
    copies: list[CopyRecord]
    swallowed: list[WordRecord]
    failures: Collection[FailureRecord]
    version: NotRequired[str]
    generated: NotRequired[str]
    start: NotRequired[StartRecord]
    pending: NotRequired[str]


class StepRecord(ConstructRecord):
    """A step of the growth: its construct, and the corpus read under the grammar after it."""

    files: int
    bytes: int
    parsed: int
    parsed_bytes: int
    restored: int
    broken: int
    restored_files: list[str]
    broken_files: list[str]
    failing_lines: int
    metrics: dict[str, float]


class LookaheadRecord(TypedDict):
    """How many tokens the decisions of a grammar need; ``one`` and ``two`` in per cent."""

    decisions: int
    one: float
    two: float
    others: list[str]


class AmbiguousLineRecord(TypedDict):
    """A line with two readings."""

    path: str
    line: int
    text: str


class AmbiguousRecord(TypedDict):
    """Lines with two readings of all lines in files that parse."""

    lines: int
    of: int
    examples: list[AmbiguousLineRecord]


class RemainingLineRecord(_FailingLine):
    """A line that fails at the end of the growth."""

    follows: bool


class RemainingFileRecord(TypedDict):
    """A file that does not parse at the end; see `recovery.growth.remaining.remaining`."""

    path: str
    origin: str
    copies: list[str]
    bytes: int
    lines: int
    failing: int
    fact: str
    fact_line: int
    kind: str
    reason: str


class GrowthRecord(TypedDict):
    """The growth; ``grammar``, ``version`` and ``generated`` are added by `krl growth`."""

    grammar_sha256: str
    files: int
    distinct: int
    bytes: int
    skipped: list[SkippedRecord]
    meanings: dict[str, str]
    steps: list[StepRecord]
    lookahead: LookaheadRecord
    ambiguous: AmbiguousRecord
    remaining: list[RemainingLineRecord]
    remaining_files: list[RemainingFileRecord]
    seconds: NotRequired[float]
    grammar: NotRequired[str]
    version: NotRequired[str]
    generated: NotRequired[str]
