"""Entry points of the ledger: `krl construct`."""

from __future__ import annotations

import json
import os
import tempfile
from functools import cache
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import REPOSITORY, Entry, Given, archive, krl, put
from tests.soak.kept import CONSTRUCTS, surveyed

PRELIMINARY = REPOSITORY / "grammar" / "preliminary.g4"
FORM = (
    'by = ""\nwhen = 2026-03-31\nrelease = "KSS 8"\n'
    '[[program]]\nfile = "a.src"\nconstruct = "0001-x"\nsha256 = "00"\nanswer = "accepted"\n'
)


def ledger(folder: Path, foundry: Foundry) -> Given:
    """A ledger of which a file is damaged, or with a journal that wants what it must not."""
    home, chance = _home(folder), foundry.chance
    foundry.note("damaged ledgers")
    victim = chance.choice([*sorted(home.rglob("*.toml")), *home.glob("*.g4")])
    match chance.randrange(4):
        case 0:
            strange = ["0002-\x1b[31m.toml", "0002.toml", "9999-x.toml", "-.toml"]
            victim.rename(victim.with_name(chance.choice(strange)))
        case 1:
            noted = {
                str(folder.parent / "canary"): None,
                str(home / ".." / ".." / "canary"): None,
                str(home / "KRL.g4"): "00",
            }
            put(home, "constructs/.unfinished.json", foundry.record(noted))
        case _:
            victim.write_bytes(foundry.text(victim.read_text(encoding="utf-8")))
    wanted = [("list",), ("show", "1"), ("replay", "--check"), ("replay", "--out", "x.g4")]
    return krl("construct", *chance.choice(wanted))


def _home(folder: Path) -> Path:
    """A grammar with a short ledger in the folder, which becomes the current one."""
    home = folder / "grammar"
    for file in CONSTRUCTS[:4]:
        put(home, f"constructs/{file.name}", file.read_bytes())
    put(home, "preliminary.g4", PRELIMINARY.read_bytes())
    put(home, "KRL.g4", _replayed().encode())
    os.chdir(folder)
    return home


@cache
def _replayed() -> str:
    """The grammar of the short ledger."""
    from recovery.ledger.construct_file import read
    from recovery.ledger.ledger import in_force, preliminary_of

    return in_force(preliminary_of(PRELIMINARY), [read(file) for file in CONSTRUCTS[:4]]).text


def weighed(folder: Path, foundry: Foundry) -> Given:
    """A construct that somebody sent, weighed on other people's programs."""
    more = ("--keep",) if foundry.chance.random() < 0.2 else ()
    return krl("construct", "try", *_sent(folder, foundry), *more)


def accepted(folder: Path, foundry: Foundry) -> Given:
    """A construct that somebody sent, accepted if there is no objection."""
    return krl("construct", "accept", *_sent(folder, foundry))


def _sent(folder: Path, foundry: Foundry) -> tuple[str | Path, ...]:
    """Files of constructs from elsewhere, damaged, and the corpus that they are weighed on."""
    _home(folder)
    chance = foundry.chance
    put(folder / "corpus" / "programs", "a.src", foundry.runnable())
    later = [file.read_text(encoding="utf-8") for file in CONSTRUCTS[3:5]]
    sent: list[str | Path] = []
    for number in range(chance.choice([1, 1, 1, 2])):
        text = chance.choice([*later, _proposal(json.dumps(surveyed(folder)))])
        intact = chance.random() < 0.1  # what comes behind reading is hostile too
        data = text.encode() if intact else foundry.text(text)
        sent.append(put(folder, f"c{number}.toml", data))
    match chance.randrange(4):
        case 0:
            sent += ["--corpus", archive(folder, foundry)]
        case 1:
            sent += ["--corpus", put(folder, "b.src", foundry.program())]
    return (*sent, "--jobs", "1")


@cache
def _proposal(record: str) -> str:
    """The text of a construct that a survey proposes."""
    from recovery.ledger.draft import propose as write

    known = json.loads(record)
    with tempfile.TemporaryDirectory() as folder:
        return write(known, known["clusters"][0]["id"], 1, Path(folder)).read_text(encoding="utf-8")


def propose(folder: Path, foundry: Foundry) -> Given:
    """A proposal taken from a survey that somebody changed."""
    survey = surveyed(folder)
    cluster = survey["clusters"][0]
    record = {**survey, "clusters": [cluster], "failures": [], "origins": []}
    file = put(folder, "survey.json", foundry.record(record))
    return krl("construct", "propose", cluster["id"], "--survey", file, "--out", folder / "out")


def oracle(folder: Path, foundry: Foundry) -> Given:
    """A form of verdicts, filled by somebody."""
    return krl("construct", "oracle", "--record", put(folder, "v.toml", foundry.text(FORM)))


ENTRIES = {
    "ledger": Entry(50, "constructs, grammar and journal of an acceptance", ledger),
    "construct try": Entry(15, "constructs that somebody proposes, and a corpus", weighed),
    "construct accept": Entry(15, "the same, accepted where there is no objection", accepted),
    "construct oracle": Entry(40, "a form with verdicts of a controller", oracle),
    "construct propose": Entry(35, "a survey that somebody changed", propose),
}
