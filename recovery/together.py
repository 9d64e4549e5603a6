"""Several files written together: all of them, or none.

Everything is laid beside its target first. What is then exchanged is put back where a later
exchange fails, so that a full disk or a file in use leaves the folder as it was.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path

__all__ = ["write_together"]


def write_together(changes: Mapping[Path, bytes | None]) -> list[Path]:
    """Give each file its new content; ``None`` removes it. Returns the files that have changed.

    Folders of new files are made. Raises `OSError`, and then nothing has changed.
    """
    olds = {path: path.read_bytes() if path.is_file() else None for path in changes}
    staged: dict[Path, Path] = {}
    done: list[Path] = []
    try:
        for path, content in changes.items():
            if content is not None and content != olds[path]:
                path.parent.mkdir(parents=True, exist_ok=True)
                staged[path] = path.with_name(f"{path.name}.part")
                staged[path].write_bytes(content)
        for path, content in changes.items():
            if path in staged:
                done.append(path)
                staged[path].replace(path)
            elif content is None and olds[path] is not None:
                done.append(path)
                path.unlink()
    except BaseException:
        for path in done:
            old = olds[path]
            with contextlib.suppress(OSError):
                path.unlink() if old is None else path.write_bytes(old)
        raise
    finally:
        for part in staged.values():
            part.unlink(missing_ok=True)
    return done
