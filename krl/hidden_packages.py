"""Whether another project hides one of our packages; imports nothing that could be hidden."""

from importlib.util import find_spec
from pathlib import Path

_OURS = ("conformance", "grammar", "interp", "recovery", "reports", "support")


def hiding_package() -> str | None:
    """Return a message if another package hides one of ours, whose names are common; else None."""
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
