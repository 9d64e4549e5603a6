"""Files that a module generates from others: they are written, or compared with what is there."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from support.files.atomic_write import write_atomic


def stale(files: Mapping[Path, str]) -> list[str]:
    """Return the names of those that are missing or have another text."""
    return [
        file.name
        for file, text in files.items()
        if not file.is_file() or file.read_text(encoding="utf-8") != text
    ]


def main(module: str, files: Callable[[], Mapping[Path, str]]) -> int:
    """Do what the command line of a module asks, and return the status: 1 if a file is stale."""
    parser = argparse.ArgumentParser(prog=f"python -m {module}")
    chosen = parser.add_mutually_exclusive_group(required=True)
    chosen.add_argument("--write", action="store_true", help="write the generated files")
    chosen.add_argument("--check", action="store_true", help="say which of them are stale")
    if parser.parse_args().write:
        for file, text in files().items():
            write_atomic(file, text)
        return 0
    for name in (names := stale(files())):
        sys.stderr.write(f"{name} is stale: python -m {module} --write\n")
    return 1 if names else 0
