"""Laws about the text of a program: folds, letter case, names, order of declarations."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from random import Random
from typing import Final

from conformance.metamorphic.comparison import Compare, same_trace, same_trace_renamed
from conformance.metamorphic.law import Law
from conformance.metamorphic.subject import Program
from conformance.metamorphic.tree_rewriting import (
    MADE,
    calls_of,
    name,
    names_of,
    rewritten,
    routines,
    with_routines,
)
from grammar.syntax import ast
from grammar.syntax.walk import walk

_TEXTS_AND_COMMENTS: Final = re.compile(r'"[^"\n]*"|;[^\n]*|&[^\n]*')


#: Statements about the line that follows them in the text [ADV-08, FCT-12].
_ABOUT_NEXT_LINE: Final = ("CONTINUE", "ON_ERROR_PROCEED")
_OPENING: Final = ("DEF", "DEFFCT", "GLOBAL", *_ABOUT_NEXT_LINE)


def _folded(program: Program, random: Random) -> Program | None:
    """Add comments and folds around statements, but not behind what is about the next line."""
    texts = {}
    for source in program.case.sources:
        if source.kind != "src":
            continue
        lines: list[str] = []
        is_bound = False
        for line in source.text.splitlines():
            is_inside = bool(lines) and not is_bound and not _opens(line)
            if is_inside and random.random() < 0.4:
                lines += [";FOLD made;%{PE}%R", line, ";ENDFOLD (made)", "", "; a remark"]
            else:
                lines.append(line)
            is_bound = any(word in line.upper().partition(";")[0] for word in _ABOUT_NEXT_LINE)
        texts[source.path] = "\n".join(lines) + "\n"
    return program.with_texts(texts) if texts else None


def _opens(line: str) -> bool:
    words = line.upper().split()
    return not words or words[0] in _OPENING or line.startswith("&")


def _other_case(program: Program, random: Random) -> Program | None:
    """Change the case of letters at random, outside of texts and comments."""
    if _prints_names(program):
        return None

    def mixed(text: str) -> str:
        return "".join(
            letter.upper() if random.random() < 0.5 else letter.lower() for letter in text
        )

    texts = {}
    for source in program.case.sources:
        pieces: list[str] = []
        end = 0
        for found in _TEXTS_AND_COMMENTS.finditer(source.text):
            pieces += [mixed(source.text[end : found.start()]), found.group()]
            end = found.end()
        texts[source.path] = "".join([*pieces, mixed(source.text[end:])])
    return program.with_texts(texts)


def _prints_names(program: Program) -> bool:
    """Return whether a program formats texts, which may contain case-sensitive constants."""
    return any(
        {"SWRITE", "CWRITE", "SREAD", "CREAD"} & calls_of(module)
        for module in (program.modules or {}).values()
    )


# ------------------------------------------------------------------------------------ names


def _renamed(program: Program, _random: Random) -> tuple[Program, Compare] | None:
    """Rename the variables that a routine declares."""
    modules = program.modules or {}
    taken = {one for module in modules.values() for one in names_of(module)}
    texts = {
        one.text.upper()
        for module in modules.values()
        for one in walk(module)
        if isinstance(one, ast.StringLiteral)
    }
    old: dict[str, str] = {}
    changed = {}
    for path, module in modules.items():
        found = []
        for routine in routines(module):
            own = [one for one in _locals(routine) if one not in texts]
            new = {}
            for key in own:
                made = next(f"Z{n}_" for n in range(10_000) if f"Z{n}_" not in taken)
                taken.add(made)
                new[key], old[made] = made, key
            found.append(_with_names(routine, new))
        changed[path] = with_routines(module, found) if found else module
    return (program.written(changed), same_trace_renamed(old)) if old else None


def _locals(routine: ast.Routine) -> list[str]:
    parameters = {one.name.key for one in routine.parameters}
    return [
        declarator.name.key
        for one in routine.body
        if isinstance(one, ast.VariableDeclaration)
        for declarator in one.declarators
        if declarator.name.key not in parameters
    ]


def _with_names(routine: ast.Routine, names: dict[str, str]) -> ast.Routine:
    """Rename variables in a routine; members and enumeration constants keep their names."""

    def declared(node: ast.Declarator) -> ast.Declarator:
        return replace(node, name=name(names.get(node.name.key, node.name.text)))

    def change(node: ast.Node) -> ast.Node:
        if isinstance(node, ast.Variable) and node.name.key in names:
            return replace(node, name=name(names[node.name.key]))
        if isinstance(node, ast.VariableDeclaration):
            return replace(node, declarators=tuple(map(declared, node.declarators)))
        if isinstance(node, ast.For) and node.counter.key in names:
            return replace(node, counter=name(names[node.counter.key]))
        return node

    return rewritten(routine, change)


# ------------------------------------------------------------------------------------ declarations


def _reordered(program: Program, _random: Random) -> Program | None:
    """Reverse the order of adjacent declarations of plain variables."""

    def change(node: ast.Node) -> ast.Node:
        if not isinstance(node, ast.Routine):
            return node
        body: list[ast.Statement] = []
        for is_declaration, group in groupby(node.body, _is_plain):
            found = list(group)
            body += reversed(found) if is_declaration else found
        is_same = all(a is b for a, b in zip(body, node.body, strict=True))
        return node if is_same else replace(node, body=tuple(body))

    return program.rewritten(lambda _routine: change)


def _is_plain(node: ast.Statement) -> bool:
    return isinstance(node, ast.VariableDeclaration) and not node.is_constant


def _routines_moved(program: Program, random: Random) -> Program | None:
    """Change the order of all routines but the first, which gives the file its name."""
    changed, is_other = {}, False
    for path, module in (program.modules or {}).items():
        others = list(routines(module)[1:])
        if len(others) < 2:
            changed[path] = module
            continue
        moved = [*others[1:], others[0]] if random.random() < 0.5 else others[::-1]
        changed[path], is_other = with_routines(module, (routines(module)[0], *moved)), True
    return program.written(changed) if is_other else None


def _components_moved(program: Program, _random: Random) -> Program | None:
    """Reverse the components of aggregates of constants."""
    count = 0

    def change(node: ast.Node) -> ast.Node:
        nonlocal count
        if not isinstance(node, ast.Aggregate) or len(node.components) < 2:
            return node
        keys = [one.name.key for one in node.components]
        if len(set(keys)) < len(keys) or any(_computes(one) for one in node.components):
            return node
        count += 1
        return replace(node, span=MADE, components=node.components[::-1])

    changed = {path: rewritten(one, change) for path, one in (program.modules or {}).items()}
    return program.written(changed) if count else None


def _computes(node: ast.Node) -> bool:
    return any(isinstance(one, ast.Call | ast.Subscript | ast.Variable) for one in walk(node))


LAWS: Final[Sequence[Law]] = (
    Law(
        "folding",
        "folds, comments and blank lines mean nothing to a program",
        ("ADV-08",),
        same_trace,
        _folded,
        is_of_text=True,
    ),
    Law(
        "letter case",
        "names and keywords may be written in any letter case",
        ("TYP-05",),
        same_trace,
        _other_case,
    ),
    Law(
        "names of local variables",
        "it does not matter what a local variable is called",
        ("TYP-05", "SCO-03"),
        same_trace,
        _renamed,
    ),
    Law(
        "order of declarations",
        "declarations that do not need one another may change places",
        ("TYP-06",),
        same_trace,
        _reordered,
    ),
    Law(
        "order of routines",
        "routines behind the first one may change places",
        ("SCO-01",),
        same_trace,
        _routines_moved,
    ),
    Law(
        "order of components",
        "the components of an aggregate are distinguished by their names",
        ("TYP-19",),
        same_trace,
        _components_moved,
    ),
)
