"""The codes of findings: one table with the meaning of each, for messages, filters and documents.

``codes.tsv`` has a row for each code. A code is the number of the controller's own message if there
is one (KSS2296). All others are ours, by subject: KRL0 syntax, KRL1 names and declarations, KRL2
types, KRL3 calls, KRL4 control flow, KRL5 motions, interrupts and triggers, KRL6 what stops the
robot, KRL7 files, KRL9 the check itself. Every code also has a *slug*, a unique name for people.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Literal, get_args

from support.files.tables import read_table
from support.lazy_dataclass import dataclass

#: In descending order. An error is a program that the controller rejects.
Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class DiagnosticCode:
    """The meaning of a code: ``title`` says what is wrong, ``explanation`` why, in sentences.

    ``severity`` is the default of its findings; ``rules`` are rule IDs.
    """

    code: str
    slug: str
    severity: Severity
    title: str
    explanation: str
    rules: tuple[str, ...]


@cache
def by_slug() -> Mapping[str, DiagnosticCode]:
    """Return all codes by their slugs, in the order of the table."""
    found: dict[str, DiagnosticCode] = {}
    severities: Mapping[str, Severity] = {word: word for word in get_args(Severity)}
    for number, row in enumerate(read_table("grammar.diagnostics", "codes.tsv")[1:], 2):
        name, slug, severity, rules, title, explanation = row
        if severity not in severities or slug in found:
            wrong = f"{slug} is there twice" if slug in found else f"no severity is {severity}"
            raise ValueError(f"codes.tsv:{number}: {wrong}")
        known = severities[severity]
        found[slug] = DiagnosticCode(name, slug, known, title, explanation, tuple(rules.split()))
    return found


@cache
def by_code() -> Mapping[str, DiagnosticCode]:
    """Return all codes by their names, such as KSS2296."""
    return {entry.code: entry for entry in by_slug().values()}


def code(slug: str) -> DiagnosticCode:
    """Return the code with this slug; raises `KeyError` if there is none, which is a defect."""
    return by_slug()[slug]


def of_message(number: int) -> DiagnosticCode | None:
    """Return the code for a message number of the controller, or ``None`` if no finding has it."""
    return by_code().get(f"KSS{number}")
