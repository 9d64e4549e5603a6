"""The summary of a nightly run in Markdown, for an issue or an e-mail."""

from collections.abc import Iterator, Mapping
from typing import Any

from reports.nightly.nightly_failures import headline
from reports.rendering.record_fields import nested, number, records, text, texts
from reports.rendering.sanitizing import shown

_MOST = 40


def nightly_summary(record: Mapping[str, Any]) -> str:
    """Return the failures with the commands that repeat them, the changes, and the steps.

    ``record`` is that of `nightly_page.write_nightly_page`. Names and messages are untrusted, and
    are set as code so that they cannot link, mention or embed anything.
    """
    return "\n".join(_lines(record))


def _lines(record: Mapping[str, Any]) -> Iterator[str]:
    failures, changes = records(record, "failures"), texts(record, "changes")
    told = headline(record)
    verdict = _code(told) if told else "nothing failed"
    yield f"## Nightly run of {_code(text(record, 'date'))}: {verdict}\n"
    for one in failures[:_MOST]:
        command = text(one, "command")
        yield f"- {_code(text(one, 'what'))}" + (
            f", again with {_code(command)}" if command else ""
        )
    yield from _more(len(failures))
    yield "\n### What changed since the last run\n"
    yield from (f"- {_code(one)}" for one in changes[:_MOST])
    yield from _more(len(changes)) if changes else ("Nothing.",)
    yield "\n### Steps\n\n| step | how it went | minutes |\n| --- | --- | ---: |"
    for name, step in nested(record, "steps").items():
        minutes = number(step, "seconds") / 60
        yield f"| {_code(name)} | {_code(text(step, 'status'))} | {minutes:.1f} |"
    yield ""


def _more(count: int) -> Iterator[str]:
    if count > _MOST:
        yield f"- {count - _MOST:,} more"


def _code(foreign: str) -> str:
    """Return a text as inline code that is safe in a line or a table cell."""
    cleaned = shown(foreign, 300).replace("`", "'").replace("|", "¦").strip()
    return f"`{cleaned or ' '}`"
