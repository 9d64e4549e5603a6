"""Error recovery of the check: builds a syntax tree although some lines have syntax errors.

A syntax error costs its statement, not the file. The first line that cannot be read is overwritten
with blanks, so that all offsets stay valid, and the text is parsed again, until it is a program.
Failures that only follow from an earlier error are marked: the end or a branch of a block whose
first line was blanked, a block whose last line was blanked, and the uses of a variable whose name
is a keyword. Such a variable gets another name of the same length in all its lines.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import PurePath

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS, OUTERMOST, PREFIXES
from grammar.diagnostics.expected_tokens import is_in_place_of_name
from grammar.diagnostics.open_blocks import OpenBlock, innermost, lead, open_blocks
from grammar.diagnostics.typos import Series, Typos
from grammar.parser.tree import Tree
from grammar.syntax import ast
from grammar.syntax.build import SyntaxFailure, builder
from grammar.syntax.node_plans import TooDeep
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

# Every line that is blanked out costs a parse of the whole text.
_MOST_ROUNDS = 60
_LARGEST = 2_000_000
#: A first line for a routine, by its closing word.
_HEADS = {"END": "DEF {}()", "ENDFCT": "DEFFCT INT {}()", "ENDDAT": "DEFDAT {}"}
#: Replacements for the first or last line of a block, with which its body runs once.
_ONCE = {"CASE": "CASE 0", "IF": "IF TRUE THEN", "FOR": "FOR {}=1 TO 1", "UNTIL": "UNTIL TRUE"}
_STRUCTURE = frozenset({*BLOCKS, *BRANCHES, *CLOSERS})
_SLIPS_OF_STRUCTURE = Typos(_STRUCTURE, series=Series.NONE)
_SLIPS_OF_HEADS = Typos(OUTERMOST, series=Series.NONE)
#: What a line begins with that no finding is about: a comment, a header of the controller.
_FREE = (";", "&")
_NAME = re.compile(r"[$A-Za-z_][\w$]*")
#: A text, a comment or a word.
_WORDS = re.compile(r'"[^"\n]*"|;.*|(?<![\w$#.])[A-Za-z_]\w*', re.ASCII)
#: A type declaration can be cut after some of its members: the type is then known to have others.
_TYPE = re.compile(r"[ \t]*(?:(?:DECL|GLOBAL)[ \t]+)*(?:ENUM|STRUC)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Recovered:
    """What can be read of a text with syntax errors.

    ``syntax`` is the tree of the text without the lines that cannot be read; ``None`` if there are
    too many of these or no routine is left. ``failures`` are in the order of the text, marked if
    they only follow from others. ``dropped`` is the text of the lines that were left out.
    ``exchanged`` are the numbers of all lines that were replaced; findings on them have to be
    discarded. ``text`` is the text that was parsed in the end, ``left_out`` are the numbers of the
    lines left out. ``is_cut`` says that the last routine or data list has no end.
    """

    syntax: ast.Module | None
    failures: tuple[SyntaxFailure, ...]
    dropped: str
    exchanged: frozenset[int] = frozenset()
    text: str = ""
    left_out: frozenset[int] = frozenset()
    is_cut: bool = False


def recover(text: str, path: str = "") -> Recovered:
    """Return what can be read of a text with syntax errors; ``path`` is its file."""
    if len(text) <= _LARGEST:
        found = _Recovery(text, path).run()
        if found is not None:
            return found
    failures = builder().read(text, path)
    assert isinstance(failures, list), "only what cannot be read is to be recovered"
    marked = tuple(_causes_first(Source(text, path), failures))
    is_cut = any(not failure.text and not failure.follows for failure in marked)
    return Recovered(None, marked, text, is_cut=is_cut)


def _causes_first(source: Source, failures: Sequence[SyntaxFailure]) -> Iterator[SyntaxFailure]:
    """Yield the failures of a text; those that follow from an unclosed block are marked."""
    blocks = open_blocks(source, [failure.line for failure in failures])
    is_unclosed = False
    for failure in failures:
        line = source.line(failure.line)
        cause = _unclosed(line, failure.text, blocks[failure.line])
        is_structural = cause is not None or lead(line) in CLOSERS or not failure.text
        yield replace(failure, follows=failure.follows or (is_unclosed and is_structural))
        is_unclosed |= cause is not None


class _Recovery:
    """A text that is edited until it can be parsed."""

    def __init__(self, text: str, path: str) -> None:
        self._path = path
        self._is_open_ended = not text.endswith(("\n", "\r"))
        self._text = f"{text}\n" if self._is_open_ended else text
        self._written = Source(self._text, path)
        self._dropped: set[int] = set()
        self._exchanged: dict[int, str] = {}
        self._failures: list[SyntaxFailure] = []
        self._readings: dict[int, Iterator[str]] = {}
        self._renamed: dict[str, str] = {}
        self._is_cut = False
        self._heads: list[str] = []  # what is named in first lines that were written here

    def run(self) -> Recovered | None:
        """Return the tree and the failures; ``None`` if recovery fails."""
        ours = builder()
        for _ in range(_MOST_ROUNDS):
            tree = ours.parser.parse(self._text)
            if isinstance(tree, Tree):
                try:
                    return self._recovered(ours.module(tree))
                except TooDeep:
                    return None
            context = ours.failures.context(tree.state)
            source = Source(self._text, self._path)
            block = open_blocks(source, [tree.line])[tree.line]
            cause = _unclosed(source.line(tree.line), tree.text, block)
            is_orphan = self._is_orphan(tree.line, tree.text)
            if cause is not None:
                follows = self._is_explained(cause)
            else:
                is_use = self._is_renamed(tree.text.upper(), context.expected)
                follows = is_use or (bool(self._failures) and (block is None or is_orphan))
            is_case = "CASE" in context.expected and cause is None
            if tree.line in self._readings:
                if self._read_otherwise(tree.line):
                    continue
            else:
                self._failures.append(
                    SyntaxFailure(
                        self._path,
                        tree.line,
                        tree.column,
                        tree.offset,
                        tree.text,
                        context.expected,
                        context.rule,
                        follows,
                    )
                )
                if cause is None:
                    self._readings[tree.line] = self._readings_of(tree.line, tree.column, block)
                    if self._read_otherwise(tree.line):
                        continue
            if not (
                (is_case and self._write(tree.line, "CASE 0"))
                or self._open(tree.line, block)
                or self._mend(cause, tree.line, is_at_end=not source.line(tree.line).strip())
            ):
                return None
        return None

    def _recovered(self, syntax: ast.Module) -> Recovered:
        self._failures.sort(key=lambda failure: failure.offset)
        lines = (self._written.line(number) for number in sorted(self._dropped))
        dropped = "\n".join((*lines, *self._heads))
        return Recovered(
            syntax,
            tuple(self._failures),
            dropped,
            frozenset(self._exchanged),
            self._text,
            frozenset(self._dropped),
            self._is_cut,
        )

    def _is_orphan(self, line: int, token: str) -> bool:
        """Return whether a line fails at its first word, which closes or continues a block."""
        word = lead(self._written.line(line))
        return word == token.upper() and (word in CLOSERS or word in BRANCHES)

    def _is_explained(self, cause: OpenBlock) -> bool:
        """Return whether a line that failed earlier may have been meant to close the block."""
        routine = cause
        while routine.outer is not None:
            routine = routine.outer
        failed = [one.line for one in self._failures if one.line >= routine.line]
        if self._is_open_ended and len(self._written.lines) - 1 in failed:
            return True  # the file breaks off there
        return any(_is_like_structure(self._written.line(line)) for line in failed)

    def _is_renamed(self, word: str, expected: Sequence[str]) -> bool:
        """Return whether a failing token is a keyword that was the name of a variable before.

        Rename it from now on if this is its declaration.
        """
        if word in self._renamed:
            return "NAME" in expected
        name = f"{word[:-1]}_"
        if is_in_place_of_name(word, expected) and not re.search(rf"\b{name}\b", self._text, re.I):
            self._renamed[word] = name
        return False

    def _readings_of(self, line: int, column: int, block: OpenBlock | None) -> Iterator[str]:
        """Yield replacements for a line that cannot be read.

        First the line with other names for variables that are called like a keyword, then its
        beginning up to the failure, then a line with the same first word that is valid and lets the
        body run once.
        """
        written = self._written.line(line)
        if self._renamed:
            words = _WORDS.sub(lambda one: self._renamed.get(one[0].upper(), one[0]), written)
            if words != written:
                yield words
        beginning = written[: column - 1].rstrip()
        word = lead(written)
        if _TYPE.match(beginning):
            yield beginning.rpartition(",")[0]
        elif lead(beginning) in BLOCKS or lead(beginning) in BRANCHES:
            yield beginning
        if word in _ONCE and (word != "UNTIL" or (block is not None and block.closer == word)):
            yield _ONCE[word].format((*_NAME.findall(written), "")[1])

    def _read_otherwise(self, line: int) -> bool:
        """Replace a line by its next possible replacement, and return whether there was one.

        It is restored if there is none left.
        """
        if self._exchanged.pop(line, None) is not None:
            self._dropped.discard(line)
        return any(text and self._write(line, text) for text in self._readings[line])

    def _open(self, line: int, block: OpenBlock | None) -> bool:
        """Write the first line of the routine or data list that ends below.

        It takes the place of a line that looks like it, else of a free line before. Returns whether
        that was possible.
        """
        if block is not None or line in self._dropped:
            return False
        later = (lead(text) for text in self._written.lines[line:])
        head = _HEADS.get(next((word for word in later if word in _HEADS or word in OUTERMOST), ""))
        if head is None:
            return False
        before = self._written.lines[: line - 1]
        stem = PurePath(self._path).stem
        words = _NAME.findall(self._written.line(line).upper())
        first, *words = [word for word in words if word not in PREFIXES] or [""]
        if first in (*OUTERMOST, stem.upper()) or _SLIPS_OF_HEADS.meant(first):
            places = [line]
            name = next((word for word in words if word not in OUTERMOST), first)
        else:
            last = max((n for n, text in enumerate(before, 1) if text[:1] == "&"), default=1)
            ends = (n for n, text in enumerate(before, 1) if lead(text) in _HEADS)
            places = [*self._free_lines(max(ends, default=last - 1) + 1, line), line]
            name = stem if OUTERMOST.isdisjoint(map(lead, before)) else ""
        for at in places:
            for one in filter(_NAME.fullmatch, (name, "A")):
                if self._write(at, head.format(one)):
                    self._heads.append(one)
                    return True
        return False

    def _mend(self, cause: OpenBlock | None, line: int, *, is_at_end: bool) -> bool:
        """Remove a line; or close a block before it; or remove the line that opens the block.

        Returns whether one of these was possible.
        """
        if cause is None:
            return self._write(line, "")
        if is_at_end:
            return self._close_all(cause)
        closer = _closing_line(cause)
        if any(self._write(free, closer) for free in self._free_lines(cause.line + 1, line)):
            return True
        if cause.word in OUTERMOST:
            return False
        self._exchanged.pop(cause.line, None)  # the line may have been replaced before
        return self._write(cause.line, "")

    def _close_all(self, block: OpenBlock | None) -> bool:
        """Close the blocks that are open at the end of the text; return whether that was possible.

        A text that was cut off may end within a line or a name.
        """
        self._is_cut = True
        if self._is_open_ended:
            last = len(self._written.lines) - 1
            word = lead(self._written.line(last))
            if word in OUTERMOST:
                return False
            if word not in BLOCKS and word not in BRANCHES and word not in CLOSERS:
                text = self._written.line(last)
                self._write(last, text.rpartition(",")[0] if _TYPE.match(text) else "")
        self._text = self._text.rstrip()
        while block is not None:
            self._text += f"\n{_closing_line(block)}"
            block = block.outer
        self._text += "\n"
        return True

    def _free_lines(self, first: int, end: int) -> Iterator[int]:
        """Yield lines that can take another text: removed, then blank, then comments and headers.

        Of each kind the last one comes first.
        """
        lines = range(end - 1, first - 1, -1)
        yield from (line for line in lines if line in self._dropped)
        yield from (line for line in lines if not self._written.line(line).strip())
        yield from (line for line in lines if self._written.line(line).lstrip()[:1] in _FREE)

    def _write(self, line: int, text: str) -> bool:
        """Replace a line by a text that is not longer; return whether that was possible.

        No line is replaced twice.
        """
        written = self._written.line(line)
        is_blank = not written.strip()
        if len(text) > len(written) or (is_blank and not text):
            return False
        if self._exchanged.get(line) or self._exchanged.get(line) == text:
            return False
        self._exchanged[line] = text
        if not is_blank and written.lstrip()[0] not in _FREE:
            self._dropped.add(line)
        start = self._written.starts[line - 1]
        self._text = (
            self._text[:start] + text.ljust(len(written)) + self._text[start + len(written) :]
        )
        return True


def _closing_line(block: OpenBlock) -> str:
    return _ONCE.get(block.closer, block.closer)


def _is_like_structure(line: str) -> bool:
    """Return whether a line has a structural word or a misspelt one, or is a single word."""
    code = line.partition(";")[0].strip()
    names = _NAME.findall(code)
    return names in ([], [code]) or any(
        name.upper() in _STRUCTURE or _SLIPS_OF_STRUCTURE.meant(name) for name in names
    )


def _unclosed(line: str, token: str, block: OpenBlock | None) -> OpenBlock | None:
    """Return the block that has to be closed before a failing line, or ``None``."""
    if block is None:
        return None
    word = lead(line)
    if not token.strip() and not line.strip():
        return block  # the end of the file
    if word != token.upper():
        return None
    if word in OUTERMOST:
        return block
    openers = CLOSERS.get(word, (BRANCHES[word],) if word in BRANCHES else ())
    if not openers or block.word in openers or innermost(block, openers) is None:
        return None
    return block
