"""Aggregates: whether their components are there, each once, and fit [TYP-19, TYP-20]."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grammar.semantics.assignability import index, initial
from grammar.semantics.operations import component, subscript
from grammar.semantics.types import INT, UNKNOWN, Aggregate, Structure, Type
from grammar.syntax import ast

if TYPE_CHECKING:
    from grammar.check.expressions import Typer

__all__ = ["aggregate"]


def aggregate(typer: Typer, node: ast.Aggregate, structure: Structure | None) -> Type:
    """Type an aggregate whose place has that structure, if one is known; its prefix counts more.

    The components are judged here, so what is given back names none that the structure lacks.
    """
    if node.type is not None:
        found = typer.context.found(node.type)
        named = typer.of(found) if found else UNKNOWN
        structure = named if isinstance(named, Structure) else None
    names: dict[str, str] = {}
    for part in node.components:
        key = part.name.text.upper()
        if key in names and part.indices is None:
            typer.tell("component-twice", part.name, f"{part.name.text} is given twice")
        to: Type | None = UNKNOWN
        if structure is not None:
            to = structure.member(part.name.text)
            if to is None:
                _tell_missing(typer, structure, part.name)
        if to is None:
            to = UNKNOWN
        else:
            names[key] = part.name.text
        typer.fit(to if part.indices is None else _indexed(typer, to, part), part.value, initial)
    made = Aggregate(tuple(names.values()), structure if node.type else None)
    typer.context.types[node] = structure or made
    return UNKNOWN if node.type is not None and structure is None else made


def _tell_missing(typer: Typer, structure: Structure, name: ast.Name) -> None:
    verdict = component(structure, name.text).verdict
    fix = typer.context.hints.meant(name.text, [member.name for member in structure.members])
    typer.refuse_part(name, verdict, structure, fix)


def _indexed(typer: Typer, array: Type, part: ast.Component) -> Type:
    """The type of ``NAME[]`` or ``LIST[2]`` as a component."""
    given = part.indices or ()
    for one in given:
        if one is not None:
            typer.fit(INT, one, lambda _to, value: index(value), "not-a-number-here")
    typed = subscript(array, [one is not None for one in given])
    if not typed.verdict:
        typer.refuse("wrong-indices", part.name, typed.verdict)
    return typed.type
