"""The oracle: what is asked, how a command answers, and what becomes of the answers."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation.edits import AddToken
from recovery.ledger.construct import Construct, Evidence
from recovery.ledger.oracle import (
    CommandOracle,
    ExampleProgram,
    OracleAnswer,
    OracleError,
    as_bytes,
    programs_of,
    reason_to_ask,
    verdict_on,
)

GOOD = '; head\nDEF Deep( A:IN)\nDEEP (A) ; deep\nS="DEEP"\nX.DEEP=1\nEND\n'
BAD = "DEF A()\nX=\nEND\n"


def construct(*accept: str, reject: tuple[str, ...] = (), **changes: object) -> Construct:
    return Construct("a", "T", (AddToken("X"),), 12, accept=accept, reject=reject, **changes)  # type: ignore[arg-type]


class Fixed:
    """An oracle that accepts what holds a word, refuses what holds another, else is silent."""

    name = "a fixed oracle"

    def ask(self, program: ExampleProgram) -> OracleAnswer | None:
        """What its text says."""
        if "GOOD" in program.text:
            return OracleAnswer(True)
        return OracleAnswer(False, "KSS2023") if "BAD" in program.text else None


# ----------------------------------------------------------------------------- test programs


def test_each_example_is_a_module_of_its_own() -> None:
    """Its first routine has its name, wherever it is named; strings and comments stay."""
    one, two = programs_of(construct(GOOD, reject=(BAD,)))
    assert ("C0012_1", "C0012_1.src", True) == (one.name, one.file_name, one.is_accept)
    assert ("C0012_2", "C0012_2.src", False) == (two.name, two.file_name, two.is_accept)
    expected = '; head\nDEF C0012_1( A:IN)\nC0012_1 (A) ; deep\nS="DEEP"\nX.C0012_1=1\nEND\n'
    assert expected == one.text
    assert "DEF C0012_2()\nX=\nEND\n" == two.text


@pytest.mark.parametrize(
    ("text", "expected", "file"),
    [
        ("DEFDAT A PUBLIC\nENDDAT\n", "DEFDAT C0012_1 PUBLIC\nENDDAT\n", "C0012_1.dat"),
        (
            "&ACCESS RV\nDEFFCT INT F(N:IN)\nRETURN F(N)\nENDFCT\n",
            "&ACCESS RV\nDEFFCT INT C0012_1(N:IN)\nRETURN C0012_1(N)\nENDFCT\n",
            "C0012_1.src",
        ),
        ("GLOBAL DEF P()\nEND\n", "GLOBAL DEF C0012_1()\nEND\n", "C0012_1.src"),
        ("DEFFCT POS Q()\nENDFCT\n", "DEFFCT POS C0012_1()\nENDFCT\n", "C0012_1.src"),
        ("; nothing\n", "; nothing\n", "C0012_1.src"),
        ("DEF ()\nEND\n", "DEF ()\nEND\n", "C0012_1.src"),
    ],
)
def test_any_kind_of_module_gets_its_name(text: str, expected: str, file: str) -> None:
    """Functions, data lists, headers in front; what has no name is left alone."""
    (program,) = programs_of(construct(text))
    assert (expected, file) == (program.text, program.file_name)
    assert len(program.name) <= 24


def test_an_answer_outlives_the_number() -> None:
    """The digest is that of the example, not of the module made of it."""
    one, other = construct(GOOD), replace(construct(GOOD), number=13)
    assert programs_of(one)[0].digest == programs_of(other)[0].digest
    assert programs_of(one)[0].digest != programs_of(construct(BAD))[0].digest


def test_a_file_is_as_a_controller_holds_it() -> None:
    """Lines end with CRLF; cp1252 where it can say it, else UTF-8."""
    for text, expected in (("A\nÄ\r\n", b"A\r\n\xc4\r\n"), ("→\n", b"\xe2\x86\x92\r\n")):
        assert expected == as_bytes(ExampleProgram("P", text, "", "", is_accept=True))


# ------------------------------------------------------------------------------- the command


def command(tmp_path: Path, body: str, timeout: float = 60.0) -> CommandOracle:
    script = tmp_path / "ask.py"
    script.write_text(f"import sys, pathlib, time\n{body}\n", encoding="utf-8")
    return CommandOracle([sys.executable, str(script)], "the command", timeout)


PROGRAM = ExampleProgram("C0001_1", "DEF C0001_1()\nEND\n", "", "", is_accept=True)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("sys.exit(0)", OracleAnswer(True)),
        ("print('  no  =\\nmore'); sys.exit(1)", OracleAnswer(False, "no =")),
        ("sys.stderr.write('bad'); sys.exit(1)", OracleAnswer(False, "bad")),
        ("sys.exit(1)", OracleAnswer(False, "without a message")),
    ],
)
def test_a_command_accepts_or_refuses(tmp_path: Path, body: str, expected: OracleAnswer) -> None:
    """Status 0 is accepted, 1 refused with the first line that it printed."""
    found = command(tmp_path, body).ask(PROGRAM)
    assert expected.is_accepted == found.is_accepted
    assert expected.is_accepted or expected.message == found.message


def test_a_command_gets_the_file_alone(tmp_path: Path) -> None:
    """The path is the last argument; the folder holds nothing else, and no input waits."""
    body = (
        "p = pathlib.Path(sys.argv[-1]); assert sys.stdin.read() == ''\n"
        "print(p.name, len(list(p.parent.iterdir())), p.read_bytes()); sys.exit(1)"
    )
    message = command(tmp_path, body).ask(PROGRAM).message
    assert r"C0001_1.src 1 b'DEF C0001_1()\r\nEND\r\n'" == message


@pytest.mark.parametrize(
    ("body", "timeout", "said"),
    [
        ("sys.exit(2)", 60, "status 2 on C0001_1.src is no answer"),
        ("time.sleep(60)", 0.5, "no answer to C0001_1.src within 0.5 s"),
    ],
)
def test_what_is_no_answer_is_an_error(
    tmp_path: Path, body: str, timeout: float, said: str
) -> None:
    """Another status and silence say nothing about the program."""
    with pytest.raises(OracleError, match=said):
        command(tmp_path, body, timeout).ask(PROGRAM)


def test_a_command_that_is_not_there_is_an_error() -> None:
    """One line says so."""
    with pytest.raises(OracleError, match="cannot be run"):
        CommandOracle(["no-such-command-anywhere"], "it", 1).ask(PROGRAM)


# ------------------------------------------------------------------------------ the verdicts


@pytest.mark.parametrize(
    ("accept", "reject", "verdict", "findings"),
    [
        (["GOOD"], [], "accepted", 0),
        (["GOOD", "BAD"], [], "refused: KSS2023", 1),
        (["GOOD", "what"], [], "", 0),
        (["BAD", "what"], [], "refused: KSS2023", 1),
        (["GOOD"], ["BAD"], "accepted", 0),
        (["GOOD"], ["GOOD one"], "accepted", 1),
        (["GOOD"], ["what"], "accepted", 0),
        ([], ["BAD"], "", 0),
    ],
)
def test_a_verdict_is_that_of_all_accept_examples(
    accept: list[str], reject: list[str], verdict: str, findings: int
) -> None:
    """One refusal refuses; a missing answer keeps it waiting; what differs is told."""
    found = verdict_on(construct(*accept, reject=tuple(reject)), Fixed())
    assert verdict == found.construct.evidence.verdict
    assert findings == len(found.findings)
    assert ("a fixed oracle" if verdict else "") == found.construct.evidence.oracle


def test_a_verdict_gives_the_state() -> None:
    """A proposal becomes confirmed; what is accepted or rejected stays so."""
    states = ("proposed", "accepted", "rejected")
    found = [
        verdict_on(construct("GOOD", state=state), Fixed()).construct.state for state in states
    ]
    assert ["confirmed", "accepted", "rejected"] == found
    refused = verdict_on(construct("BAD", state="proposed"), Fixed()).construct
    assert "proposed" == refused.state


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({}, "no ground, no origin shows it"),
        ({"evidence": Evidence(3, 1, 3)}, "no ground, one origin shows it"),
        ({"evidence": Evidence(rules=("CTL-05",))}, "documented, no origin shows it"),
        ({"evidence": Evidence(3, 1, 3, ("CTL-05",))}, "documented, one origin shows it"),
        ({"evidence": Evidence(3, 2, 3)}, ""),
        ({"evidence": Evidence(verdict="accepted")}, ""),
        ({"evidence": Evidence(verdict="refused: no")}, ""),
        ({"state": "rejected"}, ""),
    ],
)
def test_what_one_origin_shows_waits_for_a_verdict(changes: dict[str, object], reason: str) -> None:
    """Two origins, a verdict and a rejection need none."""
    assert "" == reason_to_ask(construct(**changes))  # type: ignore[arg-type]
    assert reason == reason_to_ask(construct(GOOD, **changes))  # type: ignore[arg-type]
