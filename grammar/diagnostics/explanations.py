"""Full explanation of a code: its sentences, a wrong program, and the corrected one.

``codes.tsv`` has the sentences, as every check needs them; ``examples.toml`` the programs, which
only an explanation needs. An example is one file or several: each begins with a line
``-- NAME --``, which one alone may lack: it is ``work.src`` or ``work.dat`` then. A test checks
every example, so that ``wrong`` has a finding of the code and ``right`` has none.
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
    """A code, and what helps to understand it.

    ``wrong`` and ``right`` are programs, empty where none can show it; with ``is_whole`` their
    files are all there are of a project. ``message`` is the number of the controller's own message,
    ``source`` what the rules of the code do not say.
    """

    code: DiagnosticCode
    wrong: str = ""
    right: str = ""
    message: int | None = None
    source: str = ""
    is_whole: bool = True


def explanation(name: str) -> Explanation | None:
    """The explanation of a code or slug in any letter case; ``None`` where there is no such one.

    The number of a message of the controller is enough.
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
