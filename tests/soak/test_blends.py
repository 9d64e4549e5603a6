"""Blends keep their laws on thousands of programs, other ones each time (`make blends`)."""

from __future__ import annotations

import os
import secrets

import pytest

from interp.bench.blends import measure

pytestmark = pytest.mark.soak

PROGRAMS = int(os.environ.get("KRL_BLENDS_PROGRAMS", "2000"))
SEED = int(os.environ.get("KRL_BLENDS_SEED", secrets.randbelow(1_000_000_000)))


def test_no_law_is_broken() -> None:
    """Each law that is broken is told with how often, and the seed of the worst program."""
    record = measure(PROGRAMS, SEED)
    laws = record["laws"].items()
    broken = {name: (law["broken"], law["seed"]) for name, law in laws if law["broken"]}
    print(f"{PROGRAMS:,} programs from seed {SEED}, {record['refused']:,} refused")
    assert {} == broken
