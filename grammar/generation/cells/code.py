"""A routine while it is written: its lines, and what can be named in the next one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from grammar.generation.cells.chance import Chance
from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.names import Names
from grammar.generation.cells.scope import Scope

__all__ = ["Code", "indented"]

_OPENERS = (
    *("DEF ", "DEFFCT ", "GLOBAL DEF ", "GLOBAL DEFFCT "),
    *("IF ", "FOR ", "WHILE ", "REPEAT", "LOOP", "SWITCH "),
)
_CLOSERS = frozenset("END ENDFCT ENDIF ENDFOR ENDWHILE UNTIL ENDLOOP ENDSWITCH".split())
_MIDDLES = frozenset(("ELSE", "CASE", "DEFAULT"))


class Code:
    """The lines of a routine under way; ``counters`` are its variables for FOR that are free."""

    __slots__ = ("chance", "counters", "dialect", "lines", "names", "pad", "scope")

    def __init__(self, chance: Chance, dialect: Dialect, names: Names, scope: Scope) -> None:
        self.chance = chance
        self.dialect = dialect
        self.names = names
        self.scope = scope
        self.lines: list[str] = []
        self.pad = ""
        self.counters: list[str] = []

    def line(self, text: str) -> None:
        """A line at the depth of the moment."""
        self.lines.append(self.pad + text)

    def set(self, variable: str, value: str) -> None:
        """An assignment; now and then with a remark behind it."""
        remark = f" ;{self.names.remark()}" if self.chance.real() < 0.06 else ""
        self.lines.append(f"{self.pad}{variable}{self.dialect.eq}{value}{remark}")

    def call(self, name: str, *arguments: str) -> None:
        """A call as a statement."""
        self.lines.append(self.pad + self.dialect.call(name, arguments))

    @contextmanager
    def block(self, opener: str, closer: str) -> Iterator[None]:
        """The lines of a block, a step further in than its opener and closer."""
        pad = self.pad
        self.lines.append(pad + opener)
        self.pad = pad + self.dialect.indent
        yield
        self.pad = pad
        self.lines.append(pad + closer)

    def middle(self, text: str) -> None:
        """A line that continues a block, as far in as its opener."""
        indent = len(self.dialect.indent)
        self.lines.append((self.pad[:-indent] if indent else self.pad) + text)

    @contextmanager
    def fold(self, title: str, closer: str = "") -> Iterator[None]:
        """The lines of a fold, no further in."""
        self.lines.append(f"{self.pad};FOLD {title}")
        yield
        self.lines.append(f"{self.pad};ENDFOLD ({closer})" if closer else f"{self.pad};ENDFOLD")

    def remark(self) -> None:
        """A line of comment."""
        self.lines.append(f"{self.pad};{self.dialect.gap}{self.names.remark()}")


def indented(lines: Iterable[str], dialect: Dialect) -> Iterator[str]:
    """Lines that were written without indentation, with that of a dialect."""
    depth = 0
    for line in lines:
        word = line.split(" ", 1)[0]
        depth -= word in _CLOSERS
        place = depth - 1 if word in _MIDDLES else depth
        yield dialect.indent * place + line if line else line
        depth += line.startswith(_OPENERS)
