"""The modules from which mutants are drawn: ``mutated_code.toml`` lists them, and what is not."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Sequence
from fnmatch import fnmatchcase, translate
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import Any, Final

#: The package that holds all of them.
ROOT: Final = "interp"
_TABLE: Final[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
)
PACKAGES: Final = tuple(_TABLE["packages"])
#: The packages that cases run.
OF_CASES: Final = tuple(name for name in PACKAGES if name != "machine")
#: Patterns of the modules, functions and values of which no mutant is drawn.
LEFT_OUT: Final = tuple(name for row in _TABLE["left_out"] for name in row["names"])
_LEFT_OUT: Final = re.compile("|".join(map(translate, LEFT_OUT)))


def is_left_out(name: str) -> bool:
    """Return whether no mutant is drawn of a module, function or value: ``interp.values.poses``."""
    return _LEFT_OUT.match(name) is not None


@cache
def every_module() -> tuple[str, ...]:
    """Return the names of all modules below the root, sorted."""
    found = walk_packages(import_module(ROOT).__path__, f"{ROOT}.")
    return tuple(sorted(one.name for one in found if not one.ispkg))


@cache
def modules_of(package: str) -> Sequence[str]:
    """Return the names of the modules of one of `PACKAGES` from which mutants are drawn."""
    wanted = _TABLE["packages"][package]
    named = (name for name in every_module() if any(fnmatchcase(name, one) for one in wanted))
    return [name for name in named if not is_left_out(name)]


@cache
def modules() -> tuple[str, ...]:
    """Return the names of all modules from which mutants are drawn."""
    return tuple(name for package in PACKAGES for name in modules_of(package))


def package_of(module: str) -> str:
    """Return the package of a module, or "" if no mutants are drawn from it."""
    return next((each for each in PACKAGES if module in modules_of(each)), "")


@cache
def text_of(module: str) -> str:
    """Return the source of a module."""
    return Path(str(import_module(module).__file__)).read_text(encoding="utf-8")


def tree_of(module: str) -> ast.Module:
    """Return a new syntax tree of a module, which may be changed."""
    return ast.parse(text_of(module))
