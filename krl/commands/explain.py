"""`krl explain`: the meaning of a finding's code, with a wrong and a right program."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from krl.errors import FINE, InputError

if TYPE_CHECKING:
    from grammar.diagnostics.explanations import Explanation


def explain(
    code: Annotated[str | None, typer.Argument(metavar="[CODE]")] = None,
) -> int:
    """Explain a code of `krl check`: what is wrong, why, and how to fix it.

    Options:
        code: KSS2296 or 2296; without it all codes are listed.
    """
    from grammar.diagnostics.codes import by_code, by_slug
    from grammar.diagnostics.did_you_mean import did_you_mean
    from grammar.diagnostics.explanations import explanation

    if code is None:
        for entry in by_code().values():
            typer.echo(f"{entry.code:8}{entry.severity:9}{entry.title}")
        return FINE
    found = explanation(code)
    if found is None:
        near = did_you_mean(code, [*by_code(), *by_slug()])
        hint = near.text if near else "krl explain lists all"
        raise InputError(f"no finding has the code {code}; {hint}")
    typer.echo("\n".join(_lines(found)))
    return FINE


def _lines(found: "Explanation") -> Iterator[str]:
    from grammar.semantics.rules import is_confirmed

    entry = found.code
    yield f"{entry.code} {entry.slug}: {entry.title} ({entry.severity})"
    yield ""
    yield entry.explanation
    for heading, program in (("Wrong:", found.wrong), ("Right:", found.right)):
        if program:
            yield ""
            yield heading
            yield ""
            yield from (f"    {line}".rstrip() for line in program.rstrip().splitlines())
    yield ""
    if found.message is not None:
        yield f"Message of the controller: {found.message}"
    if entry.rules:
        known = "" if is_confirmed(entry.rules) else " (unconfirmed)"
        yield f"Rules: {', '.join(entry.rules)}{known}, see docs/semantics.md"
    if found.source:
        yield f"Source: {found.source}"
    yield f"To silence one: ; krl: ignore[{entry.code}] on its line"
