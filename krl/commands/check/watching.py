"""`krl check --watch`: when to check again."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import typer

_ENDINGS = (".src", ".dat", ".sub", ".zip", ".toml")


def changes(paths: Sequence[Path]) -> Iterator[None]:
    """Yield once at the start, and again whenever programs or settings below the paths change.

    Ends when interrupted.
    """
    from watchfiles import Change, watch

    def is_ours(_change: Change, path: str) -> bool:
        return path.lower().endswith(_ENDINGS)

    yield
    # a file that is replaced by another is only noticed in its folder
    roots = {path if path.is_dir() else path.absolute().parent for path in paths}
    for _ in watch(*roots, watch_filter=is_ours, raise_interrupt=False):
        typer.echo("", err=True)
        yield
