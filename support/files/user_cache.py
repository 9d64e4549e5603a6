"""The user's cache folder."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def user_cache() -> Path | None:
    """Return the cache folder of this user, which need not exist; ``None`` if there can be none."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA")
        return Path(base, "krl", "cache") if base else None
    if base := os.environ.get("XDG_CACHE_HOME"):
        return Path(base, "krl")
    try:
        home = Path.home()
    except RuntimeError:  # a user without a home
        return None
    return home / "Library" / "Caches" / "krl" if sys.platform == "darwin" else home / ".cache/krl"
