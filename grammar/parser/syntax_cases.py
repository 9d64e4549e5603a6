"""Syntax cases: a title, KRL source, and the tree or the error that it must give.

    ====================
    an IF without ELSE
    ====================

    DEF A()
    IF B THEN
      HALT
    ENDIF
    END

    --------------------

    (procedure A (ifStatement B (halt)))

A bar is a line of three or more signs. ``:error`` below the title says that the source is no
program. The expectation is then ``LINE:COLUMN`` of the first token that no program can have there,
and the token. Blank lines around the source are ignored. `grammar.parser.sexpr` describes how trees
are written.

``python -m grammar.parser.syntax_cases PATH…`` lists the failing cases of files or folders. With
``--update`` it writes the trees of the current grammar into the files: review every changed line
before you keep it. It never turns an error into a tree or a tree into an error.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from grammar.notation.krl_grammar import krl_grammar
from grammar.parser.parse import Parser, Stop
from grammar.parser.recognizer import Recognizer
from grammar.parser.sexpr import Shortener, write

_BAR = re.compile(r"={3,}")
_RULE = re.compile(r"-{3,}")
_MARK = ":error"


class SyntaxCaseError(Exception):
    """The text is no file of cases; the message names the line."""


@dataclass(frozen=True, slots=True)
class SyntaxCase:
    """One case. ``lines`` is the range of lines of its expectation, the end excluded."""

    title: str
    source: str
    is_error: bool
    expected: str
    lines: tuple[int, int]


def read_cases(text: str) -> list[SyntaxCase]:
    """Return the cases of a file; raises `SyntaxCaseError` if it is not in the format above."""
    lines = text.split("\n")
    bars = [i for i, line in enumerate(lines) if _BAR.fullmatch(line.rstrip())]
    if len(bars) % 2 or "".join(lines[: bars[0] if bars else None]).strip():
        raise SyntaxCaseError("line 1: cases begin with a title between two bars of =")
    cases = []
    ends = [*bars[2::2], len(lines)]
    for above, below, end in zip(bars[::2], bars[1::2], ends, strict=False):
        title, *marks = (line.strip() for line in lines[above + 1 : below])
        if not title or marks not in ([], [_MARK]):
            raise SyntaxCaseError(f"line {above + 2}: a title, and {_MARK} below it or nothing")
        rules = [i for i in range(below + 1, end) if _RULE.fullmatch(lines[i].rstrip())]
        if len(rules) != 1:
            raise SyntaxCaseError(
                f"line {below + 1}: between source and expectation stands one bar of -"
            )
        source = "\n".join(lines[below + 1 : rules[0]]).strip("\n") + "\n"
        expected = "\n".join(lines[rules[0] + 1 : end]).strip()
        cases.append(SyntaxCase(title, source, bool(marks), expected, (rules[0] + 1, end)))
    return cases


class CaseReader:
    """Reads cases under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self._parser = Parser(recognizer)
        self._shortener = Shortener(recognizer.grammar)

    def outcome(self, case: SyntaxCase) -> tuple[bool, str]:
        """Return whether the source has an error, and the error or the tree as text."""
        tree = self._parser.parse(case.source)
        if isinstance(tree, Stop):
            token = tree.text.strip() or ("end of line" if tree.text else "end of file")
            return True, f"{tree.line}:{tree.column} {token}"
        return False, write(self._shortener.expression(tree))

    def difference(self, case: SyntaxCase) -> str | None:
        """Return what the source gives instead of what is expected, or ``None`` if they agree."""
        is_error, found = self.outcome(case)
        if is_error != case.is_error:
            return f"no program: {found}" if is_error else f"no error, but\n{found}"
        if _flat(case.expected, is_error=is_error) == _flat(found, is_error=is_error):
            return None
        return f"found\n{found}\nexpected\n{case.expected}"

    def updated(self, text: str) -> str:
        """Return a file of cases with the expectations replaced by what the sources give.

        A case whose source is an error although it should be none, or the other way round, stays as
        it is.
        """
        lines = text.split("\n")
        for case in reversed(read_cases(text)):
            is_error, found = self.outcome(case)
            if is_error == case.is_error and self.difference(case) is not None:
                lines[slice(*case.lines)] = ["", *found.split("\n"), ""]
        return "\n".join(lines)


def _flat(expectation: str, *, is_error: bool) -> str:
    """Return an expectation in one line: the line breaks of a tree have no meaning."""
    words = expectation.split() if is_error else map(str.strip, expectation.splitlines())
    return " ".join(filter(None, words))


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; exit status 0 all as expected, 1 some differ, 2 a file that cannot be read."""
    parser = argparse.ArgumentParser(prog="python -m grammar.parser.syntax_cases")
    parser.add_argument("paths", nargs="+", type=Path, metavar="PATH", help="file or folder")
    parser.add_argument("--update", action="store_true", help="write what is found into the files")
    options = parser.parse_args(arguments)
    reader = CaseReader(Recognizer(krl_grammar()))
    differing = 0
    files = [f for p in options.paths for f in (sorted(p.glob("*.txt")) if p.is_dir() else [p])]
    for path in files:
        try:
            text = path.read_text(encoding="utf-8")
            if options.update:
                path.write_text(reader.updated(text), encoding="utf-8", newline="\n")
                text = path.read_text(encoding="utf-8")
            cases = read_cases(text)
        except (OSError, ValueError, SyntaxCaseError) as error:
            sys.stderr.write(f"grammar.parser.syntax_cases: {path}: {error}\n")
            return 2
        for case in cases:
            difference = reader.difference(case)
            if difference is not None:
                differing += 1
                sys.stdout.write(f"{path}:{case.lines[0]}: {case.title}\n{difference}\n\n")
    return 1 if differing else 0


if __name__ == "__main__":
    raise SystemExit(main())
