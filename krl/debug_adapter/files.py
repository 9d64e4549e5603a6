"""Paths of program files: those of the client and those within the project."""

from pathlib import Path

from interp.program.load import CheckedProgram, Unit
from krl.debug_adapter.connection import Json
from krl.running.project_folders import project_root


class ProgramFiles:
    """The files of a program that started with ``file``, in its project or in an archive."""

    def __init__(self, file: Path, program: CheckedProgram) -> None:
        root = project_root(file)
        self._root = root if root.is_dir() else Path()
        self._units: list[Unit] = list(program.units.values())

    def named(self, path: str) -> str:
        """Return the path of a file within the project, from the client's."""
        wanted = path.replace("\\", "/").upper()
        owns = [unit.module.path for unit in self._units]
        for own in owns:
            if wanted in ((self._root / own).as_posix().upper(), own.upper()):
                return own
        resolved = Path(path).resolve().as_posix().upper()
        same = (own for own in owns if (self._root / own).resolve().as_posix().upper() == resolved)
        return next(same, path)

    def source(self, path: str) -> Json:
        """Return a file as a source of the protocol; by a number if it is not on disk."""
        place = self._root / path
        name = path.rpartition("/")[2]
        if place.is_file():
            return {"name": name, "path": str(place)}
        found = [number for number, one in enumerate(self._units, 1) if one.module.path == path]
        return {"name": name, "path": path, "sourceReference": found[0] if found else 0}

    def text(self, reference: int) -> str | None:
        """Return the text of a file by its number, or ``None``."""
        is_known = 1 <= reference <= len(self._units)
        return self._units[reference - 1].source.text if is_known else None
