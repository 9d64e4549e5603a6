"""Where a command writes: checked before the work, written whole or not at all."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from krl.errors import InputError
from support.files.atomic_write import write_atomic

__all__ = ["check_files", "check_targets", "write_json"]


def check_targets(out: Path, json_file: Path | None) -> None:
    """Raise `InputError` where the folder is no folder or the file cannot be one."""
    if out.exists() and not out.is_dir():
        raise InputError(f"{out}: not a folder")
    check_files(json_file)


def check_files(*targets: Path | None) -> None:
    """Raise `InputError` where something cannot be a file: it is a folder, or below a file."""
    for target in targets:
        if target is None:
            continue
        if target == Path("-"):
            raise InputError("-: what is written goes to a file; name one")
        if target.is_dir():
            raise InputError(f"{target}: a folder, not a file")
        above = next((folder for folder in target.parents if folder.exists()), None)
        if above is not None and not above.is_dir():
            raise InputError(f"{target}: {above} is not a folder")


def write_json(record: Mapping[str, Any], target: Path | None, indent: int | None = None) -> None:
    """Write ``record``, if there is a target, on one line or with so many blanks a level."""
    if target is None:
        return
    text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=indent) + "\n"
    # half of a character, which names of files may hold, is an escape of JSON then
    write_atomic(target, text.encode(errors="backslashreplace"))
