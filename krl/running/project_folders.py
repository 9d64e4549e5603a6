"""The folder of the project to which a file or folder belongs."""

import os
from pathlib import Path

#: The most files and folders that are looked at around a file, which takes some 20 ms. In larger
#: backups the names of the folders still show where the controller's begin.
_MOST = 3_000


def project_root(path: Path) -> Path:
    """Return the folder around all that a file or the files in a folder see.

    `grammar.semantics.project_grouping` says what this is. It is the folder itself if nothing in it
    belongs to what lies around it, and an archive for what is in it. It is relative if ``path`` is.
    """
    from grammar.semantics.project_grouping import projects_of
    from support.files.archives import is_archive
    from support.files.discovery import archive_around, files_around, printable

    archive = archive_around(path)
    if archive or is_archive(path.name):
        return archive or path
    place = path.resolve()
    folder = place if place.is_dir() else place.parent
    shown = f"{printable(place.as_posix())}/"
    level = folder.as_posix().rstrip("/").count("/")
    steps = (
        level - root.count("/")
        for root, _, members in projects_of(files_around(folder, _MOST))
        if any(f"{one.path}/".startswith(shown) for one in members)
    )
    up = max(steps, default=0)
    return _as_given(folder.parents[up - 1] if up > 0 else folder, path)


def _as_given(root: Path, path: Path) -> Path:
    """Return a folder around a path; relative if the path is."""
    if root == path.resolve():
        return path
    is_near = not path.is_absolute() and root.drive == Path.cwd().drive
    return Path(os.path.relpath(root)) if is_near else root
