"""Entry points that measure: `krl bench`."""

from __future__ import annotations

import os
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import (
    OK,
    PROGRAM,
    REPOSITORY,
    Entry,
    Given,
    archive,
    krl,
    program,
    put,
    runnable,
)

#: A grammar that is damaged in no time, and reads the two programs that it is measured with.
GRAMMAR = (REPOSITORY / "tests" / "small.g4").read_text(encoding="utf-8")
NEGATIVE = (
    ";@ reason: the list of parameters is not closed\n;@ phase: parse\n"
    ";@ rule: CTL-01\n;@ line: 5\nDEF A(\nEND\n"
)


def _corpus(folder: Path, foundry: Foundry) -> Path:
    """Other people's programs: in an archive, or one that can be run as often as not."""
    return archive(folder, foundry) if foundry.chance.random() < 0.4 else runnable(folder, foundry)


def tried(folder: Path, foundry: Foundry) -> Given:
    """Every routine of a corpus, on some executors."""
    corpus = _corpus(folder, foundry)
    executor = foundry.chance.choice(["tree", "vm", "native"])
    limits = ("--executor", executor, "--statements", "300", "--json", folder / "out.json")
    return krl("bench", "real-code", *limits, "--", corpus)


def run(folder: Path, foundry: Foundry) -> Given:
    """The main programs of a corpus."""
    corpus = _corpus(folder, foundry)
    where = ("--json", folder / "out.json")
    return krl("bench", "programs", "--max-time", "5", *where, "--", corpus)


def damaged(folder: Path, foundry: Foundry) -> Given:
    """A grammar that is damaged already, the programs it has to read, or the negatives."""
    victim = foundry.chance.choice(["grammar", "programs", "negatives"])
    grammar = foundry.text(GRAMMAR) if victim == "grammar" else GRAMMAR.encode()
    programs = folder / "programs"
    for number, line in enumerate((b"HALT", b"WAIT B")):
        put(programs, f"{number}.src", b"DEF A()\n" + line + b"\nEND\n")
    if victim == "programs":
        program(programs, foundry)
    negatives = folder / "negatives"
    rejected = foundry.text(NEGATIVE) if victim == "negatives" else NEGATIVE.encode()
    put(negatives, "a.src", rejected)
    drawn = "--singles 1 --multiple 1 --jobs 1".split()
    given = ("--grammar", put(folder, "g.g4", grammar), "--negatives", negatives)
    return krl("bench", "mutation", *drawn, *given, "--", programs)


def measured(folder: Path, foundry: Foundry) -> Given:
    """A program whose check is timed, or sizes of corpora; one of them is strange."""
    if foundry.chance.random() < 0.4:
        return krl("bench", "check", "--", program(folder, foundry))
    foundry.note("strange words on the command line")
    sizes = foundry.chance.choice(
        ["0", "-1", "nan", "inf", "1e9", "x", "1;2", "9" * 400, "\x1b[0m"]
    )
    return krl("bench", "scale", f"--sizes={sizes}", "--", put(folder, "ok.src", OK))


#: Options with what is wrong for them, and what makes a command quick where they are right.
OPTIONS = {
    "vm --kernels": ["x", "\x1b[31m", "arithmetic,x", "x" * 9_000],
    "vm --rounds": ["0", "-1", "101", "1e3", "x", "9" * 30],
    "arm --motions": ["0", "-1", "100001", "1e3", "x", "9" * 30, "1", "2"],
    "conform --group": ["x", "", "\x1b[31m", "\udcff"],
    "conform --jobs": ["0", "-1", "x"],
    "fuzz --programs": ["0", "-1", "x", "1e3"],
    "fuzz --seed": ["x", "", "1e3", "\x1b[31m"],
    "real-code --executor": ["x", "", "\x1b[31m", "TREE"],
    "real-code --statements": ["0", "-1", "x", "1", "9" * 30],
    "real-code --seed": ["x", "", "9" * 30, "-9"],
    "programs --executor": ["x", "", "TREE"],
    "programs --robot": ["x", "\x1b[31m"],
    "programs --max-time": ["-1", "x", "nan", "inf", "1e-30", "0", "1e300"],
    "mutation --singles": ["-1", "x"],
    "mutation --runs": ["0", "x"],
    "mutation --jobs": ["0", "x"],
    "mutation --grammar": ["nowhere.g4", "a\x00b"],
}
_READS = ("real-code", "programs", "mutation")


def options(folder: Path, foundry: Foundry) -> Given:
    """Options and words that are none of theirs; or a record that goes where none can."""
    foundry.note("strange words on the command line")
    chance = foundry.chance
    command, option = chance.choice(list(OPTIONS)).split()
    word: str | Path = chance.choice(OPTIONS[f"{command} {option}"])
    if chance.random() < 0.2 and command in _READS[:2]:
        places = [folder, folder / "a\x00b", folder / "ok.src" / "x", Path(os.devnull)]
        word = chance.choice(places)
        option = "--json"
    corpus: list[str | Path] = ["--", put(folder, "ok.src", PROGRAM)] if command in _READS else []
    return krl("bench", command, f"{option}={word}", *corpus)


ENTRIES = {
    "bench": Entry(40, "options, and places where no record can go", options),
    "bench real-code": Entry(25, "a program or an archive, tried routine by routine", tried),
    "bench programs": Entry(25, "a program or an archive, run", run),
    "bench mutation": Entry(10, "a grammar, programs and negatives", damaged),
    "bench speed": Entry(4, "a program whose check is timed, and sizes", measured),
}
