"""Values for data that a project declares and reads, but never sets.

A data list can declare a variable without a value, to be set at the panel, by a PLC, or in a file
that is missing. If any file of the project sets the variable in any way, it is left as it is, so a
read that comes too early is reported by the run. Otherwise every run would end at the first read;
on a controller, too, unless somebody has set the value from outside.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice, product
from typing import Final

from grammar.semantics.link import File, Project, extended
from grammar.semantics.scopes import Found, Module
from grammar.semantics.types import BOOL, UNKNOWN, Array, Type
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.references import Space
from grammar.syntax.source import Source, names_in_text
from grammar.syntax.walk import root_variable, walk

#: Makes a value, as it is written, of a type and for a name.
MakeValue = Callable[[Type, str], str]

_END: Final = re.compile(r"^[ \t]*ENDDAT\b", re.IGNORECASE | re.MULTILINE)
_MOST_ELEMENTS: Final = 64


@dataclass(frozen=True, slots=True)
class Unset:
    """A variable of a data list: its type, and whether a WAIT FOR waits until it is TRUE."""

    module: Module
    name: ast.Name
    type: Type
    is_waited_for: bool

    def lines(self, value: MakeValue) -> Iterator[str]:
        """Yield the lines of a data list that assign the value; none if its size is unknown."""
        name = self.name.text
        if not isinstance(self.type, Array):
            yield f"{name}={'TRUE' if self.is_waited_for else value(self.type, name)}"
            return
        sizes = [range(1, size + 1) for size in self.type.sizes if size is not None]
        if len(sizes) == len(self.type.sizes):
            for indices in islice(product(*sizes), _MOST_ELEMENTS):
                element = f"{name}[{','.join(map(str, indices))}]"
                yield f"{element}={value(self.type.element, element)}"


def unset_data(project: Project, sources: Mapping[str, Source]) -> tuple[Unset, ...]:
    """Return the variables in data lists that programs read and nothing sets."""
    open_: dict[str, list[tuple[Module, ast.Name]]] = {}
    for module in project.modules:
        for name in _without_value(module):
            open_.setdefault(name.key, []).append((module, name))
    set_: set[str] = set()
    read: set[str] = set()
    waited_for: set[str] = set()
    for module in project.modules:
        if module.syntax is None or isinstance(module.syntax.content, ast.DataList):
            continue
        if open_.keys().isdisjoint(names_in_text(sources[module.path].text)):
            continue
        for node in walk(module.syntax):
            set_ |= _set_by(node)
            if isinstance(node, ast.Variable):
                read.add(node.name.key)
            elif isinstance(node, ast.WaitFor) and isinstance(node.condition, ast.Variable):
                waited_for.add(node.condition.name.key)
    found = []
    for key, places in open_.items():
        for module, name in places if key in read - set_ else ():
            answer = project.scope(module).find(Space.VALUE, key)
            type_ = project.types.of(answer) if isinstance(answer, Found) else UNKNOWN
            if type_ != UNKNOWN:
                found.append(Unset(module, name, type_, type_ == BOOL and key in waited_for))
    return tuple(found)


def _without_value(module: Module) -> Iterator[ast.Name]:
    """Yield the variables of a data list that have no initial value."""
    if module.syntax is None or not isinstance(module.syntax.content, ast.DataList):
        return
    items = module.syntax.content.items
    set_ = {_root(one.target) for one in items if isinstance(one, ast.Assignment)}
    for item in items:
        if isinstance(item, ast.VariableDeclaration) and not item.is_constant:
            for one in item.declarators:
                if one.value is None and one.name.key not in set_ and one.name.text[0] != "$":
                    yield one.name


def _set_by(node: ast.Node) -> set[str]:
    """Return the variables that a statement may set, which for a call are all its arguments.

    A variable that only counts on from its own value does not count as set.
    """
    match node:
        case ast.Assignment(target=target, value=value):
            root = _root(target)
            names = {one.name.key for one in walk(value) if isinstance(one, ast.Variable)}
            return {root} - names
        case ast.For(counter=counter):
            return {counter.key}
        case ast.Call(arguments=arguments):
            return {_root(one) for one in arguments if one is not None}
    return set()


def _root(node: ast.Expression) -> str:
    root = root_variable(node)
    return root.name.key if root else ""


def with_values(
    project: Project, sources: Mapping[str, Source], unset: tuple[Unset, ...], value: MakeValue
) -> tuple[Project, tuple[Source, ...]]:
    """Return the project with values at the end of its data lists, and the new texts."""
    changed: dict[str, Source] = {}
    for one in unset:
        path = one.module.path
        text = changed.get(path, sources[path]).text
        ends = list(_END.finditer(text))
        place = ends[-1].start() if ends else len(text)
        more = "".join(f"{line}\n" for line in one.lines(value))
        changed[path] = Source(f"{text[:place]}{more}{text[place:]}", path)
    files = []
    for path, source in list(changed.items()):
        syntax = read_module(source.text, path)
        if isinstance(syntax, ast.Module):
            files.append(File(path, syntax))
        else:
            del changed[path]
    return extended(project, files), tuple(changed.values())
