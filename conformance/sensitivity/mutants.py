"""Mutants: one random change each in code that determines semantics."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from itertools import islice
from random import Random

from conformance.sensitivity.code_exchange import forget, reassigned, recoded
from conformance.sensitivity.mutated_code import (
    OF_CASES,
    every_module,
    is_left_out,
    modules_of,
    package_of,
    text_of,
    tree_of,
)
from conformance.sensitivity.mutation_operators import Change, Operator, changes


@dataclass(frozen=True, slots=True)
class Mutant:
    """A change of a module; ``number`` is its index among all changes of this module.

    ``lines`` are those of its statement: a case that executes none of them cannot notice it.
    ``source`` is its first line.
    """

    package: str
    module: str
    number: int
    operator: Operator
    function: str
    line: int
    lines: tuple[int, int]
    was: str
    now: str
    source: str
    is_module_level: bool

    @property
    def name(self) -> str:
        """Its identity: module and number."""
        return f"{self.module}:{self.number}"

    @property
    def change(self) -> tuple[str, ...]:
        """A description that does not change when lines of the module move."""
        return self.module, self.function, self.source, self.was, self.now

    @property
    def file(self) -> str:
        """The path of its module in the repository."""
        return self.module.replace(".", "/") + ".py"

    @contextmanager
    def plant(self) -> Iterator[None]:
        """Have the mutant in the running process while the context lasts.

        Raises `InvalidMutant` if this is not possible.
        """
        module = import_module(self.module)
        tree = tree_of(self.module)
        change = _change(tree, self.number)
        change.make()
        if change.assignment is None:
            undo = recoded(module, tree)
        else:
            assert change.assignment.value is not None, "it is a change of a value"
            undo = reassigned(module, change.function, change.assignment.value)
        forget()
        try:
            yield
        finally:
            for one in undo:
                one()
            forget()


def all_mutants(packages: Iterable[str] = OF_CASES) -> Iterator[str]:
    """Yield the names of all mutants of some of `PACKAGES`, one package after another."""
    for module in (name for package in packages for name in modules_of(package)):
        for number, function in enumerate(_changed(module)):
            if not is_left_out(f"{module}.{function}"):
                yield f"{module}:{number}"


def drawn(seed: int, count: int, packages: Iterable[str] = OF_CASES) -> tuple[Mutant, ...]:
    """Return ``count`` random mutants of some packages, in the order of `all_mutants`."""
    every = tuple(all_mutants(packages))
    chosen = Random(f"mutants {seed}").sample(range(len(every)), min(count, len(every)))
    return tuple(named(every[at]) for at in sorted(chosen))


def named(name: str) -> Mutant:
    """Return the mutant of a name, ``interp.values.values:12``; raises `KeyError` if unknown.

    Its module may be one from which none is drawn.
    """
    module, _, number = name.partition(":")
    is_known = module in every_module() and number.isdigit()
    if not is_known or int(number) >= len(_changed(module)):
        raise KeyError(name)
    tree = tree_of(module)
    one = _change(tree, int(number))
    source = text_of(module).splitlines()[one.line - 1].strip()
    return Mutant(
        package_of(module),
        module,
        int(number),
        one.operator,
        one.function,
        one.line,
        one.lines,
        one.was,
        one.now,
        source,
        one.assignment is not None,
    )


def of_line(file: str, line: int) -> list[Mutant]:
    """Return the mutants that begin on a line of a file, ``interp/values/values.py``."""
    module = file.removesuffix(".py").replace("/", ".")
    if module not in every_module():
        return []
    found = enumerate(changes(tree_of(module)))
    return [named(f"{module}:{number}") for number, one in found if one.line == line]


@cache
def _changed(module: str) -> tuple[str, ...]:
    """Return the function that each mutant of a module changes, by number."""
    return tuple(one.function for one in changes(tree_of(module)))


def _change(tree: ast.Module, number: int) -> Change:
    return next(islice(changes(tree), number, None))
