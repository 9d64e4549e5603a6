"""Entry points of the conformance suite: `krl conform`, `krl fuzz`, `krl nightly`."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import REPOSITORY, Entry, Given, krl, put

NIGHT = {
    "date": "2026-01-01",
    "steps": {"fuzz": {"status": "ok", "seconds": 1.5, "page": ""}},
    "recover": {"files": 3, "parsed": 2, "clusters": {"c-1": "WEAVE"}},
    "growth": {"steps": 3, "files": 3, "parsed": 3},
    "conform": {"verdicts": {"pass": 3}, "seconds": 1.0, "cases": {"a/b": "pass 00000000"}},
    "fuzz": {"programs": 3, "seed": 1, "divergences": 0},
    "bench": {"vm.ratio": 1.5},
}
EVENT = {"kind": "motion_end", "t": 12_000, "motion": 1, "at": "a.src:2"}
CASE = {"name": "a/b", "verdict": "pass", "results": [{"executor": "vm", "events": [EVENT]}]}
STEPS = {
    "fuzz": {"programs": 3, "seed": 1, "divergences": 0},
    "conform": {"verdicts": {"pass": 3}, "cases": [CASE], "coverage": {"hard": 3}},
    "recover": {"files": 3, "parsed": 2, "clusters": [{"id": "c-1", "title": "WEAVE"}]},
    "bench-vm": {"ratio": 1.25},
}


def conformance_case(folder: Path, foundry: Foundry) -> Given:
    """A case, damaged."""
    cases = sorted((REPOSITORY / "conformance" / "cases" / "control").glob("*.src"))
    text = foundry.chance.choice(cases).read_text(encoding="utf-8")
    file = put(folder, "control/case.src", foundry.text(text))
    return krl("conform", "--executor", "tree", "--robot", "none", "--jobs", "1", file)


def recording(folder: Path, foundry: Foundry) -> Given:
    """A recording of some cases."""
    cases = [
        {
            "case": name,
            "digest": digest,
            "ending": "end",
            "watched": ["out", "message"],
            "events": [EVENT, {"kind": "out", "t": 5, "signal": "$OUT[1]", "value": True}],
            "path": {"t": [0, 12_000], "axes": [[0.0] * 6] * 2, "points": [[1.0] * 6] * 2},
        }
        for name, digest in foundry.chance.sample(_cases(), 3)
    ]
    whole = {"format": "krl-recording/1", "controller": {"name": "X", "release": "8"}}
    record = foundry.record({**whole, "cycle": 12_000, "cases": cases})
    return krl("conform", "import", put(folder, "r.json", record), "--json", folder / "out.json")


@cache
def _cases() -> list[tuple[str, str]]:
    """The names of all cases, with their digests."""
    from conformance.suite.case import find_cases

    return [(case.name, case.digest) for case in find_cases()]


def night(folder: Path, foundry: Foundry) -> Given:
    """Records of an earlier nightly run, and a history, both damaged."""
    for name, record in STEPS.items():
        put(folder / "out" / "2026-01-02", f"{name}.json", foundry.record(record))
    put(folder / "out" / "2026-01-01", "conform.json", foundry.record(STEPS["conform"]))
    lines = [foundry.record(NIGHT) for _ in range(3)]
    history = put(folder, "h.jsonl", b"\n".join(lines))
    given = ("--date", "2026-01-02", "--out", folder / "out", "--history", history)
    return krl("nightly", *given, *(word for name in STEPS for word in ("--only", name)))


def fuzzed(folder: Path, foundry: Foundry) -> Given:
    """Options of the fuzzer, and numbers that are none of theirs."""
    foundry.note("strange words on the command line")
    numbers = ["1", "2", "0", "-1", "x", "9" * 30, "1e3", "\u0663", ""]
    options = ["--programs", foundry.chance.choice(["1", "1", "1", "2", "0", "-1", "x"])]
    for option in ("--seed", "--jobs", "--executor", "--json"):
        if foundry.chance.random() < 0.3:
            words = [*numbers, "tree", "vm", "\x1b[31m", str(folder)]
            if option == "--jobs":
                words = ["1", "0", "-1", "x", ""]
            if option == "--json":
                words = [str(folder), str(folder / "o.json"), str(folder / "\x1b[31m" / "o.json")]
            options += [option, foundry.chance.choice(words)]
    return krl("fuzz", *options)


ENTRIES = {
    "conform": Entry(9, "a conformance case", conformance_case),
    "conform import": Entry(14, "a recording of a real controller", recording),
    "nightly": Entry(50, "records of a nightly run, and the history of all", night),
    "fuzz": Entry(10, "options", fuzzed),
}
