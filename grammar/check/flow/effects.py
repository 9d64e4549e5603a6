"""Effects across the files of a project: what one file does and another depends on.

An interrupt is declared in one file and switched on in another, an output is set here and reset
there. The check of each file returns its `Effects`; `of_project` combines those of all files. What
happens to arguments is in the `routine_summaries`.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import field, replace
from typing import Any

from grammar.check.analysis.accesses import Use, accesses
from grammar.check.analysis.constant_folding import constant, integer_of
from grammar.check.analysis.context import Context
from grammar.check.flow.routine_summaries import Summaries, SummaryCollector
from grammar.check.flow.routine_summaries import of_project as of_summaries
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.diagnostics.did_you_mean import did_you_mean
from grammar.semantics.predefined import is_priority
from grammar.semantics.scopes import REST
from grammar.semantics.symbols import Access, Kind, SignalSymbol
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import left_chain, root_variable, without_parentheses
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a file, and the number or name that is concerned."""

    path: str
    region: Region
    what: str


@dataclass(frozen=True, slots=True)
class Effects:
    """Effects of the routines of a file on which others may depend.

    ``changed`` are the names that are assigned or passed on, with a constant index as in
    ``$FLAG[3]``; ``reset`` those that may become FALSE. ``declared`` and ``switched_on`` have
    interrupt numbers, and ``""`` for all or unknown ones; ``switches`` are the places that switch a
    number on, off or otherwise. ``valueless`` are variables without an initial value, ``used`` the
    variables of data lists that occur in it, each with the path of its list; ``summaries`` are
    those of its routines.
    """

    interrupts: list[Place] = field(default_factory=list)
    declared: set[str] = field(default_factory=set)
    switched_on: set[str] = field(default_factory=set)
    switches: list[Place] = field(default_factory=list)
    outputs: dict[str, Place] = field(default_factory=dict)
    reset: set[str] = field(default_factory=set)
    waits: list[tuple[Place, frozenset[str]]] = field(default_factory=list)
    changed: set[str] = field(default_factory=set)
    valueless: list[Place] = field(default_factory=list)
    used: set[tuple[str, str]] = field(default_factory=set)
    summaries: Summaries = field(default_factory=Summaries)


_OPERATORS: Mapping[str, Callable[[bool, bool], bool]] = {
    "AND": operator.and_,
    "OR": operator.or_,
    "==": operator.eq,
    "<>": operator.ne,
}

#: The operand that decides a result, whatever the other one is.
_DECIDING: Mapping[str, bool] = {"AND": False, "OR": True}

_FLAGS = frozenset({"$FLAG", "$CYCFLAG"})
#: Nothing but programs changes these.
_PROGRAMS_OWN = _FLAGS | {"$OUT"}


def effects(context: Context) -> Effects:
    """Return the effects of the routines of a file."""
    return _Collector(context).collect()


def effects_of_unread(words: frozenset[str]) -> Effects:
    """Return the possible effects of unreadable text with these words; `REST` can do anything."""
    if REST in words:
        words |= {"INTERRUPT"} | _PROGRAMS_OWN
    any_ = {""} if "INTERRUPT" in words else set[str]()
    return Effects(declared=any_, switched_on=set(any_), reset=set(words), changed=set(words))


class _Collector:
    """Visits the statements of a file."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._made = effects_of_unread(context.module.words or frozenset())
        self._summaries = SummaryCollector(context)

    def collect(self) -> Effects:
        context = self._context
        for routine in context.routines:
            for placed in routine.statements:
                self._change(placed.statement)
                rule = _RULES.get(type(placed.statement))
                if rule is not None:
                    rule(self, placed.statement)
            self._summaries.routine(routine)
        for node in context.typed_nodes[ast.Call] if context.routines else ():
            self._call(node)
        self._made.valueless.extend(self._valueless())
        self._made.used.update(self._used())
        return replace(self._made, summaries=self._summaries.made)

    def _valueless(self) -> Iterator[Place]:
        """Yield the variables of a data list without an initial value that only files here can set.

        The controller itself sets variables of its own lists.
        """
        context, data = self._context, self._context.data
        if data is None or context.table.is_system:
            return
        declared: dict[str, ast.Name] = {}
        seen = set[str]()
        for item in data.items:
            if isinstance(item, ast.VariableDeclaration):
                for one in item.declarators:
                    if one.name.key in seen:  # an error anyway
                        declared.pop(one.name.key, None)
                    elif one.value is None and not one.name.text.startswith("$"):
                        declared[one.name.key] = one.name
                    seen.add(one.name.key)
            elif isinstance(item, ast.Assignment) and (root := root_variable(item.target)):
                declared.pop(root.name.key, None)
            elif isinstance(item, ast.Importation) and (root := root_variable(item.source)):
                self._made.changed.add(root.name.key)
        for key, name in declared.items():
            symbol = context.table.table.find(Space.VALUE, key)
            is_own = symbol is not None and symbol.access is not Access.GLOBAL
            if is_own or context.project.is_complete:
                yield self._place(name, name.text)

    def _used(self) -> Iterator[tuple[str, str]]:
        for found in self._context.used:
            symbol, module = found.symbol, found.module
            is_variable = symbol.kind is Kind.VARIABLE
            if module is not None and is_variable and not self._context.declares(found):
                yield module.path, symbol.key

    def _place(self, node: ast.Node, what: str) -> Place:
        source = self._context.source
        return Place(source.path, Region.of(source, node.span), what)

    # ----------------------------------------------------------------------- statements

    def _change(self, node: ast.Node) -> None:
        for access in accesses(self._context, node):
            if access.use is not Use.READ:
                key = self._key(access.place) if access.place is not None else access.key
                self._made.changed.add(key)

    def interrupt(self, node: ast.InterruptDeclaration) -> None:
        """Record an interrupt with its possible number, and the effects of its action."""
        known = integer_of(self._context, node.number)
        self._made.declared.add(_number(known))
        if known is not None and 1 <= known <= 128:  # others are reported there
            self._made.interrupts.append(self._place(node.number, str(known)))
        self._later(node)

    def trigger(self, node: ast.Trigger) -> None:
        """Record the effects of the action of a trigger."""
        self._later(node)

    def switch(self, node: ast.InterruptSwitch) -> None:
        """Which interrupts are switched, and which of them on."""
        known = None if node.number is None else integer_of(self._context, node.number)
        if node.action in ("ON", "ENABLE"):
            self._made.switched_on.add(_number(known))
        if node.number is not None and known is not None and is_priority(known):
            self._made.switches.append(self._place(node.number, str(known)))

    def assignment(self, node: ast.Assignment) -> None:
        """Record what is set and what is reset."""
        key = self._key(node.target).replace("$OUT_C", "$OUT")
        if constant(self._context, node.value) is not True:
            self._made.reset.add(key)
        elif key.startswith("$OUT[") and key not in self._made.outputs:
            shown = self._context.source.text[slice(*node.target.span)]
            self._made.outputs[key] = self._place(node, f"{key}\t{shown}")

    def values(self, nodes: Iterable[ast.Assignment]) -> None:
        """Visit the assignments after WITH."""
        for node in nodes:
            self.assignment(node)

    def _later(self, node: ast.Trigger | ast.InterruptDeclaration) -> None:
        if isinstance(node.action, ast.Assignment):
            self.assignment(node.action)
            return
        for access in accesses(self._context, node):
            self._made.reset.add(self._key(access.place) if access.place else access.name.key)

    # --------------------------------------------------------------------------- keys

    def _key(self, node: ast.Expression) -> str:
        """Return what is accessed: a name, ``$OUT[5]``, or the output that a signal denotes."""
        node = without_parentheses(node)
        root = root_variable(node)
        if root is None:
            return ""
        key = root.name.key
        if type(node) is ast.Subscript and node.base is root:
            if key not in _PROGRAMS_OWN or not node.indices:
                return key
            index = integer_of(self._context, node.indices[0])
            return key if index is None else f"{key}[{index}]"
        found = self._context.found(root.name)
        if found is None or type(found.symbol) is not SignalSymbol:
            return key
        first = found.symbol.first
        return _written_key(first) if found.symbol.last is None else "$OUT"

    # --------------------------------------------------------------------------- waiting

    def wait(self, node: ast.WaitFor) -> None:
        """Record a WAIT FOR that only flags can fulfil and that is FALSE while these are FALSE."""
        keys: set[str] = set()
        if self._with_flags_off(node.condition, keys) is False and keys:
            shown = ", ".join(sorted(keys))
            self._made.waits.append((self._place(node.condition, shown), frozenset(keys)))

    def _with_flags_off(self, node: ast.Expression, keys: set[str]) -> bool | None:
        """Return the value of a condition while all flags are FALSE; add its flags to ``keys``."""
        match without_parentheses(node):
            case ast.BoolLiteral(value=value):
                return value
            case ast.Subscript() as place:
                key = self._key(place)
                if key.partition("[")[0] not in _FLAGS or not key.endswith("]"):
                    return None
                keys.add(key)
                return False
            case ast.Unary(operator="NOT", operand=operand):
                inner = self._with_flags_off(operand, keys)
                return None if inner is None else not inner
            case ast.Binary() as both:
                chain = left_chain(both)
                left = self._with_flags_off(chain[0].left, keys)
                for each in chain:
                    right = self._with_flags_off(each.right, keys)
                    deciding = _DECIDING.get(each.operator)
                    if deciding is not None and deciding in (left, right):
                        left = deciding
                    elif left is None or right is None or each.operator not in _OPERATORS:
                        left = None
                    else:
                        left = _OPERATORS[each.operator](left, right)
                return left
        return None

    # --------------------------------------------------------------------------- calls

    def _call(self, node: ast.Call) -> None:
        for argument in node.arguments:
            if argument is not None:
                # PULSE, and what a routine may do with it
                self._made.reset.add(self._key(argument))
        self._summaries.call(node)


def _number(known: int | None) -> str:
    """Return the number of an interrupt as `Effects` has it."""
    return "" if known is None else str(known)


def _written_key(node: ast.Expression) -> str:
    """Return the output or flag that a signal denotes."""
    match node:
        case ast.Subscript(
            base=ast.Variable(name=name), indices=(ast.IntegerLiteral(value=index),)
        ):
            return f"{name.key}[{index}]"
    return "$OUT"


_RULES: Mapping[type[Any], Callable[[_Collector, Any], None]] = {
    ast.Assignment: _Collector.assignment,
    ast.InterruptDeclaration: _Collector.interrupt,
    ast.InterruptSwitch: _Collector.switch,
    ast.Motion: lambda collector, node: collector.values(node.values),
    ast.SignalOn: lambda collector, node: collector.assignment(node.assignment),
    ast.SplineBlock: lambda collector, node: collector.values(node.values),
    ast.Trigger: _Collector.trigger,
    ast.WaitFor: _Collector.wait,
}


# ------------------------------------------------------------------------------------- a project


def of_project(found: Iterable[Effects]) -> Iterator[Diagnostic]:
    """Yield the findings about effects that depend on several files."""
    files = list(found)
    declared = set[str]().union(*(one.declared for one in files))
    switched_on = set[str]().union(*(one.switched_on for one in files))
    switches = [place for one in files for place in one.switches]
    undeclared = [] if "" in declared else list(_undeclared(switches, declared, switched_on))
    yield from undeclared
    meant = {name for one in undeclared if one.fix for name in one.fix.names}
    reset = set[str]().union(*(one.reset for one in files))
    changed = set[str]().union(*(one.changed for one in files))
    yield from of_summaries([one.summaries for one in files])
    used = set[tuple[str, str]]().union(*(one.used for one in files))
    for one in files:
        for place in one.valueless if REST not in changed else ():
            key = place.what.upper()
            if (place.path, key) in used and key not in changed:
                message = f"{place.what} has no value, and nothing assigns to it"
                yield diagnose("never-assigned", place.path, place.region, message)
        if "" not in switched_on:
            yield from _never_on(one.interrupts, switched_on | meant)
        if "$OUT" not in reset:
            yield from _never_reset(one.outputs.values(), reset)
        for place, keys in one.waits:
            if not (keys | {key.partition("[")[0] for key in keys}) & changed:
                message = f"no file at hand sets {place.what}, so this may wait for ever"
                yield diagnose("never-fulfilled", place.path, place.region, message)


def _undeclared(
    switches: Iterable[Place], declared: Set[str], switched_on: Set[str]
) -> Iterator[Diagnostic]:
    """Yield the switched interrupts that nothing declares; meant is one that stays off, if any."""
    for place in switches:
        if place.what not in declared:
            message = f"no INTERRUPT DECL has the number {place.what}"
            fix = did_you_mean(place.what, sorted(declared - switched_on))
            fix = fix or did_you_mean(place.what, sorted(declared))
            yield diagnose("interrupt-undeclared", place.path, place.region, message, fix=fix)


def _never_on(declared: Iterable[Place], switched_on: Set[str]) -> Iterator[Diagnostic]:
    reported = set()
    for place in declared:
        if place.what not in switched_on and place.what not in reported:
            reported.add(place.what)
            message = f"interrupt {place.what} is never switched on"
            yield diagnose("interrupt-never-on", place.path, place.region, message)


def _never_reset(outputs: Iterable[Place], reset: Set[str]) -> Iterator[Diagnostic]:
    for place in outputs:
        key, _, shown = place.what.partition("\t")
        if key not in reset and shown.upper() not in reset:
            message = f"{shown} is set here and never reset"
            yield diagnose("output-never-reset", place.path, place.region, message)
