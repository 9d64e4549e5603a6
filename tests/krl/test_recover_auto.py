"""`krl recover --auto` from the outside: what it writes, how it goes on, what it refuses."""

import json
import shutil
from pathlib import Path
from random import Random
from typing import Any

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.wellformed import problem
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from krl.cli import main
from recovery.induction import target_comparison
from recovery.induction.induced_ledger import without, without_some
from recovery.induction.language import KRL
from recovery.induction.target_comparison import compared, within_reach
from recovery.ledger.ledger import Ledger, in_force

NEGATIVES = GRAMMAR.parents[1] / "corpus" / "negatives"
PRELIMINARY = GRAMMAR.with_name("preliminary.g4")
TEXTS = (
    "DEF {0}()\nFOR I=1 TO 9 STEP 2\nENDFOR\nRETURN {0}1\nEND\n",
    "DEF {0}()\nFOR I=1 TO 9 STEP {0}2\nENDFOR\nGOTO L{0}\nEND\n",
    "DEF {0}()\nSWITCH {0}I\nCASE 1\nHALT\nCASE 2\nHALT\nDEFAULT\nHALT\nENDSWITCH\nEND\n",
    "DEF {0}()\nGOTO {0}M\nRETURN {0}2+1\n"
    "SWITCH {0}J\nCASE 3\nHALT\nDEFAULT\nHALT\nENDSWITCH\nEND\n",
)
pytestmark = pytest.mark.usefixtures("elsewhere")


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three origins with the same four things that the restrictive start lacks."""
    root = tmp_path_factory.mktemp("corpus")
    for origin in ("ORANGE", "PEAR", "QUINCE"):
        for number, text in enumerate(TEXTS):
            file = root / origin / "KRC" / f"P{number}.src"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text.format(origin[0] + str(number)))
    return root


def auto(*arguments: str | Path) -> int:
    """Run `krl recover --auto` in this process."""
    return main(["recover", "--auto", *map(str, arguments)])


def record(out: Path) -> dict[str, Any]:
    """What a run wrote."""
    loaded = json.loads((out / "auto.json").read_text("utf-8"))
    assert isinstance(loaded, dict)
    return loaded


@pytest.fixture(scope="module")
def out(corpus: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with a third of the origins held out."""
    folder = tmp_path_factory.mktemp("out")
    options = ("--hold-out", "0.33", "--seed", "3", "--target", GRAMMAR)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(target_comparison, "_SENTENCES", 200)
        patched.setattr(target_comparison, "_NEGATIVES", 2_000)
        assert auto(corpus, *options, "--out", folder) == 0
    return folder


def test_both_halves_parse_in_the_end(out: Path) -> None:
    """What several origins show is found, and holds for the origin held out."""
    last = record(out)["rounds"][-1]
    assert ((8, 8), (4, 4)) == (
        (last["shown"]["parsed"], last["shown"]["files"]),
        (last["held"]["parsed"], last["held"]["files"]),
    )


def test_the_grown_grammar_is_compared_with_the_target(out: Path) -> None:
    """Of the files that the target parses all are read, and most random sentences are its own."""
    target = record(out)["target"]
    assert ("KRL.g4", {"count": 8, "of": 8}, {"count": 4, "of": 4}) == (
        target["name"],
        target["shown"],
        target["held"],
    )
    assert (200, 2_000) == (
        target["sentences_rejected"]["of"],
        target["negatives_accepted"]["of"],
    )
    grown = read_file(out / "grammar.g4")
    assert record(out)["rules"] == len(grown.parser_rules)
    page = (out / "index.html").read_text("utf-8")
    assert "of its random sentences are rejected by KRL.g4" in page


def test_files_beyond_reach_are_reported(corpus: Path) -> None:
    """A file with a reserved word that no file shown has is not within reach; the word is told."""
    files = KRL.files([corpus])
    shown = [file for file in files if "SWITCH" not in file.text]
    held = [file for file in files if "SWITCH" in file.text]
    words = ["CASE", "DEFAULT", "ENDSWITCH", "HALT", "SWITCH"]
    assert ([], words) == within_reach(Recognizer(read_file(GRAMMAR)), shown, held)
    assert (shown, []) == within_reach(Recognizer(read_file(GRAMMAR)), files, shown)


@pytest.mark.parametrize("seed", [2, 4, 1125084])
def test_constructs_are_drawn_and_taken_out(seed: int) -> None:
    """The ledger without some constructs, and what needs them, reads nothing that it does not."""
    ledger = Ledger.read(GRAMMAR.with_name("constructs")).accepted
    start = read_file(PRELIMINARY)
    grammar, gone = without_some(start, ledger, 15, seed)
    assert 15 <= len(gone) < len(ledger)
    assert problem(grammar) is None
    left, again = without(start, ledger, [construct.id for construct in gone])
    assert (gone, grammar.text) == (again, in_force(start, left).text)
    whole, random = Recognizer(read_file(GRAMMAR)), Random(seed)
    sentences, speller = Sentences(grammar), Speller(grammar)
    for _ in range(60):
        text = speller.text(sentences.random(random))
        assert whole.run(whole.start, whole.kinds(text))[1] is None, text


def test_what_the_target_rejects_is_counted(corpus: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Most sentences of a wider grammar are none of a narrow target, which reads no file here."""
    monkeypatch.setattr(target_comparison, "_SENTENCES", 200)
    monkeypatch.setattr(target_comparison, "_NEGATIVES", 100)
    start, grown = read_file(PRELIMINARY), read_file(GRAMMAR)
    found = compared(start, grown, start, KRL.files([corpus]), ())
    assert {"count": 0, "of": 0} == found["shown"]
    assert 100 < found["sentences_rejected"]["count"] < 200
    assert found["sentences_rejected"] == found["sentences_rejected_for_growth"]
    nothing = compared(grown, grown, start, (), ())
    assert {"count": 0, "of": 200} == nothing["sentences_rejected_for_growth"]


def test_the_ledger_gives_the_grammar(out: Path) -> None:
    """The constructs written, replayed on the start, give the grammar written, byte for byte."""
    constructs = Ledger.read(out / "constructs").constructs
    grown = in_force(read_file(out / "start.g4"), constructs)
    assert (out / "grammar.g4").read_bytes() == grown.text.encode()


def test_the_page_shows_steps(out: Path) -> None:
    """Each step is on the page with its ID."""
    page = (out / "index.html").read_text("utf-8")
    ids = [step["id"] for done in record(out)["rounds"] for step in done["taken"]]
    assert ids
    assert [] == [name for name in ids if name not in page]


def test_a_step_is_struck_out(corpus: Path, out: Path, tmp_path: Path) -> None:
    """Without its step a construct stays out, also when the run goes on."""
    shutil.copytree(out, tmp_path, dirs_exist_ok=True)
    constructs = Ledger.read(tmp_path / "constructs").constructs
    goto = next(c.id for c in constructs if c.title.startswith("GOTO"))
    assert auto(corpus, "--out", tmp_path, "--strike", goto) == 0
    assert [] == [
        c.id
        for c in Ledger.read(tmp_path / "constructs").constructs
        if c.edits == next(k.edits for k in constructs if k.id == goto)
    ]


def test_an_interrupted_run_keeps_what_was_done(
    corpus: Path, out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C leaves the rounds so far, and --resume ends where a whole run does, to the byte."""
    from recovery.induction.rounds import Induction

    whole = Induction.rounds

    def two(self: Induction, most: int = 30) -> Any:
        for number, done in enumerate(whole(self, most)):
            if number == 2:
                raise KeyboardInterrupt
            yield done

    monkeypatch.setattr(target_comparison, "_SENTENCES", 2)
    monkeypatch.setattr(target_comparison, "_NEGATIVES", 2)
    options = ("--hold-out", "0.33", "--seed", "3", "--target", GRAMMAR, "--out", tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(Induction, "rounds", two)
        assert auto(corpus, *options) == 0
    assert (2, False) == (len(record(tmp_path)["rounds"]), record(tmp_path)["finished"])
    begun = record(tmp_path)
    assert auto(corpus, "--out", tmp_path, "--resume") == 0
    assert (out / "grammar.g4").read_bytes() == (tmp_path / "grammar.g4").read_bytes()
    kept = ("start", "without", "held_out", "hold_out", "seed", "suffix", "target_sha256")
    assert [begun[key] for key in kept] == [record(tmp_path)[key] for key in kept]
    assert "KRL.g4" == record(tmp_path)["target"]["name"]
    assert (1, 0.33, 3) == (len(begun["held_out"]), begun["hold_out"], begun["seed"])


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--hold-out", "0.5", "--hold-out 0.5: {} was begun with 0.33"),
        ("--seed", "4", "--seed 4: {} was begun with 3"),
        ("--suffix", ".s", "--suffix .s: {} was begun with none"),
        ("--grammar", str(GRAMMAR), f"--grammar {GRAMMAR}: {{}} was begun with another grammar"),
        ("--target", str(PRELIMINARY), f"--target {PRELIMINARY}: {{}} was begun with another"),
    ],
)
def test_a_run_is_continued_with_its_own_options(
    corpus: Path,
    out: Path,
    option: str,
    value: str,
    said: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Another share, seed, suffix or grammar than at the start is refused in one line."""
    assert auto(corpus, "--out", out, "--resume", option, value) == 2
    assert f"krl: {said.format(out)}\n" == capsys.readouterr().err


@pytest.mark.parametrize("text", ["", "[]", '{"held_out": [[]]}', '{"seed": "x"}', '{"seed": []}'])
def test_a_record_that_is_none(
    corpus: Path, out: Path, tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is no record of a run is named in one line."""
    shutil.copy(out / "start.g4", tmp_path)
    (tmp_path / "auto.json").write_text(text)
    assert auto(corpus, "--out", tmp_path, "--resume") == 2
    file = tmp_path / "auto.json"
    assert f"krl: {file}: not the record of an automatic recovery\n" == capsys.readouterr().err


@pytest.mark.parametrize("options", [["--grammar", "{}/start.g4"], ["--resume", "--out", "{}"]])
def test_a_start_without_line_ends(
    corpus: Path, tmp_path: Path, options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """A start that skips line ends is refused, also one that lies where growing is to go on."""
    start = tmp_path / "start.g4"
    start.write_text("grammar S;\nstart : WORD* EOF ;\nWORD : [A-Z]+ ;\nEND : '\\n' -> skip ;\n")
    (tmp_path / "constructs").mkdir()
    (tmp_path / "auto.json").write_text("{}")
    assert auto(corpus, *(option.format(tmp_path) for option in options)) == 2
    assert "no token of line ends" in capsys.readouterr().err


def test_negatives_are_the_same_when_a_run_goes_on(
    corpus: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """They need not be given again, and must not have changed."""
    written, out = tmp_path / "negatives", tmp_path / "out"
    written.mkdir()
    file = next(NEGATIVES.rglob("*.src"))
    shutil.copy(file, written)
    assert auto(corpus, "--negatives", written, "--out", out) == 0
    assert auto(corpus, "--out", out, "--resume") == 0
    (written / file.name).write_text(f"{file.read_text('utf-8')}\n")
    assert auto(corpus, "--out", out, "--resume") == 2
    assert f"{out} was begun with another" in capsys.readouterr().err


def test_an_unknown_step(out: Path, corpus: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A step that there is not is named."""
    assert auto(corpus, "--out", out, "--strike", "9999-nothing") == 2
    assert "no construct 9999-nothing; the first is 0001-" in capsys.readouterr().err
