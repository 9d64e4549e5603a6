"""Summaries of routines: what callers can know, and findings that rest on it, over all files.

Each routine is summarised once, when its file is checked. The summary says what happens to its
parameters: whether a parameter is read before it is assigned, whether it is assigned, which values
are valid; and whether the routine returns. If that depends on a routine that it calls, the summary
has a Horn clause: a fact about one routine follows from facts about others. `of_project` computes
the least fixed point of the clauses of all files, however the routines call one another. Then it
reports the suspects of each file: findings that depend on facts about called routines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field
from itertools import pairwise

from grammar.check.analysis.accesses import Parameter, Use, address_of
from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Bound, Context, RoutineBody
from grammar.check.flow.data_flow import DataFlow, data_flow
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.semantics.symbols import RoutineSymbol
from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.walk import BODIES, bodies
from support.lazy_dataclass import dataclass

#: Something about a parameter, or about the routine itself if the index is -1.
Fact = tuple[str, str, str, int]
#: A fact and those that it follows from.
Clause = tuple[Fact, tuple[Fact, ...]]

#: Every way through the routine reads the parameter before it gets a value.
READS = "reads"
#: The routine may assign to the parameter.
WRITES = "writes"
#: The routine never returns.
ENDLESS = "endless"
#: The routine stops the advance run before it moves; looked for on demand.
STOPS = "stops"
#: RESUME in the file may leave any routine; no routine has the name.
RESUMES = "resumes"

ITSELF = -1
#: Behind these statements the next one may not come, and all ways to the end may lead nowhere.
_TURNING = frozenset({ast.Loop, ast.While, ast.Repeat, ast.Goto})
#: These leave a routine, or pass by statements of it.
_LEAVING = frozenset({ast.Return, ast.Goto})


@dataclass(frozen=True, slots=True)
class Suspect:
    """A finding that is true if all facts in ``holds`` are true and none in ``lacks``."""

    slug: str
    region: Region
    message: str
    reason: str
    holds: tuple[Fact, ...] = ()
    lacks: tuple[Fact, ...] = ()


@dataclass(frozen=True, slots=True)
class Summaries:
    """What the routines of the file at ``path`` do with their parameters, and its suspects.

    The first fact of each clause follows if all others are true. ``bounds`` are the valid values of
    a parameter, ``handed_on`` pairs of a parameter and the one of a called routine that receives
    it. ``constants`` are arguments in calls, with the place of the first.
    """

    path: str = ""
    clauses: dict[Clause, None] = field(default_factory=dict)
    bounds: list[tuple[Parameter, Bound]] = field(default_factory=list)
    handed_on: list[tuple[Parameter, Parameter]] = field(default_factory=list)
    constants: dict[tuple[Parameter, float], Region] = field(default_factory=dict)
    suspects: list[Suspect] = field(default_factory=list)


class SummaryCollector:
    """Summarises the routines of a file one after another."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._path = context.module.path
        self.made = Summaries(self._path)
        if "RESUME" in (context.module.words or ()):
            self._resumes()

    def _resumes(self) -> None:
        self.made.clauses[(RESUMES, self._path, "", ITSELF), ()] = None

    def routine(self, routine: RoutineBody) -> None:
        """Summarise a routine, and find the suspects in it."""
        flow = data_flow(self._context, routine)
        # what cannot be read may be a guard
        can_try = bool(self._context.module.words) or any(
            type(one.statement) is ast.OnErrorProceed for one in routine.statements
        )
        for index, parameter in enumerate(routine.node.parameters):
            at = self._path, routine.node.name.key, index
            if parameter.name.key in flow.parameters:
                self._parameter(flow, parameter.name.key, at, can_try=can_try)
            else:  # texts or lines that cannot be read may name it
                self.made.clauses[(WRITES, *at), ()] = None
        if not can_try:
            self._early(flow)
        self._end(routine)

    def call(self, node: ast.Call) -> None:
        """Note the arguments that a call leaves out, and those that are known numbers."""
        context = self._context
        found = context.found(node.name)
        address = address_of(found)
        if found is None or address is None or not isinstance(found.symbol, RoutineSymbol):
            return
        for index, parameter in enumerate(found.symbol.parameters):
            to = *address, index
            argument = node.arguments[index] if index < len(node.arguments) else None
            if argument is None:
                message = (
                    f"the argument for {parameter.name} is left out, and {address[1]} reads it"
                )
                reason = f"{address[0].rpartition('/')[2]} does not ask VARSTATE first"
                self._suspect("argument-missing", node.span, message, reason, ((READS, *to),))
                continue
            value = constant(context, argument)
            if isinstance(value, int | float) and type(value) is not bool:
                self.made.constants.setdefault(
                    (to, value), Region.of(context.source, argument.span)
                )

    def _suspect(
        self,
        slug: str,
        where: Span,
        message: str,
        reason: str,
        holds: tuple[Fact, ...],
        lacks: tuple[Fact, ...] = (),
    ) -> None:
        region = Region.of(self._context.source, where)
        self.made.suspects.append(Suspect(slug, region, message, reason, holds, lacks))

    # ------------------------------------------------------------------------- parameters

    def _parameter(self, flow: DataFlow, key: str, at: Parameter, *, can_try: bool) -> None:
        read = None if can_try else flow.reads(key)
        if read is not None:
            self.made.clauses[(READS, *at), tuple((READS, *one) for one in read)] = None
        uses = flow.uses.get(key, ())
        written = [one.to for one in uses if one.use is not Use.READ]
        for to in (None,) if None in written else written:
            self.made.clauses[(WRITES, *at), ((WRITES, *to),) if to else ()] = None
        for use in () if written or can_try else uses:
            bound = self._context.bounds.get(use.name)
            is_whole = use.to and type(use.place) is ast.Variable
            if (bound or is_whole) and flow.is_on_every_way(use):
                if bound:
                    self.made.bounds.append((at, bound))
                elif use.to:
                    self.made.handed_on.append((at, use.to))

    # -------------------------------------------------------------------------- variables

    def _early(self, flow: DataFlow) -> None:
        """Add suspects for variables without value that a called routine reads or leaves so."""
        passed: dict[str, set[Parameter]] = {}
        for key in flow.variables & flow.uses.keys():
            for one in flow.uses[key]:
                if one.to and one.use is Use.PASSED:
                    passed.setdefault(key, set()).add(one.to)
        early = {access.key for access in flow.early(frozenset(passed))}
        for access in flow.early(frozenset(passed), is_passed_open=True):
            name, to = access.name, access.to
            others = sorted(one for one in passed[access.key] if one != to)
            lacks = tuple([(WRITES, *parameter) for parameter in others])
            message = f"{name.text} has no value yet"
            if access.use is Use.PASSED and to:
                reason = f"{to[1]} reads it before it assigns to it"
                holds = ((READS, *to),)
                self._suspect("read-too-early", name.span, message, reason, holds, lacks)
            elif access.key not in early:
                names = list(dict.fromkeys(one[1] for one in others))
                reason = f"{' and '.join(names)} give{'s' * (len(names) == 1)} it none"
                lacks += tuple([(READS, *parameter) for parameter in others])  # reported there
                self._suspect("read-too-early", name.span, message, reason, (), lacks)

    # -------------------------------------------------------------------------- the end

    def _end(self, routine: RoutineBody) -> None:
        """Add facts on whether the routine returns, and suspects after calls that do not return."""
        context = self._context
        kinds = {type(one.statement) for one in routine.statements}
        if ast.Resume in kinds:
            self._resumes()
        if context.module.words or context.is_cut(routine):
            return
        this = ENDLESS, self._path, routine.node.name.key, ITSELF
        if kinds & _TURNING and not _returns(routine):
            self.made.clauses[this, ()] = None
            return
        if ast.CallStatement not in kinds:
            return
        lists = [routine.node.body]
        lists += (
            body
            for one in routine.statements
            if type(one.statement) in BODIES
            for body in bodies(one.statement)
        )
        seen = set()
        for number, body in enumerate(lists):
            for statement, following in pairwise((*body, None)):
                if type(statement) is not ast.CallStatement:
                    continue
                called = address_of(context.found(statement.call.name))
                if called is None or called in seen:
                    continue
                fact = ENDLESS, *called, ITSELF
                if number == 0 and not kinds & _LEAVING:
                    self.made.clauses[this, (fact,)] = None
                if following is not None and type(following) is not ast.Label:
                    seen.add(called)
                    message = f"this is never reached: {called[1]} does not return"
                    where = context.head(following)
                    self._suspect("unreachable", where, message, "", (fact,))


def _returns(routine: RoutineBody) -> bool:
    end = routine.ways.end
    return any(node is end or type(node.statement) is ast.Return for node in routine.reached)


# ------------------------------------------------------------------------------------- a project


def of_project(files: Sequence[Summaries]) -> Iterator[Diagnostic]:
    """Yield the suspects of all files that are true, and arguments with invalid values."""
    facts = _facts(clause for one in files for clause in one.clauses)
    if any(fact[0] == RESUMES for fact in facts):
        facts = {fact for fact in facts if fact[0] != ENDLESS}
    bounds = _bounds(files)
    for one in files:
        for suspect in one.suspects:
            if facts.issuperset(suspect.holds) and facts.isdisjoint(suspect.lacks):
                yield diagnose(
                    suspect.slug, one.path, suspect.region, suspect.message, reason=suspect.reason
                )
        for (to, value), region in one.constants.items():
            for bound in bounds.get(to, ()):
                if not bound.accepts(value):
                    message = f"{value:g} is passed to {to[1]}, which {bound.use}"
                    yield diagnose(bound.slug, one.path, region, message, severity="warning")


def _facts(clauses: Iterable[Clause]) -> set[Fact]:
    """Return the least fixed point of some clauses."""
    found: set[Fact] = set()
    waiting: dict[Fact, list[tuple[Fact, set[Fact]]]] = {}
    todo: list[Fact] = []
    for fact, premises in clauses:
        lacking = set(premises)
        for premise in premises:
            waiting.setdefault(premise, []).append((fact, lacking))
        if not premises:
            todo.append(fact)
    while todo:
        fact = todo.pop()
        if fact not in found:
            found.add(fact)
            for head_, lacking in waiting.get(fact, ()):
                lacking.discard(fact)
                if not lacking:
                    todo.append(head_)
    return found


def _bounds(files: Iterable[Summaries]) -> dict[Parameter, dict[Bound, None]]:
    """Return the valid values of parameters, including those of routines that receive them."""
    found: dict[Parameter, dict[Bound, None]] = {}
    giving: dict[Parameter, list[Parameter]] = {}
    todo: list[tuple[Parameter, Bound]] = []
    for one in files:
        todo += one.bounds
        for parameter, to in one.handed_on:
            giving.setdefault(to, []).append(parameter)
    while todo:
        parameter, bound = todo.pop()
        known = found.setdefault(parameter, {})
        if bound not in known:
            known[bound] = None
            todo += ((one, bound) for one in giving.get(parameter, ()))
    return found
