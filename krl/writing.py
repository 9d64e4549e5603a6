"""Where a command's record goes: checked before the work, written whole or not at all."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from krl.door import Unusable

__all__ = ["check_targets", "write_json"]


def check_targets(out: Path, json_file: Path | None) -> None:
    """Raise `Unusable` where the folder is no folder or the file is one."""
    if out.exists() and not out.is_dir():
        raise Unusable(f"{out}: not a folder")
    if json_file is not None and json_file.is_dir():
        raise Unusable(f"{json_file}: a folder, not a file")


def write_json(record: Mapping[str, Any], target: Path, indent: int | None = None) -> None:
    """Write ``record`` whole or not at all, on one line or with so many blanks a level."""
    target.parent.mkdir(parents=True, exist_ok=True)
    scratch = target.with_name(target.name + ".part")
    # half of a character, which names of files may hold, is an escape of JSON then
    with scratch.open("w", encoding="utf-8", newline="\n", errors="backslashreplace") as stream:
        text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=indent)
        stream.write(text + "\n")
    scratch.replace(target)
