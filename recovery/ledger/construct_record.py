"""The record of a construct for pages: description, evidence and edits."""

from __future__ import annotations

import difflib
from dataclasses import fields

from grammar.notation.edits import apply, describe
from grammar.notation.model import Grammar
from recovery.ledger.construct import Construct, Evidence
from recovery.record.record_types import ConstructRecord

#: The restrictive start as a step of the growth, with the same fields.
START_RECORD: ConstructRecord = {
    "number": 0,
    "id": "preliminary",
    "title": "The restrictive start",
    "state": "start",
    "summary": "",
    "grounds": [],
    "evidence": {},
    "edits": [],
    "diff": "",
    "accept": [],
    "reject": [],
}


def construct_record(construct: Construct, before: Grammar, after: Grammar) -> ConstructRecord:
    """Return the record of a construct that changes ``before`` into ``after``.

    ``edits`` has a line for each typed edit, ``diff`` is the change to the text of the grammar.
    """
    edits, grammar = [], before
    for edit in construct.edits:
        edits.append(describe(grammar, edit))
        grammar = apply(grammar, [edit])
    lines = difflib.unified_diff(
        before.text.splitlines(), after.text.splitlines(), lineterm="", n=1
    )
    return {
        "number": construct.number or 0,
        "id": construct.id,
        "title": construct.title,
        "state": construct.state,
        "summary": construct.summary,
        "grounds": list(construct.evidence.grounds),
        "evidence": _plain(construct.evidence),
        "edits": edits,
        "diff": "\n".join(list(lines)[2:]),
        "accept": list(construct.accept),
        "reject": list(construct.reject),
    }


def _plain(evidence: Evidence) -> dict[str, object]:
    values = {field.name: getattr(evidence, field.name) for field in fields(evidence)}
    return {key: list(v) if isinstance(v, tuple) else v for key, v in values.items()}
