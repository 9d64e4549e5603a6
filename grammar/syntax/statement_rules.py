"""AST nodes for the rules of the grammar that lie within a line.

There is one function for each rule, or for several similar ones. It gets the children of the rule
in the order of the text and drafts its node (`grammar.syntax.node_plans`). The functions for
expressions are in `grammar.syntax.expression_rules`; rules that span lines are built in
`grammar.syntax.build`. A new rule of the grammar needs an entry in one of the three, unless it is
named after its node, such as ``waitFor`` for `WaitFor`, and has the fields in order.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.expression_rules import EXPRESSION_RULES, literal, type_name
from grammar.syntax.node_plans import Draft, Parts, Rule, Value, node
from grammar.syntax.parts import after, at, each, flag, has, one, value_of, values_of

# ----------------------------------------------------------------------------------- declarations


def _declaration(draft: Draft, parts: Parts) -> Value:
    """Return a declaration with or without initial values; or an assignment in a data list."""
    first = parts[0]
    if first.symbol == "definition":
        return first.value
    if first.symbol == "variable":
        return draft.over(ast.Assignment, parts, first.value, parts[2].value)
    return draft.over(
        ast.VariableDeclaration,
        parts,
        first.symbol == "DECL",
        has(parts[:3], "GLOBAL"),
        has(parts[:3], "CONST"),
        value_of(parts, "type") or value_of(parts, "predefinedType"),
        values_of(parts, "declarator") or values_of(parts, "initialisedDeclarator"),
    )


def _signal(draft: Draft, parts: Parts) -> Value:
    places = values_of(parts, "variable")
    if not places:
        places = (literal(draft, parts[-1:]),)
    first, last = (*places, None)[:2]
    flags = has(parts, "DECL"), has(parts, "GLOBAL")
    return draft.over(ast.Signal, parts, *flags, value_of(parts, "name"), first, last)


def _external(draft: Draft, parts: Parts) -> Value:
    parameters = value_of(parts, "externalParameters") or ()
    result, name = type_name(draft, parts), value_of(parts, "name")
    return draft.over(ast.External, parts, parts[0].symbol, result, name, parameters)


def _channel(draft: Draft, parts: Parts) -> Value:
    name, interface = values_of(parts, "name")
    return draft.over(ast.ChannelDefinition, parts, name, interface, parts[-1].value)


def _initialised_declarator(draft: Draft, parts: Parts) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(_with_value, parts, parts[0].value, parts[2].value)


def _with_value(span: Span, plain: ast.Declarator, value: ast.Expression) -> ast.Declarator:
    return ast.Declarator(span, plain.name, plain.indices, value)


# ------------------------------------------------------------------------------------- statements


def _statement(draft: Draft, parts: Parts) -> Value:
    """Return the statement; a call is an expression too, and is wrapped in a statement here."""
    value = _only(draft, parts)
    return draft.over(ast.CallStatement, parts, value) if parts[0].symbol == "call" else value


def _wait(draft: Draft, parts: Parts) -> Value:
    kind = ast.WaitFor if parts[1].symbol == "FOR" else ast.WaitSeconds
    return draft.over(kind, parts, parts[2].value)


def _cyclic_signal(draft: Draft, parts: Parts) -> Value:
    keyword = parts[0].symbol
    if parts[1].symbol == "OFF":
        return draft.over(ast.SignalOff, parts, keyword, parts[2].value)
    options = (after(parts, symbol) for symbol in ("DELAY", "MINIMUM", "MAXIMUM"))
    return draft.over(ast.SignalOn, parts, keyword, parts[2].value, *options)


def _brake(draft: Draft, parts: Parts) -> Value:
    return draft.over(ast.Brake, parts, parts[1].symbol if len(parts) > 1 else None)


def _interrupt(draft: Draft, parts: Parts) -> Value:
    expressions = values_of(parts, "expression")
    if has(parts, "DECL"):
        number, condition = expressions
        action = value_of(parts, "interruptAction")
        is_global = has(parts, "GLOBAL")
        return draft.over(ast.InterruptDeclaration, parts, is_global, number, condition, action)
    return draft.over(ast.InterruptSwitch, parts, parts[1].symbol, value_of(parts, "expression"))


def _trigger(draft: Draft, parts: Parts) -> Value:
    place = value_of(parts, "place")
    assert isinstance(place, tuple)
    delay, action = after(parts, "DELAY"), value_of(parts, "triggerAction")
    return draft.over(ast.Trigger, parts, *place, delay, action, after(parts, "PRIO"))


def _place(_draft: Draft, parts: Parts) -> Value:
    return parts[0].symbol, parts[2].value, has(parts, "ONSTART")


# ---------------------------------------------------------------------------------------- motions


def _motion(draft: Draft, parts: Parts) -> Value:
    targets = values_of(parts, "target")
    criteria = value_of(parts, "approximation") or (("C_SPL",) if has(parts, "C_SPL") else ())
    return draft.over(
        ast.Motion,
        parts,
        parts[0].symbol,
        targets[0] if len(targets) > 1 else None,
        targets[-1],
        value_of(parts, "expression"),
        value_of(parts, "with") or (),
        criteria,
        value_of(parts, "reference"),
    )


def _spline_item(draft: Draft, parts: Parts) -> Value:
    keyword, *rest = parts
    if not rest:
        return keyword.value
    on_start = has(rest, "ONSTART")
    if keyword.symbol == "STOP":
        place, condition = values_of(rest, "expression")
        return draft.over(ast.StopWhen, parts, place, on_start, condition)
    value = value_of(rest, "expression")
    if keyword.symbol == "TIME_BLOCK":
        return draft.over(ast.TimeBlock, parts, rest[0].symbol, value)
    return draft.over(ast.ConstantVelocity, parts, rest[0].symbol, value, on_start)


# --------------------------------------------------------------------------------- which for which


def _only(_draft: Draft, parts: Parts) -> Value:
    """Return the value of the only child: the rule is a choice between rules."""
    (only,) = parts
    assert only.symbol[0].islower(), only.symbol
    return only.value


def _all(symbol: str) -> Rule:
    """Return a function for a rule that is a list of ``symbol``."""

    def rule(_draft: Draft, parts: Parts) -> Value:
        return values_of(parts, symbol)

    return rule


def _symbol(_draft: Draft, parts: Parts) -> Value:
    """Return the keyword: the rule is a choice between keywords."""
    return parts[0].symbol


#: Rules that mean the same as their only child.
CHAINS = frozenset(
    "expression disjunction exclusion conjunction sum product factor composition primary target "
    "frame literal constant argument caseValue initialValue definition".split()
)


def _in_order(kind: type[ast.Node]) -> Rule:
    """Return a function for a rule that has the fields of its node in order.

    Fields at the end may be missing.
    """
    count = len(fields(kind)) - 1

    def rule(draft: Draft, parts: Parts) -> Value:
        values = [part.value for part in parts if part.symbol[0].islower()]
        assert len(values) <= count, values
        return draft.over(kind, parts, *values, *[None] * (count - len(values)))

    return rule


def _rule_name(kind: type[ast.Node]) -> str:
    return kind.__name__[0].lower() + kind.__name__[1:]


#: Functions by rule. A rule named after its node needs no entry if `_in_order` is enough.
RULES: Mapping[str, Rule] = {
    **{_rule_name(kind): _in_order(kind) for kind in ast.TEMPLATES},
    **EXPRESSION_RULES,
    "parameters": _all("parameter"),
    "parameter": node(ast.Parameter, at(0), one("index"), one("parameterMode")),
    "parameterMode": _symbol,
    "declaration": _declaration,
    "initialisation": _declaration,
    "definition": _only,
    "enumeration": node(ast.Enumeration, flag("GLOBAL"), one("name"), each("enumerator")),
    "enumerator": _only,
    "structure": node(ast.Structure, flag("GLOBAL"), one("name"), each("memberGroup")),
    "memberGroup": node(ast.MemberGroup, at(0), each("declarator")),
    "signal": _signal,
    "external": _external,
    "externalParameters": _all("externalParameter"),
    "externalParameter": node(
        ast.ExternalParameter, at(0), one("name"), one("index"), one("parameterMode")
    ),
    "channel": _channel,
    "importation": node(
        ast.Importation,
        flag("DECL"),
        one("type"),
        one("declarator"),
        each("name"),
        one("variable"),
    ),
    "initialisedDeclarator": _initialised_declarator,
    "initialValue": _only,
    "simpleStatement": _statement,
    "caseValue": _only,
    "wait": _wait,
    "cyclicSignal": _cyclic_signal,
    "motion": _motion,
    "approximation": _all("criterion"),
    "criterion": _symbol,
    "approximatedSplineMotion": _motion,
    "splineMotion": _motion,
    "with": _all("assignment"),
    "splineItem": _spline_item,
    "interrupt": _interrupt,
    "interruptAction": _statement,
    "brake": _brake,
    "trigger": _trigger,
    "place": _place,
    "triggerAction": _statement,
}
