"""`krl construct propose`: from a survey to a file ready for review."""

import json
import tomllib
from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import apply, from_data
from grammar.parser.recognizer import Recognizer
from krl.cli import main

PRELIMINARY = Path(g4.__file__).parents[1].joinpath("preliminary.g4")


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("survey")
    for n, step in enumerate((2, 3, 5)):
        text = f"DEF P{n}()\nFOR I=1 TO {n + 4} STEP {step}\nENDFOR\nEND\n"
        (folder / f"p{n}.src").write_text(text, encoding="utf-8")
    options = ["--grammar", str(PRELIMINARY), "--out", str(folder / "out"), "--jobs", "1"]
    assert main(["recover", str(folder), *options]) == 0
    return folder / "out"


def propose(out: Path, target: Path, cluster: str = "c-", *more: str) -> int:
    survey = ["--survey", str(out / "survey.json"), "--out", str(target)]
    return main(["construct", "propose", cluster, *survey, *more])


def test_the_file_can_be_read_and_its_edits_mend_the_example(out: Path, tmp_path: Path) -> None:
    """Applied to the grammar, the edits accept the accept examples, which fail without them."""
    assert propose(out, tmp_path) == 0
    (file,) = tmp_path.iterdir()
    assert file.name == "0001-for-step.toml"
    text = file.read_text(encoding="utf-8")
    construct = tomllib.loads(text)
    grammar = g4.read_file(PRELIMINARY)
    wider = g4.read(apply(grammar, [from_data(edit) for edit in construct["edit"]]).text)
    (example,) = construct["examples"]["accept"]
    assert construct["state"] == "recurring"
    assert construct["evidence"]["files"] == 3
    assert construct["evidence"].keys() >= {"rules", "manual", "verdict", "seen"}
    assert "#   3 files that parse with this edit alone" in text.splitlines()
    assert (False, True) == (
        Recognizer(grammar).accepts(example),
        Recognizer(wider).accepts(example),
    )


def test_what_two_origins_show_is_corroborated(out: Path, tmp_path: Path) -> None:
    """The state follows the evidence of the survey."""
    record = json.loads((out / "survey.json").read_text(encoding="utf-8"))
    record["clusters"][0]["origins"] = 2
    other = tmp_path / "other"
    other.mkdir()
    (other / "survey.json").write_text(json.dumps(record), encoding="utf-8")
    assert propose(other, tmp_path / "ledger") == 0
    (file,) = (tmp_path / "ledger").iterdir()
    assert tomllib.loads(file.read_text(encoding="utf-8"))["state"] == "corroborated"


def test_a_survey_of_before_is_understood(out: Path, tmp_path: Path) -> None:
    """Where a record has one text for title and signature, the name comes from that."""
    record = json.loads((out / "survey.json").read_text(encoding="utf-8"))
    (tmp_path / "old").mkdir()
    for cluster in record["clusters"]:
        cluster["title"] = cluster.pop("signature")
    (tmp_path / "old" / "survey.json").write_text(json.dumps(record), encoding="utf-8")
    assert propose(tmp_path / "old", tmp_path / "ledger") == 0
    (file,) = (tmp_path / "ledger").iterdir()
    assert "0001-for-step.toml" == file.name


def test_the_same_edits_are_proposed_once(
    out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Proposing again names the file; another construct of that name takes the next number."""
    assert propose(out, tmp_path) == 0
    file = tmp_path / "0001-for-step.toml"
    reviewed = file.read_text(encoding="utf-8").replace('summary = ""', 'summary = "A step."')
    file.write_text(reviewed, encoding="utf-8")
    assert propose(out, tmp_path) == 2
    assert f"already proposed: {file.as_posix()}" in capsys.readouterr().err
    file.write_text(reviewed.replace("(STEP ", "(STEP '-'? "), encoding="utf-8")
    assert propose(out, tmp_path) == 0
    assert "0001-for-step.toml 0002-for-step.toml" == " ".join(
        sorted(f.name for f in tmp_path.iterdir())
    )


@pytest.mark.parametrize(
    ("cluster", "more", "said"),
    [
        ("c-none", (), "'c-none' is no cluster of this survey"),
        ("c-", ("--proposal", "99"), "there is no 99"),
    ],
)
def test_what_is_not_there_is_one_line(
    out: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    cluster: str,
    more: tuple[str, ...],
    said: str,
) -> None:
    """An unknown cluster or proposal ends with status 2 and one line; nothing is written."""
    assert propose(out, tmp_path / "ledger", cluster, *more) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not (tmp_path / "ledger").exists()


def test_without_a_survey_it_says_what_to_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """No survey, or a file that is none: status 2 and one line."""
    assert propose(tmp_path, tmp_path) == 2
    assert "run krl recover first" in capsys.readouterr().err
    (tmp_path / "survey.json").write_text("[]", encoding="utf-8")
    assert propose(tmp_path, tmp_path) == 2
    assert "not a survey" in capsys.readouterr().err


def test_outside_a_checkout_the_ledger_is_that_of_the_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In a folder without a grammar, constructs can be listed and shown, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    assert 0 == main(["construct", "list"])
    assert "GLOBAL DEF" in capsys.readouterr().out
    assert 0 == main(["construct", "show", "3"])
    assert "GLOBAL" in capsys.readouterr().out
    assert [] == list(tmp_path.iterdir())
