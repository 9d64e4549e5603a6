"""Reading small untrusted files: without blocking, with limits on size and depth.

It is used for grammars, constructs, profiles, scripts and recordings; KRL files are read by
`support.files.discovery`.
"""

from __future__ import annotations

import errno
import io
import json
import math
import os
import stat
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

#: Documents that people write are far smaller; recordings may have some MB.
MOST_BYTES: Final = 64 << 20
# `tomllib` needs seconds for a dotted key of thousands of parts, and minutes for tens of thousands.
MOST_DOTS: Final = 100
MOST_TOML: Final = 1_000_000


class DocumentError(ValueError):
    """A text that is not TOML or JSON, or too deeply nested; the message is one line."""


def open_file(file: Path) -> io.FileIO:
    """Open a regular file for reading; raises OSError, also for folders, pipes and devices.

    It never blocks, as opening a pipe without a writer would.
    """
    flags = os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NONBLOCK", 0)
    opened = os.open(file, flags)
    mode = os.fstat(opened).st_mode
    if not stat.S_ISREG(mode):
        os.close(opened)
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(file))
        raise OSError(errno.EINVAL, "not a regular file", str(file))
    return io.FileIO(opened, "rb")


def read_bytes(file: Path, most: int = MOST_BYTES) -> bytes:
    """Return the bytes of a regular file; raises OSError, also if there are more than ``most``."""
    with open_file(file) as opened, io.BufferedReader(opened) as stream:
        data = stream.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"larger than {most >> 20} MB", str(file))
    return data


def read_text(file: Path, encoding: str = "utf-8") -> str:
    """Return the text of a regular file, with line feeds as line ends.

    Raises OSError and UnicodeDecodeError.
    """
    return read_bytes(file).decode(encoding).replace("\r\n", "\n").replace("\r", "\n")


def toml_of(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text; raises `DocumentError`."""
    if len(text) > MOST_TOML:
        raise DocumentError(f"TOML is too long: more than {MOST_TOML:,} characters")
    for number, line in enumerate(text.splitlines(), 1):
        if line.count(".") > MOST_DOTS:
            raise DocumentError(f"TOML has more than {MOST_DOTS} dots in line {number}")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise DocumentError("not TOML: nested too deeply") from None
    except ValueError as error:  # also an integer of thousands of digits
        raise DocumentError(f"not TOML: {error}") from None


def json_of(text: str, number: Callable[[str], object] | None = None) -> object:
    """Return the value of a JSON text; raises `DocumentError`.

    ``number`` reads numbers with a fraction and constants such as Infinity; without it they must be
    finite.
    """
    read = number or _finite
    try:
        value: object = json.loads(text, parse_float=read, parse_constant=read)
    except RecursionError:
        raise DocumentError("not JSON: nested too deeply") from None
    except ValueError as error:
        raise DocumentError(f"not JSON: {error}") from None
    return value


def _finite(written: str) -> float:
    value = float(written)
    if not math.isfinite(value):
        raise ValueError(f"{written[:20]} is no finite number")
    return value
