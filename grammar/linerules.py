"""What each rule of the grammar that lies within a line becomes: drafts of nodes of the tree.

One function a rule, or one for several that are alike. Each gets what the rule consists of, in the
order of the text, and says which node that is (`grammar.plans`). Rules that span lines are built in
`grammar.build`. A rule that is new to the grammar needs an entry here or there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from grammar import ast
from grammar.ast import Span
from grammar.plans import Draft, Part, Rule, Value

__all__ = ["CHAINS", "KEYWORD_TYPES", "RULES"]

#: Types whose names are keywords: they are kept in upper case.
KEYWORD_TYPES = frozenset("INT REAL BOOL CHAR FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split())
# More digits tell a checker nothing: the number is too large.
_MOST_DIGITS = 1_000


# ------------------------------------------------------------------------------------ selections


def _value(parts: Sequence[Part], symbol: str) -> Value:
    """What the first part of this kind came to; ``None`` where there is none."""
    return next((part.value for part in parts if part.symbol == symbol), None)


def _values(parts: Sequence[Part], symbol: str) -> tuple[Value, ...]:
    return tuple(part.value for part in parts if part.symbol == symbol)


def _has(parts: Sequence[Part], symbol: str) -> bool:
    return any(part.symbol == symbol for part in parts)


def _after(parts: Sequence[Part], symbol: str) -> Value:
    """What the part two after a keyword came to, an equals sign between; ``None`` without it."""
    for place, part in enumerate(parts):
        if part.symbol == symbol:
            return parts[place + 2].value
    return None


def _separated(parts: Sequence[Part]) -> tuple[Value, ...]:
    """What commas separate, ``None`` for what is left out."""
    items: list[Value] = [None]
    for part in parts:
        if part.symbol == "COMMA":
            items.append(None)
        else:
            items[-1] = part.value
    return tuple(items)


# ----------------------------------------------------------------------------- names and literals


def _type_of(span: Span, text: str) -> ast.Name:
    upper = text.upper()
    return ast.Name(span, upper if upper in KEYWORD_TYPES else text)


def _integer_of(span: Span, text: str) -> ast.IntegerLiteral:
    if len(text) > _MOST_DIGITS:
        text = text.lstrip("0") or "0"
        if len(text) > _MOST_DIGITS:
            return ast.IntegerLiteral(span, 10**_MOST_DIGITS)
    return ast.IntegerLiteral(span, int(text))


def _bits_of(span: Span, text: str) -> ast.BitLiteral:
    digits = text[2:-1].replace(" ", "")
    return ast.BitLiteral(span, text, int(digits, 2 if text[1] in "bB" else 16))


def _string_of(span: Span, text: str) -> ast.StringLiteral:
    return ast.StringLiteral(span, text[1:-1])


def _constant_of(span: Span, text: str) -> ast.EnumConstant:
    return ast.EnumConstant(span, ast.Name((span[0] + 1, span[1]), text[1:]))


def _bool_of(span: Span, text: str) -> ast.BoolLiteral:
    return ast.BoolLiteral(span, text.upper() == "TRUE")


_LITERALS: Mapping[str, Callable[[Span, str], ast.Node]] = {
    "INTEGER": _integer_of,
    "REAL_NUMBER": ast.RealLiteral,
    "TRUE": _bool_of,
    "FALSE": _bool_of,
    "BIT_STRING": _bits_of,
    "STRING": _string_of,
    "ENUM_CONSTANT": _constant_of,
}


def _name(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Name, parts, parts[0].first)


def _position_type(_draft: Draft, parts: Sequence[Part]) -> Value:
    return parts[0].value


def _type(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(_type_of, parts, parts[0].first)


def _type_name(draft: Draft, parts: Sequence[Part]) -> Value:
    """What an external function gives, where it is one."""
    chosen = [part for part in parts if part.symbol in ("type", "index")]
    if not chosen:
        return None
    return draft.over(ast.TypeName, chosen, chosen[0].value, _value(chosen, "index"))


def _literal(draft: Draft, parts: Sequence[Part]) -> Value:
    (only,) = parts
    make = _LITERALS.get(only.symbol)
    return only.value if make is None else draft.over(make, parts, only.value)


# ------------------------------------------------------------------------------------ expressions

_OPERATORS = {
    "EQUALS": "==",
    "NOT_EQUAL": "<>",
    "LESS": "<",
    "GREATER": ">",
    "AT_MOST": "<=",
    "AT_LEAST": ">=",
    "PLUS": "+",
    "MINUS": "-",
    "TIMES": "*",
    "DIVIDE": "/",
    "COLON": ":",
}


def _operator(part: Part) -> Value:
    return part.value if part.symbol == "relation" else _OPERATORS.get(part.symbol, part.symbol)


def _relation(_draft: Draft, parts: Sequence[Part]) -> Value:
    return _operator(parts[0])


def _infix(draft: Draft, parts: Sequence[Part]) -> Value:
    """Operators of equal rank join from left to right."""
    value = parts[0].value
    for operator, right in zip(parts[1::2], parts[2::2], strict=True):
        value = draft.node(
            ast.Binary, parts[0].first, right.stop, _operator(operator), value, right.value
        )
    return value


def _prefix(draft: Draft, parts: Sequence[Part]) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(ast.Unary, parts, _operator(parts[0]), parts[1].value)


def _primary(draft: Draft, parts: Sequence[Part]) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(ast.Parenthesised, parts, parts[1].value)


def _variable(draft: Draft, parts: Sequence[Part]) -> Value:
    first = parts[0].first
    value = draft.node(ast.Variable, first, parts[0].stop, parts[0].value)
    for part in parts[1:]:
        if part.symbol == "index":
            value = draft.node(ast.Subscript, first, part.stop, value, part.value)
        elif part.symbol == "name":
            value = draft.node(ast.Member, first, part.stop, value, part.value)
    return value


def _index(_draft: Draft, parts: Sequence[Part]) -> Value:
    return _separated(parts[1:-1])


def _call(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Call, parts, parts[0].value, _value(parts, "arguments"))


def _arguments(_draft: Draft, parts: Sequence[Part]) -> Value:
    return _separated(parts) if parts else ()


def _argument(draft: Draft, parts: Sequence[Part]) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(ast.ChannelName, parts, parts[1].value)


def _aggregate(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Aggregate, parts, _value(parts, "name"), _values(parts, "component"))


def _component(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Component, parts, parts[0].value, _value(parts, "index"), parts[-1].value)


# ----------------------------------------------------------------------------------- declarations


def _enumeration(draft: Draft, parts: Sequence[Part]) -> Value:
    constants = _values(parts, "enumerator")
    return draft.over(
        ast.Enumeration, parts, _has(parts, "GLOBAL"), _value(parts, "name"), constants
    )


def _structure(draft: Draft, parts: Sequence[Part]) -> Value:
    groups = _values(parts, "memberGroup")
    return draft.over(ast.Structure, parts, _has(parts, "GLOBAL"), _value(parts, "name"), groups)


def _member_group(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.MemberGroup, parts, parts[0].value, _values(parts, "declarator"))


def _signal(draft: Draft, parts: Sequence[Part]) -> Value:
    places = _values(parts, "variable")
    if not places:
        places = (_literal(draft, parts[-1:]),)
    first, last = (*places, None)[:2]
    flags = _has(parts, "DECL"), _has(parts, "GLOBAL")
    return draft.over(ast.Signal, parts, *flags, _value(parts, "name"), first, last)


def _external(draft: Draft, parts: Sequence[Part]) -> Value:
    parameters = _value(parts, "externalParameters") or ()
    result, name = _type_name(draft, parts), _value(parts, "name")
    return draft.over(ast.External, parts, parts[0].symbol, result, name, parameters)


def _external_parameter(draft: Draft, parts: Sequence[Part]) -> Value:
    selected = (_value(parts, symbol) for symbol in ("name", "index", "parameterMode"))
    return draft.over(ast.ExternalParameter, parts, parts[0].value, *selected)


def _parameter(draft: Draft, parts: Sequence[Part]) -> Value:
    selected = (_value(parts, symbol) for symbol in ("index", "parameterMode"))
    return draft.over(ast.Parameter, parts, parts[0].value, *selected)


def _channel(draft: Draft, parts: Sequence[Part]) -> Value:
    name, interface = _values(parts, "name")
    return draft.over(ast.ChannelDefinition, parts, name, interface, parts[-1].value)


def _importation(draft: Draft, parts: Sequence[Part]) -> Value:
    selected = (_value(parts, symbol) for symbol in ("type", "declarator"))
    path = _values(parts, "name")
    return draft.over(
        ast.Importation, parts, _has(parts, "DECL"), *selected, path, _value(parts, "variable")
    )


def _declarator(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Declarator, parts, parts[0].value, _value(parts, "index"), None)


def _initialised_declarator(draft: Draft, parts: Sequence[Part]) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(_with_value, parts, parts[0].value, parts[2].value)


def _with_value(span: Span, plain: ast.Declarator, value: ast.Expression) -> ast.Declarator:
    return ast.Declarator(span, plain.name, plain.indices, value)


# ------------------------------------------------------------------------------------- statements


def _statement(draft: Draft, parts: Sequence[Part]) -> Value:
    """What can be done: a call is an expression too, and becomes a statement here."""
    (only,) = parts
    if only.symbol == "call":
        return draft.over(ast.CallStatement, parts, only.value)
    return only.value


def _assignment(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Assignment, parts, parts[0].value, parts[2].value)


def _lone(kind: type[ast.Node]) -> Rule:
    """A statement of one keyword."""

    def rule(draft: Draft, parts: Sequence[Part]) -> Value:
        return draft.over(kind, parts)

    return rule


def _with_last(kind: type[ast.Node]) -> Rule:
    """A statement of a keyword and what follows it."""

    def rule(draft: Draft, parts: Sequence[Part]) -> Value:
        return draft.over(kind, parts, parts[-1].value)

    return rule


def _label(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Label, parts, parts[0].value)


def _return(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Return, parts, _value(parts, "expression"))


def _wait(draft: Draft, parts: Sequence[Part]) -> Value:
    kind = ast.WaitFor if parts[1].symbol == "FOR" else ast.WaitSeconds
    return draft.over(kind, parts, parts[2].value)


def _cyclic_signal(draft: Draft, parts: Sequence[Part]) -> Value:
    keyword = parts[0].symbol
    if parts[1].symbol == "OFF":
        return draft.over(ast.SignalOff, parts, keyword, parts[2].value)
    options = (_after(parts, symbol) for symbol in ("DELAY", "MINIMUM", "MAXIMUM"))
    return draft.over(ast.SignalOn, parts, keyword, parts[2].value, *options)


def _brake(draft: Draft, parts: Sequence[Part]) -> Value:
    return draft.over(ast.Brake, parts, parts[1].symbol if len(parts) > 1 else None)


def _interrupt(draft: Draft, parts: Sequence[Part]) -> Value:
    expressions = _values(parts, "expression")
    if _has(parts, "DECL"):
        number, condition = expressions
        action = _value(parts, "interruptAction")
        is_global = _has(parts, "GLOBAL")
        return draft.over(ast.InterruptDeclaration, parts, is_global, number, condition, action)
    return draft.over(ast.InterruptSwitch, parts, parts[1].symbol, _value(parts, "expression"))


def _trigger(draft: Draft, parts: Sequence[Part]) -> Value:
    place = _value(parts, "place")
    assert isinstance(place, tuple)
    delay, action = _after(parts, "DELAY"), _value(parts, "triggerAction")
    return draft.over(ast.Trigger, parts, *place, delay, action, _after(parts, "PRIO"))


def _place(_draft: Draft, parts: Sequence[Part]) -> Value:
    return parts[0].symbol, parts[2].value, _has(parts, "ONSTART")


# ---------------------------------------------------------------------------------------- motions


def _motion(draft: Draft, parts: Sequence[Part]) -> Value:
    targets = _values(parts, "target")
    criteria = _value(parts, "approximation") or (("C_SPL",) if _has(parts, "C_SPL") else ())
    return draft.over(
        ast.Motion,
        parts,
        parts[0].symbol,
        targets[0] if len(targets) > 1 else None,
        targets[-1],
        _value(parts, "expression"),
        _value(parts, "with") or (),
        criteria,
        _value(parts, "reference"),
    )


def _emily_motion(draft: Draft, parts: Sequence[Part]) -> Value:
    device, action = _values(parts, "emilyName")
    return draft.over(ast.EmilyMotion, parts, device, action, _value(parts, "expression"))


def _spline_item(draft: Draft, parts: Sequence[Part]) -> Value:
    keyword, *rest = parts
    if not rest:
        return keyword.value
    on_start = _has(rest, "ONSTART")
    if keyword.symbol == "STOP":
        place, condition = _values(rest, "expression")
        return draft.over(ast.StopWhen, parts, place, on_start, condition)
    value = _value(rest, "expression")
    if keyword.symbol == "TIME_BLOCK":
        return draft.over(ast.TimeBlock, parts, rest[0].symbol, value)
    return draft.over(ast.ConstantVelocity, parts, rest[0].symbol, value, on_start)


# --------------------------------------------------------------------------------- which for which


def _only(_draft: Draft, parts: Sequence[Part]) -> Value:
    """A rule that is a choice between others."""
    (only,) = parts
    return only.value


def _all(symbol: str) -> Rule:
    """A rule that is a list."""

    def rule(_draft: Draft, parts: Sequence[Part]) -> Value:
        return _values(parts, symbol)

    return rule


def _symbol(_draft: Draft, parts: Sequence[Part]) -> Value:
    """A rule that is a choice between keywords."""
    return parts[0].symbol


#: Rules that mean what their only child means.
CHAINS = frozenset(
    "expression disjunction exclusion conjunction sum product factor composition primary target "
    "frame literal constant argument caseValue initialValue definition".split()
)

RULES: Mapping[str, Rule] = {
    "parameters": _all("parameter"),
    "parameter": _parameter,
    "parameterMode": _symbol,
    "definition": _only,
    "enumeration": _enumeration,
    "enumerator": _only,
    "structure": _structure,
    "memberGroup": _member_group,
    "signal": _signal,
    "external": _external,
    "externalParameters": _all("externalParameter"),
    "externalParameter": _external_parameter,
    "channel": _channel,
    "importation": _importation,
    "declarator": _declarator,
    "initialisedDeclarator": _initialised_declarator,
    "initialValue": _only,
    "type": _type,
    "predefinedType": _type,
    "positionType": _position_type,
    "simpleStatement": _statement,
    "assignment": _assignment,
    "call": _call,
    "arguments": _arguments,
    "argument": _argument,
    "caseValue": _only,
    "exit": _lone(ast.Exit),
    "goto": _with_last(ast.Goto),
    "label": _label,
    "halt": _lone(ast.Halt),
    "continue": _lone(ast.Continue),
    "onErrorProceed": _lone(ast.OnErrorProceed),
    "confirm": _with_last(ast.Confirm),
    "wait": _wait,
    "cyclicSignal": _cyclic_signal,
    "return": _return,
    "motion": _motion,
    "reference": _literal,
    "approximation": _all("criterion"),
    "criterion": _symbol,
    "splineMotion": _motion,
    "emilyMotion": _emily_motion,
    "emilyName": _literal,
    "with": _all("assignment"),
    "splineItem": _spline_item,
    "target": _infix,
    "frame": _primary,
    "interrupt": _interrupt,
    "interruptAction": _statement,
    "brake": _brake,
    "resume": _lone(ast.Resume),
    "trigger": _trigger,
    "place": _place,
    "triggerAction": _statement,
    "expression": _infix,
    "relation": _relation,
    "disjunction": _infix,
    "exclusion": _infix,
    "conjunction": _infix,
    "sum": _infix,
    "product": _infix,
    "factor": _prefix,
    "composition": _infix,
    "primary": _primary,
    "variable": _variable,
    "name": _name,
    "keyword": _name,
    "index": _index,
    "literal": _literal,
    "number": _literal,
    "constant": _prefix,
    "aggregate": _aggregate,
    "component": _component,
}
