"""The oracle: a program in; accepted, or a message, out.

The official implementation says what the language is, but it is not at hand for most people. So it
is asked through one small interface, with two adapters: a command that is run for each program, and
a form of verdicts that a person with the implementation has filled (`recovery.ledger.verdicts`).
"""

from __future__ import annotations

import hashlib
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from recovery.ledger.construct import ACCEPTED, REJECTED, Construct
from recovery.negatives.tokens import SourceLine, lines

_HEADS = frozenset({"DEF", "DEFFCT", "DEFDAT"})
_LONGEST_MESSAGE = 200


class OracleError(Exception):
    """An oracle cannot be asked, or gave no answer; the message is one clear line."""


@dataclass(frozen=True, slots=True)
class ExampleProgram:
    """An example of a construct as a module of its own.

    ``name`` is at most 24 characters and the name of its first routine or data list, as a
    controller wants it. ``digest`` is that of the example as the ledger has it, so that an answer
    stays true when the construct gets another number. ``is_accept`` says what the ledger claims.
    """

    name: str
    text: str
    digest: str
    construct: str
    is_accept: bool

    @property
    def file_name(self) -> str:
        """``.dat`` for a data list, ``.src`` for anything else."""
        head = next((line for line in lines(self.text) if line.tokens), None)
        return f"{self.name}.{'dat' if head and head.lead == 'DEFDAT' else 'src'}"


@dataclass(frozen=True, slots=True)
class OracleAnswer:
    """What an oracle said about a program; the message is that of a refusal."""

    is_accepted: bool
    message: str = ""


class Oracle(Protocol):
    """Anything that accepts or refuses a program. ``name`` says what it is, and whose answer."""

    name: str

    def ask(self, program: ExampleProgram) -> OracleAnswer | None:
        """The answer; ``None`` where this oracle has none for the program. Raises `OracleError`."""
        ...


class CommandOracle:
    """Runs a command with the path of the program as its last argument.

    Exit status 0 is accepted, 1 refused, the first line of output being the message. Anything else,
    and silence for longer than the time given, is no answer and raises `OracleError`.
    """

    def __init__(self, command: Sequence[str], name: str, timeout: float) -> None:
        """``timeout`` in seconds for one program."""
        self.name = name
        self._command = tuple(command)
        self._timeout = timeout

    def ask(self, program: ExampleProgram) -> OracleAnswer:
        """Run the command in a folder of its own that holds the program and nothing else."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, program.file_name)
            path.write_bytes(as_bytes(program))
            try:
                run = subprocess.run(
                    [*self._command, str(path)],
                    cwd=folder,
                    stdin=subprocess.DEVNULL,
                    capture_output=True,
                    timeout=self._timeout,
                    check=False,
                )
            except subprocess.TimeoutExpired:
                raise OracleError(
                    f"{self.name}: no answer to {path.name} within {self._timeout:g} s"
                ) from None
            except OSError as error:
                raise OracleError(f"{self.name}: cannot be run: {error.strerror}") from None
        said = (run.stdout or run.stderr).decode("utf-8", "replace").strip().splitlines()
        message = " ".join(said[0].split())[:_LONGEST_MESSAGE] if said else ""
        if run.returncode not in (0, 1):
            raise OracleError(
                f"{self.name}: status {run.returncode} on {path.name} is no answer: {message}"
            )
        return OracleAnswer(run.returncode == 0, message or "without a message")


# ----------------------------------------------------------------------------- test programs


def programs_of(construct: Construct) -> tuple[ExampleProgram, ...]:
    """The examples of a construct as modules, ``C0012_1`` and so on, those to accept first."""
    out = []
    for place, text in enumerate((*construct.accept, *construct.reject), 1):
        name = f"C{construct.number or 0:04}_{place}"  # does not show what is expected
        digest = hashlib.sha256(text.encode()).hexdigest()
        is_accept = place <= len(construct.accept)
        out.append(ExampleProgram(name, _renamed(text, name), digest, construct.id, is_accept))
    return tuple(out)


def _renamed(text: str, name: str) -> str:
    """The program with its first routine or data list, and what refers to it, called ``name``."""
    found = lines(text)
    head = next((line for line in found if line.lead in _HEADS), None)
    old = _name_in(head) if head else ""
    if not old:
        return text
    return "\n".join(_with(line, old, name) for line in found)


def _name_in(head: SourceLine) -> str:
    """The name a head gives: before its parenthesis, or the first one; empty where none is."""
    kinds = head.kinds
    end = kinds.index("(") if "(" in kinds else len(kinds)
    names = [token.word for token in head.tokens[:end] if token.kind == "name"]
    names = [word for word in names if word not in _HEADS and word != "GLOBAL"]
    if not names:
        return ""
    return names[0] if head.lead == "DEFDAT" else names[-1]


def _with(line: SourceLine, old: str, new: str) -> str:
    text = line.text
    for token in reversed(line.tokens):
        if token.word == old:
            text = text[: token.start] + new + text[token.end :]
    return text


def as_bytes(program: ExampleProgram) -> bytes:
    """The file as a controller holds it: CRLF, and cp1252 where that can say it."""
    text = program.text.replace("\r\n", "\n").replace("\n", "\r\n")
    try:
        return text.encode("cp1252")
    except UnicodeEncodeError:
        return text.encode("utf-8")


# ----------------------------------------------------------------------------------- verdicts


def reason_to_ask(construct: Construct) -> str:
    """Why an oracle should be asked about a construct; empty where none need be.

    What two origins show needs no oracle. A rule or a manual alone is worth a question: it may be
    said from memory, or of another release.
    """
    evidence = construct.evidence
    if construct.state == REJECTED or evidence.verdict or evidence.origins >= 2:
        return ""
    if not construct.accept:  # there is nothing to ask about
        return ""
    shown = "one origin" if evidence.origins else "no origin"
    if evidence.grounds:
        return f"documented, {shown} shows it"
    return f"no ground, {shown} shows it"


@dataclass(frozen=True, slots=True)
class OracleVerdict:
    """A construct with the verdict of an oracle.

    ``unanswered`` is how many of its programs have no answer yet; ``findings`` say where the oracle
    and the ledger differ, a line each.
    """

    construct: Construct
    unanswered: int
    findings: tuple[str, ...]


def verdict_on(construct: Construct, oracle: Oracle) -> OracleVerdict:
    """Ask an oracle about all examples of a construct.

    The verdict is ``accepted`` when every accept example is, and the first refusal otherwise; it
    waits for the last answer about them. A reject example that the oracle accepts is a finding.
    """
    answers = [(program, oracle.ask(program)) for program in programs_of(construct)]
    findings: list[str] = []
    refused = ""
    for program, answer in answers:
        if answer is None or answer.is_accepted == program.is_accept:
            continue
        if program.is_accept:
            refused = refused or f"refused: {answer.message}"
            findings.append(f"{program.name}: refused: {answer.message}")
        else:
            findings.append(f"{program.name}: accepted, and the ledger says it must be rejected")
    waiting = sum(answer is None for program, answer in answers if program.is_accept)
    verdict = refused or (ACCEPTED if construct.accept and not waiting else "")
    if verdict:
        evidence = replace(construct.evidence, verdict=verdict, oracle=oracle.name)
        construct = replace(construct, evidence=evidence)
        if construct.state not in (ACCEPTED, REJECTED):
            construct = replace(construct, state=construct.earned_state)
    return OracleVerdict(construct, sum(answer is None for _, answer in answers), tuple(findings))
