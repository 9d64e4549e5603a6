"""JSON and other output files of commands: checked in advance, written atomically.

Pages are written by `reports`.
"""

import json
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import chain, islice
from pathlib import Path
from typing import Any, Final

from krl.errors import InputError
from support.files.atomic_write import atomic_path

_NOT_ASCII: Final = re.compile(r"[^\n\x20-\x7e]")
#: How many pieces of the encoder, of some ten characters each, are written at once.
_AT_ONCE: Final = 10_000


def check_targets(out: Path, json_file: Path | None) -> None:
    """Raise `InputError` if ``out`` cannot be a folder or ``json_file`` cannot be a file."""
    if out.exists() and not out.is_dir():
        raise InputError(f"{out}: not a folder")
    check_files(json_file)


def check_files(*targets: Path | None) -> None:
    """Raise `InputError` if a target cannot be a file: it is a folder, or below a file."""
    for target in targets:
        if target is None:
            continue
        if target == Path("-"):
            raise InputError("-: output cannot go to standard output; name a file")
        if target.is_dir():
            raise InputError(f"{target}: a folder, not a file")
        above = next((folder for folder in target.parents if folder.exists()), None)
        if above is not None and not above.is_dir():
            raise InputError(f"{target}: {above} is not a folder")


def write_json(record: Mapping[str, Any], target: Path | None, indent: int | None = None) -> None:
    """Write ``record`` if there is a target; on one line, or indented by ``indent``."""
    if target is None:
        return
    write_pieces(target, chain(json_pieces(record, indent), "\n"))


def json_pieces(record: Any, indent: int | None = None) -> Iterator[str]:
    """Yield the record as JSON with unprintable characters escaped.

    It comes in pieces, so that the text of a large record is never held as a whole.
    """
    encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False, indent=indent)
    pieces = _compact(encoder, record) if indent is None else encoder.iterencode(record)
    while piece := "".join(islice(pieces, _AT_ONCE)):
        yield _NOT_ASCII.sub(_escaped, piece)


def _compact(encoder: json.JSONEncoder, record: Any) -> Iterator[str]:
    """Yield what ``encoder.encode`` returns, each item of a field by itself.

    `JSONEncoder.iterencode` yields smaller pieces and takes ten times as long.
    """
    if not isinstance(record, dict):
        yield encoder.encode(record)
        return
    before = "{"
    for key, value in record.items():
        yield f"{before}{encoder.encode(key)}: "
        before = ", "
        if isinstance(value, Collection) and not isinstance(value, str | Mapping):
            opening = "["
            for item in value:
                yield opening + encoder.encode(item)
                opening = ", "
            yield "[]" if opening == "[" else "]"
        else:
            yield encoder.encode(value)
    yield "{}" if before == "{" else "}"


def json_list_pieces(records: Iterable[Any]) -> Iterator[str]:
    """Yield what `json_pieces` gives for a list of records with an indent of 1, one by one."""
    before = "[\n "
    for record in records:
        yield from (before, *(piece.replace("\n", "\n ") for piece in json_pieces(record, 1)))
        before = ",\n "
    yield "[]" if before.startswith("[") else "\n]"


def write_pieces(target: Path, pieces: Iterable[str]) -> None:
    """Write a text that comes in pieces as UTF-8, atomically."""
    with atomic_path(target) as part, part.open("w", encoding="utf-8", newline="") as file:
        file.writelines(pieces)


def _escaped(found: re.Match[str]) -> str:
    char = found[0]
    return char if char.isprintable() else json.dumps(char)[1:-1].replace("\x7f", "\\u007f")
