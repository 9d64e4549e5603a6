"""Coverage of language constructs on executed lines.

It counts kinds of nodes and their variants, operators, predefined functions, system variables, and
the instructions of executed lines. For most kinds, `language` lists everything that can occur, so
that what never occurred can be reported. A program reaches a rule or clause if it executes
everything that all conformance cases of the rule use (`needs`). This does not show that it obeys
the rule.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, Final, get_args

from conformance.differential.traces import Fact, place_of
from conformance.suite.case import Case
from grammar.motion_kinds import MOTIONS
from grammar.semantics.operations import ARITHMETIC, BITWISE, EQUALITY, LOGICAL, ORDER
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.walk import walk
from interp.bytecode._generated.opcodes import Op
from interp.executors import Prepared
from interp.values.builtins import BUILTINS
from interp.values.faults import FAULTS, LinkError

#: The number of occurrences by kind and name.
Counts = Counter[tuple[str, str]]
#: What a program must execute to reach a rule or clause, by its ID.
Needs = Mapping[str, frozenset[tuple[str, str]]]

_CRITERIA: Final = "C_PTP C_DIS C_ORI C_VEL C_SPL".split()
_VARIANTS: Final = (
    *("IF ELSE", "FOR STEP", "SWITCH DEFAULT", "CASE of several", "RETURN value"),
    *(f"INTERRUPT {word}" for word in ("DECL", "GLOBAL DECL", "ON", "OFF", "ENABLE", "DISABLE")),
    *("INTERRUPT without number", "BRAKE", "BRAKE F", "BRAKE FF"),
    *(f"{word} {way}" for word in ("ANIN", "ANOUT", "DIGIN") for way in ("ON", "OFF")),
    *("TRIGGER DISTANCE", "TRIGGER PATH", "TRIGGER ONSTART", "TRIGGER PRIO"),
    *("TIME_BLOCK START", "TIME_BLOCK PART", "TIME_BLOCK END", "CONST_VEL START", "CONST_VEL END"),
    *("SPLINE", "PTP_SPLINE", "WITH", "CA", "#BASE", "#TOOL"),
    *("argument left out", "CONST", "GLOBAL"),
)


@cache
def language() -> Mapping[str, tuple[str, ...]]:
    """Return everything that can occur, by kind."""
    nodes = {one.__name__ for one in get_args(ast.Statement | ast.Expression)}
    operators = ARITHMETIC | BITWISE | EQUALITY | LOGICAL | ORDER | {":", "NOT", "B_NOT"}
    return {
        "node": tuple(sorted(nodes)),
        "variant": (*MOTIONS, *_CRITERIA, *_VARIANTS),
        "operator": tuple(sorted(operators | {"sign -", "sign +"})),
        "function": tuple(BUILTINS),
        "instruction": tuple(op.name for op in Op),
        # "nesting" cannot happen: a type would have to contain itself.
        "fault": tuple(slug for slug in FAULTS if slug != "nesting"),
    }


def missing(counts: Counts) -> dict[str, list[str]]:
    """Return what never occurred, by kind; complete kinds are left out."""
    found = {
        kind: [name for name in names if not counts[kind, name]]
        for kind, names in language().items()
    }
    return {kind: names for kind, names in found.items() if names}


def needs(cases: Iterable[Case]) -> Needs:
    """Return the constructs that all running cases of a rule or clause have in common, if any."""
    found: dict[str, frozenset[tuple[str, str]]] = {}
    for case in cases:
        if case.phase == "run":
            used = frozenset(_constructs_of_case(case))
            found[case.basis] = found.get(case.basis, used) & used
    return {rule: used for rule, used in sorted(found.items()) if used}


def _constructs_of_case(case: Case) -> Iterator[tuple[str, str]]:
    known = language()
    for source in case.sources:
        module = read_module(source.text, source.path)
        if not isinstance(module, list) and isinstance(module.content, ast.Program):
            for routine in module.content.routines:
                for kind, name in (each for node in walk(routine) for each in _constructs_of(node)):
                    if name in known.get(kind, (name,)):  # names and headers are not executed
                        yield kind, name


def reached(rules: Needs, counts: Counts) -> Iterator[str]:
    """Return the rules and clauses that a program with these counts has reached."""
    return (rule for rule, used in rules.items() if used <= counts.keys())


def counted(program: Prepared, facts: Sequence[Fact]) -> Counts:
    """Return the counts of what a run has executed."""
    at = {place_of(fact) for fact in facts}
    executed = {(one.file, one.line) for one in at if one is not None}
    counts: Counts = Counter(_nodes(program, executed))
    counts.update(("instruction", name) for name in _instructions(program, executed))
    for fact in facts:
        if fact[0] == "Fail" and fact[2][0] == "Fault":
            counts["fault", _SLUGS.get(fact[2][1], "")] += 1
    return counts


#: Nodes without a line of their own in a trace; they count if their routine was executed.
_WITHOUT_LINE: Final = (
    ast.Definition | ast.Label | ast.CaseBranch | ast.TimeBlock | ast.ConstantVelocity
)  # fmt: skip
_SLUGS: Final = {kind.text: slug for slug, kind in FAULTS.items()}


# --------------------------------------------------------------------------------- the tree


def _nodes(program: Prepared, executed: set[tuple[str, int]]) -> Iterator[tuple[str, str]]:
    for unit in program.program.units.values():
        syntax = unit.module.syntax
        assert syntax is not None, "only what can be read is loaded"
        path = unit.module.path
        if isinstance(syntax.content, ast.DataList):
            for item in syntax.content.items:
                yield from _constructs_below(item)
            continue
        for routine in syntax.content.routines:
            if (path, unit.line(routine.body[0])) not in executed and not any(
                (path, unit.line(one)) in executed for one in routine.body
            ):
                continue
            for node in walk(routine):
                if isinstance(node, _WITHOUT_LINE) or (path, unit.line(node)) in executed:
                    yield from _constructs_of(node)


def _constructs_below(item: ast.Node) -> Iterator[tuple[str, str]]:
    for node in walk(item):
        yield from _constructs_of(node)


def _constructs_of(node: ast.Node) -> Iterator[tuple[str, str]]:
    yield "node", type(node).__name__
    match node:
        case ast.Binary():
            yield "operator", node.operator
        case ast.Unary():
            is_sign = node.operator in "+-"
            yield "operator", f"sign {node.operator}" if is_sign else node.operator
        case ast.Call() if node.name.key in BUILTINS:
            yield "function", node.name.key
        case ast.Variable() if node.name.text.startswith("$"):
            yield "variable", node.name.key
    for name in _variants(node):
        yield "variant", name


def _variants(node: Any) -> Iterator[str]:
    """Yield the variants of a node, which distinguish nodes of one kind."""
    match node:
        case ast.If() if node.otherwise is not None:
            yield "IF ELSE"
        case ast.For() if node.step is not None:
            yield "FOR STEP"
        case ast.Switch() if node.default is not None:
            yield "SWITCH DEFAULT"
        case ast.CaseBranch() if len(node.values) > 1:
            yield "CASE of several"
        case ast.Return() if node.value is not None:
            yield "RETURN value"
        case ast.Brake():
            yield f"BRAKE {node.mode or ''}".strip()
        case ast.SignalOn() | ast.SignalOff():
            yield f"{node.keyword} {'ON' if isinstance(node, ast.SignalOn) else 'OFF'}"
        case ast.Call() if None in node.arguments:
            yield "argument left out"
        case ast.VariableDeclaration():
            yield from (["CONST"] if node.is_constant else []) + (["GLOBAL"] * node.is_global)
    yield from _interrupt(node)
    yield from _motion(node)


def _interrupt(node: Any) -> Iterator[str]:
    match node:
        case ast.InterruptDeclaration():
            yield f"INTERRUPT {'GLOBAL ' * node.is_global}DECL"
        case ast.InterruptSwitch():
            yield f"INTERRUPT {node.action}"
            if node.number is None:
                yield "INTERRUPT without number"
        case ast.Trigger():
            yield f"TRIGGER {node.place_kind}"
            yield from ["TRIGGER ONSTART"] * node.on_start
            yield from ["TRIGGER PRIO"] * (node.priority is not None)


def _motion(node: Any) -> Iterator[str]:
    match node:
        case ast.Motion():
            yield node.kind
            yield from node.criteria
            yield from ["CA"] * (node.angle is not None) + ["WITH"] * bool(node.values)
            if node.reference is not None:
                yield f"#{node.reference.name.key}"
        case ast.SplineBlock():
            yield node.keyword
            yield from ["WITH"] * bool(node.values) + ["C_SPL"] * node.is_approximated
        case ast.TimeBlock():
            yield f"TIME_BLOCK {node.edge}"
        case ast.ConstantVelocity():
            yield f"CONST_VEL {node.edge}"


# --------------------------------------------------------------------------------- bytecode


def _instructions(program: Prepared, executed: set[tuple[str, int]]) -> Iterator[str]:
    """Yield the instructions of executed lines; none if the program cannot be compiled."""
    try:
        codes = program.verified.program.codes
    except LinkError:
        return
    for code in codes:
        is_executed = False
        for instruction in code.instructions:
            if instruction.op in (Op.LINE, Op.AT):
                is_executed = (code.file, instruction.operands[0]) in executed
            if is_executed:
                yield instruction.op.name
