"""Comparison with other parsers: which cases each of them accepts and rejects correctly.

Only the text of a case is used, without the front matter, because many parsers expect a file to
begin with its first routine. A case that expects ``syntax`` must be rejected, at any place; every
other case must be accepted, with all its files. This project contains nothing of third parties:
their grammar is compiled by ANTLR on request, or their program is run as a command.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module, invalidate_caches
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from conformance.evaluation.case_result import CaseResult, Result
from conformance.suite.case import Case
from grammar.notation.generate import GenerationError, run_antlr
from grammar.parser.antlr_reference import refusal_by
from grammar.syntax.build import read_module
from grammar.syntax.source import Source

#: The name of this project's parser.
OWN: Final = "krl"
#: The longest time in s that a command may take for a file.
_LONGEST: Final = 600
_NAME: Final = re.compile(r"^\s*(?:parser\s+)?grammar\s+(\w+)\s*;", re.MULTILINE)
_FRONT: Final = re.compile(r"(?:;@.*\n)+")
_COMMENT: Final = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)

#: Returns why a text is rejected; "" if it is accepted.
Parser = Callable[[Source], str]


class ParserError(ValueError):
    """A parser cannot be used; the text is one line with the reason."""


@contextmanager
def parsers(wanted: Sequence[str]) -> Iterator[Mapping[str, Parser]]:
    """Provide parsers by name, ours first, within this context. Raises `ParserError`.

    Each is given as ``NAME=WHAT``: an ANTLR grammar (``….g4``, whose first rule reads a file), or a
    command. The file name replaces ``{}`` in a command, or is appended to it; status 0 means that
    the file was accepted.
    """
    found: dict[str, Parser] = {OWN: _own_parser}
    with TemporaryDirectory() as folder:
        for number, one in enumerate(wanted):
            name, equals, what = one.partition("=")
            if not name or not equals or not what or name in found:
                raise ParserError(f"{one}: a parser is NAME=GRAMMAR.g4 or NAME=COMMAND")
            place = Path(folder, str(number))
            place.mkdir()
            is_grammar = what.endswith(".g4")
            found[name] = _compiled(Path(what), place) if is_grammar else _command(what, place)
        yield found


def _own_parser(source: Source) -> str:
    read = read_module(source.text, source.path)
    return f"line {read[0].line}: {read[0].reason or ''}" if isinstance(read, list) else ""


def _compiled(path: Path, folder: Path) -> Parser:
    """Return the parser that ANTLR generates from a grammar, whose first rule reads a file."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ParserError(f"{path}: cannot be read: {error}") from error
    named = _NAME.search(_COMMENT.sub("", text))
    if named is None:
        raise ParserError(f"{path}: it is no ANTLR grammar of a parser and its lexer")
    try:
        run_antlr(["-o", str(folder), str(path.resolve())], folder)
    except GenerationError as error:
        raise ParserError(f"{path}: {error}") from error
    sys.path.insert(0, str(folder))
    try:
        lexer, parser = (_class_of_module(f"{named[1]}{part}") for part in ("Lexer", "Parser"))
    except (ImportError, AttributeError) as error:
        raise ParserError(f"{path}: what ANTLR made of it cannot be used: {error}") from error
    finally:
        sys.path.remove(str(folder))
    rule = str(parser.ruleNames[0])
    start = rule if hasattr(parser, rule) else f"{rule}_"  # the rule name is a keyword of Python

    def reads(source: Source) -> str:
        why = refusal_by(lexer, parser, start, source.text)
        return f"line {why.line}: {why.message}" if why else ""

    return reads


def _class_of_module(name: str) -> Any:
    """Return the class of a module with the same name, even if another grammar had this name."""
    sys.modules.pop(name, None)
    invalidate_caches()
    return getattr(import_module(name), name)


def _command(what: str, folder: Path) -> Parser:
    try:
        words = shlex.split(what)
    except ValueError as error:
        raise ParserError(f"{what}: {error}") from error

    def reads(source: Source) -> str:
        file = folder / source.path.lstrip("$")
        file.write_text(source.text, encoding="utf-8", newline="\n")
        command_words = [str(file) if word == "{}" else word for word in words]
        command = command_words if "{}" in words else [*command_words, str(file)]
        try:
            done = subprocess.run(command, capture_output=True, timeout=_LONGEST, check=False)
        except subprocess.TimeoutExpired:
            return f"it takes more than {_LONGEST} seconds"
        except OSError as error:
            raise ParserError(f"{what}: cannot be run: {error.strerror}") from error
        lines = (done.stdout + done.stderr).decode("utf-8", "replace").split("\n", 1)
        return (lines[0].strip() or f"status {done.returncode}") if done.returncode else ""

    return reads


def compared(
    cases: Sequence[Case],
    by_name: Mapping[str, Parser],
    on_done: Callable[[int], None] = lambda _count: None,
) -> list[CaseResult]:
    """Return the results of each case with each parser; ``on_done`` is called for each case."""
    found = []
    for case in cases:
        results = tuple(_result(case, name, parser) for name, parser in by_name.items())
        found.append(CaseResult(case, results))
        on_done(1)
    return found


def _result(case: Case, name: str, parser: Parser) -> Result:
    begun = time.perf_counter()
    sources = [Source(_FRONT.sub("", one.text, count=1), one.path) for one in case.sources]
    refusals = [f"{one.path}: {why}" for one in sources if (why := parser(one))]
    if case.expects_syntax_error:
        reason = "" if refusals else "it is read, and is no KRL"
    else:
        reason = refusals[0] if refusals else ""
    took = time.perf_counter() - begun
    return Result(name, "none", "fail" if reason else "pass", reason, (), took)
