"""Cases of feature interactions in ``cases/interaction/``: pairwise testing of features.

A case has one value for each feature: the path of the motion, what an interrupt or the operator
does and when, what is triggered on the path, what follows the motion, and so on.
``interactions.toml`` has the values with their statements, ``interactions.krl.j2`` the routines
around them. Expectations follow from the values, each by the rule that it cites. The rows are a
covering array of strength two (every pair of values occurs), constructed greedily. Run ``python -m
conformance.suite.interactions`` after a change; a test fails if the cases are stale.

`drawn` generates further cases from a seed, with more values of each feature. They are not stored
and expect nothing specific: all executors must behave the same, and no law may be violated.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from itertools import combinations, product
from pathlib import Path
from random import Random
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Any, Final

from conformance.suite.case import CASES, Case, find_cases
from conformance.suite.templates import template

FOLDER: Final = CASES / "interaction"
_HERE: Final = Path(__file__).parent
#: An arm with external axes.
_MACHINE: Final = CASES / "motion" / "$machine.dat"
Row = Mapping[str, str]

_STATEMENTS: Final[Mapping[str, Any]] = tomllib.loads(
    (_HERE / "interactions.toml").read_text(encoding="utf-8")
)
FEATURES: Final[Mapping[str, tuple[str, ...]]] = {
    name: tuple(values) for name, values in _STATEMENTS["features"].items()
}
#: Paths on which a place can be given in mm.
_CP: Final = ("lin", "spline", "rel")
#: Paths to which only recollection lets a trigger with DISTANCE refer.
_SPLINES: Final = ("spline", "spline_blend", "ptp_spline", "slin", "scirc")
_BESIDE: Final = (
    "DEF BESIDE()\n  LOOP\n    IF $OUT[1] THEN\n"
    "      $OUT[40] = TRUE ;> out 40 TRUE after out 1 [SUB-03.b]\n    ENDIF\n"
    "    WAIT SEC 0.024\n  ENDLOOP\nEND\n"
)
#: What only a stored case has in its front matter.
_OWN: Final = (";@ rule", ";@ title", ";@ unconfirmed")
#: What stops the arm on its path, and the rule by which it keeps to it.
_STOPS: Final = {"brake": "INT-09.b", "brake_hard": "INT-09.b", "operator": "CTL-08.b"}
_STOPPED: Final = re.compile(r"(;> pa(?:th|sses) .*)\[.*\]")
#: The rule of the last expectation of each case.
_FIRST: Final = "MOT-20"
_SPEED: Final = "  $VEL.CP = "
_RULE: Final = re.compile(r"\[(.{3}-.{2})")


def covering(features: Mapping[str, tuple[str, ...]]) -> list[dict[str, str]]:
    """Return rows in which every pair of values of two features occurs at least once."""
    names = list(features)
    missing = {
        frozenset(((one, left), (other, right)))
        for one, other in combinations(names, 2)
        for left, right in product(features[one], features[other])
    }
    rows: list[dict[str, str]] = []
    while missing:
        row = dict(min(missing, key=sorted))  # start with a missing pair, then add greedily
        for name in names:
            if name not in row:
                row[name] = max(
                    features[name],
                    key=lambda value, name=name: sum(  # type: ignore[misc]
                        frozenset(((name, value), each)) in missing for each in row.items()
                    ),
                )
        missing -= {frozenset(pair) for pair in combinations(row.items(), 2)}
        rows.append({name: row[name] for name in names})
    return rows


def cases() -> Iterator[tuple[str, str]]:
    """Yield the names and contents of all files."""
    for number, row in enumerate(covering(FEATURES), 1):
        name = f"pair_{number:03}"
        yield f"{name}.src", "\n".join([*_front(row), *_main(name, row), ""])
    yield "beside.sub", _BESIDE
    yield "$machine.dat", _MACHINE.read_text(encoding="utf-8")


def drawn(seed: int) -> list[Case]:
    """Return cases that cover all pairs of values; the seed determines the combinations."""
    chance, more = Random(f"interactions {seed}"), _STATEMENTS["more"]
    every = {name: (*values, *more.get(name, ())) for name, values in FEATURES.items()}
    features = {
        name: tuple(chance.sample(every[name], len(every[name])))
        for name in chance.sample(list(every), len(every))
    }
    rows = covering(features)
    for row in rows:
        if row["act"] == "resume" and row["when"] == "0.7":
            row["when"] = "0.05"  # after 0.7 s the motion may be over, and RESUME a fault
    with TemporaryDirectory() as place:
        folder = Path(place, "pairs")
        folder.mkdir()
        (folder / "beside.sub").write_text(_BESIDE, encoding="utf-8")
        copyfile(_MACHINE, folder / _MACHINE.name)
        for number, row in enumerate(rows, 1):
            name = f"drawn_{number:03}"
            head = [one for one in _front(row) if not one.startswith(_OWN)]
            body = [_bare(one) for one in _main(name, row)]
            speed = next(at for at, one in enumerate(body) if one.startswith(_SPEED))
            body[speed] += f" ;> runs 1 [{_FIRST}]"
            title = ", ".join(f"{name} {row[name]}" for name in sorted(row))
            lines = [f";@ rule: {_FIRST}", f";@ title: {title}", *head, *filter(None, body), ""]
            (folder / f"{name}.src").write_text("\n".join(lines), encoding="utf-8", newline="\n")
        return find_cases(Path(place))


def _front(row: Row) -> Iterator[str]:
    lines = [*_main("", row), *(["[SUB-03.b]"] if row["beside"] == "submit" else [])]
    cited = sorted({rule for text in lines for rule in _RULE.findall(text)})
    yield f";@ rule: {', '.join([_FIRST, *(one for one in cited if one != _FIRST)])}"
    parts = (row["trigger"], "trigger"), (row["behind"], "behind"), (row["beside"], "too")
    words = ", ".join(f"{value} {what}" for value, what in parts if value != "none")
    words = f"{row['path']}, {row['act']} at {row['when']} s; {words or 'nothing else'}; "
    words += f"{row['override']} %, {row['advance']} ahead"
    yield f";@ title: {words}".replace("_", " ")
    yield ";@ phase: run"
    yield ";@ robot: kinematic"
    if row["path"] in _SPLINES:
        yield ";@ unconfirmed: whether DISTANCE refers to spline motions is not published"
    act = "press STOP" if row["act"] == "operator" else "IN[1]=TRUE"
    yield f";@ io: on OUT[1]=TRUE after {row['when']} {act}"
    if row["act"] == "operator":
        yield f";@ io: on OUT[1]=TRUE after {float(row['when']) + 1:g} press START"
    if row["act"] == "dialogue":
        yield f";@ io: on OUT[1]=TRUE after {float(row['when']) + 0.3:g} answer 2"
    if row["act"] == "halt":
        yield ";@ io: on HALT after 0.5 press START"
    beside = ["beside.sub"] if row["beside"] == "submit" else []
    if row["path"] == "external_blend":
        beside.insert(0, "$machine.dat")
    if beside:
        yield f";@ with: {', '.join(beside)}"


def _main(name: str, row: Row) -> list[str]:
    """Return the lines of the routines of a case."""
    is_left = row["act"].startswith("resume")
    blends = row["path"].endswith("_blend")
    doubt = "TRG-10.e" if row["path"] in _SPLINES else ""
    motions, behind = (_STATEMENTS[what][row[what]].splitlines() for what in ("path", "behind"))
    if is_left:
        motions = [_bare(text) for text in motions if not text.startswith(";")]
        behind = [_bare(text) for text in behind if not text.startswith(";")]
    else:
        last = "3" if blends else "2"
        behind = [text.replace("LAST", last) for text in behind]
        if row["act"] == "halt":  # it halts for half a second, and the arm continues
            behind = [
                text.replace(" at end", " after end").replace(f" before end {last}", "")
                for text in behind
            ]
        if row["act"] in _STOPS:  # how it stops and goes on is less certain than its path
            motions = [_STOPPED.sub(rf"\1[{_STOPS[row['act']]}]", text) for text in motions]
    return (
        template("interactions.krl.j2")
        .render(
            row,
            name=name,
            is_left=is_left,
            is_cp=row["path"] in _CP,
            never=f"never [{_never(row)}]",
            never_there=f"never [{doubt or _never(row)}]",
            start=doubt or "TRG-01",
            call=doubt or "TRG-05",
            moment=f"apex 2 [{doubt or 'TRG-02'}]" if blends else f"end 2 [{doubt or 'TRG-01'}]",
            motions=motions,
            after=behind,
            statements=_STATEMENTS,
        )
        .splitlines()
    )


def _never(row: Row) -> str:
    """Return the rule by which the end of the motion that is left is not reached."""
    if row["act"] == "resume_deep":
        return "INT-08.b"
    return "INT-12" if row["when"] == min(FEATURES["when"]) else "INT-18"


def _bare(text: str) -> str:
    """Return a statement without its expectations."""
    return text.partition(";>")[0].rstrip()


def _write() -> None:
    FOLDER.mkdir(exist_ok=True)
    for old in FOLDER.glob("*.s*"):
        old.unlink()
    for name, text in cases():
        (FOLDER / name).write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    _write()
