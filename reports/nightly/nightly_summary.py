"""A nightly run summarised in Markdown, for an issue or an e-mail."""

from collections.abc import Iterator, Mapping
from typing import Any

from reports.rendering.number_format import counted
from reports.rendering.record_fields import nested, number, records, text, texts
from reports.rendering.sanitizing import shown

_MOST = 40


def nightly_summary(record: Mapping[str, Any]) -> str:
    """Failures with how to repeat them, what changed, and how the steps went.

    ``record`` is that of `nightly_page.write_nightly_page`. Names and messages are set as
    code: they may be of other people, and link, mention and embed nothing.
    """
    return "\n".join(_lines(record))


def _lines(record: Mapping[str, Any]) -> Iterator[str]:
    failures, changes = records(record, "failures"), texts(record, "changes")
    verdict = counted(len(failures), "failure") if failures else "nothing failed"
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
    """A text as code in a line or a cell of a table."""
    cleaned = shown(foreign, 300).replace("`", "'").replace("|", "¦").strip()
    return f"`{cleaned or ' '}`"
