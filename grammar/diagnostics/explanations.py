"""The full explanation of a code: sentences, a wrong program, and the corrected one.

The sentences are in ``codes.tsv``, which every check loads; the programs are in ``examples.toml``,
which only an explanation loads. An example is one file or several, each after a line ``-- NAME
--``. A single file may lack that line; its name is then ``work.src`` or ``work.dat``. A test checks
that ``wrong`` has a finding of the code and ``right`` has none.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from grammar.diagnostics.codes import DiagnosticCode, by_code, by_slug


@dataclass(frozen=True, slots=True)
class Explanation:
    """A code with its examples.

    ``wrong`` and ``right`` are programs, empty if no program can show it; ``is_whole`` says that
    their files are the complete project. ``message`` is the number of the controller's own message,
    and ``source`` is the evidence besides the rules of the code.
    """

    code: DiagnosticCode
    wrong: str = ""
    right: str = ""
    message: int | None = None
    source: str = ""
    is_whole: bool = True


def explanation(name: str) -> Explanation | None:
    """Return the explanation of a code or slug in any letter case, or ``None`` if it is unknown.

    A message number of the controller is accepted as well.
    """
    code = f"KSS{name}" if name.isdecimal() else name.upper()
    entry = by_code().get(code) or by_slug().get(name.lower())
    if entry is None:
        return None
    known = _examples().get(entry.code, {})
    number = entry.code.removeprefix("KSS")
    message = int(number) if number.isdecimal() else known.get("message")
    return Explanation(
        entry,
        known.get("wrong", ""),
        known.get("right", ""),
        message,
        known.get("source", ""),
        not known.get("missing", False),
    )


@cache
def _examples() -> Mapping[str, Mapping[str, Any]]:
    text = resources.files(__package__).joinpath("examples.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)
