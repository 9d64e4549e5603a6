"""Negatives: read from files, and tried on grammars."""

from pathlib import Path

import pytest

from grammar.notation.g4 import read, read_file
from grammar.parser.recognizer import Recognizer
from recovery.negatives.negatives import Negative, NegativeError, NegativeSet, load

ROOT = Path(__file__).parents[3]
GOOD = (
    ";@ reason: no more\n;@ phase: parse\n;@ rule: CTL-01, TYP-05\n;@ line: 6\nDEF A()\n  5\nEND\n"
)

TOY = """grammar Toy;
module : (WORD* NEWLINE)* EOF ;
WORD : [A-Z0-9()=+]+ ;
NEWLINE : '\\r\\n' | '\\n' ;
COMMENT : ';' ~[\\r\\n]* -> skip ;
SPACE : [ \\t]+ -> skip ;
"""


def toy(old: str = "", new: str = "") -> Recognizer:
    return Recognizer(read(TOY.replace(old, new) if old else TOY))


def negative(text: str, phase: str = "parse") -> Negative:
    return Negative(None, text, "a reason", phase)  # type: ignore[arg-type]


# --------------------------------------------------------------------------------- loading


def test_front_matter_is_read(tmp_path: Path) -> None:
    """A negative knows its file, text, reason, phase, rules and line."""
    path = tmp_path / "topic" / "a.src"
    path.parent.mkdir()
    path.write_bytes(GOOD.encode())
    (found,) = load(tmp_path)
    expected = Negative(path, GOOD, "no more", "parse", ("CTL-01", "TYP-05"), 6)
    assert expected == found


def test_rule_and_line_may_be_left_out(tmp_path: Path) -> None:
    """Only reason and phase are asked for."""
    (tmp_path / "a.DAT").write_bytes(b";@ phase: check\n;@ reason: so: it is\nDEFDAT A\nENDDAT\n")
    (found,) = load(tmp_path)
    assert ("so: it is", "check", (), None) == (found.reason, found.phase, found.rules, found.line)


def test_files_come_in_order_and_others_are_left_aside(tmp_path: Path) -> None:
    """KRL files of all folders are read by path; a README is not."""
    for name in ("b/x.sub", "a/z.src", "a/y.dat", "a/b.src", "c/a.src", "d.dat"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(GOOD.encode())
    (tmp_path / "README.md").write_text("none", encoding="utf-8")
    names = [n.path.relative_to(tmp_path).as_posix() for n in load(tmp_path) if n.path]
    assert ["a/b.src", "a/y.dat", "a/z.src", "b/x.sub", "c/a.src", "d.dat"] == names


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (";@ reason: no more\n", "", r"a\.src:1: the front matter has no reason"),
        (";@ phase: parse\n", "", r"a\.src:1: the front matter has no phase"),
        ("parse", "later", r"a\.src: phase 'later'"),
        (";@ rule:", ";@ rule", r"a\.src:3: not `;@ key: value`"),
        (": no more", ":", r"a\.src:1: not `;@ key: value`"),
        (";@ rule", ";@ note", r"a\.src:3: key note is unknown"),
        (";@ rule", ";@ phase", r"a\.src:3: key phase is given twice"),
        ("line: 6", "line: 4", r"a\.src: line '4'"),
        ("line: 6", "line: 8", r"a\.src: line '8'"),
        ("line: 6", "line: six", r"a\.src: line 'six'"),
        ("DEF A()\n  5\nEND\n", "", r"a\.src: no program"),
        ("  5", "  \udcff", r"a\.src: not UTF-8 text"),
    ],
)
def test_malformed_files_are_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    """A malformed file gives an error with its name, its line and what is wrong."""
    data = GOOD.replace(old, new).encode("utf-8", "surrogateescape")
    (tmp_path / "a.src").write_bytes(data)
    with pytest.raises(NegativeError, match=message):
        load(tmp_path)


def test_a_missing_folder_is_an_error(tmp_path: Path) -> None:
    """A folder that is not there is no empty set of negatives."""
    with pytest.raises(NegativeError, match="no such folder"):
        load(tmp_path / "none")


def test_written_negatives_are_all_read_and_rejected() -> None:
    """The written negatives load, and the grammar in force rejects those that are its affair."""
    found = load(ROOT / "corpus" / "negatives")
    assert len(found) > 200
    recognizer = Recognizer(read_file(ROOT / "grammar" / "KRL.g4"))
    assert [] == NegativeSet(found).accepted(recognizer)


# ---------------------------------------------------------------------------------- trying


def test_accepted_are_those_the_recogniser_accepts() -> None:
    """Line by line gives what the whole text gives, with any line ends and without the last."""
    texts = [
        "",
        "A",
        "A\n",
        "A\r\nB\n",
        "A\n\n?\nB\n",
        "?\n",
        "A ; ?\nB",
        "; A\n",
        "A\rB\n",
        "A (  B\n",
    ]
    found = NegativeSet(map(negative, texts))
    gap = "GAP : '(' ' '+ -> skip ;\nSPACE"
    for recognizer in (
        toy(),
        toy("SPACE", gap),
        toy("WORD* NEWLINE", "WORD NEWLINE"),
        toy("'\\r\\n' | ", "'\\r' | "),
    ):
        expected = [text for text in texts if recognizer.accepts(text)]
        assert expected == [n.text for n in found.accepted(recognizer)]


@pytest.mark.parametrize(
    "rule",
    [
        "NOTE : '<' ~[>]* '>' -> skip ;",
        "LONG : '<' ~[>]* '>' ;",
        "ENDS : [\\n]+ -> skip ;",
        "TAIL : '\\n' '!' -> skip ;",
    ],
)
def test_tokens_over_several_lines_are_read_whole(rule: str) -> None:
    """A lexer whose tokens go on behind the line is asked about whole programs."""
    recognizer = toy("COMMENT", f"{rule}\nCOMMENT")
    texts = ["A <\n> B\n", "A <\nB\n", "A\n\n\nB\n", "A\n!B\n", "A"]
    expected = [text for text in texts if recognizer.accepts(text)]
    assert expected == [n.text for n in NegativeSet(map(negative, texts)).accepted(recognizer)]


def test_only_the_grammars_negatives_are_tried() -> None:
    """Negatives of the checker and of the run are not in the set."""
    found = NegativeSet([negative("A\n", "check"), negative("B\n"), negative("C\n", "run")])
    assert ["B\n"] == [n.text for n in found.accepted(toy())]
    assert 1 == len(found)


def test_what_was_rejected_before_can_be_asked_for() -> None:
    """Against the rejected ones a wider grammar shows what it newly accepts."""
    found = NegativeSet([negative("A\n"), negative("A B\n"), negative("?\n")])
    narrow = found.rejected_by(toy("WORD* NEWLINE", "WORD NEWLINE"))
    assert ["A B\n", "?\n"] == [n.text for n in narrow.negatives]
    assert ["A B\n"] == [n.text for n in narrow.accepted(toy())]
