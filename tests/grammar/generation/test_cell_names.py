"""Synthetic programs use only what is declared, and as it is declared.

This is no type checker: it looks up names, counts arguments and follows the order of statements.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import PurePosixPath

import pytest

from grammar.generation.cells import files
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Node, Token, Tree
from support.files.decode import Source, decode

# What KSS 8.6 lists as its own, as far as the programs use it [FCT-01, FCT-04, FCT-07, FCT-10];
# with the number of parameters. Channel calls take as many as their format asks for.
BUILT_IN: Mapping[str, int] = {
    **dict.fromkeys(("ABS", "SQRT", "SIN", "COS", "TAN", "STRLEN", "STRCLEAR", "VARSTATE"), 1),
    **dict.fromkeys(("EXISTS_KRLMSG", "ERR_CLEAR"), 1),
    **dict.fromkeys(("ATAN2", "STRADD", "EXISTS_KRLDLG", "COPEN", "CCLOSE"), 2),
    **dict.fromkeys(("STRCOMP", "PULSE"), 3),
    **dict.fromkeys(("STRFIND", "SET_KRLMSG", "SET_KRLDLG"), 4),
    **dict.fromkeys(("CREAD", "CWRITE", "SWRITE"), 99),
}
SYSTEM_TYPES = set(
    "CP CONT LOAD SER STATE_T MODUS_T IPO_MODE ORI_TYPE CIRC_TYPE EKRLMSGTYPE KRLMSG_T KRLMSGPAR_T"
    " KRLMSGDLGSK_T KRLMSGOPT_T FRAME POS E6POS AXIS E6AXIS".split()
)
SYSTEM = set(
    """
    $ACC $ACC_AXIS $ACC_MA $ACT_BASE $ACT_TOOL $ADVANCE $ANIN $ANOUT $APO $AXIS_ACT $BASE $BWDSTART
    $CIRC_TYPE $CYCFLAG $DIGIN1 $ERR $FLAG $IN $IPO_MODE $LOAD $MODE_OP $NULLFRAME $NUM_AX $ORI_TYPE
    $OUT $OV_PRO $POS_ACT $POS_INT $POWER_FAIL $PSER_2 $STOPMESS $TIMER $TIMER_FLAG $TIMER_STOP
    $TOOL $VEL $VEL_ACT $VEL_AXIS $VEL_MA $WORLD
    """.split()
)
INTERRUPTS = {1, 2, 3, *range(4, 40), *range(81, 129)}  # 3 is the system's own [INT-02]
DEFINITIONS = ("enumeration", "structure", "signal", "external", "importation")


@dataclass
class Names:
    """What can be named at a place: variables, types, and routines with their parameters."""

    variables: set[str] = field(default_factory=set)
    types: set[str] = field(default_factory=set)
    routines: dict[str, tuple[int, bool]] = field(default_factory=dict)


def named(node: Node) -> str:
    """The first name in a node."""
    return next(n for n in node.walk() if isinstance(n, Node) and n.rule == "name").text.upper()


def nodes(node: Node, *rules: str) -> Iterator[Node]:
    return (found for found in node.walk() if isinstance(found, Node) and found.rule in rules)


def has(node: Node, kind: str) -> bool:
    return any(isinstance(child, Token) and child.kind == kind for child in node.children)


def declare(names: Names, node: Node) -> None:
    """Take up what the declarations within a node declare."""
    members = {n.first for one in nodes(node, "structure") for n in nodes(one, "declarator")}
    for found in nodes(node, "declarator"):
        if found.first not in members:
            names.variables.add(named(found))
    for found in nodes(node, *DEFINITIONS):
        if found.rule in ("enumeration", "structure"):
            names.types.add(named(found))
        elif found.rule == "signal":
            names.variables.add(named(found))


def signature(routine: Node) -> tuple[str, int, bool]:
    """Name, number of parameters, and whether it is a function."""
    inner = next(nodes(routine, "procedure", "function"))
    name = next(c for c in inner.children if isinstance(c, Node) and c.rule == "name")
    count = sum(1 for _ in nodes(routine, "parameter"))
    return name.text.upper(), count, inner.rule == "function"


class Cell:
    """The names of the modules so far."""

    def __init__(self) -> None:
        self.shared = Names()
        self.data: dict[str, Names] = {}

    def _add_data(self, path: PurePosixPath, tree: Tree) -> None:
        local = self.data[path.stem.upper()] = Names()
        declare(local, tree.root)
        is_public = any(n for n in nodes(tree.root, "dataList") if has(n, "PUBLIC"))
        if path.stem.upper() == "$CONFIG":
            declare(self.shared, tree.root)
        for found in nodes(tree.root, "initialisation"):
            is_global = has(found, "GLOBAL") or any(
                has(one, "GLOBAL") for one in nodes(found, *DEFINITIONS)
            )
            assert is_public or not is_global, path
            if is_global:
                declare(self.shared, found)

    def problems(self, path: PurePosixPath, tree: Tree) -> Iterator[str]:
        """What is wrong with a module, the next of the cell."""
        if path.suffix.lower() == ".dat":
            self._add_data(path, tree)
            yield from self._unknown(tree.root, self._module(path), set())
            return
        module = self._module(path)
        routines = list(nodes(tree.root, "routine"))
        for number, routine in enumerate(routines):
            name, count, is_function = signature(routine)
            if number == 0 and name != path.stem.upper():
                yield f"{name} is no name for {path.name}"
            if name in module.routines and name != path.stem.upper():
                yield f"{name} is defined twice"
            module.routines[name] = (count, is_function)
            inner = next(nodes(routine, "procedure", "function"))
            if number == 0 or has(inner, "GLOBAL"):
                self.shared.routines[name] = (count, is_function)
        for routine in routines:
            yield from self._problems_of(routine, module)

    def _module(self, path: PurePosixPath) -> Names:
        """What is named in a module: the shared names, and those of its own data list."""
        module = Names(routines=dict(self.shared.routines))
        for names in (self.shared, self.data.get(path.stem.upper(), Names())):
            module.variables |= names.variables
            module.types |= names.types
        return module

    def _problems_of(self, routine: Node, module: Names) -> Iterator[str]:
        local = Names(set(module.variables), set(module.types), module.routines)
        declare(local, routine)
        local.variables |= {named(one) for one in nodes(routine, "parameter")}
        labels = {named(one) for one in nodes(routine, "label")}
        yield from self._unknown(routine, local, labels)
        _, _, is_function = signature(routine)
        for found in nodes(routine, "return"):
            if (len(found.children) == 2) is not is_function:
                yield f"{found.text} in {signature(routine)[0]}"
        began = False
        inner = next(nodes(routine, "procedure", "function"))
        for statement in inner.children:
            if isinstance(statement, Node) and statement.rule == "statement":
                first = statement.children[0]
                is_declaration = isinstance(first, Node) and first.rule == "declaration"
                if is_declaration and began:
                    yield f"late: {statement.text}"
                began |= not is_declaration
        yield from self._exits(inner, in_loop=False)

    def _exits(self, node: Node, *, in_loop: bool) -> Iterator[str]:
        for child in node.children:
            if isinstance(child, Node):
                if child.rule == "exit" and not in_loop:
                    yield "EXIT outside a loop"
                is_loop = child.rule in (
                    *("forStatement", "whileStatement", "repeatStatement", "loopStatement"),
                )
                yield from self._exits(child, in_loop=in_loop or is_loop)

    def _unknown(self, place: Node, names: Names, labels: set[str]) -> Iterator[str]:
        variables = names.variables | SYSTEM
        for found in nodes(place, "variable", "forStatement"):
            if named(found) not in variables:
                yield f"unknown variable {found.text.splitlines()[0]}"
        for found in nodes(place, "type"):
            is_named = isinstance(found.children[0], Node)
            if is_named and named(found) not in names.types | SYSTEM_TYPES:
                yield f"unknown type {found.text}"
        for found in nodes(place, "goto"):
            if named(found) not in labels:
                yield f"unknown label {found.text}"
        for found in nodes(place, "interrupt"):
            number = next(nodes(found, "expression")).text
            if not number.isdigit() or int(number) not in INTERRUPTS:
                yield f"number of {found.text}"
        for found in nodes(place, "call"):
            yield from self._call(found, names)

    def _call(self, call: Node, names: Names) -> Iterator[str]:
        name = named(call)
        if name not in names.routines and name not in BUILT_IN:
            yield f"unknown routine {call.text}"
            return
        expected = names.routines[name][0] if name in names.routines else BUILT_IN[name]
        (arguments,) = (
            one for one in call.children if isinstance(one, Node) and one.rule != "name"
        )
        commas = sum(1 for one in arguments.children if isinstance(one, Token))
        if arguments.children and commas + 1 > expected:
            yield f"too many arguments: {call.text}"


@pytest.fixture(scope="module")
def parser() -> Parser:
    return Parser(Recognizer(read_file(GRAMMAR)))


@pytest.mark.parametrize("number", [1, 2, 3])
def test_every_name_is_declared(parser: Parser, number: int) -> None:
    """Names are declared before they are used, calls fit, and statements stand where they may."""
    cell, found = Cell(), []
    for file in islice(files(seed=9, number=number), 36):
        source = decode(file.data)
        assert isinstance(source, Source)
        tree = parser.parse(source.text)
        assert isinstance(tree, Tree), file.path
        found += [f"{file.path}: {one}" for one in cell.problems(PurePosixPath(file.path), tree)]
    assert [] == found
