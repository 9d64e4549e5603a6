"""`krl growth` from the outside: statuses, files written, and what reaches the terminal."""

import json
from pathlib import Path
from typing import Any

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert
from krl.cli import main
from recovery.ledger.construct import Construct, Evidence
from recovery.ledger.construct_file import text_of

STEP = "DEF A()\nFOR I=1 TO 9 STEP 2\nENDFOR\nEND\n"
FILES = {
    "fine.src": "DEF A()\nHALT\nEND\n",
    "step.src": STEP,
    "copies/step.src": STEP,
    "halt.src": "DEF A()\nHALT 1\nEND\n",
    "never.src": "DEF A()\nA=1 2\x1b[31m\nEND\n",
    "table.dat": "1;2;3\n4;5;6\n",
}
CONTRACT = {
    *("number", "id", "title", "state", "grounds", "files", "parsed", "bytes", "parsed_bytes"),
    *("restored", "failing_lines", "metrics"),
}

pytestmark = pytest.mark.usefixtures("elsewhere")


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    root = tmp_path / "corpus"
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_bytes(text.encode())
    return root


@pytest.fixture
def ledger(tmp_path: Path) -> Path:
    """Two accepted constructs."""

    def write(number: int, title: str, *edits: Edit) -> None:
        evidence = Evidence(files=3, origins=2, lines=5)
        made = Construct(title.lower(), title, edits, number, "accepted", "", evidence, ("X",))
        file = tmp_path / "ledger" / f"{made.id}.toml"
        file.parent.mkdir(exist_ok=True)
        file.write_text(text_of(made), encoding="utf-8", newline="\n")

    write(1, "Step", AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?"))
    write(2, "Halt", AddAlternative("halt", "HALT INTEGER"))
    return tmp_path / "ledger"


def growth(*arguments: str | Path) -> int:
    """Run `krl growth` in this process."""
    return main(["growth", "--jobs", "1", *map(str, arguments)])


def record(folder: Path) -> dict[str, Any]:
    loaded = json.loads((folder / "growth.json").read_text("utf-8"))
    assert isinstance(loaded, dict)
    return loaded


def test_the_record_keeps_its_contract(corpus: Path, ledger: Path, tmp_path: Path) -> None:
    """Fields that others read, and the figures of three steps."""
    out = tmp_path / "out"
    assert 0 == growth(corpus, "--constructs", ledger, "--out", out)
    found = record(out)
    assert all(step.keys() >= CONTRACT for step in found["steps"])
    assert [(0, 1, 0), (1, 3, 2), (2, 4, 1)] == [
        (s["number"], s["parsed"], s["restored"]) for s in found["steps"]
    ]
    assert [("never.src", 2, "2", "A=1 2\x1b[31m")] == [
        (Path(x["path"]).name, x["line"], x["token"], x["text"]) for x in found["remaining"]
    ]
    assert {"version", "generated", "grammar", "grammar_sha256", "seconds"} <= found.keys()


def test_record_and_page_are_written(corpus: Path, ledger: Path, tmp_path: Path) -> None:
    """Beside each other, and the record where it is wanted too."""
    wanted = tmp_path / "deep" / "record.json"
    assert 0 == growth(corpus, "--constructs", ledger, "--out", "out", "--json", wanted)
    assert record(Path("out")) == json.loads(wanted.read_text("utf-8"))
    page = Path("out", "index.html").read_text("utf-8")
    assert "From 20.0 % of the files to 80.0 % in 2 constructs." in page
    assert {"cache", "growth.json", "index.html"} == {p.name for p in Path("out").iterdir()}


def test_the_terminal_shows_the_steps(
    corpus: Path, ledger: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first, the last and the biggest; what remains; nothing that steers a terminal."""
    growth(corpus, "--constructs", ledger, "--out", tmp_path / "out")
    said = capsys.readouterr().out
    for words in ("5 files", "2 constructs", "Step", "Halt", "20.0 %", "80.0 %", "never.src"):
        assert words in said
    assert "remains: " in said
    assert "\x1b" not in said
    assert f"Page: {tmp_path / 'out' / 'index.html'}" in said
