"""Shared objects from C, made by the installed compiler and cached by the text and all headers."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from typing import Final

from support.files.user_cache import user_cache

_NATIVE: Final = Path(__file__).parents[1]
#: Every product and sum is rounded by itself, as by the machine (docs/adr/0013-numbers.md).
_FLAGS: Final = tuple(
    "-std=c11 -O2 -fPIC -shared -ffp-contract=off -fno-math-errno -w"
    " --param=max-inline-insns-auto=200 --param=max-inline-insns-recursive-auto=1000".split()
)
_PATIENCE: Final = 600  # limit of the compiler in seconds
_MOST_KEPT: Final = 500


def compiler() -> str | None:
    """Return the C compiler of this computer: ``CC``, or the first with a usual name."""
    names = (os.environ.get("CC", ""), "cc", "gcc", "clang")
    return next((found for name in names if name and (found := shutil.which(name))), None)


def library_of(source: str) -> Path:
    """Return the shared object of a C source, which is cached for the user.

    Raises `OSError` if there is no compiler, if it fails, or if there is no cache folder.
    """
    folder = user_cache()
    if folder is None:
        raise OSError("there is no folder to keep it in")
    folder /= "native"
    command = compiler()
    if command is None:
        raise OSError("there is no C compiler")
    key = hashlib.sha256(f"{command} {_FLAGS}\0{source}\0{_headers()}".encode()).hexdigest()
    target = folder / f"{key}.so"
    if target.is_file():
        return target
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    with tempfile.TemporaryDirectory(dir=folder) as work:
        text, made = Path(work, "program.c"), Path(work, "program.so")
        text.write_text(source, encoding="utf-8")
        called = [command, *_FLAGS, f"-I{_NATIVE}", str(text), "-o", str(made)]
        try:
            done = subprocess.run(called, capture_output=True, check=False, timeout=_PATIENCE)
        except subprocess.TimeoutExpired as error:
            raise OSError(f"{command} takes more than {_PATIENCE} s") from error
        if done.returncode:
            errors = done.stderr.decode(errors="replace").strip().splitlines()
            raise OSError(f"{command}: {errors[0] if errors else 'failed'}")
        made.replace(target)
    for old in sorted(folder.glob("*.so"), key=lambda one: one.stat().st_mtime)[:-_MOST_KEPT]:
        old.unlink(missing_ok=True)
    return target


@cache
def _headers() -> str:
    return "".join(one.read_text(encoding="utf-8") for one in sorted(_NATIVE.rglob("*.h")))
