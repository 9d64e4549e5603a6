"""Name resolution: `resolve` looks up all names of a file.

The answers are keyed by the identity of the `ast.Name` nodes: variables, calls, types, labels and
channels, whether used or declared, and members if the structure is known. Some names have no
answer, because they depend on a type that is not known here: enumeration constants, which their
target determines [TYP-16], components of an aggregate whose target only the type checker knows, and
members of the result of a function or an operator.

Linear in the size of the file and without recursion, so the depth of nesting has no limit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from grammar.semantics.link import Project
from grammar.semantics.scopes import Answer, Found, Module, NotFound, Reason, Scope, Undetermined
from grammar.semantics.symbols import Kind, TypeSymbol
from grammar.syntax import ast
from grammar.syntax.references import PLANS, Space
from support.lazy_dataclass import dataclass, node


@node
class Use:
    """A use of a name that has no declaration in the project, with the answer of the look-up.

    ``space`` is ``None`` for a member that a known structure does not have.
    """

    space: Space | None
    name: ast.Name
    module: Module
    answer: Answer


@dataclass(frozen=True, slots=True, eq=False)
class Resolution:
    """The answers for one file, and its uses of names without a declaration in the project.

    ``open_uses`` are in the order of the file. They include calls of routines that are only
    announced by EXT; their answer is `Found`, but nothing is known of what they do.
    ``unknown_members`` are components of structures that no file at hand declares.
    """

    module: Module
    answers: Mapping[ast.Name, Answer]
    open_uses: tuple[Use, ...]
    unknown_members: tuple[ast.Name, ...] = ()

    def found(self, name: ast.Name) -> Found | None:
        """Return the symbol that a name means, or ``None`` if it is not known."""
        answer = self.answers.get(name)
        return answer if isinstance(answer, Found) else None


def resolve(project: Project, module: Module) -> Resolution:
    """Return the answers for all names of a file; none if the file has no tree."""
    if module.syntax is None or module.table is None:
        return Resolution(module, {}, ())
    content, scope = module.syntax.content, project.scope(module)
    walk = _Walk()
    if isinstance(content, ast.DataList):
        walk.resolve(scope, content.items)
    else:
        for routine, table in zip(content.routines, module.table.routines, strict=True):
            inner = project.scope(module, table)
            walk.name(scope, routine.name, Space.ROUTINE)
            if routine.result:
                walk.resolve(scope, [routine.result])
            walk.resolve(inner, [*routine.parameters, *routine.body])
    uses = tuple(walk.open_uses(module))
    return Resolution(module, walk.answers, uses, tuple(walk.unknown_members))


class _Walk:
    """Looks up the names of one file."""

    def __init__(self) -> None:
        self.answers: dict[ast.Name, Answer] = {}
        self.unknown_members: list[ast.Name] = []
        self._open: list[tuple[Space | None, ast.Name]] = []
        self._known: dict[tuple[Scope, Space, str], Answer] = {}
        self._members: dict[Found, dict[str, Answer]] = {}

    def resolve(self, scope: Scope, nodes: Iterable[ast.Node]) -> None:
        """Look up all names below some nodes in a scope."""
        todo: list[ast.Node | None] = list(nodes)
        while todo:
            node = todo.pop()
            kind = type(node)
            plan = PLANS.get(kind)
            if plan is None:
                continue
            special = _SPECIAL.get(kind)
            if special is not None:
                special(self, scope, node, todo)
                continue
            use, below = plan
            if use is not None:
                name, space = getattr(node, use[0]), use[1]
                known = self.name(scope, name, space)
                if kind is ast.Call and type(known) is Found and known.symbol.kind is Kind.EXTERNAL:
                    self._open.append((space, name))
            for field in below:
                value = getattr(node, field)
                if type(value) is tuple:
                    todo.extend(value)
                else:
                    todo.append(value)

    def name(self, scope: Scope, name: ast.Name, space: Space) -> Answer:
        """Look up one name and record the answer."""
        place = scope, space, name.text
        answer = self._known.get(place)
        if answer is None:
            answer = self._known[place] = scope.find(space, name.text.upper())
        self.answers[name] = answer
        if type(answer) is not Found:
            self._open.append((space, name))
        return answer

    def open_uses(self, module: Module) -> Iterator[Use]:
        """Yield the uses without a declaration, in the order of the text."""
        for space, name in sorted(self._open, key=lambda use: use[1].span):
            yield Use(space, name, module, self.answers[name])

    # ------------------------------------------------------------------------ members

    def member(self, structure: Found, name: ast.Name) -> Answer:
        """Look up a member of a structure and record the answer."""
        assert isinstance(structure.symbol, TypeSymbol), "only types have members"
        known, key = self._members.setdefault(structure, {}), name.text.upper()
        answer = known.get(key)
        if answer is None:
            symbol = structure.symbol.members.get(key)
            lacking = Undetermined(Reason.SYSTEM) if structure.is_open else NotFound()
            answer = known[key] = Found(symbol, structure.scope) if symbol else lacking
        self.answers[name] = answer
        if type(answer) is not Found:
            self._open.append((None, name))
        return answer

    def chain(self, scope: Scope, node: ast.Node, todo: list[ast.Node | None]) -> Found | None:
        """Look up ``a.b[1].c``; returns the structure that is its type, or ``None``."""
        links: list[ast.Member | ast.Subscript] = []
        while isinstance(node, ast.Member | ast.Subscript):
            links.append(node)
            node = node.base
        answer: Answer | None = None
        if isinstance(node, ast.Variable):
            answer = self.name(scope, node.name, Space.VALUE)
        else:
            todo.append(node)
        structure = _structure(answer)
        for link in reversed(links):
            if isinstance(link, ast.Subscript):
                todo.extend(link.indices)
            elif structure is not None:
                structure = _structure(self.member(structure, link.name))
            else:
                self.unknown_members.append(link.name)
        return structure

    def aggregate(
        self,
        scope: Scope,
        node: ast.Aggregate,
        structure: Found | None,
        todo: list[ast.Node | None],
    ) -> None:
        """Look up the names in an aggregate whose value has this structure."""
        inner: list[tuple[ast.Aggregate, Found | None]] = [(node, structure)]
        while inner:
            node, structure = inner.pop()
            if node.type is not None:
                structure = _as_structure(self.name(scope, node.type, Space.TYPE))
            for component in node.components:
                answer = self.member(structure, component.name) if structure else None
                if answer is None:
                    self.unknown_members.append(component.name)
                if component.indices:
                    todo.extend(component.indices)
                if isinstance(component.value, ast.Aggregate):
                    inner.append((component.value, _structure(answer)))
                else:
                    todo.append(component.value)


def _structure(answer: Answer | None) -> Found | None:
    """Return the structure that is the type of a variable, a member or a function's result."""
    return _as_structure(answer.type_symbol()) if isinstance(answer, Found) else None


def _as_structure(answer: Answer | None) -> Found | None:
    if isinstance(answer, Found) and answer.symbol.kind is Kind.STRUCTURE:
        return answer
    return None


# ---------------------------------------------------------------- nodes that need more than a plan

_Special = Callable[[_Walk, Scope, Any, list[ast.Node | None]], object]


def _assignment(
    walk: _Walk, scope: Scope, node: ast.Assignment, todo: list[ast.Node | None]
) -> None:
    structure = walk.chain(scope, node.target, todo)
    if isinstance(node.value, ast.Aggregate):
        walk.aggregate(scope, node.value, structure, todo)
    else:
        todo.append(node.value)


def _declaration(
    walk: _Walk, scope: Scope, node: ast.VariableDeclaration, todo: list[ast.Node | None]
) -> None:
    structure = _as_structure(walk.name(scope, node.type, Space.TYPE))
    for declarator in node.declarators:
        walk.name(scope, declarator.name, Space.VALUE)
        todo.extend(declarator.indices or ())
        if isinstance(declarator.value, ast.Aggregate):
            walk.aggregate(scope, declarator.value, structure, todo)
        else:
            todo.append(declarator.value)


def _importation(
    walk: _Walk, scope: Scope, node: ast.Importation, todo: list[ast.Node | None]
) -> None:
    walk.name(scope, node.type, Space.TYPE)
    walk.name(scope, node.declarator.name, Space.VALUE)
    todo.extend(node.declarator.indices or ())


_SPECIAL: dict[type[Any], _Special] = {
    ast.Aggregate: lambda walk, scope, node, todo: walk.aggregate(scope, node, None, todo),
    ast.Assignment: _assignment,
    ast.Importation: _importation,
    ast.Member: _Walk.chain,
    ast.VariableDeclaration: _declaration,
}
