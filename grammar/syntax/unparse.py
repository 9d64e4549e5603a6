"""From the abstract syntax tree back to text: one statement a line, in the style of `krl format`.

Reading the text again gives a tree that says the same (`grammar.syntax.walk.same`). Comments, folds
and blank lines are not in the tree and so not in the text: `grammar.syntax.formatter` keeps them. A
tree made by hand may have operands that bind weaker than their operator; they are put in
parentheses.

Blocks are printed without recursion, expressions with it (`grammar.syntax.node_plans.MAX_DEPTH`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from grammar.syntax import ast

__all__ = ["expression", "indent", "unparse"]

_INDENT = "  "
# A file of a megabyte may hold 100,000 nested blocks; indented in full it would have gigabytes.
_DEEPEST = 60

#: A line, or what is still to be printed; lower ones are indented by one more.
_Text = str | ast.Node
_Line = tuple[int, _Text]


def unparse(module: ast.Module) -> str:
    """The text of a module, with line feeds."""
    lines = [header.text for header in module.headers]
    todo: list[_Line] = [(0, module.content)]
    while todo:
        depth, node = todo.pop()
        if isinstance(node, str):
            lines.append(indent(depth) + node)
        elif type(node) in _BLOCKS:
            inner = list(_BLOCKS[type(node)](node))
            todo += [(depth + more, item) for more, item in reversed(inner)]
        else:
            lines.append(indent(0 if isinstance(node, ast.Label) else depth) + _text(node))
    return "".join(f"{line}\n" for line in lines)


def indent(depth: int) -> str:
    """The blanks before a line that lies in so many blocks."""
    return _INDENT * min(depth, _DEEPEST)


def _text(node: Any) -> str:
    """The text of what lies within a line."""
    return _PRINTERS[type(node)](node)


def expression(node: ast.Expression) -> str:
    """The text of an expression."""
    return _text(node)


# ------------------------------------------------------------------------------------ expressions

# From the weakest to the tightest, as in the grammar; other nodes are primary.
_RANKS = (
    ("==", "<>", "<", ">", "<=", ">="),
    ("OR", "B_OR"),
    ("EXOR", "B_EXOR"),
    ("AND", "B_AND"),
    ("+", "-"),
    ("*", "/"),
)
_RANK = {operator: rank for rank, operators in enumerate(_RANKS) for operator in operators}
_UNARY = len(_RANKS)
_RANK[":"] = _UNARY + 1


def _rank(node: ast.Expression) -> int:
    match node:
        case ast.Binary(operator=operator):
            return _RANK[operator]
        case ast.Unary():
            return _UNARY
        case _:
            return _UNARY + 2


def _operand(node: ast.Expression, least: int) -> str:
    return _text(node) if _rank(node) >= least else f"({_text(node)})"


def _binary(node: ast.Binary) -> str:
    rank = _RANK[node.operator]
    left, right = _operand(node.left, rank), _operand(node.right, rank + 1)
    if node.operator == ":":
        return f"{left}:{right}"
    return f"{left} {node.operator} {right}"


def _unary(node: ast.Unary) -> str:
    blank = " " if node.operator.isalnum() or "_" in node.operator else ""
    return f"{node.operator}{blank}{_operand(node.operand, _UNARY)}"


def _list(nodes: Iterable[ast.Node | None]) -> str:
    texts = ["" if node is None else f" {_text(node)}" for node in nodes]
    return ",".join(texts).removeprefix(" ")


def _indices(indices: tuple[ast.Expression | None, ...] | None) -> str:
    return (
        "" if indices is None else f"[{','.join('' if i is None else _text(i) for i in indices)}]"
    )


def _call(node: ast.Call) -> str:
    return f"{_text(node.name)}({_list(node.arguments)})"


def _aggregate(node: ast.Aggregate) -> str:
    prefix = "" if node.type is None else f"{_text(node.type)}: "
    return f"{{{prefix}{_list(node.components)}}}"


def _component(node: ast.Component) -> str:
    return f"{_text(node.name)}{_indices(node.indices)} {_text(node.value)}"


# ----------------------------------------------------------------------------------- declarations


def _words(*words: str | None) -> str:
    return " ".join(word for word in words if word)


def _if(wanted: bool, word: str) -> str:
    return word if wanted else ""


def _with_keyword(keyword: str, node: ast.Node | None) -> str:
    return "" if node is None else f"{keyword} {_text(node)}"


def _declarator(node: ast.Declarator) -> str:
    value = "" if node.value is None else f"={_text(node.value)}"
    return f"{_text(node.name)}{_indices(node.indices)}{value}"


def _declaration(node: ast.VariableDeclaration) -> str:
    return _words(
        _if(node.has_decl, "DECL"),
        _if(node.is_global, "GLOBAL"),
        _if(node.is_constant, "CONST"),
        _text(node.type),
        _list(node.declarators),
    )


def _enumeration(node: ast.Enumeration) -> str:
    return _words(_if(node.is_global, "GLOBAL"), "ENUM", _text(node.name), _list(node.constants))


def _structure(node: ast.Structure) -> str:
    return _words(_if(node.is_global, "GLOBAL"), "STRUC", _text(node.name), _list(node.groups))


def _signal(node: ast.Signal) -> str:
    return _words(
        _if(node.has_decl, "DECL"),
        _if(node.is_global, "GLOBAL"),
        "SIGNAL",
        _text(node.name),
        _text(node.first),
        _with_keyword("TO", node.last),
    )


def _type_name(node: ast.TypeName) -> str:
    return f"{_text(node.name)}{_indices(node.indices)}"


def _optional(node: ast.Node | None) -> str:
    return "" if node is None else _text(node)


def _parameter(node: ast.Parameter) -> str:
    return f"{_text(node.name)}{_indices(node.indices)}{_mode(node.mode)}"


def _external(node: ast.External) -> str:
    head = _words(node.keyword, _optional(node.result), _text(node.name))
    return f"{head}({_list(node.parameters)})"


def _external_parameter(node: ast.ExternalParameter) -> str:
    head = _words(_text(node.type), _optional(node.name))
    return f"{head}{_indices(node.indices)}{_mode(node.mode)}"


def _mode(mode: str | None) -> str:
    return "" if mode is None else f":{mode}"


def _channel(node: ast.ChannelDefinition) -> str:
    return f"CHANNEL :{_text(node.name)} :{_text(node.interface)} {_text(node.description)}"


def _importation(node: ast.Importation) -> str:
    path = "".join(f"/{_text(name)}" for name in node.path)
    return _words(
        _if(node.has_decl, "DECL"),
        "IMPORT",
        _text(node.type),
        _text(node.declarator),
        f"IS {path}..{_text(node.source)}",
    )


# ------------------------------------------------------------------------------------- statements


def _assignment(node: ast.Assignment) -> str:
    return f"{_text(node.target)} = {_text(node.value)}"


def _parameter_value(keyword: str, node: ast.Node | None) -> str:
    return "" if node is None else f"{keyword}={_text(node)}"


def _signal_on(node: ast.SignalOn) -> str:
    return _words(
        node.keyword,
        "ON",
        _text(node.assignment),
        _parameter_value("DELAY", node.delay),
        _parameter_value("MINIMUM", node.minimum),
        _parameter_value("MAXIMUM", node.maximum),
    )


def _with(values: tuple[ast.Assignment, ...]) -> str:
    return _if(bool(values), f"WITH {_list(values)}")


def _motion(node: ast.Motion) -> str:
    points = [point for point in (node.auxiliary, node.target) if point is not None]
    angle = "" if node.angle is None else f", CA {_text(node.angle)}"
    return _words(
        node.kind,
        f"{_list(points)}{angle}",
        _with(node.values),
        *node.criteria,
        _optional(node.reference),
    )


def _emily_motion(node: ast.EmilyMotion) -> str:
    number = _with_keyword("FLT", node.number)
    return _words("MOVE_EMI", _text(node.device), _text(node.action), number)


def _place(kind: str, place: ast.Expression, on_start: bool) -> str:
    return _words(f"{kind}={_text(place)}", _if(on_start, "ONSTART"))


def _trigger(node: ast.Trigger) -> str:
    return _words(
        "TRIGGER WHEN",
        _place(node.place_kind, node.place, node.on_start),
        f"DELAY={_text(node.delay)}",
        f"DO {_text(node.action)}",
        _parameter_value("PRIO", node.priority),
    )


def _interrupt(node: ast.InterruptDeclaration) -> str:
    return _words(
        _if(node.is_global, "GLOBAL"),
        f"INTERRUPT DECL {_text(node.number)}",
        f"WHEN {_text(node.condition)} DO {_text(node.action)}",
    )


def _time_block(node: ast.TimeBlock) -> str:
    value = "" if node.value is None else f"={_text(node.value)}"
    return f"TIME_BLOCK {node.edge}{value}"


def _stop_when(node: ast.StopWhen) -> str:
    place = _place("PATH", node.place, node.on_start)
    return f"STOP WHEN {place} IF {_text(node.condition)}"


_PRINTERS: Mapping[type, Callable[[Any], str]] = {
    ast.Name: lambda node: node.text,
    ast.TypeName: _type_name,
    ast.IntegerLiteral: lambda node: str(node.value),
    ast.RealLiteral: lambda node: node.text,
    ast.BoolLiteral: lambda node: "TRUE" if node.value else "FALSE",
    ast.BitLiteral: lambda node: node.text,
    ast.StringLiteral: lambda node: f'"{node.text}"',
    ast.EnumConstant: lambda node: f"#{_text(node.name)}",
    ast.Variable: lambda node: _text(node.name),
    ast.Subscript: lambda node: f"{_text(node.base)}{_indices(node.indices)}",
    ast.Member: lambda node: f"{_text(node.base)}.{_text(node.name)}",
    ast.ChannelName: lambda node: f":{_text(node.name)}",
    ast.Call: _call,
    ast.Unary: _unary,
    ast.Binary: _binary,
    ast.Parenthesised: lambda node: f"({_text(node.inner)})",
    ast.Component: _component,
    ast.Aggregate: _aggregate,
    ast.Declarator: _declarator,
    ast.VariableDeclaration: _declaration,
    ast.Enumeration: _enumeration,
    ast.MemberGroup: lambda node: f"{_text(node.type)} {_list(node.declarators)}",
    ast.Structure: _structure,
    ast.Signal: _signal,
    ast.ExternalParameter: _external_parameter,
    ast.External: _external,
    ast.ChannelDefinition: _channel,
    ast.Importation: _importation,
    ast.Assignment: _assignment,
    ast.CallStatement: lambda node: _text(node.call),
    ast.Exit: lambda _: "EXIT",
    ast.Goto: lambda node: f"GOTO {_text(node.label)}",
    ast.Label: lambda node: f"{_text(node.name)}:",
    ast.Return: lambda node: _words("RETURN", _optional(node.value)),
    ast.Halt: lambda _: "HALT",
    ast.Continue: lambda _: "CONTINUE",
    ast.OnErrorProceed: lambda _: "ON_ERROR_PROCEED",
    ast.Confirm: lambda node: f"CONFIRM {_text(node.number)}",
    ast.WaitFor: lambda node: f"WAIT FOR {_text(node.condition)}",
    ast.WaitSeconds: lambda node: f"WAIT SEC {_text(node.duration)}",
    ast.SignalOn: _signal_on,
    ast.SignalOff: lambda node: f"{node.keyword} OFF {_text(node.variable)}",
    ast.Motion: _motion,
    ast.EmilyMotion: _emily_motion,
    ast.ConstantVelocity: lambda node: f"CONST_VEL {_place(node.edge, node.place, node.on_start)}",
    ast.TimeBlock: _time_block,
    ast.StopWhen: _stop_when,
    ast.Brake: lambda node: _words("BRAKE", node.mode),
    ast.Resume: lambda _: "RESUME",
    ast.InterruptDeclaration: _interrupt,
    ast.InterruptSwitch: lambda node: _words("INTERRUPT", node.action, _optional(node.number)),
    ast.Trigger: _trigger,
    ast.Parameter: _parameter,
}


# ----------------------------------------------------------------------------------------- blocks

#: What a block consists of, with how much more it is indented than the block.
_Lines = Iterator[_Line]


def _inside(nodes: Iterable[ast.Node]) -> _Lines:
    return ((1, node) for node in nodes)


def _program(node: ast.Program) -> _Lines:
    for number, routine in enumerate(node.routines):
        if number:
            yield 0, ""
        yield 0, routine


def _routine(node: ast.Routine) -> _Lines:
    keyword = "DEF" if node.result is None else "DEFFCT"
    head = _words(_if(node.is_global, "GLOBAL"), keyword, _optional(node.result), _text(node.name))
    yield 0, f"{head}({_list(node.parameters)})"
    yield from ((0, statement) for statement in node.body)
    yield 0, "END" if node.result is None else "ENDFCT"


def _data_list(node: ast.DataList) -> _Lines:
    yield 0, _words("DEFDAT", _text(node.name), _if(node.is_public, "PUBLIC"))
    for item in node.items:
        if isinstance(item, ast.Assignment):  # set tight, as initial values are
            yield 0, f"{_text(item.target)}={_text(item.value)}"
        else:
            yield 0, item
    yield 0, "ENDDAT"


def _if_block(node: ast.If) -> _Lines:
    yield 0, f"IF {_text(node.condition)} THEN"
    yield from _inside(node.body)
    if node.otherwise is not None:
        yield 0, "ELSE"
        yield from _inside(node.otherwise)
    yield 0, "ENDIF"


def _for(node: ast.For) -> _Lines:
    first, last = _text(node.first), _text(node.last)
    step = _with_keyword("STEP", node.step)
    yield 0, _words(f"FOR {_text(node.counter)} = {first} TO {last}", step)
    yield from _inside(node.body)
    yield 0, "ENDFOR"


def _while(node: ast.While) -> _Lines:
    yield 0, f"WHILE {_text(node.condition)}"
    yield from _inside(node.body)
    yield 0, "ENDWHILE"


def _repeat(node: ast.Repeat) -> _Lines:
    yield 0, "REPEAT"
    yield from _inside(node.body)
    yield 0, f"UNTIL {_text(node.condition)}"


def _loop(node: ast.Loop) -> _Lines:
    yield 0, "LOOP"
    yield from _inside(node.body)
    yield 0, "ENDLOOP"


def _switch(node: ast.Switch) -> _Lines:
    yield 0, f"SWITCH {_text(node.selector)}"
    yield from _inside(node.branches)
    if node.default is not None:
        yield 1, "DEFAULT"
        yield from ((2, statement) for statement in node.default)
    yield 0, "ENDSWITCH"


def _case(node: ast.CaseBranch) -> _Lines:
    yield 0, f"CASE {_list(node.values)}"
    yield from _inside(node.body)


def _spline_block(node: ast.SplineBlock) -> _Lines:
    yield 0, _words(node.keyword, _with(node.values))
    yield from _inside(node.items)
    yield 0, _words("ENDSPLINE", _if(node.is_approximated, "C_SPL"))


_BLOCKS: Mapping[type, Callable[[Any], _Lines]] = {
    ast.Program: _program,
    ast.Routine: _routine,
    ast.DataList: _data_list,
    ast.If: _if_block,
    ast.For: _for,
    ast.While: _while,
    ast.Repeat: _repeat,
    ast.Loop: _loop,
    ast.Switch: _switch,
    ast.CaseBranch: _case,
    ast.SplineBlock: _spline_block,
}
