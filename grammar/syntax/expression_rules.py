"""AST nodes for the rules of names, types, literals and expressions (see `statement_rules`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.node_plans import Draft, Parts, Rule, Value, node
from grammar.syntax.parts import Part, at, each, one, separated, value_of

# Types whose names are keywords: they are kept in upper case.
_KEYWORD_TYPES = frozenset("INT REAL BOOL CHAR FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split())
# A number with more digits is too large in any case; converting it would take long.
_MOST_DIGITS = 1_000


# ----------------------------------------------------------------------------- names and literals


def _type_of(span: Span, text: str) -> ast.Name:
    upper = text.upper()
    return ast.Name(span, upper if upper in _KEYWORD_TYPES else text)


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


def _name(draft: Draft, parts: Parts) -> Value:
    return draft.over(ast.Name, parts, parts[0].first)


def _position_type(_draft: Draft, parts: Parts) -> Value:
    return parts[0].value


def _type(draft: Draft, parts: Parts) -> Value:
    return draft.over(_type_of, parts, parts[0].first)


def type_name(draft: Draft, parts: Parts) -> Value:
    """Return the result type of an external function, or ``None`` for a procedure."""
    chosen = [part for part in parts if part.symbol in ("type", "index")]
    if not chosen:
        return None
    return draft.over(ast.TypeName, chosen, chosen[0].value, value_of(chosen, "index"))


def literal(draft: Draft, parts: Parts) -> Value:
    """Return the node of a literal; any other child is returned as it is."""
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


def _operator(part: Part[Value]) -> Value:
    return part.value if part.symbol == "relation" else _OPERATORS.get(part.symbol, part.symbol)


def _relation(_draft: Draft, parts: Parts) -> Value:
    return _operator(parts[0])


def _infix(draft: Draft, parts: Parts) -> Value:
    """Return the node of a chain of operators of equal rank, which are left-associative."""
    value, chain = parts[0].value, None
    for operator, right in zip(parts[1::2], parts[2::2], strict=True):
        operands = _operator(operator), value, right.value
        value = chain = draft.node(ast.Binary, parts[0].first, right.stop, *operands, chain=chain)
    return value


def _prefix(draft: Draft, parts: Parts) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(_unary_of, parts, _operator(parts[0]), parts[1].value)


def _unary_of(span: Span, operator: str, operand: ast.Expression) -> ast.Unary | ast.IntegerLiteral:
    """Return a unary operation; ``-`` with 2147483648 becomes the least INT [TYP-01].

    Without its sign the number would be out of range.
    """
    if operator == "-" and type(operand) is ast.IntegerLiteral and operand.value == 2**31:
        return ast.IntegerLiteral(span, -(2**31))
    return ast.Unary(span, operator, operand)


def _primary(draft: Draft, parts: Parts) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(ast.Parenthesised, parts, parts[1].value)


def _variable(draft: Draft, parts: Parts) -> Value:
    first = parts[0].first
    value = draft.node(ast.Variable, first, parts[0].stop, parts[0].value)
    for part in parts[1:]:
        if part.symbol == "index":
            value = draft.node(ast.Subscript, first, part.stop, value, part.value)
        elif part.symbol == "name":
            value = draft.node(ast.Member, first, part.stop, value, part.value)
    return value


def _index(_draft: Draft, parts: Parts) -> Value:
    return separated(parts[1:-1])


def _arguments(_draft: Draft, parts: Parts) -> Value:
    return separated(parts) if parts else ()


def _argument(draft: Draft, parts: Parts) -> Value:
    if len(parts) == 1:
        return parts[0].value
    return draft.over(ast.ChannelName, parts, parts[1].value)


#: By the name of the rule.
EXPRESSION_RULES: Mapping[str, Rule] = {
    "type": _type,
    "predefinedType": _type,
    "positionType": _position_type,
    "arguments": _arguments,
    "argument": _argument,
    "reference": literal,
    "emilyName": literal,
    "target": _infix,
    "frame": _primary,
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
    "literal": literal,
    "number": literal,
    "constant": _prefix,
    "aggregate": node(ast.Aggregate, one("name"), each("component")),
    "component": node(ast.Component, at(0), one("index"), at(-1)),
}
