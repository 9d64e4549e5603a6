"""Subjects of laws: a program with everything that is needed to run it.

Programs come from cases and from `grammar.generation`. A law changes a program, and both versions
are run. `Program.modules` are its files as syntax trees; `Program.written` returns a program with
other trees.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Final, Literal

from conformance.evaluation.execution import Setup, observe
from conformance.evaluation.observation import Observation
from conformance.metamorphic.tree_rewriting import Change, rewritten, routines, with_routines
from conformance.suite.case import Case
from grammar.generation.programs import Sample
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from grammar.syntax.unparse import unparse

#: Virtual seconds of the run of a generated program, which may wait for an input forever.
_WATCHED: Final = 5.0
#: Names that give a program its own line numbers: it can observe a change of its text.
_KNOW_LINES: Final = ("LINE_NR", "PROG_LINE", "$PRO_IP", "$PRO_NAME")


@dataclass(frozen=True, slots=True)
class Run:
    """How a program is run: the robot, and the strategy of motion planning."""

    robot: str = "none"
    motion: Literal["lookahead", "batch"] = "lookahead"


@dataclass(frozen=True)
class Program:
    """A program in the form of a case, which may have been generated."""

    case: Case

    @staticmethod
    def of_sample(sample: Sample, name: str, seconds: float = _WATCHED) -> Program:
        """Return a generated program; it is run for ``seconds`` of virtual time."""
        sources = tuple(Source(text, path) for path, text in sample.files)
        made = Case(name, Path(name), "", ("CTL-01",), "run", "kss8", sources, (), seconds=seconds)
        return Program(made)

    @property
    def name(self) -> str:
        """The name of its case, or the number of the generated program."""
        return self.case.name

    @cached_property
    def modules(self) -> Mapping[str, ast.Module] | None:
        """Its files as syntax trees; ``None`` if one cannot be read."""
        found: dict[str, ast.Module] = {}
        for source in self.case.sources:
            read = read_module(source.text, source.path)
            if isinstance(read, list):
                return None
            found[source.path] = read
        return found

    @cached_property
    def knows_lines(self) -> bool:
        """Whether it can read its own line numbers."""
        return any(word in one.text.upper() for one in self.case.sources for word in _KNOW_LINES)

    @cached_property
    def plain(self) -> Program:
        """The same program printed from its trees: without comments, one statement per line."""
        return self if self.modules is None else self.written(self.modules)

    def written(self, modules: Mapping[str, ast.Module]) -> Program:
        """Return a program with other trees, its files in the given order."""
        sources = tuple(Source(unparse(module), path) for path, module in modules.items())
        return Program(replace(self.case, sources=sources))

    def rewritten(self, change_for: Callable[[ast.Routine], Change]) -> Program | None:
        """Return the program with changed routines, or ``None`` if no routine changes."""
        changed, is_other = {}, False
        for path, module in (self.modules or {}).items():
            found = [rewritten(one, change_for(one)) for one in routines(module)]
            pairs = zip(found, routines(module), strict=True)
            is_other = is_other or any(one is not before for one, before in pairs)
            changed[path] = with_routines(module, found) if found else module
        return self.written(changed) if is_other else None

    def with_texts(self, texts: Mapping[str, str]) -> Program:
        """Return a program with other texts for some of its files."""
        sources = tuple(
            Source(texts.get(one.path, one.text), one.path) for one in self.case.sources
        )
        return Program(replace(self.case, sources=sources))

    def run(self, how: Run) -> Observation:
        """Run the program on the tree interpreter, and return the observation."""
        return observe(self.case, Setup("tree", how.robot, how.motion))
