"""Writing a proposal of a survey as a construct, ready for review."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from grammar.notation.edits import from_data
from recovery.ledger.construct import Construct, Evidence, LedgerError
from recovery.ledger.construct_file import name_from, parse, read, text_of
from recovery.ledger.evidence import place

_PLACES_SEEN = 10
_FIGURES = {
    "restores": "files that parse with this edit alone",
    "mends": "distinct failing lines",
    "accepts_negatives": "programs that must stay rejected and would not",
    "ambiguities": "lines that then have two readings",
    "breaks": "files that parse now and would not",
}


def propose(record: Mapping[str, Any], cluster: str, number: int, folder: Path) -> Path:
    """Write proposal ``number`` (from 1) of a cluster in a survey record into ``folder``.

    ``cluster`` is an ID or its beginning. The comment at the head of the file has the survey's
    figures for the proposal. Returns the new file; an existing one is never replaced. Raises
    `LedgerError`, also if a file of the same name already proposes these edits.
    """
    chosen = _cluster(record, cluster)
    proposals = chosen["proposals"]
    if not proposals:
        raise LedgerError(f"{chosen['id']} has no proposal: no single edit was found to mend it")
    if not 1 <= number <= len(proposals):
        raise LedgerError(f"{chosen['id']} has {len(proposals)} proposals; there is no {number}")
    construct = _construct(record, chosen, proposals[number - 1])
    text, name = text_of(construct), construct.name
    parse(text, folder / f"{name}.toml")  # raises an error if the file could not be read back
    for file in folder.glob(f"[0-9][0-9][0-9][0-9]-{name}.toml"):
        if read(file).edits == construct.edits:
            raise LedgerError(f"{chosen['id']} is already proposed: {file.as_posix()}")
    folder.mkdir(parents=True, exist_ok=True)
    taken = [int(p.name[:4]) for p in folder.glob("[0-9][0-9][0-9][0-9]-*.toml")]
    at = max(taken, default=0) + 1
    while True:
        target = folder / f"{at:04}-{name}.toml"
        try:
            with target.open("x", encoding="utf-8", newline="\n") as stream:
                stream.write(text)
        except FileExistsError:
            at += 1
        else:
            return target


def _cluster(record: Mapping[str, Any], wanted: str) -> Mapping[str, Any]:
    found = [c for c in record.get("clusters", ()) if str(c["id"]).startswith(wanted)]
    if len(found) != 1 or not wanted:
        known = ", ".join(str(c["id"]) for c in record.get("clusters", ())[:5])
        what = "is no cluster" if not found else "is more than one cluster"
        raise LedgerError(f"{wanted!r} {what} of this survey; the first are {known or 'none'}")
    only: Mapping[str, Any] = found[0]
    return only


def _construct(
    record: Mapping[str, Any], cluster: Mapping[str, Any], proposal: Mapping[str, Any]
) -> Construct:
    """Return the proposal as a construct without an effect, which only an evaluation measures."""
    reproducer = cluster["reproducer"]
    seen = [
        f"{place(file['path'], origin['origin'])}:{file['line']}"
        for origin in cluster["files_by_origin"]
        for file in origin["files"][:2]
    ]
    files, origins, lines = (int(cluster[key]) for key in ("files", "origins", "failures"))
    evidence = Evidence(files, min(origins, lines), lines, seen=tuple(seen[:_PLACES_SEEN]))
    signature = cluster.get("signature", cluster["title"])  # older records have one text for both
    found = Construct(
        name=name_from(str(signature)),
        title=str(cluster["title"]),
        edits=tuple(from_data(edit) for edit in proposal["edits"]),
        evidence=evidence,
        accept=(str(reproducer["text"]),) if reproducer else (),
        comment=_comment(record, cluster, proposal),
    )
    return replace(found, state=found.earned_state)


def _comment(
    record: Mapping[str, Any], cluster: Mapping[str, Any], proposal: Mapping[str, Any]
) -> str:
    lines = [
        str(proposal["edit"]),
        "",
        *str(proposal["diff"]).splitlines()[2:],
        "",
        f"Cluster {cluster['id']}, tried on the grammar {record['grammar_sha256'][:12]}:",
        *(f"  {proposal[key]} {what}" for key, what in _FIGURES.items()),
    ]
    return "\n".join(f"# {line}".rstrip() for line in lines)
