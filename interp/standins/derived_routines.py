"""Routines for undeclared names, derived from their calls.

A routine consists of its signature: it does nothing, assigns a default to arguments without a
value, the first case if a SWITCH asks for it, and returns a default. A function that reports
success returns TRUE, and other numeric functions return 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest

from grammar.semantics.packages import PackageRoutine
from interp.standins.default_values import NOTHING
from interp.standins.derived_declarations import DerivedDeclarations, TypedValue, number
from interp.standins.uses import DataUse, RoutineUse


@dataclass(frozen=True, slots=True)
class _Parameter:
    """A parameter with its default; ``brackets`` are those of an array."""

    name: str
    kind: TypedValue
    is_out: bool
    brackets: str

    def default(self) -> Iterator[str]:
        """Yield the lines that give the argument a value if it has none."""
        if self.is_out and not self.brackets and self.kind.value != NOTHING:
            yield f'IF VARSTATE("{self.name}")<>#INITIALIZED THEN'
            yield f"{self.name}={self.kind.value}"
            yield "ENDIF"


def derived_routine(
    name: str,
    use: RoutineUse,
    declarations: DerivedDeclarations,
    known: PackageRoutine | None = None,
) -> str:
    """Return the text of a routine without a body; ``known`` is its signature in a package."""
    parameters = list(_parameters(name, use, declarations, known))
    heads = (f"{p.name}{p.brackets} :{'OUT' if p.is_out else 'IN'}" for p in parameters)
    declared = [f"DECL {p.kind.type} {p.name}{p.brackets}" for p in parameters]
    body = [line for one in parameters for line in one.default()]
    head = f"{name} ({','.join(heads)} )"
    if use.is_function or (known is not None and known.result):
        result = _result(name, use, declarations, known)
        lines = [
            f"GLOBAL DEFFCT {result.type} {head}",
            *declared,
            f"DECL {result.type} RESULT",
            *body,
            *([f"RESULT={result.value}"] if result.value != NOTHING else ()),
            "RETURN RESULT",
            "ENDFCT",
        ]
    else:
        lines = [f"GLOBAL DEF {head}", *declared, *body, "END"]
    return "\n".join(lines) + "\n"


def _parameters(
    name: str, use: RoutineUse, declarations: DerivedDeclarations, known: PackageRoutine | None
) -> Iterator[_Parameter]:
    signature = () if known is None or known.has_more else known.parameters
    pairs = zip_longest(use.arguments, signature)
    for place, (given, typed) in enumerate(pairs, start=1):
        one = _parameter(f"P{place}", name, given or DataUse(is_assigned=True), declarations)
        if typed is not None and not typed.is_out and declarations.type_named(typed.type):
            kind = TypedValue(typed.type, one.kind.value, is_text=typed.is_array)
            one = _Parameter(one.name, kind, is_out=False, brackets="[]" if typed.is_array else "")
        yield one


def _parameter(
    name: str, routine: str, use: DataUse, declarations: DerivedDeclarations
) -> _Parameter:
    """Return a parameter as its arguments imply it."""
    kind = declarations.typed_value(f"{routine}_{name}", use) or number(use)
    if kind.is_text:
        return _Parameter(name, kind, is_out=False, brackets="[]")
    is_out = use.is_variable and bool(use.types) and {kind.type} == {*map(str, use.types)}
    brackets = f"[{',' * (use.indices - 1)}]" if use.indices else ""
    return _Parameter(name, kind, is_out, brackets)


def _result(
    name: str, use: RoutineUse, declarations: DerivedDeclarations, known: PackageRoutine | None
) -> TypedValue:
    kind = declarations.typed_value(f"{name}_R", use.result) or number(DataUse(is_assigned=True))
    if known is not None and kind.type in ("INT", "REAL", "BOOL"):
        type_ = declarations.type_named(known.result)
        kind = kind if type_ is None else TypedValue(known.result, declarations.value(type_, name))
    if known is not None and known.default and kind.type == known.result:
        value = known.default
    elif kind.type == "BOOL":
        value = "FALSE" if use.result.left_by is False else "TRUE"
    else:
        value = {"INT": "0", "REAL": "0.0"}.get(kind.type, kind.value)
    return TypedValue(kind.type, value)
