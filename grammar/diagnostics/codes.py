"""The codes of findings: one table with what each means, for messages, filters and documents.

``codes.tsv`` has a row for each code. A code is the number of the controller's own message where
one fits, KSS2296, else ours: KRL0 reading, KRL1 names and declarations, KRL2 types, KRL3 calls,
KRL4 control flow, KRL5 motions, interrupts and triggers, KRL6 what stops the robot, KRL7 files,
KRL9 the check itself. Code and *slug*, a name for people, both stand once.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Literal, get_args

from support.lazy_dataclass import dataclass

#: From the gravest to the mildest. An error is what the controller refuses.
Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class DiagnosticCode:
    """What a code means: ``title`` says what is wrong, ``explanation`` why, in sentences.

    ``severity`` is that of a finding of which nothing else is known; ``rules`` are IDs.
    """

    code: str
    slug: str
    severity: Severity
    title: str
    explanation: str
    rules: tuple[str, ...]


@cache
def by_slug() -> Mapping[str, DiagnosticCode]:
    """All codes by their slugs, in the order of the table."""
    table = resources.files(__package__).joinpath("codes.tsv").read_text(encoding="utf-8")
    found = {}
    for row in table.splitlines()[1:]:
        name, slug, severity, rules, title, explanation = row.split("\t")
        (known,) = (word for word in get_args(Severity) if word == severity)
        found[slug] = DiagnosticCode(name, slug, known, title, explanation, tuple(rules.split()))
    return found


@cache
def by_code() -> Mapping[str, DiagnosticCode]:
    """The same by their codes."""
    return {entry.code: entry for entry in by_slug().values()}


def code(slug: str) -> DiagnosticCode:
    """The code with this slug; raises `KeyError`, which can only be a mistake of ours."""
    return by_slug()[slug]


def of_message(number: int) -> DiagnosticCode | None:
    """The code of a message of the controller, where findings have it."""
    return by_code().get(f"KSS{number}")
