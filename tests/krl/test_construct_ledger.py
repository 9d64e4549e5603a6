"""`krl construct` on a checkout: list, show, try, accept, replay, oracle."""

import json
import shutil
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddAlternative, AddToken, Insert
from krl.cli import main
from recovery.ledger.construct import Construct, Effect, Evidence
from recovery.ledger.construct_file import read, text_of

REPOSITORY = Path(__file__).parents[2]
GRAMMAR = Path(g4.__file__).parents[1]
LOOP = "FOR I=1 TO 9 STEP 2\nENDFOR\n"
STEP = Construct(
    name="for-step",
    title="FOR … STEP",
    edits=(AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")),
    summary="A step.",
    evidence=Evidence(rules=("CTL-05",)),
    accept=(f"DEF A()\n{LOOP}END\n",),
    reject=("DEF A()\nFOR I=1 TO 9 STEP=2\nENDFOR\nEND\n",),
)
WEAVE = Construct(
    name="weave",
    title="WEAVE",
    edits=(AddToken("WEAVE"), AddAlternative("simpleStatement", "WEAVE expression")),
    accept=("DEF A()\nWEAVE 7\nEND\n",),
)

#: Runs `krl construct`; gives its status, and what it printed.
Run = Callable[..., tuple[int, str, str]]


def put(construct: Construct, folder: Path = Path("grammar", "constructs")) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"{construct.id}.toml"
    path.write_text(text_of(construct), encoding="utf-8", newline="\n")
    return path


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """A checkout with the restrictive start, an own program and two origins of other people."""
    monkeypatch.chdir(tmp_path)
    files = {
        "corpus/programs/cell/own.src": f"DEF OWN()\n{LOOP}END\n",
        "corpus/open/A__X/a.src": f"DEF A()\n{LOOP}END\n",
        "corpus/open/B__Y/b.src": f"DEF B()\n{LOOP}WEAVE 7\nEND\n",
        "corpus/negatives/n.src": ";@ reason: so\n;@ phase: parse\nDEF N()\nFOR I=1 TO\nEND\n",
    }
    for name, text in files.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text, encoding="utf-8", newline="\n")
    Path("grammar").mkdir()
    for name in ("preliminary.g4", "KRL.g4"):
        shutil.copyfile(GRAMMAR / "preliminary.g4", Path("grammar", name))

    def invoke(*arguments: object) -> tuple[int, str, str]:
        status = main(["construct", *map(str, arguments)])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return invoke


def everything() -> dict[Path, bytes]:
    kept = (p for p in Path("grammar").rglob("*") if p.is_file())
    return {path: path.read_bytes() for path in kept}


# ------------------------------------------------------------------------------ list and show


def test_an_empty_ledger_is_no_mistake(run: Run) -> None:
    """Nothing to list, nothing that waits, and the grammar is the start."""
    assert 0 == run("list")[0]
    assert (0, "nothing waits for a verdict\n", "") == run("oracle")
    assert (0, "grammar/KRL.g4 is the replay of 0 constructs\n", "") == run("replay", "--check")


def test_the_list_has_a_row_for_each_and_what_waits(run: Run, tmp_path: Path) -> None:
    """Number, title, state, grounds, files and origins; as data too."""
    put(replace(STEP, number=1, state="documented", evidence=Evidence(9, 3, 9, ("CTL-05",))))
    put(replace(WEAVE, number=2))
    status, out, _ = run("list", "--json", tmp_path / "new" / "list.json")
    _, first, second, _, _, waits = out.splitlines()
    assert 0 == status, out
    assert ["0001", "FOR … STEP", "documented", "corroborated, documented", "9 / 3"] == [
        cell.strip() for cell in first.split("  ") if cell.strip()
    ]
    assert "0002  WEAVE" in second
    assert "0002-weave  no ground, no origin shows it" == waits.strip()
    one, two = json.loads((tmp_path / "new" / "list.json").read_text(encoding="utf-8"))[
        "constructs"
    ]
    assert ("0001-for-step", 9, 3, "") == (one["id"], one["files"], one["origins"], one["waits"])
    assert "no ground, no origin shows it" == two["waits"]


def test_a_construct_is_shown_with_its_difference(run: Run) -> None:
    """By its number: summary, evidence, examples, effect, edits, and the lines that change."""
    effect = Effect(9, 8, 70, 60, 5, 4, 3, 0, 1, {"TERM": 77, "AVS": 4.25})
    put(replace(STEP, number=1, state="accepted", effect=effect))
    status, out, _ = run("show", 1)
    assert 0 == status, out
    for line in (
        "0001-for-step: FOR … STEP",
        "accepted; grounds: documented",
        "A step.",
        "  rules: CTL-05",
        "  FOR I=1 TO 9 STEP=2",
        "  8 of 9 files parse (60 of 70 bytes), 5 of them newly",
        "  metrics: TERM 77, AVS 4.25",
        "  reserve STEP",
        "+STEP : 'STEP' ;",
        "-    : FOR NAME '=' expression TO expression eol statement* ENDFOR",
    ):
        assert line in out.splitlines()


def test_what_does_not_fit_is_shown_as_such(run: Run) -> None:
    """A proposal that the grammar has moved away from."""
    put(replace(WEAVE, number=1, edits=(AddAlternative("none", "NAME"),)))
    status, out, _ = run("show", "weave")
    assert 0 == status, out
    assert "edit: there is no rule none" in out


# ----------------------------------------------------------------------------- try and accept


def test_a_construct_is_tried(run: Run, tmp_path: Path) -> None:
    """Its figures are shown and nothing is written, unless it is to be kept."""
    file = put(STEP, tmp_path)
    before = file.read_bytes()
    status, out, _ = run("try", file)
    assert 0 == status, out
    assert "evidence   2 files of 2 origins, 2 lines" in out
    assert "effect     1 of 2 files parse, 1 of them newly; own 1 of 1" in out
    assert before == file.read_bytes()
    assert 0 == run("try", file, "--keep")[0]
    assert ("documented", 2) == (read(file).state, read(file).evidence.origins)


def test_what_would_be_refused_has_status_1(run: Run, tmp_path: Path) -> None:
    """With the reason; and so has an edit that does not fit."""
    status, out, _ = run("try", put(WEAVE, tmp_path))
    assert 1 == status
    assert "refused    no ground: only one file shows it" in out
    status, out, _ = run("try", put(replace(WEAVE, edits=(AddToken("FOR"),)), tmp_path))
    assert 1 == status
    assert "refused: 0001-weave: " in out
    assert "token FOR exists already" in out


def test_another_corpus_may_be_named(run: Run, tmp_path: Path) -> None:
    """With --corpus the files there are the evidence, and only those."""
    out = run("try", put(STEP, tmp_path), "--corpus", "corpus/open/B__Y")[1]
    assert "evidence   1 file of 1 origin, 1 line" in out


def test_without_a_corpus_the_figures_are_kept(run: Run, tmp_path: Path) -> None:
    """And a line says so."""
    shutil.rmtree("corpus/open")
    status, out, _ = run("try", put(replace(STEP, evidence=Evidence(45, 12, 783)), tmp_path))
    assert 0 == status, out
    assert "evidence is kept as it is written" in out.splitlines()[0]
    assert "evidence   45 files of 12 origins, 783 lines (as written" in out


@pytest.mark.skipif(shutil.which("java") is None, reason="ANTLR needs Java")
def test_a_construct_is_accepted_and_the_check_holds(run: Run, tmp_path: Path) -> None:
    """Ledger, grammar and parser are written together, and are what the ledger says."""
    status, out, _ = run("accept", put(STEP, tmp_path))
    assert 0 == status, out
    assert out.endswith("; the grammar has 1 construct\n")
    accepted = read(Path("grammar", "constructs", "0001-for-step.toml"))
    assert ("accepted", 2) == (accepted.state, accepted.evidence.origins)
    assert (0, "grammar/KRL.g4 is the replay of 1 construct\n", "") == run("replay", "--check")
    assert "'STEP'" in Path("grammar/_generated/KRLParser.py").read_text(encoding="utf-8")
    before = everything()
    status, out, _ = run("accept", put(WEAVE, tmp_path))
    assert 1 == status
    assert "refused: 0002-weave: no ground" in out
    assert before == everything()


def test_without_java_nothing_is_accepted(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One line says what is missing, and status 2."""
    file = put(STEP, tmp_path)
    before = everything()
    monkeypatch.setenv("PATH", str(tmp_path))
    status, _, err = run("accept", file)
    assert (2, 1) == (status, err.count("\n"))
    assert "no java" in err
    assert before == everything()


# ------------------------------------------------------------------------------------- replay


def test_the_grammar_is_rebuilt_as_far_as_wanted(run: Run) -> None:
    """Whole, up to a number, or nothing but the start; to a file or to the terminal."""
    put(replace(STEP, number=1, state="accepted"))
    put(replace(WEAVE, number=2, state="accepted"))
    start = Path("grammar", "preliminary.g4").read_text(encoding="utf-8")
    assert (0, start, "") == run("replay", "--until", 0)
    out = run("replay", "--until", 1)[1]
    assert ("STEP : 'STEP' ;" in out, "WEAVE" in out) == (True, False)
    assert 0 == run("replay", "-o", "whole.g4")[0]
    assert "WEAVE : 'WEAVE' ;" in Path("whole.g4").read_text(encoding="utf-8")
    assert 2 == run("replay", "--check", "--until", 1)[0]


def test_the_check_has_a_line_for_each_finding(run: Run) -> None:
    """And status 1."""
    put(replace(STEP, number=1, state="accepted", effect=Effect()))
    status, out, _ = run("replay", "--check")
    assert (1, 1) == (status, out.count("\n"))
    assert "grammar/KRL.g4: differs from the replay of the ledger from line" in out


def test_the_ledger_of_this_checkout_holds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`KRL.g4` is the replay of its ledger, and all examples are treated as they ask for."""
    monkeypatch.chdir(REPOSITORY)
    assert (0, "") == (main(["construct", "replay", "--check"]), capsys.readouterr().err)


# ------------------------------------------------------------------------------------- oracle


def test_a_bundle_goes_out_and_its_form_comes_back(run: Run) -> None:
    """What was answered becomes the verdict and the state; a difference has status 1."""
    file = put(replace(WEAVE, number=1, reject=("DEF A()\nWEAVE\nEND\n",)))
    corroborated = put(replace(STEP, number=2, accept=WEAVE.accept, evidence=Evidence(3, 2, 3)))
    assert "0001-weave  no ground, no origin shows it" in run("oracle")[1]
    assert (0, "wrote 2 programs and a form to out\n", "") == run("oracle", "--bundle", "out")
    assert "DEF C0001_1()" in Path("out/programs/C0001_1.src").read_text(encoding="utf-8")
    form = Path("out", "verdicts.toml")
    text = form.read_text(encoding="utf-8").replace('release = ""', 'release = "KSS 8.6"')
    form.write_text(text.replace('answer = ""', 'answer = "accepted"'), encoding="utf-8")
    status, out, _ = run("oracle", "--record", form)
    assert 1 == status
    assert "C0001_2: accepted, and the ledger says it must be rejected" in out
    found = read(file)
    assert ("accepted", "KSS 8.6", "confirmed") == (
        found.evidence.verdict,
        found.evidence.oracle,
        found.state,
    )
    assert "accepted" == read(corroborated).evidence.verdict  # the same program was asked about
    assert (0, "nothing waits for a verdict\n", "") == run("oracle")


def test_a_command_may_be_asked(run: Run, tmp_path: Path) -> None:
    """Its refusal is the verdict."""
    script = tmp_path / "ask.py"
    script.write_text("print('KSS2023'); raise SystemExit(1)", encoding="utf-8")
    file = put(replace(WEAVE, number=1))
    command = f'"{Path(sys.executable).as_posix()}" "{script.as_posix()}"'
    status, out, _ = run("oracle", "--command", command, "--name", "a stand-in")
    assert 1 == status
    assert "0001-weave: refused: KSS2023" in out
    evidence = read(file).evidence
    assert ("refused: KSS2023", "a stand-in") == (evidence.verdict, evidence.oracle)


# ------------------------------------------------------------------------------------- errors


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("show", "7"), "'7' is no construct of grammar/constructs"),
        (("try", "none.toml"), "none.toml: No such file"),
        (("try", "bad.toml"), "bad.toml: title: is missing"),
        (("try", "good.toml", "--corpus", "nowhere"), "nowhere: no such file or folder"),
        (("oracle", "--record", "none.toml"), "none.toml: No such file"),
        (("oracle", "--bundle", "x"), "nothing waits for a verdict"),
        (("oracle", "--command", ""), "--command is empty"),
        (("oracle", "--bundle", "x", "--record", "y"), "only one of"),
    ],
)
def test_what_cannot_be_used_is_one_line(run: Run, arguments: tuple[str, ...], said: str) -> None:
    """Status 2, one line on stderr."""
    Path("bad.toml").write_text('state = "proposed"', encoding="utf-8")
    Path("good.toml").write_text(text_of(STEP), encoding="utf-8")
    status, _, err = run(*arguments)
    assert (2, 1) == (status, err.count("\n"))
    assert said in err


@pytest.mark.parametrize("command", [("list",), ("show", "1"), ("replay", "--check"), ("oracle",)])
def test_a_ledger_that_is_not_one_is_one_line(run: Run, command: tuple[str, ...]) -> None:
    """Whichever command meets the file; its name and the key are told."""
    put(replace(STEP, number=1)).write_text('title = "T"\nstate = "no"', encoding="utf-8")
    status, _, err = run(*command)
    assert (2, 1) == (status, err.count("\n"))
    assert "0001-for-step.toml: state: 'no' is none of" in err
