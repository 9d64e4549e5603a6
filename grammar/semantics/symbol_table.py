"""Building the symbol table of one file: from its tree to its `ModuleTable`.

Linear in the size of the file and without recursion. No content of a file is an error here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain

from grammar.semantics.predefined import System
from grammar.semantics.symbols import (
    Access,
    Duplicate,
    ImportSymbol,
    Kind,
    ModuleTable,
    ParameterSymbol,
    RoutineSymbol,
    RoutineTable,
    SignalSymbol,
    Symbol,
    Table,
    TypeReference,
    TypeSymbol,
)
from grammar.semantics.types import UNKNOWN, Array
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import BODIES, bodies

#: Machine data that are upper limits of what programs set; their values are stored.
MAXIMA = frozenset({"$VEL_MA", "$ACC_MA"})


def table_of(module: ast.Module) -> ModuleTable:
    """Return the symbol tables of one file."""
    content = module.content
    if isinstance(content, ast.DataList):
        scope = _Scope(_access_in(content), is_system=_is_system(content))
        for item in content.items:
            if not isinstance(item, ast.Assignment):
                scope.declare(item)
        name, is_public = content.name, content.is_public
        return ModuleTable(name.text, name.span, True, is_public, scope.table(), (), frozenset())
    scope = _Scope({True: Access.GLOBAL, False: Access.MODULE})
    routines = []
    for index, routine in enumerate(content.routines):
        inner = _routine_table(routine, is_main=index == 0)
        scope.add(Space.ROUTINE, inner.routine)
        routines.append(inner)
    name = content.routines[0].name
    own, calls = scope.table(), module.called
    return ModuleTable(name.text, name.span, False, False, own, tuple(routines), calls)


def _access_in(content: ast.DataList) -> Mapping[bool, Access]:
    """Return the visibility of a data list's declarations, with GLOBAL and without it."""
    if _is_system(content):
        return {True: Access.GLOBAL, False: Access.GLOBAL}
    return {True: Access.GLOBAL if content.is_public else Access.MODULE, False: Access.MODULE}


def _is_system(content: ast.DataList) -> bool:
    return content.name.text.startswith("$")


def _routine_table(routine: ast.Routine, is_main: bool) -> RoutineTable:
    scope = _Scope({True: Access.ROUTINE, False: Access.ROUTINE})
    declarations: list[ast.VariableDeclaration] = []
    for node in _declared_in(routine.body):
        if isinstance(node, ast.VariableDeclaration):
            declarations.append(node)
        elif isinstance(node, ast.Label):
            scope.name(Space.LABEL, Kind.LABEL, node.name)
        else:
            scope.declare(node)
    parameters = _parameters(routine, declarations)
    for parameter in parameters:
        scope.add(Space.VALUE, parameter)
    awaited = {parameter.key for parameter in parameters}
    for declaration in declarations:
        for declarator in declaration.declarators:
            if declarator.name.key in awaited:  # declares the type of a parameter
                awaited.remove(declarator.name.key)
            else:
                scope.variable(declaration, declarator)
    access = Access.GLOBAL if is_main or routine.is_global else Access.MODULE
    result = routine.result
    symbol = RoutineSymbol(
        Kind.ROUTINE,
        routine.name.text,
        routine.name.span,
        access,
        TypeReference(result.name.text, result.indices) if result else None,
        parameters=parameters,
    )
    return RoutineTable(symbol, scope.table())


def _declared_in(
    body: tuple[ast.Statement, ...],
) -> Iterator[ast.Definition | ast.Label]:
    """Yield the declarations and labels of a routine in order, also misplaced ones in blocks."""
    todo = [iter(body)]
    while todo:
        for statement in todo[-1]:
            if isinstance(statement, _DECLARING):
                yield statement
            elif type(statement) in BODIES:
                todo.append(chain.from_iterable(bodies(statement)))
                break
        else:
            todo.pop()


_DECLARING = (
    ast.VariableDeclaration,
    ast.Label,
    ast.Signal,
    ast.External,
    ast.Enumeration,
    ast.Structure,
    ast.ChannelDefinition,
    ast.Importation,
)


def _parameters(
    routine: ast.Routine, declarations: list[ast.VariableDeclaration]
) -> tuple[ParameterSymbol, ...]:
    """Return the parameters of a routine, with the types declared for them in its body."""
    types: dict[str, TypeReference] = {}
    if routine.parameters:
        for declaration in declarations:
            for declarator in declaration.declarators:
                written = TypeReference(declaration.type.text, declarator.indices)
                types.setdefault(declarator.name.key, written)
    found = []
    for parameter in routine.parameters:
        written_type = types.get(parameter.name.key)
        if written_type and written_type.indices is None and parameter.indices is not None:
            written_type = replace(written_type, indices=parameter.indices)
        found.append(
            ParameterSymbol(
                Kind.PARAMETER,
                parameter.name.text,
                parameter.name.span,
                Access.ROUTINE,
                written_type,
                mode=parameter.mode or "OUT",
            )
        )
    return tuple(found)


class _Scope:
    """Collects the symbols of one table; ``access`` is the visibility with GLOBAL and without.

    Only the controller's own data lists (``is_system``) declare its system variables, and none
    makes a signal of an array such as $OUT. Any other declaration of one changes nothing.
    """

    def __init__(self, access: Mapping[bool, Access], *, is_system: bool = False) -> None:
        self._access = access
        self._is_system = is_system
        self._spaces: dict[Space, dict[str, Symbol]] = {space: {} for space in Space}
        self._duplicates: list[Duplicate] = []

    def table(self) -> Table:
        return Table(self._spaces, tuple(self._duplicates))

    def add(self, space: Space, symbol: Symbol) -> None:
        if not (space is Space.VALUE and symbol.name[0] == "$" and self._is_fixed(symbol)):
            self._put(self._spaces[space], symbol)

    def _is_fixed(self, symbol: Symbol) -> bool:
        """Return whether this is a system variable that cannot be declared here like that."""
        known = System.load().variables.get(symbol.key)
        if known is None or known.type == UNKNOWN:  # a stand-in may tell the type
            return False
        return not self._is_system or (symbol.kind is Kind.SIGNAL and isinstance(known.type, Array))

    def _put(self, names: dict[str, Symbol], symbol: Symbol) -> None:
        first = names.setdefault(symbol.key, symbol)
        if first is not symbol:
            self._duplicates.append(Duplicate(first, symbol))

    def name(self, space: Space, kind: Kind, name: ast.Name) -> None:
        """Add a symbol that has only a name."""
        self.add(space, Symbol(kind, name.text, name.span, self._access[False]))

    def variable(self, declaration: ast.VariableDeclaration, declarator: ast.Declarator) -> None:
        is_constant, name = declaration.is_constant, declarator.name
        is_kept = is_constant or name.key in MAXIMA
        self.add(
            Space.VALUE,
            Symbol(
                Kind.CONSTANT if is_constant else Kind.VARIABLE,
                name.text,
                name.span,
                self._access[declaration.is_global],
                TypeReference(declaration.type.text, declarator.indices),
                declarator.value if is_kept else None,
            ),
        )

    def declare(self, node: ast.Definition) -> None:
        """Add the symbols that a declaration introduces."""
        if isinstance(node, ast.VariableDeclaration):
            for declarator in node.declarators:
                self.variable(node, declarator)
        elif isinstance(node, ast.Enumeration):
            self._enumeration(node)
        elif isinstance(node, ast.Structure):
            self._structure(node)
        elif isinstance(node, ast.Signal):
            self._signal(node)
        elif isinstance(node, ast.External):
            self._external(node)
        elif isinstance(node, ast.ChannelDefinition):
            self.name(Space.CHANNEL, Kind.CHANNEL, node.name)
        else:
            self._import(node)

    def _enumeration(self, node: ast.Enumeration) -> None:
        access, constants = self._access[node.is_global], dict[str, Symbol]()
        for name in node.constants:
            constant = Symbol(Kind.ENUM_CONSTANT, name.text, name.span, access)
            self._put(constants, constant)
        self._type(Kind.ENUMERATION, node.name, access, constants)

    def _structure(self, node: ast.Structure) -> None:
        access, members = self._access[node.is_global], dict[str, Symbol]()
        for group in node.groups:
            for declarator in group.declarators:
                written = TypeReference(group.type.text, declarator.indices)
                name = declarator.name
                self._put(members, Symbol(Kind.MEMBER, name.text, name.span, access, written))
        self._type(Kind.STRUCTURE, node.name, access, members)

    def _type(
        self, kind: Kind, name: ast.Name, access: Access, members: Mapping[str, Symbol]
    ) -> None:
        self.add(Space.TYPE, TypeSymbol(kind, name.text, name.span, access, members=members))

    def _signal(self, node: ast.Signal) -> None:
        name, access = node.name, self._access[node.is_global]
        self.add(
            Space.VALUE,
            SignalSymbol(
                Kind.SIGNAL, name.text, name.span, access, first=node.first, last=node.last
            ),
        )

    def _external(self, node: ast.External) -> None:
        access = self._access[False]
        parameters = tuple(
            ParameterSymbol(
                Kind.PARAMETER,
                parameter.name.text if parameter.name else "",
                (parameter.name or parameter).span,
                Access.ROUTINE,
                TypeReference(parameter.type.text, parameter.indices),
                mode=parameter.mode or "OUT",
            )
            for parameter in node.parameters
        )
        result = TypeReference(node.result.name.text, node.result.indices) if node.result else None
        kind = Kind.EXTERNAL if node.keyword in {"EXT", "EXTFCT"} else Kind.ROUTINE
        name = node.name
        self.add(
            Space.ROUTINE,
            RoutineSymbol(kind, name.text, name.span, access, result, parameters=parameters),
        )

    def _import(self, node: ast.Importation) -> None:
        name = node.declarator.name
        self.add(
            Space.VALUE,
            ImportSymbol(
                Kind.IMPORT,
                name.text,
                name.span,
                self._access[False],
                TypeReference(node.type.text, node.declarator.indices),
                module=node.path[-1].key,
                source=node.source,
            ),
        )
