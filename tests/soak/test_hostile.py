"""Hostile input at every entry point: no traceback, no hang, nothing written elsewhere.

Not part of `make test`: `make hostile` runs it and tells how many inputs went where. Each input is
made from a seed, so what fails can be made again.
"""

import contextlib
import io
import json
import os
import random
import struct
import threading
import time
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

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
#: Entry points to try, separated by commas; all of them where it is empty.
ONLY = [name.strip() for name in os.environ.get("KRL_HOSTILE_ONLY", "").split(",") if name.strip()]
#: Seconds that no input may take, on a machine that is busy with something else.
LONGEST = 60.0

PIECES = [
    "</script><script>alert(1)</script>",
    "<!--",
    "\x1b[2J\x1b[31m",
    "\x1b]0;title\x07",
    "\u202e\u2066",
    "\x00",
    "\ufeff",
    "𝄞",
    "é" * 50,
    "(" * 500,
    "NOT " * 300,
    "[1," * 200,
    "{A1 0,",
    '"' * 3,
    "9" * 400,
    "1E" + "9" * 30,
    "'HFFFFFFFFFFFFFFFF'",
    "IF TRUE THEN\n" * 120,
    "LOOP\n" * 400,
    "DEF A()\nEND\n",
    "DEFDAT X\nENDDAT\n",
    "FOR I=1 TO 9 STEP 0\nENDFOR\n",
    "DECL INT A[2147483647]\n",
    "DECL CHAR C[99999,99999,9]\n",
    "GOTO X\nX:\n",
    "PTP {A1 1E38}\n",
    "LIN {X 1E30,Y 0,Z 0}\n",
    "WAIT SEC -1\n",
    "$OV_PRO=0\n",
    "INTERRUPT DECL 5 WHEN TRUE DO X()\nINTERRUPT ON\n",
    "TRIGGER WHEN PATH=1E9 DELAY=-1E9 DO $OUT[1]=TRUE\n",
    "&ACCESS RVO\n&REL 1\n",
    "\r",
    "\r\n\r\n",
    "\x1a",
    ";FOLD " * 60,
]


class Foundry:
    """Makes inputs out of our own programs and of what breaks readers."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)  # nobody's secret depends on it
        own = [*(REPOSITORY / "corpus").rglob("*.src"), *(REPOSITORY / "corpus").rglob("*.dat")]
        self.own = [file.read_bytes() for file in sorted(own) if file.stat().st_size < 20_000]
        image = REPOSITORY / "tests"
        self.images = [file.read_bytes() for file in sorted(image.rglob("*.krlb"))]

    def program(self) -> bytes:
        """A program, damaged in one of many ways; now and then no program at all."""
        data = bytearray(self.chance.choice(self.own))
        for _ in range(self.chance.randrange(1, 6)):
            self._damage(data)
        return bytes(data[:400_000])

    def _damage(self, data: bytearray) -> None:
        chance = self.chance
        place = chance.randrange(len(data) + 1)
        match chance.randrange(9):
            case 0:
                data[place:place] = chance.choice(PIECES).encode("utf-8", "surrogatepass")
            case 1:
                data[place : place + chance.randrange(200)] = b""
            case 2:
                data[place:place] = chance.randbytes(chance.randrange(1, 60))
            case 3:
                other = chance.choice(self.own)
                start = chance.randrange(len(other))
                data[place:place] = other[start : start + 300]
            case 4:
                lines = bytes(data).split(b"\n")
                chance.shuffle(lines)
                data[:] = b"\n".join(lines)
            case 5:
                line = bytes(data).split(b"\n")[:1][0]
                data[place:place] = line * chance.randrange(1, 200)
            case 6:
                data[place:place] = b"x" * chance.randrange(1, 60_000)
            case 7:
                data[:] = bytes(data).replace(b"(", b"((", 3).replace(b"END", b"EN", 1)
            case 8:
                with contextlib.suppress(UnicodeDecodeError):
                    data[:] = bytes(data).decode("utf-8").encode("utf-16")

    def archive(self) -> bytes:
        """An archive whose names lead out of it, lie about sizes, are links, bombs, nested."""
        chance = self.chance
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for _ in range(chance.randrange(1, 5)):
                name = chance.choice(
                    [
                        "../../up.src",
                        "/etc/up.src",
                        "C:\\up.src",
                        "a/../../b.src",
                        "a\x00b.src",
                        "KRC/R1/x.src",
                        "R1/\x1b[31m.dat",
                        "con.src",
                        "x.src/",
                        "é.src",
                        "a" * 300 + ".src",
                    ]
                )
                entry = zipfile.ZipInfo(name)
                entry.compress_type = zipfile.ZIP_DEFLATED
                match chance.randrange(5):
                    case 0:
                        entry.external_attr = 0o120777 << 16  # a symbolic link
                        archive.writestr(entry, "/etc/passwd")
                    case 1:
                        archive.writestr(
                            entry, b"DEF A()\n" + b" " * chance.choice([10, 30_000_000])
                        )
                    case 2:
                        inner = io.BytesIO()
                        with zipfile.ZipFile(inner, "w") as nested:
                            nested.writestr("n.src", "DEF A()\nEND\n")
                        entry.filename = "nested.zip"
                        archive.writestr(entry, inner.getvalue())
                    case _:
                        archive.writestr(entry, self.program())
        data = bytearray(stream.getvalue())
        match chance.randrange(4):
            case 0:
                for _ in range(chance.randrange(1, 30)):
                    data[chance.randrange(len(data))] = chance.randrange(256)
            case 1:
                data = data[: chance.randrange(len(data))]
            case 2:
                place = bytes(data).find(b"PK\x03\x04")
                data[place + 6 : place + 8] = struct.pack("<H", 1)  # encrypted, it says
        return bytes(data)

    def text(self, given: str) -> bytes:
        """A text of some format, damaged."""
        data = bytearray(given.encode())
        for _ in range(self.chance.randrange(1, 4)):
            self._damage(data)
        return bytes(data[:200_000])


Arguments = Callable[[Path, Foundry], list[str]]


def _put(folder: Path, name: str, data: bytes) -> str:
    path = folder / name
    path.write_bytes(data)
    return str(path)


def _program(folder: Path, foundry: Foundry) -> str:
    return _put(
        folder, foundry.chance.choice(["a.src", "a.dat", "a.sub", "$config.dat"]), foundry.program()
    )


GRAMMAR = (REPOSITORY / "grammar" / "KRL.g4").read_text(encoding="utf-8")
CONSTRUCT = sorted((REPOSITORY / "grammar" / "constructs").glob("*.toml"))[3].read_text(
    encoding="utf-8"
)
ASSEMBLY = "program\n"
SCRIPT = "t=0.5 IN[1]=TRUE\non OUT[3]=TRUE after 0.2 IN[7]=TRUE\nstop at 2\n"
POINTS = '[{"id":1,"x":600,"y":0,"z":700,"a":0,"b":90,"c":0,"s":2}]'
PROFILE = (REPOSITORY / "interp" / "controller" / "profiles" / "kss8.toml").read_text(
    encoding="utf-8"
)
MACHINE = (REPOSITORY / "interp" / "robot" / "models" / "kr6r900.dat").read_text(encoding="utf-8")
PROGRAM = "DEF A()\n  $TOOL=$NULLFRAME\n  $BASE=$NULLFRAME\n  PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nEND\n"

#: What each entry point is given; the number is its share of all inputs.
ENTRIES: dict[str, tuple[int, Arguments]] = {
    "check": (10, lambda d, f: ["check", _program(d, f)]),
    "check archive": (6, lambda d, f: ["check", _put(d, "a.zip", f.archive())]),
    "check sarif": (3, lambda d, f: ["check", "--format", "sarif", _program(d, f)]),
    "format": (6, lambda d, f: ["format", "--check", _program(d, f)]),
    "recover": (
        4,
        lambda d, f: [
            "recover",
            _program(d, f),
            "--no-start",
            "--out",
            str(d / "out"),
            "--jobs",
            "1",
        ],
    ),
    "recover archive": (
        4,
        lambda d, f: [
            "recover",
            _put(d, "a.zip", f.archive()),
            "--no-start",
            "--out",
            str(d / "out"),
        ],
    ),
    "recover grammar": (
        2,
        lambda d, f: [
            "recover",
            _put(d, "ok.src", b"DEF A()\nEND\n"),
            "--grammar",
            _put(d, "g.g4", f.text(GRAMMAR)),
            "--out",
            str(d / "out"),
        ],
    ),
    "construct try": (3, lambda d, f: ["construct", "try", _put(d, "c.toml", f.text(CONSTRUCT))]),
    "run": (
        8,
        lambda d, f: [
            "run",
            _program(d, f),
            "--executor",
            f.chance.choice(["tree", "vm", "native"]),
            "--max-time",
            "5",
            "--html",
            str(d / "out.html"),
        ],
    ),
    "run archive": (2, lambda d, f: ["run", _put(d, "a.zip", f.archive()) + "/KRC/R1/x.src"]),
    "run io": (
        4,
        lambda d, f: [
            "run",
            _put(d, "p.src", PROGRAM.encode()),
            "--executor",
            "vm",
            "--io",
            _put(d, "s.txt", f.text(SCRIPT)),
        ],
    ),
    "run profile": (
        3,
        lambda d, f: [
            "run",
            _put(d, "p.src", PROGRAM.encode()),
            "--executor",
            "vm",
            "--profile",
            _put(d, "p.toml", f.text(PROFILE)),
        ],
    ),
    "compile": (6, lambda d, f: ["compile", _program(d, f), "-o", str(d / "out.krlb")]),
    "asm": (4, lambda d, f: ["asm", _put(d, "a.krla", f.text(ASSEMBLY))]),
    "disasm": (8, lambda d, f: ["disasm", _put(d, "a.krlb", _image(f))]),
    "status-turn": (
        3,
        lambda d, f: [
            "robot",
            "status-turn",
            _put(d, "p.json", f.text(POINTS)),
            "--machine",
            _put(d, "$machine.dat", MACHINE.encode()),
        ],
    ),
    "machine data": (
        3,
        lambda d, f: [
            "robot",
            "status-turn",
            _put(d, "p.json", POINTS.encode()),
            "--machine",
            _put(d, "$machine.dat", f.text(MACHINE)),
        ],
    ),
    "conform": (3, lambda d, f: ["conform", "--executor", "tree", "--jobs", "1", _case(d, f)]),
    "arguments": (4, lambda _, f: f.chance.choices(WORDS, k=f.chance.randrange(1, 5))),
}
WORDS = [
    "recover",
    "check",
    "run",
    "growth",
    "conform",
    "fuzz",
    "--json",
    "--out",
    "--jobs",
    "0",
    "-1",
    "99999999999999",
    "\x1b[31m",
    "nothing/here.src",
    "/dev/null",
    "--seed",
    "x",
    "compile",
    "asm",
    "--",
    "-",
    "",
    "é",
    "\ud800",
]


def _image(foundry: Foundry) -> bytes:
    if not foundry.images:
        return foundry.chance.randbytes(foundry.chance.randrange(300))
    data = bytearray(foundry.chance.choice(foundry.images))
    for _ in range(foundry.chance.randrange(1, 9)):
        data[foundry.chance.randrange(len(data))] = foundry.chance.randrange(256)
    return bytes(data)


def _case(folder: Path, foundry: Foundry) -> str:
    cases = sorted((REPOSITORY / "conformance" / "cases" / "control").glob("*.src"))
    text = foundry.chance.choice(cases).read_text(encoding="utf-8")
    (folder / "control").mkdir(exist_ok=True)
    return _put(folder / "control", "case.src", foundry.text(text))


#: Standard error as it is before anything captures it.
_STDERR = os.dup(2)


class Watch:
    """Tells which input hangs: a hang in C cannot be broken off from inside."""

    def __init__(self) -> None:
        self.doing = ""
        self.since = time.monotonic()
        threading.Thread(target=self._look, daemon=True).start()

    def begin(self, doing: str) -> None:
        """An input begins; an empty text: none does."""
        self.doing, self.since = doing, time.monotonic()

    def _look(self) -> None:
        while True:
            time.sleep(1)
            if self.doing and time.monotonic() - self.since > LONGEST:
                os.write(_STDERR, f"\nHANG: {self.doing}\n".encode("utf-8", "replace"))
                os._exit(1)


def _plan() -> Iterator[tuple[str, int]]:
    """Entry points with the numbers of their inputs."""
    shares = sum(share for share, _ in ENTRIES.values())
    number = 0
    for name, (share, _) in ENTRIES.items():
        for _ in range(max(1, round(INPUTS * share / shares))):
            if not ONLY or name in ONLY:
                yield name, number
            number += 1


def test_nothing_breaks_and_nothing_escapes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Every input ends with 0, 1 or 2, one clear line on stderr for 2, and nothing outside."""
    monkeypatch.chdir(tmp_path)
    watch, went, slowest = Watch(), Counter[tuple[str, int]](), (0.0, "")
    for name, number in _plan():
        folder = tmp_path / "input"
        folder.mkdir()
        foundry = _seeded(number)
        arguments = ENTRIES[name][1](folder, foundry)
        watch.begin(f"{name}, input {number}: {arguments}")
        began = time.monotonic()
        status = main(arguments)
        slowest = max(slowest, (time.monotonic() - began, f"{name} {number}"))
        out, err = capfd.readouterr()
        said = f"{name}, input {number}: {arguments}: {err[-600:]!r}"
        assert status in (0, 1, 2), said
        assert "defect in krl" not in err, said
        assert "Traceback" not in err, said
        assert "\x1b" not in out + err, f"a raw escape: {said}"
        if status == 2:
            assert err.strip(), said
        outside = [
            p.name for p in tmp_path.iterdir() if p.name not in ("input", "reports", ".krl-cache")
        ]
        assert not outside, f"written outside: {outside}: {said}"
        for page in folder.rglob("*.html"):
            assert "<script>alert(1)" not in page.read_text(encoding="utf-8"), said
        for record in folder.rglob("survey.json"):
            json.loads(record.read_text(encoding="utf-8"))
        went[name, status] += 1
        _clear(folder)
    watch.begin("")
    with capfd.disabled():
        print()
        for name in ENTRIES:
            counts = {status: went[name, status] for status in (0, 1, 2)}
            print(f"{name:16} {sum(counts.values()):6}  by status {counts}")
        print(f"{'all':16} {sum(went.values()):6}  slowest {slowest[0]:.1f} s ({slowest[1]})")
    assert sum(went.values()) == len(list(_plan()))
    assert ONLY or sum(went.values()) >= INPUTS * 0.95


_FOUNDRY: list[Foundry] = []


def _seeded(number: int) -> Foundry:
    """The same foundry with the chance of this number: reading our programs again takes long."""
    if not _FOUNDRY:
        _FOUNDRY.append(Foundry(SEED))
    _FOUNDRY[0].chance.seed(SEED + number)
    return _FOUNDRY[0]


def _clear(folder: Path) -> None:
    for path in sorted(folder.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
    folder.rmdir()
