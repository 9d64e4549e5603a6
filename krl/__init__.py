"""The KRL workbench: the command `krl`, and `check`, `run`, `recover` and `load_backup`.

The functions are imported on first use, so that the command starts quickly.
"""

from typing import TYPE_CHECKING, Any

from krl.hidden_packages import hiding_package

if TYPE_CHECKING:
    from krl.library import check, load_backup, recover, run

__all__ = ["check", "load_backup", "recover", "run"]


def __getattr__(name: str) -> Any:
    """Return a function of `krl.library`, imported on first use."""
    if name not in __all__:
        raise AttributeError(f"module 'krl' has no attribute {name!r}")
    if hiding := hiding_package():
        raise ImportError(hiding)
    from krl import library

    return getattr(library, name)
