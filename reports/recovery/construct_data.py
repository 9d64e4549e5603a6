"""A construct of the ledger as JSON for the scripts of a page."""

from typing import Any

from reports.rendering.embedding import printable
from reports.rendering.number_format import clip
from reports.rendering.record_fields import Record, count, nested, text, texts

_MAX_TEXT = 8000
_MAX_EXAMPLES = 12

Json = dict[str, Any]


def anchor(construct: Record) -> str:
    """Return the name of a construct for links, such as ``c-0012``."""
    return f"c-{count(construct, 'number'):04}"


def construct_data(construct: Record) -> Json:
    """Return a construct as JSON: its description, evidence, edits and examples."""
    evidence = nested(construct, "evidence")
    return {
        "anchor": anchor(construct),
        "number": count(construct, "number"),
        "id": printable(clip(text(construct, "id"), 80)),
        "title": printable(clip(text(construct, "title") or text(construct, "id"), 200)),
        "summary": printable(clip(text(construct, "summary"), 2000)),
        "grounds": clipped(texts(construct, "grounds"), 20),
        "evidence": {
            "files": count(evidence, "files"),
            "origins": count(evidence, "origins"),
            "lines": count(evidence, "lines"),
            "rules": clipped(texts(evidence, "rules"), 20),
            "manual": printable(clip(text(evidence, "manual"), 600)),
            "verdict": printable(clip(text(evidence, "verdict"), 400)),
            "oracle": printable(clip(text(evidence, "oracle"), 200)),
            "seen": clipped(texts(evidence, "seen")[:_MAX_EXAMPLES], 400),
        },
        "edits": clipped(texts(construct, "edits"), 600),
        "diff": clip(text(construct, "diff"), _MAX_TEXT),
        "accept": [clip(t, _MAX_TEXT) for t in texts(construct, "accept")[:_MAX_EXAMPLES]],
        "reject": [clip(t, _MAX_TEXT) for t in texts(construct, "reject")[:_MAX_EXAMPLES]],
    }


def clipped(foreign: list[str], width: int) -> list[str]:
    """Return the texts in printable form, each of limited length."""
    return [printable(clip(line, width)) for line in foreign]
