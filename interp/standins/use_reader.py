"""Reads what a file tells about the types of undeclared names; see `interp.standins.uses`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from grammar.check.project.framework import Checked
from grammar.semantics.link import Project
from grammar.semantics.scopes import Found, Module
from grammar.semantics.symbols import Kind, RoutineSymbol, Symbol, TypeReference
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    UNKNOWN,
    Array,
    Constant,
    Scalar,
    Text,
    Type,
)
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import left_chain, root_variable, walk
from interp.standins.uses import FOLDER, DataUse, Uses

_LOGICAL = frozenset({"AND", "OR", "EXOR"})
_BITWISE = frozenset({"B_AND", "B_OR", "B_EXOR"})
_RELATIONS = frozenset({"==", "<>", "<", ">", "<=", ">="})


def read_uses(
    uses: Uses,
    project: Project,
    files: Iterable[Checked],
    is_apart: Callable[[Module, str], bool],
) -> None:
    """Add to ``uses`` what all files of a project tell of its names.

    ``is_apart`` says whether a file has a variable of its own by a name.
    """
    for checked in files:
        _Reader(uses, project, checked, is_apart).read()
    uses.settle()


class _Reader:
    """Reads one file."""

    def __init__(
        self,
        uses: Uses,
        project: Project,
        checked: Checked,
        is_apart: Callable[[Module, str], bool],
    ) -> None:
        self._uses = uses
        self._project = project
        self._checked = checked
        self._is_apart = is_apart
        #: Calls that are statements, and operands that are known to be numbers.
        self._statements: set[ast.Call] = set()
        self._numbers: set[tuple[ast.Binary, Type]] = set()
        #: Of the current routine: the type of its result, as written too, and the largest value of
        #: each loop counter by name in upper case.
        self._result: Type = UNKNOWN
        self._written_result: TypeReference | None = None
        self._counted: dict[str, int] = {}
        #: By declared variables: the arguments of undeclared routines that they are, and the
        #: numbers with which a SWITCH compares them.
        self._passed: dict[Symbol, list[DataUse]] = defaultdict(list)
        self._cases: dict[Symbol, list[str]] = defaultdict(list)

    def read(self) -> None:
        syntax = self._checked.module.syntax
        assert syntax is not None, "only files that can be parsed are read"
        if isinstance(syntax.content, ast.DataList):
            self._visit(syntax)
            return
        for routine in syntax.content.routines:
            found = self._checked.resolution.found(routine.name)
            self._result = UNKNOWN if found is None else self._project.types.of(found)
            self._written_result = None if found is None else found.symbol.type
            self._counted.clear()
            self._visit(routine)
        for symbol, cases in self._cases.items():
            for use in self._passed[symbol]:  # what such a routine answers selects a case
                use.cases.update(cases)
                use.asked_for = use.asked_for or cases[0]

    # ------------------------------------------------------------------------- statements

    def _visit(self, root: ast.Node) -> None:
        for node in walk(root):
            rule = _RULES.get(type(node))
            if rule is not None:
                rule(self, node)

    def _statement(self, node: ast.CallStatement) -> None:
        self._statements.add(node.call)

    def _assignment(self, node: ast.Assignment) -> None:
        self._unify(node.target, node.value)
        use = self._use(node.target)
        if use is not None:
            use.is_assigned = True
        self._parts(use, node.value)

    def _declaration(self, node: ast.VariableDeclaration) -> None:
        use = self._uses.types.get(node.type.key)
        for one in node.declarators:
            if one.value is not None:
                if use is not None:
                    use.record(self._type(one.value))
                self._parts(use, one.value)

    def _parts(self, use: DataUse | None, value: ast.Expression) -> None:
        """The parts of a structure that is written out."""
        if isinstance(value, ast.Aggregate):
            for part in value.components:
                inner = self._member(use, part.name)
                type_ = self._type(part.value)
                if inner is not None and isinstance(type_, Scalar | Constant | Text):
                    inner.record(type_)
                self._parts(inner, part.value)

    def _condition(self, node: ast.If | ast.InterruptDeclaration) -> None:
        self._expect(node.condition, BOOL)

    def _loop(self, node: ast.While | ast.Repeat) -> None:
        self._expect(node.condition, BOOL)
        self._exit(node.condition, is_true=isinstance(node, ast.Repeat))

    def _exit(self, node: ast.Expression, *, is_true: bool) -> None:
        """Record the value with which a condition ends a loop, for each variable in it."""
        match node:
            case ast.Parenthesised(inner=inner):
                self._exit(inner, is_true=is_true)
            case ast.Unary(operator="NOT", operand=operand):
                self._exit(operand, is_true=not is_true)
            case ast.Binary(operator="==" | "<>", left=left, right=ast.BoolLiteral(value=value)):
                self._exit(left, is_true=is_true == ((node.operator == "==") == value))
            case ast.Binary(operator="AND" | "OR"):
                for part in (*(one.right for one in left_chain(node)), left_chain(node)[0].left):
                    self._exit(part, is_true=is_true)
            case _:
                use = self._use(node)
                if use is not None:
                    use.left_by = is_true

    def _wait(self, node: ast.WaitFor) -> None:
        self._expect(node.condition, BOOL)
        for one in walk(node.condition):
            use = self._use(one) if isinstance(one, ast.Variable) else None
            if use is not None:
                use.is_waited_for = True

    def _pause(self, node: ast.WaitSeconds) -> None:
        self._expect(node.duration, REAL)

    def _for(self, node: ast.For) -> None:
        counter = self._use_of(node.counter)
        if counter is not None:
            counter.types.append(INT)
        for number in (node.first, node.last, node.step):
            if number is not None:
                self._expect(number, INT)
        ends = (self._largest(one) for one in (node.first, node.last))
        self._counted[node.counter.key] = max(self._counted.get(node.counter.key, 0), *ends)

    def _largest(self, number: ast.Expression | None) -> int:
        """Return the largest value of a number or of a loop counter; 0 if it is unknown."""
        match number:
            case ast.IntegerLiteral(value=value):
                return value
            case ast.Variable(name=name):
                return self._counted.get(name.key, 0)
        return 0

    def _return(self, node: ast.Return) -> None:
        if node.value is not None:
            self._has_type(node.value, self._written_result)
            self._expect(node.value, self._result)

    def _trigger(self, node: ast.Trigger) -> None:
        self._expect(node.place, REAL)
        self._expect(node.delay, REAL)

    def _unary(self, node: ast.Unary) -> None:
        if node.operator in ("NOT", "B_NOT"):
            self._expect(node.operand, BOOL if node.operator == "NOT" else INT)

    def _subscript(self, node: ast.Subscript) -> None:
        self._use(node)
        for index in node.indices:
            if index is not None:
                self._expect(index, INT)
                use = self._use(index)
                if use is not None:
                    use.is_index = True

    def _switch(self, node: ast.Switch) -> None:
        for branch in node.branches:
            for value in branch.values:
                self._unify(node.selector, value)
                self._compared(node.selector, value)
                use = self._use(node.selector)
                if use is not None:
                    use.cases.add(_number(value))
                elif (symbol := self._declared(node.selector)) and _number(value):
                    self._cases[symbol].append(_number(value))

    def _motion(self, node: ast.Motion) -> None:
        for point in (node.auxiliary, node.target):
            for use in self._targets(point):
                use.motions.add(node.kind)
        if node.angle is not None:
            self._expect(node.angle, REAL)

    def _targets(self, node: ast.Expression | None) -> Iterator[DataUse]:
        if isinstance(node, ast.Parenthesised):
            yield from self._targets(node.inner)
        elif isinstance(node, ast.Binary) and node.operator == ":":
            chain = left_chain(node)
            parts = *(each.right for each in reversed(chain)), chain[0].left
            yield from next(filter(None, ([*self._targets(part)] for part in parts)), ())
        elif node is not None:
            use = self._use(node)
            if use is not None:
                yield use

    def _binary(self, node: ast.Binary) -> None:
        if node.operator in _LOGICAL | _BITWISE:
            wanted = BOOL if node.operator in _LOGICAL else INT
            self._expect(node.left, wanted)
            self._expect(node.right, wanted)
        elif node.operator in _RELATIONS:
            self._unify(node.left, node.right)
            if node.operator in ("==", "<>"):
                self._compared(node.left, node.right)
                self._compared(node.right, node.left)
        elif node.operator == ":":
            frame = self._project.types.of(_system_type(self._project, "FRAME"))
            self._expect(node.left, frame)
            self._expect(node.right, frame)
        else:
            self._unify(node.left, node.right)

    def _compared(self, node: ast.Expression, value: ast.Expression) -> None:
        """Record that a value is compared with a number, which is therefore a possible value."""
        use = self._use(node)
        if use is not None:
            use.is_compared = True
            use.asked_for = use.asked_for or _number(value)

    def _call(self, node: ast.Call) -> None:
        is_value = node not in self._statements
        use = self._uses.routines.get(node.name.key)
        found = self._checked.resolution.found(node.name)
        if use is not None and self._is_undeclared(node.name):
            use.is_function = use.is_function or is_value
            for place, argument in enumerate(node.arguments):
                if place == len(use.arguments):
                    use.arguments.append(DataUse(is_assigned=True))
                if argument is not None:
                    type_ = self._type(argument)
                    if isinstance(argument, ast.Subscript) and argument.indices == (None,):
                        type_ = type_ if isinstance(type_, Array) else Array(CHAR, (None,))
                        self._expect(argument, type_)
                    given = use.arguments[place]
                    given.record(type_)
                    given.is_variable &= type_ != UNKNOWN and self._is_variable(argument)
                    if symbol := self._declared(argument):
                        self._passed[symbol].append(given)
        elif found is not None and isinstance(found.symbol, RoutineSymbol):
            for output in node.arguments[:1] if node.name.key == "PULSE" else ():
                pulsed = None if output is None else self._use(output)
                if pulsed is not None:
                    pulsed.is_pulsed = True
            for parameter, argument in zip(found.symbol.parameters, node.arguments, strict=False):
                if argument is not None:
                    self._has_type(argument, parameter.type)
                    self._expect(argument, self._project.types.of(Found(parameter, found.scope)))

    def _is_undeclared(self, name: ast.Name) -> bool:
        """Return whether no file declares a name at this place."""
        found = self._checked.resolution.found(name)
        if found is None or found.module is None or found.symbol.kind is Kind.EXTERNAL:
            return True
        if found.module.folder == FOLDER:
            return True
        is_listed = found.module.suffix == ".dat" and name.key in self._uses.data
        return is_listed and self._is_apart(self._checked.module, name.key)

    def _declared(self, node: ast.Expression) -> Symbol | None:
        """Return the variable that an expression is, if a file declares it."""
        if not isinstance(node, ast.Variable) or self._is_undeclared(node.name):
            return None
        found = self._checked.resolution.found(node.name)
        return found.symbol if found is not None and found.module is not None else None

    def _is_variable(self, node: ast.Expression) -> bool:
        """Return whether a call can change an expression; system variables are excluded."""
        root = root_variable(node)
        if root is None or root.name.text.startswith("$"):
            return False
        found = self._checked.resolution.found(root.name)
        return found is not None and found.module is not None and found.symbol.kind in _PLAIN

    # ------------------------------------------------------------------------- expressions

    def _use_of(self, name: ast.Name) -> DataUse | None:
        """Return the use of an undeclared variable, or of the undeclared type of a declared one."""
        if self._is_undeclared(name):
            module = self._checked.module
            if name.key in self._uses.data and self._is_apart(module, name.key):
                return self._uses.apart.setdefault((module.path, name.key), DataUse())
            return self._uses.data.get(name.key)
        return self._of_type(name)

    def _of_type(self, name: ast.Name) -> DataUse | None:
        """Return the use of the undeclared type of a declared variable, component or function."""
        found = self._checked.resolution.found(name)
        written = None if found is None else found.symbol.type
        return None if written is None else self._uses.types.get(written.key)

    def _member(self, use: DataUse | None, name: ast.Name) -> DataUse | None:
        """Return the use of a component, or of the undeclared type of a declared one."""
        return self._of_type(name) if use is None else use.member(name)

    def _use(self, node: ast.Expression) -> DataUse | None:
        """Return the use of the undeclared name, or part of one, in an expression."""
        match node:
            case ast.Variable(name=name):
                return self._use_of(name)
            case ast.Parenthesised(inner=inner):
                return self._use(inner)
            case ast.Call(name=name):
                if not self._is_undeclared(name):
                    return self._use_of(name)
                use = self._uses.routines.get(name.key)
                return None if use is None else use.result
            case ast.Member(base=base, name=name):
                return self._member(self._use(base), name)
            case ast.Subscript(base=base, indices=indices):
                array = self._use(base)
                if array is not None:
                    array.indices = max(array.indices, len(indices))
                    for place, index in enumerate(indices[:3]):
                        array.largest[place] = max(array.largest[place], self._largest(index))
                    array.is_text = array.is_text or indices[-1] is None
                return array
        return None

    def _type(self, node: ast.Expression) -> Type:
        match node:
            case ast.IntegerLiteral() | ast.BitLiteral():
                return INT
            case ast.RealLiteral():
                return REAL
            case ast.BoolLiteral():
                return BOOL
            case ast.StringLiteral(text=text):
                return Text(len(text))
            case ast.EnumConstant(name=name):
                return Constant(name.text)
            case ast.Binary(operator=operator) if operator in _RELATIONS | _LOGICAL:
                return BOOL
        found = self._checked.types.get(node, UNKNOWN)
        if found == UNKNOWN and isinstance(node, ast.Variable):
            symbol = self._checked.resolution.found(node.name)
            found = UNKNOWN if symbol is None else self._project.types.of(symbol)
        if found == UNKNOWN and isinstance(node, ast.Subscript):  # of data of a lost $config.dat
            array = self._type(node.base)
            found = array.element if isinstance(array, Array) else UNKNOWN
        return found

    def _has_type(self, node: ast.Expression, written: TypeReference | None) -> None:
        """Record that an expression has a type by name, which may be undeclared."""
        use = self._use(node)
        type_ = self._uses.types.get(written.key) if written is not None else None
        if type_ is not None:
            if use is not None:
                self._uses.same_type.append((use, type_))
            type_.record(self._type(node))

    def _unify(self, left: ast.Expression, right: ast.Expression) -> None:
        """Record that both sides have the same type; whole arrays do not occur here."""
        uses = self._use(left), self._use(right)
        if uses[0] is not None and uses[1] is not None:
            self._uses.same_type.append((uses[0], uses[1]))
        for node, other in ((left, right), (right, left)):
            type_ = self._type(other)
            if not isinstance(type_, Array) or type_.element == CHAR:
                self._expect(node, type_)

    def _expect(self, node: ast.Expression, type_: Type) -> None:
        """Record the type of an expression."""
        while isinstance(node, ast.Parenthesised):
            node = node.inner
        if isinstance(node, ast.Unary) and type_ != UNKNOWN:
            self._expect(node.operand, type_)
        use = self._use(node)
        if use is None or type_ == UNKNOWN:
            if type_ in (INT, REAL):
                self._expect_number(node, type_)
            return
        use.record(type_)

    def _expect_number(self, node: ast.Expression, type_: Type) -> None:
        """Record that the operands of a number are numbers; each long sum is visited only once."""
        operand = node
        while isinstance(operand, ast.Binary) and operand.operator in "+-*/":
            if (operand, type_) in self._numbers:
                return
            self._numbers.add((operand, type_))
            self._expect(operand.right, type_)
            operand = operand.left
        if operand is not node:
            self._expect(operand, type_)


def _number(node: ast.Expression) -> str:
    """Return a number as it is written; empty for other expressions."""
    match node:
        case ast.IntegerLiteral(value=value):
            return str(value)
        case ast.Unary(operator="-", operand=ast.IntegerLiteral(value=value)):
            return f"-{value}"
    return ""


_PLAIN = (Kind.VARIABLE, Kind.PARAMETER)

_RULES: Mapping[type[ast.Node], Callable[[_Reader, Any], object]] = {
    ast.Assignment: _Reader._assignment,
    ast.Binary: _Reader._binary,
    ast.Call: _Reader._call,
    ast.CallStatement: _Reader._statement,
    ast.For: _Reader._for,
    ast.If: _Reader._condition,
    ast.InterruptDeclaration: _Reader._condition,
    ast.Member: _Reader._use,
    ast.Motion: _Reader._motion,
    ast.Repeat: _Reader._loop,
    ast.Return: _Reader._return,
    ast.Subscript: _Reader._subscript,
    ast.Switch: _Reader._switch,
    ast.Trigger: _Reader._trigger,
    ast.Unary: _Reader._unary,
    ast.VariableDeclaration: _Reader._declaration,
    ast.WaitFor: _Reader._wait,
    ast.WaitSeconds: _Reader._pause,
    ast.While: _Reader._loop,
}


def _system_type(project: Project, name: str) -> Found:
    found = project.scope(project.modules[0]).find(Space.TYPE, name)
    assert isinstance(found, Found), "the type is predefined"
    return found
