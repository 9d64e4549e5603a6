"""Output files of commands: checked before the work, written whole or not at all."""

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from krl.errors import InputError
from support.files.atomic_write import write_atomic

_NOT_ASCII: Final = re.compile(r"[^\n\x20-\x7e]")


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
    write_atomic(target, json_text(record, indent) + "\n")


def json_text(record: Any, indent: int | None = None) -> str:
    """The record as JSON that steers no terminal: what is not printable is escaped."""
    text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=indent)
    return _NOT_ASCII.sub(_escaped, text)


def _escaped(found: re.Match[str]) -> str:
    char = found[0]
    return char if char.isprintable() else json.dumps(char)[1:-1].replace("\x7f", "\\u007f")
