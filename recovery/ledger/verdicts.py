"""Recorded verdicts: a bundle that a person takes to the implementation, and its form.

The bundle is a folder with programs, a README with instructions, and ``verdicts.toml``, the form to
fill in. A filled form is an oracle.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from recovery.ledger.oracle import ExampleProgram, OracleAnswer, OracleError, as_bytes
from support.files.atomic_write import write_together
from support.files.untrusted import DocumentError, read_bytes, toml_of

#: The name of the form in a bundle.
FORM = "verdicts.toml"
_ACCEPTED = "accepted"
_README = """\
Programs for the official implementation
========================================

Somebody without it asks you, who have it, what it says about these programs: {count} in all. Each
shows one construct of the KUKA Robot Language and does nothing. They are to be loaded or compiled,
never to be run.

1. Copy the folder programs to the controller or to OfficeLite, for instance into KRC:\\R1\\Program.
   Each file is a module of its own, and its first routine has its name.
2. Look at the messages about each file, as the editor or the display of errors shows them.
3. Fill verdicts.toml. At its head: who you are (a name or none), when it was, which release. For
   each program: answer = "accepted", or the message it was refused with, in one line.
   Leave the answer empty where you do not know.

Only the form of the programs is asked for. Where the only messages are about names or files that
do not exist, the answer is "accepted". Some programs are expected to be refused; nothing here says
which, so that the answers are not biased.

Send verdicts.toml back. It is read with

    krl construct oracle --record verdicts.toml
"""
_HEAD = """\
# Fill the three lines, and an answer for each program: "accepted", or the message of the refusal.
by = ""
when = ""      # such as 2026-03-31
release = ""   # such as KSS 8.6.7, OfficeLite
"""


def write_bundle(programs: Sequence[ExampleProgram], folder: Path) -> list[Path]:
    """Write programs, README and an empty form into a folder; return the written files.

    Raises `OracleError` if the folder already has a form, which may be partly filled in.
    """
    if (folder / FORM).exists():
        raise OracleError(f"{folder / FORM}: there is a form already; choose another folder")
    files: dict[Path, bytes | None] = {
        folder / "programs" / program.file_name: as_bytes(program) for program in programs
    }
    readme = _README.format(count=len(programs))
    files[folder / "README.txt"] = readme.encode()
    files[folder / FORM] = "\n".join((_HEAD, *map(_entry, programs))).encode()
    return write_together(files)


def _entry(program: ExampleProgram) -> str:
    return (
        f'[[program]]\nfile = "{program.file_name}"\nconstruct = "{program.construct}"\n'
        f'sha256 = "{program.digest}"\nanswer = ""\n'
    )


class RecordedOracle:
    """The answers in a filled form, by the digest of the example.

    ``name`` says which release was asked, by whom and when.
    """

    def __init__(self, form: Path) -> None:
        """Read a form; raises `OracleError`, which names the file and the key."""
        try:
            data = toml_of(read_bytes(form).decode("utf-8-sig"))
        except OSError as error:
            raise OracleError(f"{form}: {error.strerror or error}") from None
        except UnicodeDecodeError:
            raise OracleError(f"{form}: not TOML: not UTF-8 text") from None
        except DocumentError as error:
            raise OracleError(f"{form}: {error}") from None
        self._form = form
        named = [self._text(data, key) for key in ("release", "by", "when")]
        if not named[0]:
            raise OracleError(f"{form}: release: is empty; say which release was asked")
        self.name = ", ".join(filter(None, named))
        self._answers: dict[str, OracleAnswer] = {}
        programs = data.get("program", [])
        if not isinstance(programs, list) or not all(isinstance(p, dict) for p in programs):
            raise OracleError(f"{form}: program: is not a list of tables")
        for number, program in enumerate(programs, 1):
            where = f"program number {number}: "
            digest = self._text(program, "sha256", where)
            said = " ".join(self._text(program, "answer", where).split())
            if said:
                is_accepted = said.lower() == _ACCEPTED
                self._answers[digest] = OracleAnswer(is_accepted, "" if is_accepted else said)

    def __len__(self) -> int:
        """Return how many programs have an answer."""
        return len(self._answers)

    def ask(self, program: ExampleProgram) -> OracleAnswer | None:
        """Return the recorded answer for a program, or ``None``."""
        return self._answers.get(program.digest)

    def _text(self, table: dict[str, Any], key: str, where: str = "") -> str:
        value = table.get(key, "")
        if key == "when":  # an unquoted date is as good as a quoted one
            value = str(value)
        if not isinstance(value, str):
            raise OracleError(f"{self._form}: {where}{key}: is not a text")
        return value.strip()
