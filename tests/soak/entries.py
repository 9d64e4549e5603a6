"""What each entry point is given: a command line, with hostile files in a folder of its own."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from krl.cli import main
from tests.soak.foundry import Foundry

__all__ = ["ENTRIES", "Entry", "Given", "put"]

REPOSITORY = Path(__file__).parents[2]


@dataclass(frozen=True, slots=True)
class Given:
    """What an entry point is given; with ``stdin`` it is a process of its own."""

    arguments: list[str]
    stdin: bytes | None = None


Maker = Callable[[Path, Foundry], Given]


def krl(*arguments: str | Path) -> Given:
    """A command line."""
    return Given([str(one) for one in arguments])


def put(folder: Path, name: str, data: bytes) -> Path:
    """A file."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


def program(folder: Path, foundry: Foundry) -> Path:
    """A file with a program; its name may be strange too."""
    plain = ["a.src"] * 6 + ["a.dat", "a.sub", "$config.dat", "R1/System/a.src"]
    return put(folder, _named(foundry, plain), foundry.program())


STRANGE = ["\x1b[31m.src", "a\nb.src", "<b>\u202ecrs.src", "\udcff.src", "-o.src", "é 𝄞.src"]


def _named(foundry: Foundry, plain: list[str]) -> str:
    name: str = foundry.chance.choice([*plain, *STRANGE])
    if name in STRANGE:
        foundry.note("strange names of files and folders")
    return name


def runnable(folder: Path, foundry: Foundry) -> Path:
    """A file with a program that can be run as often as not."""
    if foundry.chance.random() < 0.3:
        return program(folder, foundry)
    return put(folder, _named(foundry, ["a.src"] * 9), foundry.runnable())


GRAMMAR = (REPOSITORY / "grammar" / "KRL.g4").read_text(encoding="utf-8")
CONSTRUCTS = sorted((REPOSITORY / "grammar" / "constructs").glob("*.toml"))
CONSTRUCT = CONSTRUCTS[3].read_text(encoding="utf-8")
LATER = CONSTRUCTS[4].read_text(encoding="utf-8")
FORM = (
    'by = ""\nwhen = 2026-03-31\nrelease = "KSS 8"\n'
    '[[program]]\nfile = "a.src"\nconstruct = "0001-x"\nsha256 = "00"\nanswer = "accepted"\n'
)
SCRIPT = "t=0.5 IN[1]=TRUE\non OUT[3]=TRUE after 0.2 IN[7]=TRUE\nstop at 2\n"
POINTS = [{"id": 1, "x": 600, "y": 0, "z": 700, "a": 0, "b": 90, "c": 0, "s": 2}]
PROFILE = (REPOSITORY / "interp" / "controller" / "profiles" / "kss8.toml").read_text(
    encoding="utf-8"
)
MACHINE = (REPOSITORY / "interp" / "robot" / "models" / "kr6r900.dat").read_text(encoding="utf-8")
PROGRAM = (
    b"DEF A()\n  $TOOL=$NULLFRAME\n  $BASE=$NULLFRAME\n"
    b"  PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nEND\n"
)
OK = b"DEF A()\nEND\n"
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


def recover_again(folder: Path, foundry: Foundry) -> Given:
    """A survey whose kept results were damaged."""
    _damaged(folder, foundry, "recover")
    return krl("recover", folder / "in", "--no-start", "--out", folder / "out", "--jobs", "1")


def grow_again(folder: Path, foundry: Foundry) -> Given:
    """A growth whose kept results were damaged."""
    _damaged(folder, foundry, "growth")
    short = _short_ledger(folder)
    return krl("growth", folder / "in", "--constructs", short, "--out", folder / "out")


def check_again(folder: Path, foundry: Foundry) -> Given:
    """Findings that were kept, and damaged."""
    _damaged(folder, foundry, "check")
    return krl("check", folder / "in", "--cache", folder / "out" / "cache")


def grow(folder: Path, foundry: Foundry) -> Given:
    """A program read under the first grammars of the ledger."""
    file, short = program(folder, foundry), _short_ledger(folder)
    return krl("growth", "--constructs", short, "--out", folder / "out", "--", file)


def _short_ledger(folder: Path) -> Path:
    for file in CONSTRUCTS[:3]:
        put(folder, f"ledger/{file.name}", file.read_bytes())
    return folder / "ledger"


SURVEYED = [OK, b"DEF A()\nWEAVE 1\nEND\n"]
_CACHES: dict[str, dict[str, bytes]] = {}
_SURVEY: dict[str, Any] = {}


def _damaged(folder: Path, foundry: Foundry, command: str) -> None:
    """Two programs, and what a command kept of them, damaged."""
    _survey(folder)
    for name, content in _CACHES[command].items():
        put(folder / "out" / "cache", name, foundry.bytes_of(content))
    if foundry.chance.random() < 0.1:
        (folder / "out" / "cache" / "results.sqlite").unlink()
        (folder / "out" / "cache" / "results.sqlite").mkdir()


def _survey(folder: Path) -> None:
    """Two programs; looked at once, for what is kept of it and for the record of the survey."""
    for number, content in enumerate(SURVEYED):
        put(folder / "in", f"{number}.src", content)
    if _CACHES:
        return
    given, out = str(folder / "in"), folder.parent / "reports" / "kept"
    short = str(_short_ledger(folder))
    main(["recover", given, "--no-start", "--out", str(out), "--jobs", "1"])
    _SURVEY.update(json.loads((out / "survey.json").read_text(encoding="utf-8")))
    for command, more in (
        ("recover", None),
        ("growth", ["--constructs", short, "--out", str(out)]),
        ("check", ["--cache", str(out / "cache")]),
    ):
        if more:
            main([command, given, *more])
        cache = out / "cache"
        _CACHES[command] = {file.name: file.read_bytes() for file in cache.iterdir()}
        shutil.rmtree(cache)
    shutil.rmtree(out)


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
    for name in ("preliminary.g4", "KRL.g4"):
        put(home, name, (REPOSITORY / "grammar" / name).read_bytes())
    os.chdir(folder)
    return home


def try_construct(folder: Path, foundry: Foundry) -> Given:
    """A proposal that somebody sent."""
    _home(folder)
    put(folder / "corpus" / "programs", "a.src", foundry.runnable())
    given = CONSTRUCT if foundry.chance.random() < 0.5 else LATER
    return krl("construct", "try", put(folder, "c.toml", foundry.text(given)))


def oracle(folder: Path, foundry: Foundry) -> Given:
    """A form of verdicts, filled by somebody."""
    return krl("construct", "oracle", "--record", put(folder, "v.toml", foundry.text(FORM)))


def night(folder: Path, foundry: Foundry) -> Given:
    """Records of a night that are there already, and a history, both damaged."""
    for name, record in STEPS.items():
        put(folder / "out" / "2026-01-02", f"{name}.json", foundry.record(record))
    put(folder / "out" / "2026-01-01", "conform.json", foundry.record(STEPS["conform"]))
    lines = [foundry.record(NIGHT) for _ in range(3)]
    history = put(folder, "h.jsonl", b"\n".join(lines))
    given = ("--date", "2026-01-02", "--out", folder / "out", "--history", history)
    return krl("nightly", *given, *(word for name in STEPS for word in ("--only", name)))


def recording(folder: Path, foundry: Foundry) -> Given:
    """A recording of some cases."""
    from conformance.case import find_cases

    if not _CASES:
        _CASES.extend((case.name, case.digest) for case in find_cases())
    cases = [
        {
            "case": name,
            "digest": digest,
            "ending": "end",
            "watched": ["out", "message"],
            "events": [EVENT, {"kind": "out", "t": 5, "signal": "$OUT[1]", "value": True}],
            "path": {"t": [0, 12_000], "axes": [[0.0] * 6] * 2, "points": [[1.0] * 6] * 2},
        }
        for name, digest in foundry.chance.sample(_CASES, 3)
    ]
    whole = {"format": "krl-recording/1", "controller": {"name": "X", "release": "8"}}
    return krl(
        "conform",
        "import",
        put(folder, "r.json", foundry.record({**whole, "cycle": 12_000, "cases": cases})),
        "--json",
        folder / "out.json",
    )


_CASES: list[tuple[str, str]] = []


def case_of_the_judge(folder: Path, foundry: Foundry) -> Given:
    """A case, damaged."""
    cases = sorted((REPOSITORY / "conformance" / "cases" / "control").glob("*.src"))
    text = foundry.chance.choice(cases).read_text(encoding="utf-8")
    file = put(folder, "control/case.src", foundry.text(text))
    return krl("conform", "--executor", "tree", "--robot", "none", "--jobs", "1", file)


def propose(folder: Path, foundry: Foundry) -> Given:
    """A proposal taken from a survey that somebody changed."""
    _survey(folder)
    cluster = _SURVEY["clusters"][0]
    record = {**_SURVEY, "clusters": [cluster], "failures": [], "origins": []}
    file = put(folder, "survey.json", foundry.record(record))
    return krl("construct", "propose", cluster["id"], "--survey", file, "--out", folder / "out")


def editor(folder: Path, foundry: Foundry) -> Given:
    """An editor that says strange things to the language server, and then goes."""
    uri = (folder / "a.src").as_uri()
    document: dict[str, Any] = {"uri": uri}
    text = foundry.program().decode("utf-8", "replace")
    opened = {**document, "languageId": "krl", "version": 1, "text": text}
    place = {"line": foundry.chance.randrange(40), "character": foundry.chance.randrange(90)}
    asked = {"textDocument": document, "position": place}
    said: list[tuple[str, Any]] = [
        ("initialize", {"processId": None, "rootUri": folder.as_uri(), "capabilities": {}}),
        ("initialized", {}),
        ("textDocument/didOpen", {"textDocument": opened}),
        ("textDocument/hover", asked),
        ("textDocument/definition", asked),
        ("textDocument/documentSymbol", {"textDocument": document}),
        ("textDocument/foldingRange", {"textDocument": document}),
        ("textDocument/formatting", {"textDocument": document, "options": {"tabSize": 2}}),
        ("textDocument/didChange", {"textDocument": opened, "contentChanges": [{"text": text}]}),
        ("textDocument/didClose", {"textDocument": document}),
    ]
    messages = [
        {"jsonrpc": "2.0", "id": number, "method": method, "params": params}
        for number, (method, params) in enumerate(said)
    ]
    first = foundry.chance.choice([0, 1, 3])
    return Given(["lsp"], _framed(messages[:first]) + foundry.messages(messages[first:]))


def _framed(messages: list[Any]) -> bytes:
    bodies = [json.dumps(message).encode() for message in messages]
    return b"".join(b"Content-Length: %d\r\n\r\n" % len(body) + body for body in bodies)


WORDS = (
    "recover check run growth conform fuzz construct corpus robot bench --json --out --jobs 0 -1 "
    "99999999999999 nothing/here.src /dev/null --seed x compile asm -- - é --help --io --profile"
).split()
WORDS += ["", "\x1b[31m", "\ud800", "a\x00b"]


def words(_folder: Path, foundry: Foundry) -> Given:
    """A command line of words by chance; what would work for minutes gets little to do."""
    foundry.note("strange words on the command line")
    chosen = foundry.chance.choices(WORDS, k=foundry.chance.randrange(1, 5))
    little = {"fuzz": ["--programs", "2"], "conform": ["nothing"], "bench": ["nothing"]}
    return krl(*chosen, *little.get(next(iter(little.keys() & set(chosen)), ""), ()))


def run(folder: Path, foundry: Foundry) -> Given:
    """A program that is run, with everything that is written about it."""
    more = foundry.chance.choice(
        [(), ("--html", folder / "out.html"), ("--trace", folder / "t.jsonl"), ("--strict",)]
    )
    executor = foundry.chance.choice(["tree", "vm", "native"])
    limits = ("--executor", executor, "--max-time", "5")
    return krl("run", *limits, *more, "--", runnable(folder, foundry))


def _ran(folder: Path, *options: str | Path) -> Given:
    return krl("run", "--executor", "vm", *options, put(folder, "p.src", PROGRAM))


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


def odd_file(folder: Path, foundry: Foundry) -> Given:
    """Something else than a file where a file is wanted."""
    foundry.note(
        "pipes, devices, folders, loops of links and enormous files in the place of a file"
    )
    command, suffix = foundry.chance.choice(FILES_WANTED)
    odd = folder / f"odd{suffix}"
    match foundry.chance.randrange(6):
        case 0:
            os.mkfifo(odd)
        case 1:
            odd.symlink_to(odd.name)
        case 2:
            odd = Path("/dev/zero")
        case 3:
            odd.mkdir()
        case 4:
            with odd.open("wb") as stream:  # sparse: it needs no room
                stream.truncate(foundry.chance.choice([65 << 20, 1 << 40]))
        case _:
            put(folder, odd.name, b"").chmod(0)
    places = {"?": str(odd), "=": str(folder / "out"), "!": str(put(folder, "ok.src", PROGRAM))}
    return krl(*(places.get(word, word) for word in command.split()))


#: Commands by the place of the file that they read, and how its name ends.
FILES_WANTED = [
    ("check --no-cache ?", ".src"),
    ("check --no-cache ?", ".zip"),
    ("format --check ?", ".src"),
    ("recover --no-start --out = ?", ".src"),
    ("recover --no-start --out = --grammar ? !", ".g4"),
    ("run ?", ".src"),
    ("run --io ? !", ".txt"),
    ("run --profile ? !", ".toml"),
    ("compile ? -o =", ".src"),
    ("asm ? -o =", ".krla"),
    ("disasm ?", ".krlb"),
    ("robot status-turn ? --machine !", ".json"),
    ("robot status-turn ! --machine ?", ".dat"),
    ("conform import ?", ".json"),
    ("conform ?", ".src"),
    ("construct try ?", ".toml"),
    ("construct oracle --record ?", ".toml"),
    ("construct propose c-1 --survey ?", ".json"),
    ("nightly --only nothing --history ? --out =", ".jsonl"),
]


@dataclass(frozen=True, slots=True)
class Entry:
    """An entry point: its share of all inputs, what it is given in words, and who makes that."""

    share: int
    words: str
    make: Maker


ENTRIES: dict[str, Entry] = {
    "check": Entry(
        110,
        "a program, its name strange too",
        lambda d, f: krl("check", "--no-cache", "--", program(d, f)),
    ),
    "check archive": Entry(
        80, "an archive", lambda d, f: krl("check", put(d, "a.zip", f.archive()))
    ),
    "check sarif": Entry(
        40,
        "a program, told as SARIF",
        lambda d, f: krl("check", "--format", "sarif", "--", program(d, f)),
    ),
    "check json": Entry(
        30,
        "a program, told as JSON",
        lambda d, f: krl("check", "--format", "json", "--", program(d, f)),
    ),
    "format": Entry(
        50, "a program, compared", lambda d, f: krl("format", "--check", "--", program(d, f))
    ),
    "format files": Entry(
        30, "a program, written anew", lambda d, f: krl("format", "--", program(d, f))
    ),
    "recover": Entry(
        8,
        "a program, surveyed with causes and page",
        lambda d, f: krl("recover", "--no-start", "--out", d / "out", "--", program(d, f)),
    ),
    "recover archive": Entry(
        15,
        "an archive",
        lambda d, f: krl("recover", put(d, "a.zip", f.archive()), "--no-start", "--out", d / "out"),
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
    "ledger": Entry(50, "constructs, grammar and journal of an acceptance", ledger),
    "construct try": Entry(15, "a construct that somebody proposes", try_construct),
    "construct oracle": Entry(40, "a form with verdicts of a controller", oracle),
    "construct propose": Entry(35, "a survey that somebody changed", propose),
    "run": Entry(80, "a program that is run, on each executor, with page and trace", run),
    "run archive": Entry(
        12,
        "a program in an archive",
        lambda d, f: krl("run", put(d, "a.zip", f.archive(f.runnable())) / "KRC/R1/x.src"),
    ),
    "run io": Entry(
        50, "a script of inputs", lambda d, f: _ran(d, "--io", put(d, "s.txt", f.text(SCRIPT)))
    ),
    "run profile": Entry(
        45,
        "a profile of a controller",
        lambda d, f: _ran(d, "--profile", put(d, "p.toml", f.text(PROFILE))),
    ),
    "compile": Entry(
        80, "a program", lambda d, f: krl("compile", "-o", d / "out.krlb", "--", runnable(d, f))
    ),
    "asm": Entry(
        45,
        "text of the bytecode machine",
        lambda d, f: krl("asm", put(d, "a.krla", f.text(f.chance.choice(f.compiled)[1]))),
    ),
    "disasm": Entry(
        100,
        "an image of the bytecode machine",
        lambda d, f: krl("disasm", put(d, "a.krlb", f.image())),
    ),
    "points": Entry(
        40,
        "points for an arm",
        lambda d, f: krl(
            "robot",
            "status-turn",
            put(d, "p.json", f.record(POINTS)),
            "--machine",
            put(d, "$machine.dat", MACHINE.encode()),
        ),
    ),
    "machine data": Entry(
        40,
        "machine data of an arm",
        lambda d, f: krl(
            "robot",
            "status-turn",
            put(d, "p.json", json.dumps(POINTS).encode()),
            "--machine",
            put(d, "$machine.dat", f.text(MACHINE)),
        ),
    ),
    "conform": Entry(9, "a case of the judge", case_of_the_judge),
    "conform import": Entry(14, "a recording of a real controller", recording),
    "nightly": Entry(50, "records of a night, and the history of nights", night),
    "lsp": Entry(3, "what an editor says", editor),
    "arguments": Entry(60, "words on the command line", words),
    "check cache": Entry(20, "findings kept from an earlier check", check_again),
    "corpus": Entry(30, "the list of public repositories and of their files", corpus),
    "fuzz": Entry(10, "options", fuzzed),
    "odd files": Entry(60, "no file at all where a command wants one", odd_file),
}
