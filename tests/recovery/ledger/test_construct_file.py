"""The file of a construct: written in one way, read strictly, every mistake named."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.edits import AddToken, Insert
from recovery.ledger.construct import Construct, Effect, Evidence, LedgerError
from recovery.ledger.construct_file import name_from, parse, quoted, read, text_of

FILE = Path("0007-for-step.toml")
FULL = Construct(
    name="for-step",
    title='FOR … "STEP"',
    edits=(AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")),
    number=7,
    state="accepted",
    summary="Two lines\nwith a \\ and a tab\t.",
    evidence=Evidence(
        45,
        12,
        783,
        ("CTL-05", "SCO-04"),
        "Programming manual, 10.4",
        "accepted",
        "KSS 8.6, somebody, 2026-03-31",
        ("A__B/C D.src:5",),
    ),
    accept=('DEF A()\nSAY("X")\nEND\n', "DEF B()\r\nEND\r\n"),
    reject=('"""', 'a"""""\n""""', "a\\nb\n", "\x7f\x00\n"),
    effect=Effect(9, 8, 70, 60, 5, 4, 3, 0, 1, {"TERM": 77, "AVS": 4.25}),
    comment="# why\n#   indeed",
)
LEAST = """title = "T"
state = "proposed"
[[edit]]
edit = "add-token"
name = "STEP"
"""


def test_what_is_written_is_what_is_read() -> None:
    """Every key comes back, odd characters and the comment at the head included."""
    text = text_of(FULL)
    found = parse(text, FILE)
    assert FULL == found
    assert text == text_of(found)


@given(st.text())
def test_any_text_can_be_quoted(text: str) -> None:
    """Whatever a program holds comes back as it was."""
    construct = Construct("a", "T", (AddToken("X"),), accept=(text,), reject=(f"{text}\n",))
    if not any("\ud800" <= character <= "\udfff" for character in text):
        found = parse(text_of(construct), Path("a.toml"))
        assert ((text,), (f"{text}\n",)) == (found.accept, found.reject)


def test_a_program_is_written_to_be_read() -> None:
    """A text of several lines keeps them."""
    assert '"""\nDEF A()\n"X"\n"""' == quoted('DEF A()\n"X"\n')


def test_what_is_left_out_has_nothing() -> None:
    """A title, a state and an edit are enough; the rest is empty, and there is no effect."""
    found = parse(LEAST, Path("for-step.toml"))
    assert Construct("for-step", "T", (AddToken("STEP"),)) == found
    assert "for-step" == found.id


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("title = ", "not TOML"),
        (LEAST.replace("title", "titel"), "title: is missing"),
        (LEAST.replace('"T"', '""'), "title: is not one line of text"),
        (LEAST.replace('"proposed"', '"done"'), "state: 'done' is none of proposed"),
        (LEAST.replace('"proposed"', "3"), "state: is not a text"),
        (LEAST.replace('"proposed"', '"corroborated"'), "state: the evidence does not make it"),
        (LEAST.replace('"proposed"', '"rejected"'), "summary: does not say why"),
        ('title = "T"\nstate = "proposed"\n', "edit: is missing"),
        ('title = "T"\nstate = "proposed"\nedit = 3\n', "edit: is not a list of tables"),
        (LEAST.replace("add-token", "add"), "edit: number 1: there is no edit 'add'"),
        (f"{LEAST}[evidence]\nfile = 3\n", "evidence.file: is not a key"),
        (f"{LEAST}[evidence]\nfiles = -1\n", "evidence.files: is not a whole number"),
        (f"{LEAST}[evidence]\nfiles = true\n", "evidence.files: is not a whole number"),
        (f"{LEAST}[evidence]\nfiles = 1\norigins = 2\nlines = 2\n", "evidence.origins: more"),
        (f'{LEAST}[evidence]\nrules = ["TRG-4"]\n', "evidence.rules: 'TRG-4' is not the ID"),
        (f'{LEAST}[evidence]\nrules = ["CTL-05", "XYZ-99"]\n', "evidence.rules: 'XYZ-99' is not"),
        (f"{LEAST}[evidence]\nrules = [4]\n", "evidence.rules: is not a list of texts"),
        (f'{LEAST}[evidence]\nverdict = "yes"\n', "evidence.verdict: is neither"),
        (f'{LEAST}[evidence]\nverdict = "refused: "\n', "evidence.verdict: is neither"),
        (f"{LEAST}[evidence]\nseen = {['p'] * 11}\n", "evidence.seen: has more than 10"),
        (f"{LEAST}[examples]\naccepts = []\n", "examples.accepts: is not a key"),
        (f'{LEAST}[examples]\naccept = "x"\n', "examples.accept: is not a list of texts"),
        (f"{LEAST}[effect]\nparsed = 1.5\n", "effect.parsed: is not a whole number"),
        (f"{LEAST}[effect.metrics]\nTERM = nan\n", "effect.metrics.TERM: is not a number"),
        (f"effect = 3\n{LEAST}", "effect: is not a table"),
        (f"more = 3\n{LEAST}", "more: is not a key of a construct"),
    ],
)
def test_a_mistake_is_one_line_with_file_and_key(text: str, said: str) -> None:
    """Whatever is wrong, the message begins with the file and names the key."""
    with pytest.raises(LedgerError) as caught:
        parse(text, FILE)
    assert str(caught.value).startswith(f"{FILE}: {said}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["For.toml", "0001-a_b.toml", "0001.txt", "-a.toml"])
def test_a_name_of_another_form_is_refused(name: str) -> None:
    """A file is called after four figures and words in lower case, or the words alone."""
    with pytest.raises(LedgerError, match="the name is not"):
        parse(LEAST, Path(name))


def test_what_cannot_be_read_is_said(tmp_path: Path) -> None:
    """A missing file and one that is not UTF-8 are a line each."""
    with pytest.raises(LedgerError, match="No such file"):
        read(tmp_path / "a.toml")
    (tmp_path / "a.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(LedgerError, match="not UTF-8"):
        read(tmp_path / "a.toml")


def test_names_have_one_form() -> None:
    """They are words in lower case."""
    assert ["for-step", "construct"] == [name_from(text) for text in ("FOR … STEP", "…")]


@pytest.mark.parametrize(
    ("evidence", "grounds", "earned_state", "objection"),
    [
        (Evidence(), (), "proposed", "no ground: no file"),
        (Evidence(9, 1, 9), (), "proposed", "no ground: only one file"),
        (Evidence(1, 1, 2, seen=("o/a:1", "o/a:2")), (), "proposed", "no ground: only one file"),
        (Evidence(2, 1, 2, seen=("o/a:1", "o/b:1")), ("recurring",), "recurring", ""),
        (Evidence(2, 2, 2), ("corroborated",), "corroborated", ""),
        (Evidence(rules=("TRG-04",)), ("documented",), "documented", ""),
        (Evidence(manual="10.4"), ("documented",), "documented", ""),
        (Evidence(verdict="accepted"), ("confirmed",), "confirmed", ""),
        (
            Evidence(2, 2, 2, ("TRG-04",), verdict="accepted"),
            ("corroborated", "documented", "confirmed"),
            "confirmed",
            "",
        ),
        (
            Evidence(2, 2, 2, verdict="refused: no ="),
            ("corroborated",),
            "corroborated",
            "the oracle refused it: no =",
        ),
    ],
)
def test_grounds_follow_from_the_evidence(
    evidence: Evidence, grounds: tuple[str, ...], earned_state: str, objection: str
) -> None:
    """Two origins, a rule or manual, and a verdict are grounds; a refusal outweighs them all."""
    construct = Construct("a", "T", (AddToken("X"),), evidence=evidence)
    assert (grounds, earned_state) == (evidence.grounds, construct.earned_state)
    assert evidence.objection.startswith(objection)
    assert bool(objection) == bool(evidence.objection)
