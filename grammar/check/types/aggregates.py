"""Aggregates: whether their components exist, occur once, and have the right type.

The rules are [TYP-19, TYP-20].
"""

from __future__ import annotations

from collections.abc import Set

from grammar.check.analysis.type_checker import TypeChecker
from grammar.semantics.assignability import index, initial
from grammar.semantics.operations import component, subscript
from grammar.semantics.types import INT, UNKNOWN, Aggregate, Structure, Type
from grammar.syntax import ast


def aggregate(checker: TypeChecker, node: ast.Aggregate, expected: Type) -> Type:
    """Return the type of an aggregate; its structure is that of its prefix, or of its place.

    The components are checked here; the type contains only those that the structure has.
    """
    structure = expected if isinstance(expected, Structure) else None
    if node.type is not None:
        found = checker.context.found(node.type)
        named = checker.type_of(found) if found else UNKNOWN
        structure = named if isinstance(named, Structure) else None
    names: dict[str, str] = {}
    given: Set[str] = frozenset()
    for part in node.components:
        key = part.name.text.upper()
        if key in names and part.indices is None:
            checker.report("component-twice", part.name, f"{part.name.text} is given twice")
        to: Type | None = UNKNOWN
        if structure is not None:
            to = structure.member(part.name.text)
            if to is None:
                given = given or {one.name.key for one in node.components}
                _report_missing(checker, structure, part.name, given)
        if to is None:
            to = UNKNOWN
        else:
            names[key] = part.name.text
        checker.check(
            to if part.indices is None else _indexed(checker, to, part), part.value, initial
        )
    made = Aggregate(tuple(names.values()), structure if node.type else None)
    checker.context.types[node] = structure or made
    return UNKNOWN if node.type is not None and structure is None else made


def _report_missing(
    checker: TypeChecker, structure: Structure, name: ast.Name, given: Set[str]
) -> None:
    """Report a component that a structure lacks; those that are ``given`` are not meant."""
    verdict = component(structure, name.text).verdict
    known = [one.name for one in structure.members if one.name.upper() not in given]
    fix = checker.context.suggestions.suggest(name.text, known)
    checker.reject_part(name, verdict, structure, fix)


def _indexed(checker: TypeChecker, array: Type, part: ast.Component) -> Type:
    """Return the type of ``NAME[]`` or ``LIST[2]`` as a component."""
    given = part.indices or ()
    for one in given:
        if one is not None:
            checker.check(INT, one, lambda _to, value: index(value), "not-a-number-here")
    typed = subscript(array, [one is not None for one in given])
    if not typed.verdict:
        checker.reject("wrong-indices", part.name, typed.verdict)
    return typed.type
