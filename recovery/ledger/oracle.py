"""Oracles: a program in; accepted, or an error message, out.

The official implementation defines the language, but most people do not have it. So it is accessed
through one small interface with two adapters: a command that is run for each program, and a form of
verdicts that a person with the implementation has filled in (`recovery.ledger.verdicts`).
"""

from __future__ import annotations

import hashlib
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from grammar.blocks import OUTERMOST
from recovery.ledger.construct import ACCEPTED, REJECTED, Construct
from recovery.negatives.tokens import SourceLine, lines

_LONGEST_MESSAGE = 200


class OracleError(Exception):
    """An oracle cannot be asked or gave no answer; the message is one line."""


@dataclass(frozen=True, slots=True)
class ExampleProgram:
    """An example of a construct as a module of its own.

    ``name`` has at most 24 characters and is the name of its first routine or data list, as a
    controller requires. ``digest`` is that of the example in the ledger, so that an answer stays
    valid if the construct is renumbered. ``is_accept`` is what the ledger claims.
    """

    name: str
    text: str
    digest: str
    construct: str
    is_accept: bool

    @property
    def file_name(self) -> str:
        """The name with ``.dat`` for a data list and ``.src`` for anything else."""
        head = next((line for line in lines(self.text) if line.tokens), None)
        return f"{self.name}.{'dat' if head and head.lead == 'DEFDAT' else 'src'}"


@dataclass(frozen=True, slots=True)
class OracleAnswer:
    """The answer of an oracle to a program; ``message`` is the reason of a refusal."""

    is_accepted: bool
    message: str = ""


class Oracle(Protocol):
    """Accepts or refuses programs. ``name`` says what it is and whose answer it gives."""

    name: str

    def ask(self, program: ExampleProgram) -> OracleAnswer | None:
        """Return the answer, or ``None`` if it has none for the program; raises `OracleError`."""
        ...


class CommandOracle:
    """Runs a command with the path of the program as its last argument.

    Exit status 0 means accepted, 1 refused with the first line of output as the message. Any other
    status, and a timeout, is no answer and raises `OracleError`.
    """

    def __init__(self, command: Sequence[str], name: str, timeout: float) -> None:
        """Create it; ``timeout`` is in seconds for one program."""
        self.name = name
        self._command = tuple(command)
        self._timeout = timeout

    def ask(self, program: ExampleProgram) -> OracleAnswer:
        """Return the answer of the command, run in a temporary folder with only the program."""
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
    """Return the examples of a construct as modules, ``C0012_1`` and so on, accept ones first."""
    out = []
    for place, text in enumerate((*construct.accept, *construct.reject), 1):
        name = f"C{construct.number or 0:04}_{place}"  # must not reveal the expectation
        digest = hashlib.sha256(text.encode()).hexdigest()
        is_accept = place <= len(construct.accept)
        out.append(ExampleProgram(name, _renamed(text, name), digest, construct.id, is_accept))
    return tuple(out)


def _renamed(text: str, name: str) -> str:
    """Return the program with its first routine or data list renamed, and its references too."""
    found = lines(text)
    head = next((line for line in found if line.lead in OUTERMOST), None)
    old = _name_in(head) if head else ""
    if not old:
        return text
    return "\n".join(_with(line, old, name) for line in found)


def _name_in(head: SourceLine) -> str:
    """Return the name in the head of a routine or data list; empty if there is none."""
    kinds = head.kinds
    end = kinds.index("(") if "(" in kinds else len(kinds)
    names = [token.word for token in head.tokens[:end] if token.kind == "name"]
    names = [word for word in names if word not in OUTERMOST and word != "GLOBAL"]
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
    """Return the file as on a controller: CRLF, and cp1252 if that can encode it, else UTF-8."""
    text = program.text.replace("\r\n", "\n").replace("\n", "\r\n")
    try:
        return text.encode("cp1252")
    except UnicodeEncodeError:
        return text.encode("utf-8")


# ----------------------------------------------------------------------------------- verdicts


def reason_to_ask(construct: Construct) -> str:
    """Return why an oracle should be asked about a construct; empty if it need not be.

    A construct that two origins show needs no oracle. One that only a rule or a manual supports
    does: that may be from memory, or about another release.
    """
    evidence = construct.evidence
    if construct.state == REJECTED or evidence.verdict or evidence.origins >= 2:
        return ""
    if not construct.accept:  # there is no program to ask about
        return ""
    shown = "one origin" if evidence.origins else "no origin"
    if evidence.grounds:
        return f"documented, {shown} shows it"
    return f"no ground, {shown} shows it"


@dataclass(frozen=True, slots=True)
class OracleVerdict:
    """A construct with the verdict of an oracle, and how it differs from the ledger, by lines."""

    construct: Construct
    findings: tuple[str, ...]


def verdict_on(construct: Construct, oracle: Oracle) -> OracleVerdict:
    """Return the verdict of an oracle on a construct, from all of its examples.

    The verdict is ``accepted`` if every accept example is, and the first refusal otherwise; it is
    empty until all of them have answers. A reject example that the oracle accepts is a finding.
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
    return OracleVerdict(construct, tuple(findings))
