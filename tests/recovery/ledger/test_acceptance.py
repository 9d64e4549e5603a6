"""Acceptance: constructs taken into the grammar, all of them or none."""

import shutil
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert
from grammar.notation.generate import GENERATED, GenerationError
from grammar.parser import antlr_reference
from recovery.ledger.acceptance import Acceptance, AcceptanceRefused, GrammarPaths, prepare, write
from recovery.ledger.baseline import Corpora
from recovery.ledger.construct import Construct, Evidence, LedgerError
from recovery.ledger.construct_file import read, text_of
from recovery.ledger.ledger import Ledger, findings, in_force

PRELIMINARY = Path(g4.__file__).parents[1].joinpath("preliminary.g4")
START = g4.read_file(PRELIMINARY)
STEP = (AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?"))


def construct(name: str, edits: tuple[Edit, ...], accept: str, reject: str) -> Construct:
    return Construct(
        name=name,
        title=name,
        edits=edits,
        summary=name,
        evidence=Evidence(rules=("CTL-05",)),
        accept=(f"DEF A()\n{accept}\nEND\n",),
        reject=(f"DEF A()\n{reject}\nEND\n",),
    )


FOR_STEP = construct("for-step", STEP, "FOR I=1 TO 9 STEP 2\nENDFOR", "FOR I=1 TO 9 STEP=2\nENDFOR")
WORDS = {
    word: construct(
        word.lower(),
        (AddToken(word), AddAlternative("simpleStatement", f"{word} expression")),
        f"{word} 1",
        f"{word} =",
    )
    for word in ("AAA", "BBB", "CCC")
}


class House:
    """A grammar with its ledger, in a folder of its own, and constructs elsewhere."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.home = GrammarPaths(
            folder / "preliminary.g4",
            folder / "KRL.g4",
            folder / "_generated",
            folder / "constructs",
        )
        self.home.grammar.write_bytes(START.text.encode())
        self.generated = 0
        self.fails = False

    @property
    def ledger(self) -> Ledger:
        """The ledger as it now is."""
        return Ledger.read(self.home.ledger)

    def file(self, construct: Construct, name: str = "") -> Path:
        """A construct written into the ledger under its name there, or beside it."""
        path = self.home.ledger / f"{name}.toml" if name else self.folder / f"{construct.id}.toml"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text_of(construct), encoding="utf-8", newline="\n")
        return path

    def generate(self, grammar: Path, folder: Path) -> None:
        """The real parser of the project's grammar, taken for that of any grammar."""
        del grammar
        if self.fails:
            raise GenerationError("no Java")
        self.generated += 1
        shutil.copytree(GENERATED, folder, ignore=shutil.ignore_patterns("__pycache__"))

    def prepare(self, *files: Path, own: Path | None = None) -> Acceptance:
        """Weigh the constructs of files."""
        ledger = self.ledger
        current = g4.read_file(self.home.grammar)
        corpora = Corpora([], own, [], generated=0, jobs=1)
        return prepare([ledger.take(f) for f in files], START, ledger, corpora, current)

    def accept(self, *files: Path) -> list[Path]:
        """Weigh and write them."""
        return write(self.prepare(*files), self.home, self.generate)

    def content(self) -> dict[str, bytes]:
        """Every file there is."""
        files = (path for path in self.folder.rglob("*") if path.is_file())
        return {path.relative_to(self.folder).as_posix(): path.read_bytes() for path in files}


@pytest.fixture
def house(tmp_path: Path) -> House:
    return House(tmp_path)


@pytest.fixture
def trusting(monkeypatch: pytest.MonkeyPatch) -> None:
    """ANTLR's parser, which here is that of another grammar, is not asked."""
    monkeypatch.setattr("recovery.ledger.regeneration.disagreements", lambda _: [])


def test_what_is_accepted_is_written(house: House) -> None:
    """A file from elsewhere moves into the ledger; grammar and parser follow; the check holds."""
    file = house.file(replace(FOR_STEP, comment="# mine"))
    house.accept(file)
    (accepted,) = house.ledger.constructs
    assert ("0001-for-step", "accepted", "") == (accepted.id, accepted.state, accepted.comment)
    assert accepted.effect is not None
    assert not file.exists()
    assert (house.home.generated / "KRLParser.py").exists()
    assert [] == list(findings(house.ledger, START, house.home.grammar))


@pytest.mark.usefixtures("trusting")
def test_several_are_accepted_in_the_order_given(house: House) -> None:
    """Each is weighed on the grammar with those before it; the parser is generated once."""
    files = [house.file(WORDS[word]) for word in ("CCC", "AAA")]
    inside = house.file(WORDS["BBB"], "0001-bbb")
    house.accept(*files, inside)
    assert ["0001-ccc", "0002-aaa", "0003-bbb"] == [c.id for c in house.ledger.accepted]
    assert 1 == house.generated
    assert in_force(START, house.ledger.accepted).text == house.home.grammar.read_text("utf-8")


@pytest.mark.usefixtures("trusting")
def test_what_waits_moves_behind_what_is_accepted(house: House) -> None:
    """Accepted constructs keep their numbers; a proposal gets another, and not a byte changes."""
    house.accept(house.file(WORDS["AAA"]))
    waiting = house.file(replace(WORDS["BBB"], comment="# as I wrote it"), "0002-bbb")
    text = waiting.read_bytes()
    house.accept(house.file(WORDS["CCC"], "0003-ccc"))
    assert ["0001-aaa", "0002-ccc", "0003-bbb"] == [c.id for c in house.ledger.constructs]
    assert text == (house.home.ledger / "0003-bbb.toml").read_bytes()
    assert not waiting.exists()


@pytest.mark.usefixtures("trusting")
def test_one_refusal_refuses_all_and_changes_nothing(house: House) -> None:
    """Every reason is told, with the construct that it speaks against."""
    wrong = replace(WORDS["BBB"], accept=("DEF A(\n",), evidence=Evidence())
    files = [house.file(c) for c in (WORDS["AAA"], wrong, WORDS["CCC"])]
    before = house.content()
    found = house.prepare(*files)
    assert ["0002-bbb"] * 2 == [where for where, _ in found.refusals]
    assert 3 == len(found.evaluations)
    with pytest.raises(AcceptanceRefused, match="no ground"):
        write(found, house.home, house.generate)
    assert before == house.content()


def test_an_edit_that_does_not_fit_refuses(house: House) -> None:
    """It is named; what comes after it is not weighed, for there is no grammar to weigh it on."""
    wrong = replace(WORDS["BBB"], edits=(AddAlternative("sum", "sum"),))
    found = house.prepare(house.file(wrong), house.file(WORDS["AAA"]))
    ((where, why),) = found.refusals
    assert "0001-bbb" == where
    assert "left recursion" in why
    assert (found.refusals, ()) == (found.other_refusals, found.evaluations)


def test_an_example_that_fails_in_the_end_refuses(house: House) -> None:
    """A construct may take away what one before it accepted."""
    name = construct("names", (AddAlternative("simpleStatement", "NAME sum"),), "AAA 1", "1")
    edits = (AddToken("AAA"), AddAlternative("simpleStatement", "AAA AAA"))
    other = replace(WORDS["AAA"], edits=edits, accept=("DEF A()\nAAA AAA\nEND\n",))
    found = house.prepare(house.file(name), house.file(other))
    assert (
        ("0001-names", "in the end examples.accept: number 1 is not accepted"),
    ) == found.refusals


def test_where_antlr_disagrees_nothing_is_written(house: House) -> None:
    """The generated parser is asked about the examples before it is kept."""
    file = house.file(WORDS["AAA"])  # no word of the grammar whose parser is generated here
    before = house.content()
    assert antlr_reference.accepts(FOR_STEP.accept[0])
    ours = sys.modules["grammar._generated.KRLParser"]
    with pytest.raises(AcceptanceRefused, match="ANTLR refuses number 1, line 2"):
        house.accept(file)
    assert before == house.content()
    assert ours is sys.modules["grammar._generated.KRLParser"]


def test_where_the_parser_cannot_be_generated_nothing_is_written(house: House) -> None:
    """Without Java the ledger stays as it is."""
    file = house.file(FOR_STEP)
    house.fails = True
    before = house.content()
    with pytest.raises(GenerationError):
        house.accept(file)
    assert before == house.content()


@pytest.mark.usefixtures("trusting")
def test_a_grammar_changed_by_hand_is_not_overwritten(house: House) -> None:
    """What is in force has to be the replay of the ledger."""
    house.home.grammar.write_bytes(START.text.replace("// Only", "// Only,").encode())
    with pytest.raises(LedgerError, match="is not the replay of the ledger"):
        house.prepare(house.file(WORDS["AAA"]))


@pytest.mark.usefixtures("trusting")
def test_an_accepted_construct_is_weighed_again_at_its_place(house: House) -> None:
    """After its file was changed; the others keep what was measured of them."""
    house.accept(*(house.file(WORDS[word]) for word in ("AAA", "BBB")))
    file = house.home.ledger / "0001-aaa.toml"
    other = (house.home.ledger / "0002-bbb.toml").read_bytes()
    edits = (AddToken("AAA"), AddAlternative("simpleStatement", "AAA sum"))
    file.write_text(text_of(replace(read(file), edits=edits, effect=None)), encoding="utf-8")
    house.accept(file)
    assert ["0001-aaa", "0002-bbb"] == [c.id for c in house.ledger.accepted]
    assert other == (house.home.ledger / "0002-bbb.toml").read_bytes()
    assert read(file).effect is not None
    assert [] == list(findings(house.ledger, START, house.home.grammar))


@pytest.mark.usefixtures("trusting")
def test_evaluating_again_changes_nothing_that_is_right(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same construct gives the same files, and the parser is not generated again."""

    def up_to_date(folder: Path) -> str | None:
        return None if folder.exists() else "missing"

    monkeypatch.setattr("recovery.ledger.regeneration.check", lambda _, folder: up_to_date(folder))
    house.accept(house.file(WORDS["AAA"]))
    before = house.content()
    assert [] == house.accept(house.home.ledger / "0001-aaa.toml")
    assert before == house.content()
    assert 1 == house.generated


@pytest.mark.usefixtures("trusting")
def test_a_change_in_the_middle_may_not_undo_what_came_after(house: House, tmp_path: Path) -> None:
    """What parses under the grammar in force has to parse under the one that comes of it."""
    house.accept(*(house.file(WORDS[word]) for word in ("AAA", "BBB")))
    own = tmp_path / "programs"
    own.mkdir()
    (own / "a.src").write_text("DEF A()\nAAA 1 == 2\nEND\n", encoding="utf-8")
    file = house.home.ledger / "0001-aaa.toml"
    edits = (AddToken("AAA"), AddAlternative("simpleStatement", "AAA sum"))
    file.write_text(text_of(replace(read(file), edits=edits)), encoding="utf-8")
    found = house.prepare(file, own=own)
    assert (("in the end", "no longer parses: programs/a.src:2, at '=='"),) == found.refusals


def test_progress_is_reported(house: House) -> None:
    """Each construct that was weighed is one."""
    done: list[int] = []
    note: Callable[[int], object] = done.append
    ledger = house.ledger
    given = [ledger.take(house.file(WORDS[word])) for word in ("AAA", "BBB")]
    prepare(given, START, ledger, Corpora([], None, [], generated=0), None, note)
    assert [1, 1] == done
