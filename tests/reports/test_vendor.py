"""Libraries that pages hold inside: they are what they say they are."""

import hashlib
import json
from pathlib import Path

VENDOR = Path(__file__).parents[2] / "reports" / "templates" / "vendor"


def test_libraries_have_the_checksums_of_their_releases() -> None:
    """Nobody has changed a byte, be it by an editor or by the line ends of a checkout."""
    lines = (VENDOR / "SHA256SUMS").read_text("utf-8").splitlines()
    listed = {name: checksum for checksum, name in (line.split() for line in lines)}
    found = {
        file.name: hashlib.sha256(file.read_bytes()).hexdigest()
        for file in VENDOR.iterdir()
        if ".min." in file.name or file.suffix == ".LICENSE"
    }
    assert listed == found


def test_libraries_are_of_the_releases_that_are_pinned() -> None:
    """Version and licence stand in the files, and are those of the lock file."""
    pinned = json.loads((VENDOR / "package-lock.json").read_text("utf-8"))["packages"]
    three, uplot = (pinned[f"node_modules/{name}"] for name in ("three", "uplot"))
    begins = {
        name: (VENDOR / name).read_text("utf-8")[:200]
        for name in ("three.min.js", "uPlot.iife.min.js")
    }
    assert f"three.js {three['version']}, {three['license']} licence" in begins["three.min.js"]
    assert f"(v{uplot['version']})" in begins["uPlot.iife.min.js"]
    assert "MIT" == uplot["license"]
