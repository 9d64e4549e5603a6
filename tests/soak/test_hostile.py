"""Hostile input at every entry point: no traceback, no hang, nothing written elsewhere.

Not part of `make test`: `make hostile` runs it and tells how many inputs went where. Each input is
made from a seed, so what fails can be made again: KRL_HOSTILE_INPUTS is how many there are (which
decides what each is), KRL_HOSTILE_ONLY names the entry points or single numbers to try.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from krl.cli import main

pytestmark = [
    pytest.mark.soak,
    pytest.mark.filterwarnings("ignore:Duplicate name"),  # archives that name a file twice
]

REPOSITORY = Path(__file__).parents[2]
SEED = 20_261_121
#: Inputs in all, over all entry points; the environment may ask for fewer or more.
INPUTS = int(os.environ.get("KRL_HOSTILE_INPUTS", "10000"))
#: Entry points or numbers of inputs to try, separated by commas; all where it is empty.
ONLY = [name.strip() for name in os.environ.get("KRL_HOSTILE_ONLY", "").split(",") if name.strip()]
#: Seconds of processor time that no input may take, and seconds by the clock, for what waits.
LONGEST = 60.0
LONGEST_WAIT = 600.0
#: Failures after which it is time to stop.
MOST_TOLD = 12
#: What must not reach a terminal raw: it could steer it, or turn the order of what is read.
STEERING = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


@dataclass(frozen=True, slots=True)
class Given:
    """What an entry point is given; with ``stdin`` it is a process of its own."""

    arguments: list[str]
    stdin: bytes | None = None


Entry = Callable[[Path, Any], Given]


def krl(*arguments: str | Path) -> Given:
    """A command line."""
    return Given([str(one) for one in arguments])


def put(folder: Path, name: str, data: bytes) -> Path:
    """A file."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


def program(folder: Path, foundry: Any) -> Path:
    """A file with a program; its name may be strange too."""
    names = ["a.src"] * 6 + ["a.dat", "a.sub", "$config.dat", "R1/System/a.src"]
    names += ["\x1b[31m.src", "a\nb.src", "<b>\u202ecrs.src", "\udcff.src", "-o.src", "é 𝄞.src"]
    return put(folder, foundry.chance.choice(names), foundry.program())


def runnable(folder: Path, foundry: Any) -> Path:
    """A file with a program that can be run as often as not."""
    if foundry.chance.random() < 0.3:
        return program(folder, foundry)
    return put(folder, foundry.chance.choice(["a.src", "<b>\u202ecrs.src"]), foundry.runnable())


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


def recover_again(folder: Path, foundry: Any) -> Given:
    """A survey whose kept results were damaged."""
    _kept(folder, foundry)
    return krl("recover", folder / "in", "--no-start", "--out", folder / "out", "--jobs", "1")


SURVEYED = [OK, b"DEF A()\nWEAVE 1\nEND\n"]
_CACHE: dict[str, bytes] = {}
_SURVEY: dict[str, Any] = {}


def _kept(folder: Path, foundry: Any) -> None:
    _survey(folder)
    for number, content in enumerate(SURVEYED):
        put(folder / "in", f"{number}.src", content)
    for name, content in _CACHE.items():
        put(folder / "out" / "cache", name, foundry.bytes_of(content))
    if foundry.chance.random() < 0.1:
        (folder / "out" / "cache" / "results.sqlite").unlink()
        (folder / "out" / "cache" / "results.sqlite").mkdir()


def _survey(folder: Path) -> None:
    """Survey two programs once, for what is kept of it and for its record."""
    if not _CACHE:
        out = folder.parent / "reports" / "kept"
        for number, content in enumerate(SURVEYED):
            put(folder / "in", f"{number}.src", content)
        main(["recover", str(folder / "in"), "--no-start", "--out", str(out), "--jobs", "1"])
        for file in (out / "cache").iterdir():
            _CACHE[file.name] = file.read_bytes()
        _SURVEY.update(json.loads((out / "survey.json").read_text(encoding="utf-8")))
        shutil.rmtree(out)


def ledger(folder: Path, foundry: Any) -> Given:
    """A ledger of which a file is damaged, or with a journal that wants what it must not."""
    home, chance = _home(folder), foundry.chance
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


def try_construct(folder: Path, foundry: Any) -> Given:
    """A proposal that somebody sent."""
    _home(folder)
    put(folder / "corpus" / "programs", "a.src", foundry.runnable())
    given = CONSTRUCT if foundry.chance.random() < 0.5 else LATER
    return krl("construct", "try", put(folder, "c.toml", foundry.text(given)))


def oracle(folder: Path, foundry: Any) -> Given:
    """A form of verdicts, filled by somebody."""
    return krl("construct", "oracle", "--record", put(folder, "v.toml", foundry.text(FORM)))


def night(folder: Path, foundry: Any) -> Given:
    """Records of a night that are there already, and a history, both damaged."""
    for name, record in STEPS.items():
        put(folder / "out" / "2026-01-02", f"{name}.json", foundry.record(record))
    put(folder / "out" / "2026-01-01", "conform.json", foundry.record(STEPS["conform"]))
    lines = [foundry.record(NIGHT) for _ in range(3)]
    history = put(folder, "h.jsonl", b"\n".join(lines))
    given = ("--date", "2026-01-02", "--out", folder / "out", "--history", history)
    return krl("nightly", *given, *(word for name in STEPS for word in ("--only", name)))


def recording(folder: Path, foundry: Any) -> Given:
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


def case_of_the_judge(folder: Path, foundry: Any) -> Given:
    """A case, damaged."""
    cases = sorted((REPOSITORY / "conformance" / "cases" / "control").glob("*.src"))
    text = foundry.chance.choice(cases).read_text(encoding="utf-8")
    file = put(folder, "control/case.src", foundry.text(text))
    return krl("conform", "--executor", "tree", "--robot", "none", "--jobs", "1", file)


def propose(folder: Path, foundry: Any) -> Given:
    """A proposal taken from a survey that somebody changed."""
    _survey(folder)
    cluster = _SURVEY["clusters"][0]
    record = {**_SURVEY, "clusters": [cluster], "failures": [], "origins": []}
    file = put(folder, "survey.json", foundry.record(record))
    return krl("construct", "propose", cluster["id"], "--survey", file, "--out", folder / "out")


def editor(folder: Path, foundry: Any) -> Given:
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


def words(_folder: Path, foundry: Any) -> Given:
    """A command line of words by chance; what would work for minutes gets little to do."""
    chosen = foundry.chance.choices(WORDS, k=foundry.chance.randrange(1, 5))
    little = {"fuzz": ["--programs", "2"], "conform": ["nothing"], "bench": ["nothing"]}
    return krl(*chosen, *little.get(next(iter(little.keys() & set(chosen)), ""), ()))


def run(folder: Path, foundry: Any) -> Given:
    """A program that is run, with everything that is written about it."""
    more = foundry.chance.choice(
        [(), ("--html", folder / "out.html"), ("--trace", folder / "t.jsonl"), ("--strict",)]
    )
    executor = foundry.chance.choice(["tree", "vm", "native"])
    limits = ("--executor", executor, "--max-time", "5")
    return krl("run", *limits, *more, "--", runnable(folder, foundry))


def _ran(folder: Path, *options: str | Path) -> Given:
    return krl("run", "--executor", "vm", *options, put(folder, "p.src", PROGRAM))


#: What each entry point is given; the number is its share of all inputs.
ENTRIES: dict[str, tuple[int, Entry]] = {
    "check": (10, lambda d, f: krl("check", "--no-cache", "--", program(d, f))),
    "check archive": (6, lambda d, f: krl("check", put(d, "a.zip", f.archive()))),
    "check sarif": (3, lambda d, f: krl("check", "--format", "sarif", "--", program(d, f))),
    "check json": (2, lambda d, f: krl("check", "--format", "json", "--", program(d, f))),
    "format": (4, lambda d, f: krl("format", "--check", "--", program(d, f))),
    "format files": (2, lambda d, f: krl("format", "--", program(d, f))),
    "recover": (
        3,
        lambda d, f: krl("recover", "--no-start", "--out", d / "out", "--", program(d, f)),
    ),
    "recover archive": (
        3,
        lambda d, f: krl("recover", put(d, "a.zip", f.archive()), "--no-start", "--out", d / "out"),
    ),
    "recover grammar": (
        2,
        lambda d, f: krl(
            "recover",
            put(d, "ok.src", OK),
            "--grammar",
            put(d, "g.g4", f.text(GRAMMAR)),
            "--out",
            d / "out",
        ),
    ),
    "recover cache": (3, recover_again),
    "growth": (1, lambda d, f: krl("growth", "--out", d / "out", "--", program(d, f))),
    "ledger": (4, ledger),
    "construct try": (3, try_construct),
    "construct oracle": (3, oracle),
    "construct propose": (3, propose),
    "run": (8, run),
    "run archive": (2, lambda d, f: krl("run", put(d, "a.zip", f.archive()) / "KRC/R1/x.src")),
    "run io": (4, lambda d, f: _ran(d, "--io", put(d, "s.txt", f.text(SCRIPT)))),
    "run profile": (3, lambda d, f: _ran(d, "--profile", put(d, "p.toml", f.text(PROFILE)))),
    "compile": (6, lambda d, f: krl("compile", "-o", d / "out.krlb", "--", runnable(d, f))),
    "asm": (
        5,
        lambda d, f: krl("asm", put(d, "a.krla", f.text(f.chance.choice(f.compiled)[1]))),
    ),
    "disasm": (8, lambda d, f: krl("disasm", put(d, "a.krlb", f.image()))),
    "points": (
        3,
        lambda d, f: krl(
            "robot",
            "status-turn",
            put(d, "p.json", f.record(POINTS)),
            "--machine",
            put(d, "$machine.dat", MACHINE.encode()),
        ),
    ),
    "machine data": (
        3,
        lambda d, f: krl(
            "robot",
            "status-turn",
            put(d, "p.json", json.dumps(POINTS).encode()),
            "--machine",
            put(d, "$machine.dat", f.text(MACHINE)),
        ),
    ),
    "conform": (3, case_of_the_judge),
    "conform import": (4, recording),
    "nightly": (4, night),
    "lsp": (1, editor),
    "arguments": (4, words),
}


#: Standard error as it is before anything captures it.
_STDERR = os.dup(2)


class Watch:
    """Tells which input hangs: a hang in C cannot be broken off from inside."""

    def __init__(self) -> None:
        self.doing = ""
        self.since = self.worked = 0.0
        threading.Thread(target=self._look, daemon=True).start()

    def begin(self, doing: str) -> None:
        """An input begins; an empty text: none does."""
        self.since, self.worked = time.monotonic(), time.process_time()
        self.doing = doing

    def _look(self) -> None:
        while True:
            time.sleep(1)
            worked, waited = time.process_time() - self.worked, time.monotonic() - self.since
            if self.doing and (worked > LONGEST or waited > LONGEST_WAIT):
                os.write(_STDERR, f"\nHANG: {self.doing}\n".encode("utf-8", "replace"))
                os._exit(1)


class Guard:
    """Hears of every file that this process opens for writing, renames, makes or removes."""

    def __init__(self, allowed: Path) -> None:
        self.allowed = str(allowed)
        self.elsewhere: list[str] = []
        self.is_on = True
        sys.addaudithook(self._hear)  # there is no way to take one off again

    def _hear(self, event: str, given: tuple[Any, ...]) -> None:
        if not self.is_on:
            return
        if event == "open":
            path, mode, flags = given
            writes = flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT) if flags else "w" in str(mode)
            named = [path] if writes else []
        elif event in ("os.rename", "os.link", "os.symlink"):
            named = list(given[:2])
        elif event in ("os.remove", "os.mkdir", "os.rmdir", "os.truncate", "os.chmod"):
            named = [given[0]]
        else:
            return
        self.elsewhere += [f"{event} {one!r}" for one in named if not self._is_allowed(one)]

    def _is_allowed(self, path: Any) -> bool:
        if not isinstance(path, str | bytes | os.PathLike):
            return True  # a descriptor, which somebody opened
        text = os.path.abspath(os.fsdecode(path))  # noqa: PTH100  a Path would cost much
        return text.startswith(self.allowed) or text == os.devnull or "__pycache__" in text


def _plan() -> Iterator[tuple[str, int]]:
    """Entry points with the numbers of their inputs."""
    shares = sum(share for share, _ in ENTRIES.values())
    number = 0
    for name, (share, _) in ENTRIES.items():
        for _ in range(max(1, -(-INPUTS * share // shares))):
            if not ONLY or name in ONLY or str(number) in ONLY:
                yield name, number
            number += 1


def _go(given: Given, capfd: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """The status, and what was said on stdout and stderr."""
    if given.stdin is None:
        status = main(given.arguments)
        return status, *capfd.readouterr()
    done = subprocess.run(
        [sys.executable, "-m", "krl", *given.arguments],
        input=given.stdin,
        capture_output=True,
        check=False,
        timeout=LONGEST_WAIT,
        cwd=REPOSITORY,
    )
    # what the server answers goes to a program, not to a terminal
    return done.returncode, "", done.stderr.decode("utf-8", "replace")


def test_nothing_breaks_and_nothing_escapes(
    tmp_path: Path,
    foundry: Any,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """Every input ends with 0, 1 or 2, one clear line on stderr for 2, and nothing outside."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "reports"))
    canary = put(tmp_path, "canary", b"alive")
    watch, went = Watch(), Counter[tuple[str, int]]()
    worked, slowest = 0.0, (0.0, "")
    guard = Guard(tmp_path)
    failures: list[str] = []
    for name, number in _plan():
        folder = tmp_path / "input"
        folder.mkdir()
        foundry.chance.seed(SEED + number)
        given = ENTRIES[name][1](folder, foundry)
        capfd.readouterr()
        said = f"{name}, input {number}: {given.arguments}"
        watch.begin(said)
        began = time.process_time()
        status, out, err = _go(given, capfd)
        took = time.process_time() - began
        slowest, worked = max(slowest, (took, f"{name} {number}")), worked + took
        watch.begin("")
        os.chdir(tmp_path)
        went[name, status] += 1
        wrong = [*_wrong_of(status, out, err), *_wrong_in(folder)]
        there = {p.name for p in tmp_path.iterdir()} - {"input", "reports", "canary"}
        wrong += [f"written outside: {one}" for one in (*sorted(there), *guard.elsewhere)]
        if canary.read_bytes() != b"alive":
            wrong.append("written over what lies outside")
        failures += [f"{said}: {one}: {err[-300:]!r}" for one in wrong]
        if len(failures) > MOST_TOLD:
            break
        guard.elsewhere.clear()
        shutil.rmtree(folder)
    guard.is_on = False
    with capfd.disabled():
        print()
        for name in ENTRIES:
            counts = {status: went[name, status] for status in (0, 1, 2)}
            print(f"{name:17} {sum(counts.values()):6}  by status {counts}")
        told = f"{worked:.0f} s of processor time, slowest {slowest[0]:.1f} s ({slowest[1]})"
        print(f"{'all':17} {sum(went.values()):6}  {told}")
    assert not failures, "\n".join(failures)
    assert ONLY or sum(went.values()) >= INPUTS


def _wrong_of(status: int, out: str, err: str) -> Iterator[str]:
    """What is wrong with how a command ended and what it said."""
    if status not in (0, 1, 2):
        yield f"status {status}"
    if "defect in krl" in err or "Traceback" in err:
        yield "a defect"
    steering = STEERING.search(out + err)
    if steering is not None:
        yield f"raw on the terminal: {steering[0]!r}"
    if status == 2 and len(err.strip().splitlines()) != 1:
        yield "not one line on stderr"


def _wrong_in(folder: Path) -> Iterator[str]:
    """What is wrong with the files that a command wrote."""
    for page in folder.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        if "<script>alert(1)" in text or "<img src=x" in text:
            yield f"{page.name} holds what would run in it"
    for record in folder.rglob("out/*.json"):
        try:
            json.loads(record.read_text(encoding="utf-8"))
        except ValueError as error:
            yield f"{record.name}: {error}"
