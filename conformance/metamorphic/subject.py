"""Subjects of laws: a program with everything it is run with.

Programs come from cases and from `grammar.generation`. A law changes a
program and runs both; `Program.modules` are its files as trees, `Program.written` puts trees back.
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
from grammar.generation.closed.programs import Sample
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from grammar.syntax.unparse import unparse

#: Virtual seconds that a generated program is watched: it may wait for inputs for ever.
_WATCHED: Final = 5.0
#: What gives a program its own line number: such programs do see a change of text.
_KNOW_LINES: Final = ("LINE_NR", "PROG_LINE", "$PRO_IP", "$PRO_NAME")


@dataclass(frozen=True, slots=True)
class Run:
    """How a program is run."""

    robot: str = "none"
    motion: Literal["lookahead", "batch"] = "lookahead"


@dataclass(frozen=True)
class Program:
    """A program: the case that it is, or is made into, to be run."""

    case: Case

    @staticmethod
    def of_sample(sample: Sample, name: str, seconds: float = _WATCHED) -> Program:
        """A generated program, and the virtual seconds that it is watched."""
        sources = tuple(Source(text, path) for path, text in sample.files)
        made = Case(name, Path(name), "", ("CTL-01",), "run", "kss8", sources, (), seconds=seconds)
        return Program(made)

    @property
    def name(self) -> str:
        """As its case is called, or the number of the generated program."""
        return self.case.name

    @cached_property
    def modules(self) -> Mapping[str, ast.Module] | None:
        """Its files as trees; ``None`` where one cannot be read."""
        found: dict[str, ast.Module] = {}
        for source in self.case.sources:
            read = read_module(source.text, source.path)
            if isinstance(read, list):
                return None
            found[source.path] = read
        return found

    @cached_property
    def knows_lines(self) -> bool:
        """Whether it can read its own line number."""
        return any(word in one.text.upper() for one in self.case.sources for word in _KNOW_LINES)

    @cached_property
    def plain(self) -> Program:
        """The same as it is printed from its trees: without comments, one statement a line."""
        return self if self.modules is None else self.written(self.modules)

    def written(self, modules: Mapping[str, ast.Module]) -> Program:
        """A program of other trees, its files in their order."""
        sources = tuple(Source(unparse(module), path) for path, module in modules.items())
        return Program(replace(self.case, sources=sources))

    def rewritten(self, change_for: Callable[[ast.Routine], Change]) -> Program | None:
        """The program with each routine changed; ``None`` where all stay as they are."""
        changed, is_other = {}, False
        for path, module in (self.modules or {}).items():
            found = [rewritten(one, change_for(one)) for one in routines(module)]
            pairs = zip(found, routines(module), strict=True)
            is_other = is_other or any(one is not before for one, before in pairs)
            changed[path] = with_routines(module, found) if found else module
        return self.written(changed) if is_other else None

    def with_texts(self, texts: Mapping[str, str]) -> Program:
        """A program with other texts of some of its files."""
        sources = tuple(
            Source(texts.get(one.path, one.text), one.path) for one in self.case.sources
        )
        return Program(replace(self.case, sources=sources))

    def run(self, how: Run) -> Observation:
        """Run it."""
        return observe(self.case, Setup("tree", how.robot, how.motion))
