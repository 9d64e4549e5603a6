"""The file format of a construct: TOML that is checked key by key and written in one way only.

Reading a file that `text_of` wrote gives the same construct, and writing that gives the same text.
Of comments, only those at the head of the file are kept.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from grammar.notation.edits import Edit, from_data, to_data
from grammar.notation.model import GrammarError
from grammar.semantics.rules import tiers
from recovery.ledger.construct import (
    GROUNDS,
    REJECTED,
    STATES,
    Construct,
    Effect,
    Evidence,
    LedgerError,
)
from support.files.untrusted import DocumentError, read_bytes, toml_of

_FILE_NAME = re.compile(r"(?:(?P<number>\d{4})-)?(?P<name>[a-z0-9]+(?:-[a-z0-9]+)*)\.toml")
_VERDICT = re.compile(r"(?:accepted|refused: \S.*)?")
_HEAD = re.compile(r"(?:[ \t]*(?:#.*)?\r?\n)*")
_ESCAPE = re.compile(r"\\.")
_PLAIN = {"\\n": "\n", '\\"': '"'}  # escapes that are not needed in a multi-line text
_WIDEST_NAME = 40
_MOST_SEEN = 10
_COUNTS = ("files", "origins", "lines")
_FIGURES = tuple(f.name for f in fields(Effect) if f.name != "metrics")


def name_from(text: str) -> str:
    """Return a name for a construct: the words of a text in lower case, joined by hyphens."""
    words = re.sub(r"[^A-Za-z0-9]+", "-", text).strip("-").lower()
    return words[:_WIDEST_NAME].strip("-") or "construct"


# ------------------------------------------------------------------------------------- reading


def read(path: Path) -> Construct:
    """Return the construct in a file; raises `LedgerError`, which names the file and the key."""
    try:
        text = read_bytes(path).decode("utf-8")
    except OSError as error:
        raise LedgerError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise LedgerError(f"{path}: not UTF-8 text") from None
    return parse(text, path)


def parse(text: str, path: Path) -> Construct:
    """Return the construct in a text that belongs to the file ``path``; raises `LedgerError`."""
    named = _FILE_NAME.fullmatch(path.name)
    if named is None:
        raise LedgerError(f"{path}: the name is not NNNN-words-in-lower-case.toml")
    try:
        data = toml_of(text)
    except DocumentError as error:
        raise LedgerError(f"{path}: {error}") from None
    number = None if named["number"] is None else int(named["number"])
    try:
        found = _construct(_Table(data), named["name"], number, path)
    except _WrongError as wrong:
        raise LedgerError(f"{path}: {wrong}") from None
    head = _HEAD.match(text)
    return replace(found, comment=head[0].strip() if head else "")


class _WrongError(Exception):
    """A key has a wrong value; the message names it."""


class _Table:
    """A TOML table whose keys are removed as they are read; remaining ones are errors."""

    def __init__(self, data: Mapping[str, Any], name: str = "") -> None:
        self._left = dict(data)
        self._prefix = f"{name}." if name else ""

    def wrong(self, key: str, what: str) -> _WrongError:
        return _WrongError(f"{self._prefix}{key}: {what}")

    def text(self, key: str, default: str | None = None) -> str:
        value = self._left.pop(key, default)
        if value is None:
            raise self.wrong(key, "is missing")
        if not isinstance(value, str):
            raise self.wrong(key, "is not a text")
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        value = self._left.pop(key, [])
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise self.wrong(key, "is not a list of texts")
        return tuple(value)

    def count(self, key: str) -> int:
        value = self._left.pop(key, 0)
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise self.wrong(key, "is not a whole number")
        return value

    def table(self, key: str) -> _Table:
        value = self._left.pop(key, {})
        if not isinstance(value, dict):
            raise self.wrong(key, "is not a table")
        return _Table(value, f"{self._prefix}{key}")

    def tables(self, key: str) -> list[Mapping[str, object]]:
        value = self._left.pop(key, [])
        if not isinstance(value, list) or not all(isinstance(v, dict) for v in value):
            raise self.wrong(key, f"is not a list of tables, each under [[{key}]]")
        return value

    def figures(self) -> dict[str, float]:
        """Return all remaining keys, each with a number."""
        values, self._left = self._left, {}
        for key, value in values.items():
            known = isinstance(value, int | float) and not isinstance(value, bool)
            if not known or not math.isfinite(value):
                raise self.wrong(key, "is not a number")
        return values

    def done(self) -> None:
        for key in self._left:
            raise self.wrong(key, "is not a key of a construct")

    def __contains__(self, key: str) -> bool:
        return key in self._left


def _construct(table: _Table, name: str, number: int | None, path: Path) -> Construct:
    title, state, summary = table.text("title"), table.text("state"), table.text("summary", "")
    if not title.strip() or "\n" in title:
        raise table.wrong("title", "is not one line of text")
    if state not in STATES:
        raise table.wrong("state", f"{state!r} is none of {', '.join(STATES)}")
    edits = tuple(_edit(table, n, data) for n, data in enumerate(table.tables("edit"), 1))
    if not edits:
        raise table.wrong("edit", "is missing: a construct has at least one [[edit]]")
    evidence = _evidence(table.table("evidence"))
    if state in GROUNDS and state not in evidence.grounds:
        raise table.wrong("state", f"the evidence does not make it {state}")
    if state == REJECTED and not summary.strip():
        raise table.wrong("summary", "does not say why the construct is rejected")
    examples = table.table("examples")
    accept, reject = examples.texts("accept"), examples.texts("reject")
    examples.done()
    effect = _effect(table.table("effect")) if "effect" in table else None
    table.done()
    return Construct(
        name, title, edits, number, state, summary, evidence, accept, reject, effect, file=path
    )


def _edit(table: _Table, number: int, data: Mapping[str, object]) -> Edit:
    try:
        return from_data(data)
    except GrammarError as error:
        raise table.wrong("edit", f"number {number}: {error}") from None


def _evidence(table: _Table) -> Evidence:
    files, origins, lines = map(table.count, _COUNTS)
    if not (origins <= files and origins <= lines):
        raise table.wrong("origins", "more origins than files or lines")
    rules, manual = table.texts("rules"), table.text("manual", "")
    for rule in rules:
        if rule not in tiers():
            raise table.wrong("rules", f"{rule!r} is not the ID of a rule in docs/semantics.md")
    verdict = table.text("verdict", "")
    if _VERDICT.fullmatch(verdict) is None:
        raise table.wrong("verdict", "is neither empty, 'accepted', nor 'refused: MESSAGE'")
    oracle, seen = table.text("oracle", ""), table.texts("seen")
    if len(seen) > _MOST_SEEN:
        raise table.wrong("seen", f"has more than {_MOST_SEEN} places")
    table.done()
    return Evidence(files, origins, lines, rules, manual, verdict, oracle, seen)


def _effect(table: _Table) -> Effect:
    figures = {key: table.count(key) for key in _FIGURES}
    metrics = table.table("metrics").figures()
    table.done()
    return Effect(**figures, metrics=metrics)


# ------------------------------------------------------------------------------------- writing


def text_of(construct: Construct) -> str:
    """Return the text of a construct's file."""
    head = f"{construct.comment}\n\n" if construct.comment else ""
    return head + "\n".join(_lines(construct)) + "\n"


def _lines(construct: Construct) -> Iterator[str]:
    yield f"title = {quoted(construct.title)}"
    yield f"state = {quoted(construct.state)}"
    yield f"summary = {quoted(construct.summary)}"
    for edit in construct.edits:
        yield from ("", "[[edit]]")
        yield from (f"{key} = {_value(value)}" for key, value in to_data(edit).items())
    evidence = construct.evidence
    yield from ("", "[evidence]")
    yield from (f"{key} = {getattr(evidence, key)}" for key in _COUNTS)
    yield f"rules = {json.dumps(evidence.rules)}"
    yield from (f"{key} = {quoted(getattr(evidence, key))}" for key in ("manual", "verdict"))
    if evidence.oracle:
        yield f"oracle = {quoted(evidence.oracle)}"
    yield f"seen = {_listed(evidence.seen)}"
    yield from ("", "[examples]")
    yield f"accept = {_listed(construct.accept)}"
    yield f"reject = {_listed(construct.reject)}"
    if construct.effect is not None:
        yield from ("", "[effect]")
        yield from (f"{key} = {getattr(construct.effect, key)}" for key in _FIGURES)
        yield from ("", "[effect.metrics]")
        yield from (f"{key} = {value!r}" for key, value in construct.effect.metrics.items())


def _value(value: object) -> str:
    return json.dumps(value) if isinstance(value, int | list) else quoted(str(value))


def _listed(texts: Sequence[str]) -> str:
    return "[\n" + "".join(f"    {quoted(text)},\n" for text in texts) + "]" if texts else "[]"


def quoted(text: str) -> str:
    """Return a text as a TOML string; with several lines it is a multi-line string."""
    # the escapes of JSON are those of TOML, except that TOML requires one for DEL
    line = json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
    if "\n" not in text:
        return line
    body = _ESCAPE.sub(lambda found: _PLAIN.get(found[0], found[0]), line[1:-1])
    return '"""\n' + body.replace('"""', '""\\"') + '"""'
