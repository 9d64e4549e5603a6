"""The ledger of constructs: a proposal written as a file that a maintainer can review.

One construct a file, ``NNNN-name.toml``: what it is, the typed edits, the evidence for it and what
the survey measured. It is written in the state ``proposed``; a person completes it.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

__all__ = ["LedgerError", "propose"]

_FILES_NAMED = 10
_WIDEST_NAME = 40


class LedgerError(Exception):
    """The record has no such cluster or proposal; the message is one clear line."""


def propose(record: Mapping[str, Any], cluster: str, number: int, folder: Path) -> Path:
    """Write proposal ``number`` (from 1) of a cluster of a survey record into ``folder``.

    ``cluster`` is an ID or its beginning. Returns the new file; one that exists is never replaced.
    Raises `LedgerError`.
    """
    chosen = _cluster(record, cluster)
    proposals = chosen["proposals"]
    if not proposals:
        raise LedgerError(f"{chosen['id']} has no proposal: no single edit was found to mend it")
    if not 1 <= number <= len(proposals):
        raise LedgerError(f"{chosen['id']} has {len(proposals)} proposals; there is no {number}")
    text = _text(record, chosen, proposals[number - 1])
    tomllib.loads(text)  # what is written can be read
    folder.mkdir(parents=True, exist_ok=True)
    name = _name(str(chosen["title"]))
    taken = [int(p.name[:4]) for p in folder.glob("[0-9][0-9][0-9][0-9]-*.toml")]
    place = max(taken, default=0) + 1
    while True:
        target = folder / f"{place:04}-{name}.toml"
        try:
            with target.open("x", encoding="utf-8", newline="\n") as stream:
                stream.write(text)
        except FileExistsError:
            place += 1
        else:
            return target


def _cluster(record: Mapping[str, Any], wanted: str) -> Mapping[str, Any]:
    found = [c for c in record.get("clusters", ()) if str(c["id"]).startswith(wanted)]
    if len(found) != 1 or not wanted:
        known = ", ".join(str(c["id"]) for c in record.get("clusters", ())[:5])
        what = "is no cluster" if not found else "is more than one cluster"
        raise LedgerError(f"{wanted!r} {what} of this survey; the first are {known or 'none'}")
    return found[0]  # type: ignore[no-any-return]


def _name(title: str) -> str:
    words = re.sub(r"[^A-Za-z0-9]+", "-", title).strip("-").lower()
    return words[:_WIDEST_NAME].strip("-") or "construct"


def _text(
    record: Mapping[str, Any], cluster: Mapping[str, Any], proposal: Mapping[str, Any]
) -> str:
    reproducer = cluster["reproducer"] or {}
    lines = [
        f"# {proposal['edit']}",
        "#",
        *(f"# {line}" for line in str(proposal["diff"]).splitlines()[2:]),
        "",
        f"title = {_quoted(cluster['title'])}",
        'state = "proposed"',
        f"grammar = {_quoted(record['grammar_sha256'])}  # the grammar it was tried on",
        "",
        *(line for edit in proposal["edits"] for line in _table("[[edit]]", edit)),
        "[evidence]",
        f"files = {cluster['files']}",
        f"origins = {cluster['origins']}",
        f"lines = {cluster['failures']}",
        "rules = []  # IDs of documented rules that say so",
        'verdict = ""  # what the official implementation said, where it was asked',
        f"seen = {_seen(cluster)}",
        "",
        "[examples]",
        f"accept = {_listed([str(reproducer['text'])] if reproducer else [])}",
        "reject = []  # programs near it that must stay rejected",
        "",
        "[effect]",
        f"restores = {proposal['restores']}  # files that parse with this edit alone",
        f"mends = {proposal['mends']}  # distinct failing lines",
        f"accepts_negatives = {proposal['accepts_negatives']}",
        f"ambiguities = {proposal['ambiguities']}",
        f"breaks = {proposal['breaks']}",
        "",
    ]
    return "\n".join(lines)


def _table(header: str, values: Mapping[str, Any]) -> list[str]:
    return [header, *(f"{key} = {_value(value)}" for key, value in values.items()), ""]


def _value(value: object) -> str:
    return json.dumps(value) if isinstance(value, int | list) else _quoted(value)


def _seen(cluster: Mapping[str, Any]) -> str:
    """Places of the first files, a few of each origin."""
    places = [
        f"{file['path']}:{file['line']}"
        for origin in cluster["files_by_origin"]
        for file in origin["files"][:2]
    ]
    return _listed(places[:_FILES_NAMED])


def _listed(texts: Sequence[str]) -> str:
    return "[\n" + "".join(f"    {_quoted(text)},\n" for text in texts) + "]" if texts else "[]"


def _quoted(text: object) -> str:
    """A basic string of TOML: JSON's escapes, and DEL spelt out as TOML wants it."""
    return json.dumps(str(text), ensure_ascii=False).replace("\x7f", "\\u007f")
