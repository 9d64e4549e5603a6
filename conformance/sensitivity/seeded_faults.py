"""Seeded faults, drawn or planted, and the code around them: lines, functions, rules it cites."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Final, TypeAlias

from conformance.sensitivity.mutants import Mutant
from conformance.sensitivity.mutated_code import modules, text_of, tree_of
from conformance.sensitivity.planted_faults import Fault

_RULE: Final = re.compile(r"\b[A-Z]{3}-\d\d\b")
#: A fault that cases should notice: a drawn mutant, or one that is planted by hand.
SeededFault: TypeAlias = Mutant | Fault


def uses_of(fault: SeededFault) -> Mapping[str, frozenset[int]]:
    """Return the lines of which a case has to run one to notice a fault, by module.

    Those of its statement, or where a module-level name was changed those that use this name.
    """
    if not fault.is_module_level:
        first, last = fault.lines
        return {fault.module: frozenset(range(first, last + 1))}
    importing = f"from {fault.module} import"
    return {
        module: frozenset(
            one.lineno
            for function in ast.walk(tree_of(module))
            if isinstance(function, ast.FunctionDef | ast.Lambda)
            for one in ast.walk(function)
            if isinstance(one, ast.Name) and one.id == fault.function
        )
        for module in modules()
        if module == fault.module or importing in text_of(module)
    }


def around(fault: SeededFault) -> Mapping[str, frozenset[int]]:
    """Return the lines of a fault's function, and of the functions and classes that it names."""
    first, last = sorted(map(abs, fault.lines))
    words = {fault.function.rpartition(".")[2]}
    for node in ast.walk(tree_of(fault.module)):
        if isinstance(node, ast.Name | ast.Attribute) and first <= node.lineno <= last:
            words.add(node.id if isinstance(node, ast.Name) else node.attr)
    found: dict[str, set[int]] = {}
    for module, name, lines in _functions_of_modules():
        if name in words:
            found.setdefault(module, set()).update(lines)
    return {module: frozenset(lines) for module, lines in found.items()}


def cited(fault: SeededFault) -> frozenset[str]:
    """Return the rules that a fault's function cites or its statement names, and modules."""
    found = set()
    for module, lines in around(fault).items():
        rows = text_of(module).splitlines()
        text = [ast.get_docstring(tree_of(module)) or "", *(rows[number - 1] for number in lines)]
        found.update(_RULE.findall("\n".join(text)))
    return frozenset(found)


@cache
def _functions_of_modules() -> Sequence[tuple[str, str, range]]:
    """Module, name and lines of each function and class."""
    return [
        (module, node.name, range(node.lineno, (node.end_lineno or node.lineno) + 1))
        for module in modules()
        for node in ast.walk(tree_of(module))
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    ]
