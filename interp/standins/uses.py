"""Infers types of undeclared names from their uses.

``X=3.5`` implies that X is a number, ``WAIT FOR X`` that it is a truth value, ``PTP X`` that it is
a position, ``X[2].NR`` that it is an array of structures. `Uses` collects such facts over all files
of a project; it does not guess.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field
from typing import Any

from grammar.check.project.framework import Checked
from grammar.semantics.link import Project
from grammar.semantics.scopes import Found, Module
from grammar.semantics.symbols import Kind, RoutineSymbol, TypeReference
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    UNKNOWN,
    Aggregate,
    Array,
    Constant,
    Enumeration,
    Scalar,
    Structure,
    Text,
    Type,
)
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import left_chain, walk
from support.lazy_dataclass import dataclass

#: The folder of stand-ins in paths. No file of a backup has such a path.
FOLDER = "<stand-in>"

#: The largest depth of nested members that is examined.
_DEEPEST = 4

_LOGICAL = frozenset({"AND", "OR", "EXOR"})
_BITWISE = frozenset({"B_AND", "B_OR", "B_EXOR"})
_RELATIONS = frozenset({"==", "<>", "<", ">", "<=", ">="})


@dataclass(slots=True, eq=False)
class DataUse:
    """The uses of a variable, a member of a structure, or the result of a function.

    ``types`` are the types that it is assigned, compared or combined with, in the order of the
    text. ``constants`` are the enumeration constants among them. ``members`` are the uses of its
    members by name in upper case. ``motions`` are the kinds of the motions that go to it.
    ``indices`` is the largest number of indices in one use, 0 for a scalar, and ``largest`` the
    largest known index in each dimension. ``is_text``: it is used as a CHAR array.
    ``is_assigned``: an assignment sets it. ``is_waited_for``: a WAIT FOR reads it. ``is_pulsed``:
    PULSE sets it. ``left_by`` is its value that ends a loop. ``is_index``: it is an index of an
    array. ``is_part``: it is a member of a structure. ``is_compared``: it is compared with ``==``
    or ``<>``. ``asked_for`` is the first number that it is compared with, also by a SWITCH, and
    ``cases`` are all numbers that a SWITCH compares it with.
    """

    types: list[Type] = field(default_factory=list)
    members: dict[str, DataUse] = field(default_factory=dict)
    constants: dict[str, str] = field(default_factory=dict)
    motions: set[str] = field(default_factory=set)
    indices: int = 0
    largest: list[int] = field(default_factory=lambda: [0, 0, 0])
    is_text: bool = False
    is_assigned: bool = False
    is_waited_for: bool = False
    is_pulsed: bool = False
    left_by: bool | None = None
    is_index: bool = False
    is_part: bool = False
    is_compared: bool = False
    asked_for: str = ""
    cases: set[str] = field(default_factory=set)

    def member(self, name: ast.Name) -> DataUse:
        """Return the use of a member."""
        return self.members.setdefault(name.key, DataUse(is_part=True))


@dataclass(slots=True, eq=False)
class RoutineUse:
    """The result of a routine, and the arguments of its calls.

    ``arguments`` has an entry for each parameter: the type of each argument passed to it, and
    whether the argument is a variable that the routine may change.
    """

    result: DataUse = field(default_factory=DataUse)
    is_function: bool = False
    arguments: list[list[tuple[Type, bool]]] = field(default_factory=list)


class _TypeClasses:
    """Equivalence classes of uses that have the same type; a union-find structure.

    If two uses have the same type, so have their members of the same name.
    """

    def __init__(self) -> None:
        self._class: dict[int, list[DataUse]] = {}

    def members(self, use: DataUse) -> list[DataUse]:
        """Return the uses in the class of a use."""
        return self._class.setdefault(id(use), [use])

    def unite(self, one: DataUse, other: DataUse) -> None:
        """Merge the classes of two uses, and those of their members."""
        todo = [(one, other)]
        while todo:
            larger, smaller = sorted(map(self.members, todo.pop()), key=len, reverse=True)
            if larger is smaller:
                continue
            members = {name: use for each in larger for name, use in each.members.items()}
            for each in smaller:
                self._class[id(each)] = larger
                shared = each.members.keys() & members.keys()
                todo += [(members[name], each.members[name]) for name in sorted(shared)]
                members = {**each.members, **members}
            larger += smaller

    def collect(self, use: DataUse, depth: int = 0) -> None:
        """Add what is known of all uses in the class of a use to that use."""
        for other in self.members(use):
            use.constants.update(other.constants)
            use.types += [one for one in other.types if one not in use.types]
            use.is_compared |= other.is_compared
            use.is_text |= other.is_text
            for name, member in other.members.items() if depth < _DEEPEST else ():
                self.unite(use.members.setdefault(name, DataUse(is_part=True)), member)
        for member in use.members.values() if depth < _DEEPEST else ():
            self.collect(member, depth + 1)


class Uses:
    """Collects the uses of some undeclared names: ``data``, ``routines`` and ``types`` by name.

    ``is_apart`` says whether a file has a variable of its own by a name; ``apart`` are the uses of
    such variables by path and name.
    """

    def __init__(
        self,
        project: Project,
        data: Iterable[str],
        routines: Iterable[str],
        types: Iterable[str],
        is_apart: Callable[[Module, str], bool] = lambda _module, _name: False,
    ) -> None:
        self._project = project
        self.apart: dict[tuple[str, str], DataUse] = {}
        self._is_apart = is_apart
        self.types: Mapping[str, DataUse] = {name: DataUse() for name in types}
        self.data: Mapping[str, DataUse] = {name: DataUse() for name in data}
        self.routines: Mapping[str, RoutineUse] = {name: RoutineUse() for name in routines}
        self._checked: Checked | None = None
        self._result: Type = UNKNOWN
        self._written_result: TypeReference | None = None
        self._statements: set[ast.Call] = set()
        self._numbers: set[tuple[ast.Binary, Type]] = set()
        #: Pairs of uses of the same type, because one is assigned to or compared with the other.
        self._same_type: list[tuple[DataUse, DataUse]] = []
        #: The largest value of each loop counter of the current routine, by name in upper case.
        self._counted: dict[str, int] = {}

    def read(self, checked: Checked) -> None:
        """Collect the uses in one file."""
        syntax = checked.module.syntax
        assert syntax is not None, "only files that can be parsed are read"
        self._checked = checked
        if isinstance(syntax.content, ast.DataList):
            self._visit(syntax)
            return
        for routine in syntax.content.routines:
            found = checked.resolution.found(routine.name)
            self._result = UNKNOWN if found is None else self._project.types.of(found)
            self._written_result = None if found is None else found.symbol.type
            self._counted.clear()
            self._visit(routine)

    def settle(self) -> None:
        """Add the uses of all variables of a type to that type, once all files have been read."""
        classes = _TypeClasses()
        for one, other in self._same_type:
            classes.unite(one, other)
        for use in self.types.values():
            classes.collect(use)

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

    def _parts(self, use: DataUse, value: ast.Expression) -> None:
        """The parts of a structure that is written out."""
        if isinstance(value, ast.Aggregate):
            for part in value.components:
                inner = use.member(part.name)
                type_ = self._type(part.value)
                inner.types += [type_] if isinstance(type_, Scalar) else ()
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
        assert self._checked is not None, "a file is being read"
        use = self.routines.get(node.name.key)
        found = self._checked.resolution.found(node.name)
        if use is not None and self._is_undeclared(node.name):
            use.is_function = use.is_function or is_value
            for place, argument in enumerate(node.arguments):
                if place == len(use.arguments):
                    use.arguments.append([])
                if argument is not None:
                    type_ = self._type(argument)
                    if isinstance(argument, ast.Subscript) and argument.indices == (None,):
                        type_ = type_ if isinstance(type_, Array) else Array(CHAR, (None,))
                        self._expect(argument, type_)
                    use.arguments[place].append((type_, self._is_variable(argument)))
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
        assert self._checked is not None, "a file is being read"
        found = self._checked.resolution.found(name)
        if found is None or found.module is None or found.symbol.kind is Kind.EXTERNAL:
            return True
        if found.module.folder == FOLDER:
            return True
        is_listed = found.module.suffix == ".dat" and name.key in self.data
        return is_listed and self._is_apart(self._checked.module, name.key)

    def _is_variable(self, node: ast.Expression) -> bool:
        """Return whether a call can change an expression; system variables are excluded."""
        while isinstance(node, ast.Subscript | ast.Member):
            node = node.base
        if not isinstance(node, ast.Variable) or node.name.text.startswith("$"):
            return False
        assert self._checked is not None, "a file is being read"
        found = self._checked.resolution.found(node.name)
        return found is not None and found.module is not None and found.symbol.kind in _PLAIN

    # ------------------------------------------------------------------------- expressions

    def _use_of(self, name: ast.Name) -> DataUse | None:
        """Return the use of an undeclared variable, or of the undeclared type of a declared one."""
        assert self._checked is not None, "a file is being read"
        if self._is_undeclared(name):
            module = self._checked.module
            if name.key in self.data and self._is_apart(module, name.key):
                return self.apart.setdefault((module.path, name.key), DataUse())
            return self.data.get(name.key)
        found = self._checked.resolution.found(name)
        written = None if found is None else found.symbol.type
        return None if written is None else self.types.get(written.key)

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
                use = self.routines.get(name.key)
                return None if use is None else use.result
            case ast.Member(base=base, name=name):
                use_of_base = self._use(base)
                return None if use_of_base is None else use_of_base.member(name)
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
        assert self._checked is not None, "a file is being read"
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
        type_ = self.types.get(written.key) if written is not None else None
        if type_ is not None:
            if use is not None:
                self._same_type.append((use, type_))
            _record_type(type_, self._type(node))

    def _unify(self, left: ast.Expression, right: ast.Expression) -> None:
        """Record that both sides have the same type; whole arrays do not occur here."""
        uses = self._use(left), self._use(right)
        if uses[0] is not None and uses[1] is not None:
            self._same_type.append((uses[0], uses[1]))
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
        _record_type(use, type_)

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


def _record_type(use: DataUse, type_: Type) -> None:
    """Add a type to a use."""
    match type_:
        case Constant(name=name):
            use.constants.setdefault(name.upper(), name)
        case Text() | Array(element=Scalar(name="CHAR")):
            use.is_text = True
        case Array(element=element, sizes=sizes):
            use.indices = max(use.indices, len(sizes))
            use.types.append(element)
        case Aggregate(structure=structure, names=names):
            use.types += [structure] if structure is not None else ()
            for name in names:
                use.members.setdefault(name.upper(), DataUse())
        case Scalar() | Structure() | Enumeration():
            use.types.append(type_)


def _number(node: ast.Expression) -> str:
    """Return a number as it is written; empty for other expressions."""
    match node:
        case ast.IntegerLiteral(value=value):
            return str(value)
        case ast.Unary(operator="-", operand=ast.IntegerLiteral(value=value)):
            return f"-{value}"
    return ""


_PLAIN = (Kind.VARIABLE, Kind.PARAMETER)

_RULES: Mapping[type[ast.Node], Callable[[Uses, Any], object]] = {
    ast.Assignment: Uses._assignment,
    ast.Binary: Uses._binary,
    ast.Call: Uses._call,
    ast.CallStatement: Uses._statement,
    ast.For: Uses._for,
    ast.If: Uses._condition,
    ast.InterruptDeclaration: Uses._condition,
    ast.Member: Uses._use,
    ast.Motion: Uses._motion,
    ast.Repeat: Uses._loop,
    ast.Return: Uses._return,
    ast.Subscript: Uses._subscript,
    ast.Switch: Uses._switch,
    ast.Trigger: Uses._trigger,
    ast.Unary: Uses._unary,
    ast.WaitFor: Uses._wait,
    ast.WaitSeconds: Uses._pause,
    ast.While: Uses._loop,
}


def _system_type(project: Project, name: str) -> Found:
    found = project.scope(project.modules[0]).find(Space.TYPE, name)
    assert isinstance(found, Found), "the type is predefined"
    return found
