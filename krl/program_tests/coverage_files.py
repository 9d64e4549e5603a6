"""Coverage of tests joined with the texts of the programs, for the page and for lcov."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from interp.testing.coverage import CoverageRecord, coverage_of
from reports.programs.coverage_page import CoveredFile
from support.files.decode import decode
from support.files.untrusted import read_bytes


def covered_files(records: Sequence[CoverageRecord]) -> list[CoveredFile]:
    """Return the files with statements; paths below the working folder are relative."""
    files = []
    for path, one in coverage_of(records).items():
        if one["lines"]:
            files.append(CoveredFile(_shown(path), _text(Path(path)), **one))
    return files


def _shown(path: str) -> str:
    file = Path(path).resolve()
    here = Path.cwd()
    return (file.relative_to(here) if file.is_relative_to(here) else file).as_posix()


def _text(path: Path) -> str:
    """Return the text of a file; empty if it cannot be read any more."""
    try:
        found = decode(read_bytes(path))
    except OSError:
        return ""
    return "" if isinstance(found, str) else found.text
