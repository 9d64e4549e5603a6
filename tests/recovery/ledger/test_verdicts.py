"""Recorded verdicts: the bundle to carry over, and the form that comes back."""

import tomllib
from pathlib import Path

import pytest

from grammar.notation.edits import AddToken
from recovery.ledger.construct import Construct
from recovery.ledger.oracle import OracleAnswer, OracleError, programs_of
from recovery.ledger.verdicts import FORM, RecordedOracle, write_bundle

CONSTRUCT = Construct(
    "a", "T", (AddToken("X"),), 3, accept=("DEF A()\nEND\n",), reject=("DEFDAT A\nX\nENDDAT\n",)
)
PROGRAMS = programs_of(CONSTRUCT)
HEAD = 'by = "somebody"\nwhen = 2026-03-31\nrelease = "KSS 8.6"\n'


def test_a_bundle_has_programs_readme_and_form(tmp_path: Path) -> None:
    """The form can be read as it is; it does not tell what is expected."""
    write_bundle(PROGRAMS, tmp_path / "new")
    names = sorted(p.relative_to(tmp_path / "new").as_posix() for p in tmp_path.rglob("*.*"))
    assert ["README.txt", "programs/C0003_1.src", "programs/C0003_2.dat", FORM] == names
    assert b"DEF C0003_1()\r\nEND\r\n" == (tmp_path / "new/programs/C0003_1.src").read_bytes()
    form = (tmp_path / "new" / FORM).read_text(encoding="utf-8")
    entries = tomllib.loads(form)["program"]
    assert ["C0003_1.src", "C0003_2.dat"] == [entry["file"] for entry in entries]
    assert {""} == {entry["answer"] for entry in entries}
    assert "accept" not in str(entries)
    readme = (tmp_path / "new" / "README.txt").read_text(encoding="utf-8")
    assert "these programs: 2 in all" in readme
    assert max(map(len, readme.splitlines())) <= 100


def test_a_form_is_never_written_over(tmp_path: Path) -> None:
    """It may be half filled."""
    write_bundle(PROGRAMS, tmp_path)
    with pytest.raises(OracleError, match="there is a form already"):
        write_bundle(PROGRAMS, tmp_path)


def filled(tmp_path: Path, *answers: str, head: str = HEAD) -> Path:
    write_bundle(PROGRAMS, tmp_path)
    text = (tmp_path / FORM).read_text(encoding="utf-8")
    for answer in answers:
        text = text.replace('answer = ""', f'answer = "{answer}"', 1)
    form = tmp_path / "filled.toml"
    # as an editor on Windows may save it
    entries = text[text.index("[[program]]") :]
    form.write_text(f"\ufeff{head}{entries}", encoding="utf-8", newline="\r\n")
    return form


def test_a_filled_form_is_an_oracle(tmp_path: Path) -> None:
    """Accepted in any letters, any other text a refusal, nothing no answer."""
    oracle = RecordedOracle(filled(tmp_path / "a", " Accepted ", "KSS2023  no"))
    assert [OracleAnswer(True), OracleAnswer(False, "KSS2023 no")] == [
        oracle.ask(p) for p in PROGRAMS
    ]
    assert "KSS 8.6, somebody, 2026-03-31" == oracle.name
    assert 2 == len(oracle)
    half = RecordedOracle(filled(tmp_path / "b", "accepted"))
    assert [OracleAnswer(True), None] == [half.ask(p) for p in PROGRAMS]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("by = ", "not TOML"),
        ('by = "x"\n', "release: is empty"),
        ("release = 8\n", "release: is not a text"),
        ('release = "8"\nprogram = 3\n', "program: is not a list of tables"),
        ('release = "8"\n[[program]]\nanswer = true\n', "program number 1: answer: is not a text"),
    ],
)
def test_a_form_that_is_none_is_one_line(tmp_path: Path, text: str, said: str) -> None:
    """The file and the key are named."""
    form = tmp_path / FORM
    form.write_text(text, encoding="utf-8")
    with pytest.raises(OracleError) as caught:
        RecordedOracle(form)
    assert str(caught.value).startswith(str(form))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_form_is_one_line(tmp_path: Path) -> None:
    """So is a folder in its place."""
    for form in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(OracleError, match=str(form.name)):
            RecordedOracle(form)
