"""Every node of the syntax tree has a rule in each table that needs one.

A statement without a rule is a no-op for the executors, so nothing else would show it: add a node,
and these tests name the tables that lack it.
"""

from collections.abc import Callable, Iterator
from typing import Any, get_args, get_type_hints

import pytest

from grammar.check.types import expressions
from grammar.generation.programs import seeded
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.sentences import Sentences, Speller
from grammar.syntax import ast, unparse
from grammar.syntax.build import read_module
from grammar.syntax.walk import walk
from interp.bytecode.compiler import expressions as compiled_expressions
from interp.bytecode.compiler import statements as compiled_statements
from interp.tree import expressions as tree_expressions
from interp.tree import statements as tree_statements

Kinds = set[type[Any]]

NODES: Kinds = {
    one
    for one in vars(ast).values()
    if isinstance(one, type) and issubclass(one, ast.Node) and one is not ast.Node
}
EXPRESSIONS: Kinds = set(get_args(ast.Expression))
DEFINITIONS: Kinds = set(get_args(ast.Definition))
#: What is executed where it stands; a label is where others go.
EXECUTED: Kinds = set(get_args(ast.Statement)) - DEFINITIONS - {ast.Label}
#: These are places, and have a value as such.
PLACES: Kinds = {ast.Variable, ast.Subscript, ast.Member}


def members(hint: Any) -> Iterator[type[Any]]:
    """All classes that an annotation names."""
    if isinstance(hint, type) and not get_args(hint):
        yield hint
    for argument in get_args(hint):
        yield from members(argument)


def fields_of(kind: type[Any]) -> Kinds:
    """The classes of what a node holds."""
    return {one for hint in get_type_hints(kind, vars(ast)).values() for one in members(hint)}


def reached() -> Kinds:
    """All nodes that may lie in a module."""
    found: Kinds = set()
    todo: list[type[Any]] = [ast.Module]
    while todo:
        kind = todo.pop()
        if kind not in found:
            found.add(kind)
            todo += fields_of(kind) & NODES
    return found


def built() -> Kinds:
    """All nodes that the shortest programs through each part of the grammar are built of."""
    grammar = read_file(GRAMMAR)
    sentences, speller = Sentences(grammar), Speller(grammar)
    return {
        type(node)
        for rule in sentences.reachable
        for tokens in sentences.through(rule)
        for module in [read_module(speller.text(tokens))]
        if isinstance(module, ast.Module)
        for node in walk(module)
    }


def generated() -> Kinds:
    """The nodes of some hundred generated programs, or of fewer that have all."""
    found: Kinds = set()
    for number in range(150):
        for path, text in seeded(1, number).files:
            module = read_module(text, path)
            assert isinstance(module, ast.Module), text
            found |= {type(node) for node in walk(module)}
        if found >= EXECUTED | EXPRESSIONS | DEFINITIONS:
            break
    return found


#: What needs a rule in a table, and what has one.
TABLES: dict[str, tuple[Kinds, Callable[[], Kinds]]] = {
    "the unions and fields of grammar.syntax.ast": (NODES, reached),
    "the rules of grammar.syntax, or the grammar": (NODES, built),
    "the templates of grammar.syntax.ast": (
        NODES - {ast.Module},
        lambda: {*ast.TEMPLATES, *unparse._PRINTERS},
    ),
    "grammar.check.types.expressions": (EXPRESSIONS, lambda: {*expressions._RULES}),
    "interp.tree.statements": (EXECUTED, lambda: {*tree_statements._RULES}),
    "interp.tree.expressions": (EXPRESSIONS, lambda: {*tree_expressions._VALUES, *PLACES}),
    "interp.bytecode.compiler.statements": (EXECUTED, lambda: {*compiled_statements._RULES}),
    "interp.bytecode.compiler.expressions": (
        EXPRESSIONS,
        lambda: {*compiled_expressions._VALUES, *PLACES},
    ),
    "grammar.generation": (EXECUTED | EXPRESSIONS | DEFINITIONS, generated),
}


@pytest.mark.parametrize("table", TABLES)
def test_every_node_has_a_rule(table: str) -> None:
    """What a table lacks is named."""
    wanted, present = TABLES[table]
    assert [] == sorted(kind.__name__ for kind in wanted - present())
