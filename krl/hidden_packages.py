"""Whether another project hides a package of ours; imports nothing that may be hidden."""

from importlib.util import find_spec
from pathlib import Path

_OURS = ("conformance", "grammar", "interp", "recovery", "reports", "support")


def hiding_package() -> str | None:
    """What to say, in one line, where another package hides one of ours: the names are common."""
    home = Path(__file__).parents[1]
    for name in _OURS:
        spec = find_spec(name)
        found = Path((spec and spec.origin) or "nowhere").parent
        if found != home / name:
            message = (
                f"{name} should be {home / name} and is {found}, of another project: install "
                "krl-workbench into a separate environment, as `uv tool` and pipx do"
            )
            return "".join(sign if sign.isprintable() else "?" for sign in message)
    return None
