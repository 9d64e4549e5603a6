"""Shared by the commands about constructs: paths, errors, output."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from krl.errors import one_line, say

if TYPE_CHECKING:
    from recovery.ledger.evaluation import Evaluation

# Paths in the working folder: constructs can only be accepted in a checkout.
GRAMMAR = Path("grammar", "KRL.g4")
PRELIMINARY = Path("grammar", "preliminary.g4")
GENERATED = Path("grammar", "_generated")
LEDGER = Path("grammar", "constructs")


def checkout_or_packaged(path: Path) -> Path:
    """Return where to read one of these paths: in the checkout, or else in the package."""
    from grammar.notation.generate import GRAMMAR as OURS

    return path if path.parent.is_dir() else OURS.parent / path.relative_to("grammar")


def print_evaluation(found: "Evaluation") -> None:
    """Print the figures of an evaluated construct, and the objections to it."""
    from recovery.ledger.overview import counts_of

    construct = found.construct
    evidence, effect = construct.evidence, construct.effect
    say(f"{construct.id}: {construct.title}")
    old = "" if found.is_counted else " (as written in the file: there is no corpus to count in)"
    typer.echo(f"  evidence   {counts_of(evidence)}{old}")
    typer.echo(f"  grounds    {', '.join(evidence.grounds) or 'none'}")
    if effect is not None:
        typer.echo(
            f"  effect     {effect.parsed} of {effect.files} files parse, {effect.restores} of "
            f"them newly; own {effect.own_parsed} of {effect.own_files}"
        )
        typer.echo(
            f"  costs      negatives accepted {effect.negatives}, ambiguities {effect.ambiguities}"
        )
    for why in found.refusals:
        typer.echo(f"  refused    {one_line(why)}")


def print_refusals(refusals: Iterable[tuple[str, str]]) -> None:
    """Print the refusals: where and why."""
    for where, why in refusals:
        say(f"refused: {where}: {why}")
