"""The ledger: a folder of constructs that replays to the grammar."""

from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, SetComment
from recovery.ledger.construct import Construct, Effect, Evidence, LedgerError
from recovery.ledger.construct_file import text_of
from recovery.ledger.ledger import Ledger, findings, grown, in_force, preliminary_of, replay

PRELIMINARY = Path(g4.__file__).parents[1].joinpath("preliminary.g4")
START = g4.read_file(PRELIMINARY)


def construct(number: int, word: str, *edits: Edit, state: str = "accepted") -> Construct:
    """A construct that adds a statement ``WORD 1``."""
    return Construct(
        name=word.lower(),
        title=word,
        edits=edits or (AddToken(word), AddAlternative("simpleStatement", f"{word} expression")),
        number=number,
        state=state,
        summary=word,
        evidence=Evidence(rules=("CTL-01",)),
        accept=(f"DEF A()\n{word} 1\nEND\n",),
        reject=(f"DEF A()\n{word} =\nEND\n",),
        effect=Effect(),
    )


def written(folder: Path, *constructs: Construct) -> Path:
    folder.mkdir(exist_ok=True)
    for each in constructs:
        (folder / f"{each.id}.toml").write_text(text_of(each), encoding="utf-8", newline="\n")
    return folder


def checked(folder: Path) -> list[str]:
    ledger = Ledger.read(folder)
    grammar = folder / "KRL.g4"
    if not grammar.exists():
        grammar.write_bytes(in_force(START, ledger.accepted).text.encode())
    return list(findings(ledger, START, grammar))


# -------------------------------------------------------------------------------- the folder


def test_an_empty_ledger_replays_to_the_start(tmp_path: Path) -> None:
    """Without constructs, or without the folder, the grammar is the restrictive start."""
    ledger = Ledger.read(tmp_path / "none")
    assert ((), START) == (ledger.constructs, in_force(START, ledger.accepted))
    assert [] == list(findings(ledger, START, PRELIMINARY))


def test_constructs_stand_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    """Only the accepted ones count for the grammar."""
    folder = written(
        tmp_path,
        construct(3, "AAA"),
        construct(1, "CCC"),
        replace(construct(2, "BBB", state="rejected"), summary="no"),
    )
    ledger = Ledger.read(folder)
    assert ["0001-ccc", "0002-bbb", "0003-aaa"] == [c.id for c in ledger.constructs]
    assert ["ccc", "aaa"] == [c.name for c in ledger.accepted]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["0001-a", "0001-b"], "0001-b.toml: number 1 is given twice"),
        (["0001-a", "0003-b"], "0003-b.toml: number 3 stands here, and there is no 2"),
        (["0002-a"], "0002-a.toml: number 2 stands here, and there is no 1"),
        (["a"], "a.toml: the name has no number"),
    ],
)
def test_numbers_are_contiguous_and_unique(tmp_path: Path, names: list[str], said: str) -> None:
    """A number twice, a gap, and a file without a number are refused by the file's name."""
    for name in names:
        (tmp_path / f"{name}.toml").write_text(text_of(construct(1, "A")), encoding="utf-8")
    with pytest.raises(LedgerError, match=said):
        Ledger.read(tmp_path)


def test_a_construct_is_found_by_number_id_or_name(tmp_path: Path) -> None:
    """What is not there, or more than one, is said."""
    ledger = Ledger.read(written(tmp_path, construct(1, "AAA"), construct(2, "AAB")))
    for wanted in ("2", "0002", "0002-aab", "aab", "0002-a"):
        assert "0002-aab" == ledger.find(wanted).id
    for wanted, said in (("3", "no construct"), ("0", "no"), ("000", "no"), ("0000", "no")):
        with pytest.raises(LedgerError, match=said):
            ledger.find(wanted)


def test_a_file_of_the_ledger_is_the_construct_of_the_ledger(tmp_path: Path) -> None:
    """By whatever path it is named; a file from elsewhere is read."""
    ledger = Ledger.read(written(tmp_path / "ledger", construct(1, "AAA")))
    named = tmp_path / "ledger" / ".." / "ledger" / "0001-aaa.toml"
    assert ledger.constructs[0] is ledger.take(named)
    (other,) = written(tmp_path / "other", construct(1, "BBB")).iterdir()
    assert ("bbb", other) == (ledger.take(other).name, ledger.take(other).file)


# -------------------------------------------------------------------------------- the replay


def test_each_construct_comes_with_the_grammar_after_it() -> None:
    """The text grows by what the edits say and is otherwise that of the start."""
    one, two = construct(1, "AAA"), construct(2, "BBB")
    (first, once), (second, twice) = replay(START, [one, two])
    assert (one, two) == (first, second)
    assert START.text != once.text
    assert START.text == once.text.replace("AAA : 'AAA' ;\n", "").replace(
        "\n    | AAA expression", ""
    )
    assert g4.read(twice.text).text == twice.text


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (Insert("forStatement", (1, 99), "NAME"), "rule forStatement has no place 1.99"),
        (AddAlternative("simpleStatement", "nothing"), "nothing is not defined"),
        (Insert("sum", (1, 1), "sum"), "left recursion through sum"),
    ],
)
def test_an_edit_that_does_not_fit_names_the_construct(edit: Edit, said: str) -> None:
    """No place, no such rule, left recursion: the construct is named, and what is wrong."""
    with pytest.raises(LedgerError, match=f"0001-aaa: edit: .*{said}"):
        grown(START, construct(1, "AAA", edit))


# --------------------------------------------------------------------------------- the check


def test_a_ledger_that_holds_has_no_findings(tmp_path: Path) -> None:
    """Grammar, examples, grounds and effects as they must be."""
    assert [] == checked(written(tmp_path, construct(1, "AAA"), construct(2, "BBB")))


def test_a_byte_of_difference_is_found(tmp_path: Path) -> None:
    """Line ends and the end of the file count too; the first line that differs is named."""
    folder = written(tmp_path, construct(1, "AAA"))
    text = in_force(START, Ledger.read(folder).accepted).text
    for wrong, where in (
        (text.replace("\n", "\r\n"), "from line 1 on"),
        (f"{text}// more\n", "in length"),
        (text.replace("grammar KRL;", "grammar KRL ;"), "from line"),
    ):
        (folder / "KRL.g4").write_bytes(wrong.encode())
        (finding,) = checked(folder)
        assert f"KRL.g4: differs from the replay of the ledger {where}" in finding
    (folder / "KRL.g4").unlink()
    (finding,) = findings(Ledger.read(folder), START, folder / "KRL.g4")
    assert "No such file" in finding


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"accept": ("DEF A()\nBBB 1\nEND\n",)}, "examples.accept: number 1 is not accepted"),
        ({"reject": ("DEF A()\nEND\n",)}, "examples.reject: number 1 is accepted"),
        ({"accept": ()}, "examples.accept: there is no program"),
        ({"evidence": Evidence(5, 1, 5)}, "evidence: no ground"),
        ({"evidence": Evidence(5, 2, 5, verdict="refused: x")}, "the oracle refused it: x"),
        ({"effect": None}, "effect: is missing"),
    ],
)
def test_what_does_not_hold_is_a_line(tmp_path: Path, change: dict[str, object], said: str) -> None:
    """Examples under the final grammar, grounds and effect are looked at."""
    folder = written(tmp_path, replace(construct(1, "AAA"), **change))  # type: ignore[arg-type]
    (finding,) = checked(folder)
    assert said in finding
    assert "0001-aaa.toml" in finding


def test_wording_needs_no_evidence(tmp_path: Path) -> None:
    """A construct that changes a comment has nothing to show."""
    words = replace(construct(1, "AAA", SetComment("literal", "So.")), evidence=Evidence())
    assert [] == checked(written(tmp_path, replace(words, accept=(), reject=())))


def test_a_construct_that_does_not_fit_is_the_finding(tmp_path: Path) -> None:
    """Where the ledger cannot be replayed there is nothing to compare."""
    folder = written(tmp_path, construct(1, "AAA", Insert("none", (1, 1), "NAME")))
    (folder / "KRL.g4").write_text("", encoding="utf-8")
    (finding,) = checked(folder)
    assert "0001-aaa.toml: edit: there is no rule none" in finding


def test_only_a_grammar_is_a_start(tmp_path: Path) -> None:
    """A missing start is an error of the ledger."""
    with pytest.raises(LedgerError, match="No such file"):
        preliminary_of(tmp_path / "preliminary.g4")
    assert START.text == preliminary_of(PRELIMINARY).text
