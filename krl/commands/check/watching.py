"""`krl check --watch`: when to check again."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import typer

_ENDINGS = (".src", ".dat", ".sub", ".zip", ".toml")
# Milliseconds from one look at the files beside to the next.
_PAUSE = 200


def changes(paths: Sequence[Path], beside: Callable[[], Iterable[Path]]) -> Iterator[None]:
    """Yield once at the start, and again whenever programs or settings below the paths change.

    ``beside`` returns single files that also matter at this moment, wherever they are. What changes
    while the caller works is noticed too. Ends when interrupted.
    """
    from watchfiles import Change, watch

    def is_ours(_change: Change, path: str) -> bool:
        return path.lower().endswith(_ENDINGS)

    # a file that is replaced by another is only noticed in its folder
    roots = {path if path.is_dir() else path.absolute().parent for path in paths}
    known: dict[Path, float | None] | None = None
    for found in watch(
        *roots,
        watch_filter=is_ours,
        rust_timeout=_PAUSE,
        yield_on_timeout=True,
        raise_interrupt=False,
    ):
        now = {file: _changed(file) for file in beside()}
        if found or now != known:
            if known is not None:
                typer.echo("", err=True)
            yield
            known = {file: now.get(file, _changed(file)) for file in beside()}


def _changed(file: Path) -> float | None:
    """Return when a file was changed; ``None`` if there is none."""
    try:
        return file.stat().st_mtime
    except OSError:
        return None
