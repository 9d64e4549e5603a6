"""Entry points of the survey: `krl recover`, `krl growth`, `krl corpus`."""

from __future__ import annotations

import os
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import OK, REPOSITORY, Entry, Given, archive, krl, program, put
from tests.soak.kept import damaged, short_ledger

GRAMMAR = (REPOSITORY / "grammar" / "KRL.g4").read_text(encoding="utf-8")


def recover_again(folder: Path, foundry: Foundry) -> Given:
    """A survey whose kept results were damaged."""
    damaged(folder, foundry, "recover")
    return krl("recover", folder / "in", "--no-start", "--out", folder / "out", "--jobs", "1")


def grow_again(folder: Path, foundry: Foundry) -> Given:
    """A growth whose kept results were damaged."""
    damaged(folder, foundry, "growth")
    short = short_ledger(folder)
    return krl("growth", folder / "in", "--constructs", short, "--out", folder / "out")


def grow(folder: Path, foundry: Foundry) -> Given:
    """A program read under the first grammars of the ledger."""
    file, short = program(folder, foundry), short_ledger(folder)
    return krl("growth", "--constructs", short, "--out", folder / "out", "--", file)


def corpus(folder: Path, foundry: Foundry) -> Given:
    """A list of repositories and of their files, damaged, in a working folder of its own."""
    listed = {
        "sources.toml": f'[[source]]\nrepository = "a/b"\nurl = "https://example.org/a/b"\n'
        f'commit = "{"0" * 40}"\nlicence = "MIT"\ngeneration = "KRC4"\nnote = "n"\n',
        "checksums.tsv": "repository\tpath\tbytes\tsha256\tkind\tquality\n"
        f"a/b\tx.src\t12\t{'0' * 64}\tuser\treal\n",
    }
    victim = foundry.chance.choice(list(listed))
    for name, text in listed.items():
        hostile = name == victim
        put(folder / "corpus", name, foundry.text(text) if hostile else text.encode())
    (folder / "mirrors").mkdir()
    os.chdir(folder)
    return krl("corpus", *foundry.chance.choice([("list",), ("fetch", "--mirror", "mirrors")]))


ENTRIES = {
    "recover": Entry(
        8,
        "a program, surveyed with causes and page",
        lambda d, f: krl("recover", "--no-start", "--out", d / "out", "--", program(d, f)),
    ),
    "recover archive": Entry(
        15,
        "an archive",
        lambda d, f: krl("recover", archive(d, f), "--no-start", "--out", d / "out"),
    ),
    "recover grammar": Entry(
        20,
        "a grammar",
        lambda d, f: krl(
            "recover",
            put(d, "ok.src", OK),
            "--grammar",
            put(d, "g.g4", f.text(GRAMMAR)),
            "--out",
            d / "out",
        ),
    ),
    "recover cache": Entry(10, "results kept from an earlier survey", recover_again),
    "growth": Entry(5, "a program, under the first grammars of the ledger", grow),
    "growth cache": Entry(5, "results kept from an earlier growth", grow_again),
    "corpus": Entry(30, "the list of public repositories and of their files", corpus),
}
