"""Kernels for `interp.bench.executor_speed`: small programs in KRL and in other languages.

A kernel is a file ``NAME.src`` with a function ``DEFFCT INT WORK(N:IN)``, whose result shows
whether the work was done right. Beside it lie what does the same: ``NAME.lua``, a chunk that
returns a function; ``NAME.py`` with a function ``work``; ``NAME.c`` with ``int work(int n)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

#: The kernels of this project.
HERE = Path(__file__).parent


@dataclass(frozen=True, slots=True)
class Kernel:
    """A kernel: its name, its file in KRL."""

    name: str
    file: Path

    @property
    def krl(self) -> str:
        """The source in KRL, as ISO 8859-1 where it is no UTF-8."""
        data = self.file.read_bytes()
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError:
            return data.decode("latin-1")

    def beside(self, ending: str) -> Path | None:
        """Return the same in another language, if it is there."""
        file = self.file.with_suffix(ending)
        return file if file.is_file() else None


def kernels_in(folder: Path = HERE) -> dict[str, Kernel]:
    """All kernels of a folder by name, in the order of the alphabet."""
    files = sorted(file for file in folder.iterdir() if file.suffix.lower() == ".src")
    return {file.stem: Kernel(file.stem, file) for file in files}
