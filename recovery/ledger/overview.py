"""Overviews of a construct: a row of a list, a page of text, its change to the grammar."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypedDict

from grammar.notation.model import Grammar
from recovery.ledger.construct import Construct, Evidence, LedgerError
from recovery.ledger.construct_record import construct_record
from recovery.ledger.ledger import Ledger, grown, in_force
from recovery.ledger.oracle import reason_to_ask


class ConstructRow(TypedDict):
    """A construct in a list; ``waits`` says why an oracle should be asked, or is empty."""

    number: int | None
    id: str
    title: str
    state: str
    grounds: list[str]
    files: int
    origins: int
    lines: int
    rules: list[str]
    manual: str
    verdict: str
    waits: str


def row_of(construct: Construct) -> ConstructRow:
    """Return a construct as a row of a list."""
    evidence = construct.evidence
    return {
        "number": construct.number,
        "id": construct.id,
        "title": construct.title,
        "state": construct.state,
        "grounds": list(evidence.grounds),
        "files": evidence.files,
        "origins": evidence.origins,
        "lines": evidence.lines,
        "rules": list(evidence.rules),
        "manual": evidence.manual,
        "verdict": evidence.verdict,
        "waits": reason_to_ask(construct),
    }


def page_of(construct: Construct) -> Iterator[str]:
    """Yield the content of a construct's file, without its edits, line by line."""
    evidence = construct.evidence
    yield f"{construct.id}: {construct.title}"
    yield f"{construct.state}; grounds: {', '.join(evidence.grounds) or 'none'}"
    if construct.summary:
        yield from ("", *construct.summary.splitlines())
    yield from ("", f"Evidence: {counts_of(evidence)}")
    sources = {
        "rules": ", ".join(evidence.rules),
        "manual": evidence.manual,
        "verdict": evidence.verdict,
        "oracle": evidence.oracle,
    }
    yield from (f"  {key}: {value}" for key, value in sources.items() if value)
    yield from (f"  seen: {place}" for place in evidence.seen)
    for heading, texts in (("Accepts", construct.accept), ("Rejects", construct.reject)):
        for text in texts:
            yield from ("", f"{heading}:")
            yield from (f"  {line}" for line in text.strip("\r\n").splitlines())
    effect = construct.effect
    if effect is not None:
        yield from ("", "Effect, measured when it was accepted:")
        yield (
            f"  {effect.parsed} of {effect.files} files parse ({effect.parsed_bytes} of "
            f"{effect.bytes} bytes), {effect.restores} of them newly"
        )
        yield f"  {effect.own_parsed} of {effect.own_files} own programs parse"
        yield f"  {effect.negatives} negatives accepted, {effect.ambiguities} ambiguities"
        metrics = (f"{name} {value:g}" for name, value in effect.metrics.items())
        yield f"  metrics: {', '.join(metrics)}"


def counts_of(evidence: Evidence) -> str:
    """Return the counts of the evidence in words."""
    counts = (evidence.files, "file"), (evidence.origins, "origin"), (evidence.lines, "line")
    files, origins, lines = (f"{n} {what}" if n == 1 else f"{n} {what}s" for n, what in counts)
    return f"{files} of {origins}, {lines}"


def difference(construct: Construct, preliminary: Grammar, ledger: Ledger) -> Iterator[str]:
    """Yield the edits and the change to the grammar, line by line.

    An accepted construct is shown at its place, another one after the current grammar. Raises
    `LedgerError` if the ledger cannot be replayed.
    """
    before = in_force(preliminary, ledger.ahead_of(construct))
    try:
        record = construct_record(construct, before, grown(before, construct))
    except LedgerError as error:
        yield from ("", str(error))
        return
    yield from ("", "Edits:")
    yield from (f"  {edit}" for edit in record["edits"])
    yield ""
    yield from record["diff"].splitlines()
