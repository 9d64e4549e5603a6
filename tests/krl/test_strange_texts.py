"""Names of files and texts of programs steer nothing, wherever they come out."""

import csv
import json
import re
import sys
import xml.etree.ElementTree as ET
from html.parser import HTMLParser
from pathlib import Path

import pytest

from krl.cli import main

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no such names of files")

#: What steers a terminal, a page, a log of GitHub or a spreadsheet, and half of a character.
STRANGE = '=1+1\x1b[31m[/bold]\n::error::x\u202e"><img src=x onerror=alert(1)><script>x\udcff'
PROGRAM = f"""DEF A()
INT I ; {STRANGE!r} <script>alert(1)</script>
CHAR C[9]
C[]="<img src=x onerror=alert(1)>\x1b[31m\u202e"
U\x9b31m=1
I="<script>alert(1)</script>"
[/bold] [link=file:///]A[/link] :smile: 3 4
I=1\x08\x08\x00 \u2066 9
BOGUS <script>alert(1)</script> \x1b]0;x\x07
HALT
END
"""
STEERING = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")

#: What is printed or written, by the words of a command; ``{0}`` is the folder of the program.
OUTPUTS = {
    "check, text": "check --no-cache {0}",
    "check, JSON": "check --no-cache --format json --out out/c.json {0}",
    "check, SARIF": "check --no-cache --format sarif --out out/c.json {0}",
    "check, GitHub": "check --no-cache --format github {0}",
    "check, JUnit": "check --no-cache --format junit --out out/c.xml {0}",
    "fixes": "check --no-cache --diff {0}",
    "format": "format --check {0}",
    "diff, text": "diff {0} other",
    "diff, page": "diff --html out/d.html --json out/d.json {0} other",
    "survey": "recover --no-start --jobs 1 --out out --json out/s.json {0}",
    "growth of the ledger": "growth --jobs 1 --out out --json out/g.json {0}",
    "growth by itself": "recover --auto --jobs 1 --out out {0}",
    "run": "run --robot none --max-time 1 --trace out/t.json --html out/r.html {1}",
    "path as a table": "run --robot kinematic --max-time 1 --path out/p.csv {1}",
    "compile": "compile -o out/a.krlb {1}",
    "fixes of the text": "check --no-cache --fix {0}",
    "baseline": "check --no-cache --write-baseline out/b.json {0}",
    "debugger": "debug --robot none --max-time 1 {1}",
    "unit tests": "test --junit out/t.xml --cov-html out/t --lcov out/t.info {0}",
    "points of an arm": "robot status-turn --machine {1} {1}",
    "assembler": "asm -o out/a.krlb {1}",
    "image": "disasm {1}",
    "code of strangers": "bench real-code --executor vm --json out/c.json {0}",
    "programs of strangers": "bench programs --executor vm --jobs 1 --json out/p.json {0}",
    "a name on the command line": "explain {1}",
    "a case on the command line": "conform --robot none {1}",
}


class Tags(HTMLParser):
    """The tags of a page with their attributes."""

    def __init__(self) -> None:
        super().__init__()
        self.dangerous: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep what would run."""
        self.dangerous += [f"{tag} {name}" for name, _ in attrs if name.startswith("on")]


@pytest.mark.parametrize("output", OUTPUTS)
def test_nothing_is_steered(
    output: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Terminals get nothing but text, records can be read, and nothing of it runs in a page."""
    monkeypatch.chdir(tmp_path)
    folder = Path(f"in{STRANGE.replace('/', '')}")
    folder.mkdir()
    Path("other").mkdir()
    program = folder / f"a{STRANGE.replace('/', '')}.src"
    program.write_text(PROGRAM, encoding="utf-8", errors="surrogateescape")
    assert main([word.format(folder, program) for word in OUTPUTS[output].split()]) in (0, 1, 2)
    out, err = capfd.readouterr()
    assert None is STEERING.search(out + err)
    assert [] == [line for line in out.splitlines() if line.startswith(("::error::x", "=1"))]
    for path in Path("out").rglob("*"):
        _check(path)


def _check(path: Path) -> None:
    if path.suffix == ".json":
        for line in path.read_text(encoding="utf-8").splitlines():
            assert None is STEERING.search(line)
        if path.name != "t.json":  # a record a line
            json.loads(path.read_text(encoding="utf-8"))
    elif path.suffix == ".csv":
        with path.open(encoding="utf-8", newline="") as file:
            cells = [cell for row in csv.reader(file) for cell in row]
        assert [] == [cell for cell in cells if re.match(r"[=+@\t\r]|-[^0-9.]", cell)]
    elif path.suffix == ".info":
        assert None is STEERING.search(path.read_text(encoding="utf-8"))
    elif path.suffix == ".xml":
        ET.parse(path)
    elif path.suffix == ".html":
        page = path.read_text(encoding="utf-8")
        tags = Tags()
        tags.feed(page)
        assert ([], False) == (tags.dangerous, "<script>alert(1)" in page)
