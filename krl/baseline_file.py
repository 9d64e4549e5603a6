"""The file of a baseline of findings: how it is read, and the paths that it has for files."""

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from krl.errors import InputError

if TYPE_CHECKING:
    from grammar.diagnostics.baseline import Baseline


def read_baseline(file: Path) -> "Baseline":
    """Return the baseline in a file; raises `InputError`."""
    from grammar.diagnostics.baseline import Baseline
    from support.files.untrusted import json_of, read_text

    try:
        return Baseline.read(json_of(read_text(file)))
    except OSError as error:
        hint = f": make it with --write-baseline {file}" if not file.exists() else ""
        raise InputError(f"{file}: {error.strerror or error}{hint}") from None
    except ValueError as error:
        raise InputError(f"{file}: {error}") from None


def baseline_place(baseline: Path) -> Callable[[str], str]:
    """Return a function that makes paths relative to a baseline, whatever the working folder is.

    On Windows, a path on another drive stays absolute.
    """
    home = baseline.absolute().parent

    def place(path: str) -> str:
        whole = Path(path).absolute()
        with suppress(ValueError):
            whole = Path(os.path.relpath(whole, home))
        return whole.as_posix()

    return place
