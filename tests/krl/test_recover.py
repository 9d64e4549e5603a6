"""`krl recover` from the outside: statuses, files written, and what reaches the terminal."""

import json
import os
import subprocess
import sys
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from grammar.notation.edits import AddToken, Insert, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from krl.cli import main
from recovery.ledger.construct import Construct, Evidence
from recovery.ledger.construct_file import text_of

PRELIMINARY = GRAMMAR.with_name("preliminary.g4")
FINE = b"DEF A()\nHALT\nEND\n"
STEP = b"DEF A()\r\nFOR I=1 TO 9 STEP %s\r\nENDFOR\r\nEND\r\n"
RETURN = b"DEF B()\nRETURN 1\nEND\n"
#: What the small grammar of the tests does not read; it is surveyed in no time.
TWO = b"DEF B()\nWAIT X Y\nEND\n"
pytestmark = pytest.mark.usefixtures("elsewhere")


def lay(root: Path, **files: bytes) -> Path:
    """Make `root` a folder with programs, each in a folder of its own."""
    for name, data in files.items():
        (root / name).mkdir(parents=True, exist_ok=True)
        (root / name / f"{name}.src").write_bytes(data)
    return root


def several_causes(root: Path) -> Path:
    """Two causes in four files, one file that is fine, and one that is no KRL."""
    steps = {f"step{n}": STEP % word for n, word in enumerate((b"2", b"K", b"LONG"))}
    return lay(root, **steps, back=RETURN, fine=FINE, junk=bytes(range(256)) * 9)


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    return several_causes(tmp_path / "corpus")


def recover(*arguments: str | Path, grammar: Path = PRELIMINARY) -> int:
    """Run `krl recover` in this process."""
    return main(["recover", "--grammar", str(grammar), "--jobs", "1", *map(str, arguments)])


@pytest.fixture
def small(tmp_path: Path, small_grammar: str) -> Path:
    """The small grammar of the tests as a file."""
    file = tmp_path / "small.g4"
    file.write_text(small_grammar, encoding="utf-8", newline="\n")
    return file


def record(folder: Path) -> dict[str, Any]:
    loaded = json.loads((folder / "survey.json").read_text("utf-8"))
    assert isinstance(loaded, dict)
    return loaded


def settled(data: dict[str, Any]) -> dict[str, Any]:
    """A record without what differs from run to run."""
    return {k: v for k, v in data.items() if "seconds" not in k and k != "generated"}


def tree(root: Path) -> dict[str, bytes]:
    return {str(p.relative_to(root)): p.read_bytes() for p in root.rglob("*") if p.is_file()}


@dataclass(frozen=True)
class Surveyed:
    """A survey in ``root``: its status, what reached the terminal, and what was there before."""

    root: Path
    status: int
    said: str
    before: dict[str, bytes]

    @property
    def out(self) -> Path:
        """The output folder."""
        return self.root / "new" / "out"


@pytest.fixture(scope="module")
def surveyed(tmp_path_factory: pytest.TempPathFactory) -> Surveyed:
    """One survey of a corpus; its record goes into a file that was there, too."""
    root = tmp_path_factory.mktemp("surveyed")
    corpus = several_causes(root / "corpus")
    (root / "record.json").write_text("x" * 100_000, encoding="utf-8")
    before = tree(root)
    with redirect_stdout(StringIO()) as said, pytest.MonkeyPatch.context() as patched:
        patched.chdir(tmp_path_factory.mktemp("elsewhere"))  # where no negatives lie
        patched.setenv("XDG_CACHE_HOME", str(root / "cache"))
        patched.setenv("LOCALAPPDATA", str(root / "cache"))
        status = recover(corpus, "--out", root / "new" / "out", "--json", root / "record.json")
    return Surveyed(root, status, said.getvalue(), before)


# -------------------------------------------------------------------------------- statuses


def test_failures_are_what_a_survey_is_for(surveyed: Surveyed, small: Path, tmp_path: Path) -> None:
    """A completed survey is fine, whatever it found; `--strict` makes failures findings."""
    assert 0 == surveyed.status
    root = lay(tmp_path / "corpus", two=TWO)
    assert 1 == recover(root, "--out", tmp_path / "out", "--strict", grammar=small)


def test_strict_is_content_where_every_file_parses(tmp_path: Path) -> None:
    """What is skipped is no finding."""
    root = lay(tmp_path / "corpus", fine=FINE, junk=b"\0\1\2" * 99)
    assert 0 == recover(root, "--out", tmp_path / "out", "--strict")


# ---------------------------------------------------------------------------- what it writes


def test_page_and_record_are_written_to_the_output_folder(surveyed: Surveyed) -> None:
    """The page is one file with its clusters in it, the record is JSON, and neither is a part."""
    page = (surveyed.out / "index.html").read_text("utf-8")
    data = record(surveyed.out)
    assert 2 == len(data["clusters"])
    assert all(entry["id"] in page for entry in data["clusters"])
    assert [] == list(surveyed.root.rglob(".part-*"))


def test_the_record_says_what_was_surveyed(surveyed: Surveyed) -> None:
    """Counts, causes and the grammar are those of the corpus named."""
    data = record(surveyed.out)
    assert PRELIMINARY.as_posix() == data["grammar"]
    assert (5, 1, 1) == (data["files"], data["parsed"], len(data["skipped"]))
    assert [("FOR with STEP", 3), ("RETURN followed by an integer", 1)] == [
        (entry["title"], entry["unlocks"]) for entry in data["clusters"]
    ]


def test_json_is_the_record_too(surveyed: Surveyed) -> None:
    """`--json` writes the same record where it is wanted, and replaces what was there whole."""
    target = surveyed.root / "record.json"
    assert record(surveyed.out) == json.loads(target.read_text("utf-8"))


def test_nothing_is_written_but_where_it_was_asked_for(surveyed: Surveyed, elsewhere: Path) -> None:
    """The corpus, the working directory and all around them stay as they were."""
    asked = ("new", "cache", "record.json")
    after = {name: data for name, data in tree(surveyed.root).items() if not name.startswith(asked)}
    assert {n: d for n, d in surveyed.before.items() if n != "record.json"} == after
    assert [] == list(elsewhere.iterdir())


# ------------------------------------------------------------------------------- the options


def test_another_grammar_finds_something_else(tmp_path: Path) -> None:
    """The grammar named is the one that is read under."""
    corpus = lay(tmp_path / "corpus", back=RETURN)
    wider = tmp_path / "wider.g4"
    text = PRELIMINARY.read_text("utf-8").replace(": RETURN\n", ": RETURN expression?\n")
    wider.write_text(text, encoding="utf-8")
    assert 0 == recover(corpus, "--out", tmp_path / "out", "--grammar", wider)
    assert 1 == record(tmp_path / "out")["parsed"]


def test_negatives_judge_the_proposals(tmp_path: Path) -> None:
    """A proposal that accepts a program of the folder named says so; without one none does."""
    corpus = lay(tmp_path / "corpus", back=RETURN)
    folder = tmp_path / "negatives"
    folder.mkdir()
    head = b";@ reason: no procedure returns a value\n;@ phase: parse\n"
    (folder / "returned.src").write_bytes(head + RETURN.replace(b"1", b"7"))
    accepted = []
    for options in ([], ["--negatives", str(folder)]):
        assert 0 == recover(corpus, "--out", tmp_path / "out", *options)
        (entry,) = record(tmp_path / "out")["clusters"]
        accepted.append({p["accepts_negatives"] for p in entry["proposals"] if p["restores"]})
    assert [{0}, {1}] == accepted


def test_the_working_directory_makes_no_difference(small: Path, tmp_path: Path) -> None:
    """As a process of its own, from another folder, absolute paths are all it needs."""
    corpus = lay(tmp_path / "corpus", two=TWO)
    assert 0 == recover(corpus, "--out", tmp_path / "here", grammar=small)
    options = ["--out", str(tmp_path / "there"), "--jobs", "1", "--grammar", str(small)]
    done = subprocess.run(
        [sys.executable, "-m", "krl", "recover", str(corpus), *options],
        cwd=corpus,
        capture_output=True,
        check=False,
    )
    assert (0, b"") == (done.returncode, done.stderr)
    assert settled(record(tmp_path / "here")) == settled(record(tmp_path / "there"))


def test_the_default_grammar_is_found_from_anywhere(tmp_path: Path) -> None:
    """Without `--grammar` the grammar in force is read, wherever one stands."""
    corpus = lay(tmp_path / "corpus", fine=FINE)
    assert 0 == main(["recover", str(corpus), "--out", str(tmp_path / "out"), "--jobs", "1"])
    assert "grammar/KRL.g4" == record(tmp_path / "out")["grammar"]


def test_the_default_corpus_is_that_of_the_folder(elsewhere: Path) -> None:
    """Without a path `corpus/` is surveyed, and the page goes below `reports/out`."""
    lay(elsewhere / "corpus", back=RETURN)
    assert 0 == recover()
    (page,) = (elsewhere / "reports" / "out").rglob("index.html")
    assert 1 == record(page.parent)["files"]


# ------------------------------------------------------------------------------ the terminal


def test_the_terminal_shows_the_figures_and_the_first_causes(surveyed: Surveyed) -> None:
    """Files, share that parses, each cluster with its identity, and where the page is."""
    said = surveyed.said
    assert said.startswith("5 files, ")
    assert "parsed 1 (20.0 % of files" in said
    assert "skipped 1; surveyed in " in said
    assert all(entry["id"] in said for entry in record(surveyed.out)["clusters"])
    assert said.endswith(f"Page: {surveyed.out / 'index.html'}\n")


def test_skipped_files_are_counted_on(
    tmp_path: Path, small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first five are listed, and it says how many are not."""
    junk = {f"junk{n}": bytes(range(256)) * (n + 9) for n in range(7)}
    assert 0 == recover(lay(tmp_path / "c", **junk, fine=FINE), "--out", tmp_path, grammar=small)
    said = capsys.readouterr().out.splitlines()
    assert 5 == sum(line.startswith("skipped ") for line in said)
    assert "… and 2 more skipped" in said


def test_a_corpus_that_parses_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where nothing is missing there is no table."""
    lay(tmp_path / "corpus", fine=FINE)
    assert 0 == recover(tmp_path / "corpus", "--out", tmp_path / "out")
    assert "Nothing is missing" in capsys.readouterr().out


def test_an_output_folder_may_be_called_anything(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Brackets and colons in a name are no markup."""
    corpus = lay(tmp_path / "corpus", fine=FINE)
    out = tmp_path / "[bold]out[-b] :smile:"
    if os.name == "nt":
        out = tmp_path / "[bold]out[-b]"
    assert 0 == recover(corpus, "--out", out)
    assert f"Page: {out / 'index.html'}" in capsys.readouterr().out


# --------------------------------------------------------------------- the restrictive start


@pytest.fixture
def grown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A grammar in force that is the start and one construct."""
    home = tmp_path / "grammar"
    (home / "constructs").mkdir(parents=True)
    edits = (AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?"))
    made = Construct("for-step", "FOR … STEP", edits, 1, "accepted", evidence=Evidence(3, 2, 4))
    ledger = home / "constructs" / "0001-for-step.toml"
    ledger.write_text(text_of(made), encoding="utf-8", newline="\n")
    start = read_file(PRELIMINARY)
    (home / "preliminary.g4").write_bytes(start.text.encode())
    (home / "KRL.g4").write_bytes(apply(start, edits).text.encode())
    # first the module that takes the path over from the other when it is imported
    for module in ("krl_grammar", "generate"):
        monkeypatch.setattr(f"grammar.notation.{module}.GRAMMAR", home / "KRL.g4")
    return home


@pytest.mark.usefixtures("grown")
def test_the_start_is_surveyed_beside_the_grammar_in_force(
    corpus: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its clusters lead to what answered them; what others read stays that of the grammar."""
    assert 0 == main(["recover", str(corpus), "--out", str(tmp_path / "out"), "--jobs", "1"])
    found = record(tmp_path / "out")
    assert ("grammar/KRL.g4", 5, 4) == (found["grammar"], found["files"], found["parsed"])
    start = found["start"]
    assert ("grammar/preliminary.g4", 5, 1) == (start["grammar"], start["files"], start["parsed"])
    answers = {c["title"].split()[0]: c["answered_by"] for c in start["clusters"]}
    assert {"FOR": "0001-for-step", "RETURN": None} == answers
    assert ["FOR … STEP"] == [c["title"] for c in start["constructs"]]
    assert (
        "of its 2 clusters 1 are answered by constructs (1, 2.0 clusters each)"
        in capsys.readouterr().out
    )
    page = (tmp_path / "out" / "index.html").read_text("utf-8")
    assert page.index('id="rows"') < page.index('id="start-rows"')


@pytest.mark.usefixtures("grown")
def test_the_page_comes_before_the_causes(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It says what is still being computed, once for each grammar; what is kept is not awaited."""
    shown: list[tuple[str | None, int, int]] = []

    def write(record: dict[str, Any], folder: Path) -> Path:
        pending = record.get("pending")
        shown.append((pending, len(record["clusters"]), len(record.get("start", ()))))
        return folder / "index.html"

    monkeypatch.setattr("reports.recovery.survey_page.write_survey_page", write)
    given = ["recover", str(corpus), "--out", str(tmp_path / "out"), "--jobs", "1"]
    assert 0 == main(given)
    assert [
        ("the causes of failures, in 1 file", 0, 0),
        ("the causes of failures under the restrictive start, in 4 files", 1, 0),
    ] == shown[:2]
    assert (None, 1) == shown[2][:2]
    assert 3 == len(shown)
    assert 0 == main(given)
    assert shown[2:3] == shown[3:]


@pytest.mark.parametrize("given", [["--no-start"], ["--grammar", "{grown}/KRL.g4"]])
def test_the_start_can_be_left_out(given: list[str], grown: Path, tmp_path: Path) -> None:
    """When asked, and where another grammar is named."""
    corpus = lay(tmp_path / "corpus", step=STEP % b"2")
    options = [word.format(grown=grown) for word in given]
    assert 0 == main(["recover", str(corpus), "--out", str(tmp_path / "out"), *options])
    assert "start" not in record(tmp_path / "out")


def test_a_grammar_that_is_the_start_is_surveyed_once(grown: Path, tmp_path: Path) -> None:
    """Nothing has grown yet."""
    corpus = lay(tmp_path / "corpus", back=RETURN)
    (grown / "KRL.g4").write_bytes((grown / "preliminary.g4").read_bytes())
    assert 0 == main(["recover", str(corpus), "--out", str(tmp_path / "out"), "--jobs", "1"])
    assert "start" not in record(tmp_path / "out")


@pytest.mark.usefixtures("grown")
def test_where_nothing_is_missing_the_page_shows_the_growth(tmp_path: Path) -> None:
    """A friendly first screen, then how it got there."""
    root = lay(tmp_path / "corpus", fine=FINE, step=STEP % b"2")
    assert 0 == main(["recover", str(root), "--out", str(tmp_path / "out"), "--strict"])
    page = (tmp_path / "out" / "index.html").read_text("utf-8")
    assert "Nothing is missing: every file parses under this grammar" in page
    assert 'href="#story"' in page


def test_a_damaged_ledger_is_one_clear_line(
    grown: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Said before the work; without the start it does not matter."""
    corpus = lay(tmp_path / "corpus", step=STEP % b"2")
    (grown / "constructs" / "0001-for-step.toml").write_text("title = ", encoding="utf-8")
    assert 2 == main(["recover", str(corpus), "--out", str(tmp_path / "out")])
    said, complaint = capsys.readouterr()
    assert ("", 1) == (said, complaint.count("\n"))
    assert "0001-for-step.toml" in complaint
    assert 0 == main(["recover", str(corpus), "--out", str(tmp_path / "out"), "--no-start"])
