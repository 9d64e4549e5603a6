"""Exchange of code in the running process: of existing functions, and of values of modules.

Caches of interpreters are to be emptied with it. Nothing is written to a file.
"""

from __future__ import annotations

import ast
import gc
import inspect
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial
from importlib import import_module
from types import CodeType, FunctionType, ModuleType
from typing import Any

from conformance.sensitivity.mutated_code import ROOT, modules, text_of


class InvalidMutant(ValueError):
    """A change that cannot be activated, because the function would need other names."""


def reassigned(module: ModuleType, name: str, value: ast.expr) -> Sequence[Callable[[], None]]:
    """Compute a module-level name from another expression, for all modules that have its value.

    Returns what undoes it. Raises `InvalidMutant` if it cannot be computed.
    """
    code = compile(ast.Expression(value), str(module.__file__), "eval")
    before = vars(module)[name]
    try:
        new = eval(code, vars(module))
    except Exception as error:
        raise InvalidMutant(f"{type(error).__name__}: {error}") from error
    undo: list[Callable[[], None]] = []
    for one in [one for key, one in sys.modules.items() if key.partition(".")[0] == ROOT]:
        if vars(one).get(name) is before:
            setattr(one, name, new)
            undo.append(partial(setattr, one, name, before))
    return undo


def recoded(module: ModuleType, tree: ast.Module) -> Sequence[Callable[[], None]]:
    """Exchange the code of the functions that a tree has otherwise; returns what undoes it.

    Raises `InvalidMutant` where none is another.
    """
    found = other_code(module, tree)
    if not found:
        raise InvalidMutant("it compiles to the same code")
    return exchanged(found)


def other_code(module: ModuleType, tree: ast.Module) -> Sequence[tuple[FunctionType, CodeType]]:
    """Return the functions of which a tree has other code, with that code.

    Functions, comprehensions and lambdas are to begin where they did. Raises `InvalidMutant` where
    one has other variables of the functions around it.
    """
    path = str(module.__file__)
    original = compile(text_of(module.__name__), path, "exec", dont_inherit=True)
    mutated = compile(tree, path, "exec", dont_inherit=True)
    found = [
        (function, new)
        for old, new in _different(original, mutated)
        for function in _functions().get(_key(old), ())
    ]
    if any(one.__code__.co_freevars != new.co_freevars for one, new in found):
        raise InvalidMutant("it has other variables of the functions around it")
    return found


def exchanged(found: Sequence[tuple[FunctionType, CodeType]]) -> Sequence[Callable[[], None]]:
    """Give functions other code; returns what undoes it."""
    undo = [partial(setattr, one, "__code__", one.__code__) for one, _ in found]
    for one, new in found:
        one.__code__ = new
    return undo


def _different(old: CodeType, new: CodeType) -> Iterator[tuple[CodeType, CodeType]]:
    """Yield pairs of code of the same function, from the outside in, that are not the same."""
    left = [one for one in new.co_consts if isinstance(one, CodeType)]
    for one in (one for one in old.co_consts if isinstance(one, CodeType)):
        name = one.co_qualname, one.co_firstlineno
        other = next(
            (each for each in left if (each.co_qualname, each.co_firstlineno) == name), None
        )
        if other is None:
            continue
        left.remove(other)
        if one != other:
            yield one, other
            yield from _different(one, other)


def _key(code: CodeType) -> tuple[Any, ...]:
    """Return which function it is of; lambdas of a line are distinguished by their columns."""
    columns = tuple(column for _, _, column, _ in code.co_positions())
    return code.co_filename, code.co_qualname, code.co_firstlineno, columns


def load() -> None:
    """Import all modules and find their functions and caches; an exchange is quick then."""
    _functions()
    _caches()


def forget() -> None:
    """Empty the caches of interpreters and of the evaluation of cases."""
    for one in _caches():
        one.cache_clear()


@cache
def _functions() -> Mapping[tuple[Any, ...], Sequence[FunctionType]]:
    """Return the existing functions by file and place, once all modules are loaded."""
    for name in modules():
        import_module(name)
    found: dict[tuple[Any, ...], list[FunctionType]] = {}
    for one in _objects():
        if inspect.isfunction(one) and str(one.__module__).partition(".")[0] == ROOT:
            found.setdefault(_key(one.__code__), []).append(one)
    return found


@cache
def _caches() -> Sequence[Any]:
    return [
        one
        for one in _objects()
        if type(one) is type(_functions)
        and str(one.__module__).startswith((f"{ROOT}.", "conformance.evaluation."))
    ]


def _objects() -> list[Any]:
    gc.unfreeze()  # what is set aside is not listed
    return gc.get_objects()
