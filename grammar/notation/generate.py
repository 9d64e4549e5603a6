"""Generate the ANTLR parser: ``python -m grammar.notation.generate [--check | --verify]``.

Without an option, runs ANTLR (Java) on ``KRL.g4`` and writes ``_generated/``: the parser, the
grammar as data, and a manifest of digests. ``--check`` needs no Java: it compares the digests with
the files. ``--verify`` generates afresh and compares byte for byte.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from support.input_error import InputError

ANTLR_VERSION = "4.13.2"
_LONGEST = 600  # seconds that ANTLR may take for a grammar
HERE = Path(__file__).resolve().parents[1]
GRAMMAR = HERE / "KRL.g4"
GENERATED = HERE / "_generated"
DATA = "krl_grammar.py"
MANIFEST = "MANIFEST"
MARK = '"""Generated from grammar/KRL.g4 by ANTLR; do not edit (make grammar)."""\n'


class GenerationError(InputError):
    """ANTLR could not be run, or it rejected the grammar."""


def generate(grammar: Path, folder: Path) -> None:
    """Write lexer, parser, ``__init__`` and manifest for ``grammar`` into ``folder``.

    Raises `GenerationError` if Java or ANTLR is missing or the grammar has errors.
    """
    with tempfile.TemporaryDirectory() as scratch:
        # ANTLR writes the path it was given into what it generates; a bare name keeps that stable
        shutil.copyfile(grammar, Path(scratch) / "KRL.g4")
        run_antlr(["-no-listener", "-no-visitor", "-Werror", "KRL.g4"], Path(scratch))
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("KRLLexer.py", "KRLParser.py"):
            text = (Path(scratch) / name).read_text(encoding="utf-8")
            (folder / name).write_text(text, encoding="utf-8", newline="\n")
    (folder / "__init__.py").write_text(MARK, encoding="utf-8", newline="\n")
    (folder / DATA).write_text(_data(grammar), encoding="utf-8", newline="\n")
    manifest = "".join(f"{digest}  {name}\n" for name, digest in _digests(grammar, folder))
    (folder / MANIFEST).write_text(manifest, encoding="utf-8", newline="\n")


def run_antlr(arguments: Sequence[str], folder: Path) -> None:
    """Let ANTLR generate Python code in a folder. Raises `GenerationError`."""
    tool = shutil.which(
        "antlr4",
        path=os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", ""))),
    )
    if tool is None:
        raise GenerationError("antlr4 is missing: install the extra 'dev' (antlr4-tools)")
    command = [tool, "-Dlanguage=Python3", *arguments]
    environment = {**os.environ, "ANTLR4_TOOLS_ANTLR_VERSION": ANTLR_VERSION}
    try:
        run = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=_LONGEST,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise GenerationError(f"antlr4 cannot be run: {error}") from None
    if run.returncode != 0:
        lines = (run.stderr or run.stdout).strip().splitlines()
        raise GenerationError(lines[0] if lines else "ANTLR failed without a message")


def check(grammar: Path = GRAMMAR, folder: Path = GENERATED) -> str | None:
    """Return why the generated parser is stale, or ``None`` if it is up to date. Needs no Java."""
    try:
        manifest = (folder / MANIFEST).read_text(encoding="utf-8")
        pairs = (line.split("  ", 1) for line in manifest.splitlines())
        recorded = {name: digest for digest, name in pairs}
        for name, digest in _digests(grammar, folder):
            if recorded.get(name) != digest:
                return f"{name} is not what the generated parser was made from; run 'make grammar'"
        if (folder / DATA).read_text(encoding="utf-8") != _data(grammar):
            return f"{DATA} is not what KRL.g4 is read as; run 'make grammar'"
    except (OSError, ValueError) as error:
        return f"the generated parser is incomplete ({error}); run 'make grammar'"
    return None


def _data(grammar: Path) -> str:
    """Return the source of a module that builds the grammar without parsing it."""
    from grammar.notation.g4 import read  # brings Lark

    source = grammar.read_bytes().replace(b"\r\n", b"\n")
    found = read(source.decode(), source=grammar.name)
    digest = hashlib.sha256(source).hexdigest()
    return (
        f"{MARK}\nfrom grammar.notation.model import *\n\nSHA256 = {digest!r}\n\n\n"
        f"def grammar() -> Grammar:\n    return {found!r}\n"
    )


def _digests(grammar: Path, folder: Path) -> list[tuple[str, str]]:
    files = [("KRL.g4", grammar)]
    files += [(name, folder / name) for name in ("KRLLexer.py", "KRLParser.py", "__init__.py")]
    return [
        (name, hashlib.sha256(path.read_bytes().replace(b"\r\n", b"\n")).hexdigest())
        for name, path in files
    ]


def _verify() -> str | None:
    with tempfile.TemporaryDirectory() as scratch:
        fresh = Path(scratch)
        generate(GRAMMAR, fresh)
        for path in sorted(fresh.iterdir()):
            committed = GENERATED / path.name
            if not committed.exists() or committed.read_bytes() != path.read_bytes():
                return (
                    f"_generated/{path.name} differs from what ANTLR generates; run 'make grammar'"
                )
    return None


def main() -> int:
    """Entry point; exit status 0 fine, 1 stale, 2 ANTLR could not be run."""
    import argparse  # every command imports this module for its paths

    parser = argparse.ArgumentParser(
        prog="python -m grammar.notation.generate", description=__doc__
    )
    parser.add_argument("--check", action="store_true", help="compare digests, without Java")
    parser.add_argument("--verify", action="store_true", help="generate afresh and compare")
    options = parser.parse_args()
    try:
        if options.check or options.verify:
            stale = check() or (_verify() if options.verify else None)
            print(stale or "the generated parser is up to date")
            return 1 if stale else 0
        generate(GRAMMAR, GENERATED)
    except GenerationError as error:
        print(f"grammar.notation.generate: {error}", file=sys.stderr)
        return 2
    print(f"generated {GENERATED.name}/ from {GRAMMAR.name} with ANTLR {ANTLR_VERSION}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
