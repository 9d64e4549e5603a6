"""A construct of the ledger as JSON for the scripts of a page."""

from typing import Any

from reports.rendering.number_format import clip
from reports.rendering.record_fields import Record, count, nested, text, texts
from reports.rendering.sanitizing import shown, shown_texts

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
        **shown_texts(construct, id=80, summary=2000),
        "title": shown(text(construct, "title") or text(construct, "id"), 200),
        "grounds": [shown(one, 20) for one in texts(construct, "grounds")],
        "evidence": {
            **{name: count(evidence, name) for name in ("files", "origins", "lines")},
            "rules": [shown(one, 20) for one in texts(evidence, "rules")],
            **shown_texts(evidence, manual=600, verdict=400, oracle=200),
            "seen": [shown(one) for one in texts(evidence, "seen")[:_MAX_EXAMPLES]],
        },
        "edits": [shown(one, 600) for one in texts(construct, "edits")],
        "diff": clip(text(construct, "diff"), _MAX_TEXT),
        "accept": [clip(t, _MAX_TEXT) for t in texts(construct, "accept")[:_MAX_EXAMPLES]],
        "reject": [clip(t, _MAX_TEXT) for t in texts(construct, "reject")[:_MAX_EXAMPLES]],
    }
