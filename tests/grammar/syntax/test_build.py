"""Every construct becomes the node that it is, where it stands, however deep it lies."""

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import pytest

from grammar.notation.edits import AddAlternative, AddRule, AddToken, Edit, apply
from grammar.notation.krl_grammar import krl_grammar
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from grammar.syntax import ast
from grammar.syntax.build import BLOCK_RULES, Builder, SyntaxFailure, builder, read_module
from grammar.syntax.node_plans import MAX_DEPTH, NoNode
from grammar.syntax.statement_rules import RULES
from grammar.syntax.unparse import expression
from grammar.syntax.walk import children, walk


def module_of(text: str) -> ast.Module:
    module = read_module(text)
    assert isinstance(module, ast.Module), module
    return module


def failures_of(text: str, path: str = "") -> list[SyntaxFailure]:
    found = read_module(text, path)
    assert isinstance(found, list)
    return found


def statements(*lines: str) -> tuple[ast.Statement, ...]:
    module = module_of("\n".join(["DEF MAIN()", *lines, "END", ""]))
    assert isinstance(module.content, ast.Program)
    return module.content.routines[0].body


# ------------------------------------------------------------------------------- statements


def test_called_routines() -> None:
    """A module knows what it calls, wherever it does, and not what it defines or announces."""
    text = """DEF A( )
    EXT E( )
    b(C(1), X[D( )])
    IF F( ) THEN
    TRIGGER WHEN DISTANCE=0 DELAY=0 DO g( ) PRIO=5
    ENDIF
    END
    DEF H( )
    END
    """
    assert frozenset("BCDFG") == module_of(text).called


# ------------------------------------------------------------------------------------ spans


def test_spans_hold_what_was_written() -> None:
    """The span of a node is its text: no blanks, comments or line ends around it."""
    text = " DEF A( ) ; one\n  IF B THEN ; two\n  X = - F(1 , C) ; three\n  ENDIF\n END ; four\n"
    module = module_of(text)
    texts = {type(node).__name__: text[slice(*node.span)] for node in walk(module)}
    assert text == texts["Module"]
    assert texts["Routine"] == texts["Program"] == text.strip().removesuffix(" ; four")
    assert "IF B THEN ; two\n  X = - F(1 , C) ; three\n  ENDIF" == texts["If"]
    assert "X = - F(1 , C)" == texts["Assignment"]
    assert "- F(1 , C)" == texts["Unary"]
    assert "F(1 , C)" == texts["Call"]
    assert "1" == texts["IntegerLiteral"]
    assert "C" == texts["Variable"]


def test_a_branch_ends_with_its_last_statement() -> None:
    """A branch of SWITCH reaches from CASE to the end of its last statement, or to its values."""
    text = "DEF A()\nSWITCH B\nCASE 1\nHALT\n\nCASE 2 ;\n\nENDSWITCH\nEND\n"
    branches = [node for node in walk(module_of(text)) if isinstance(node, ast.CaseBranch)]
    assert ["CASE 1\nHALT", "CASE 2"] == [text[slice(*branch.span)] for branch in branches]


def test_spans_nest(corpus: Mapping[Path, str]) -> None:
    """In every third own program nodes lie within their parents, one behind the other."""
    count = 0
    for path, text in list(corpus.items())[::3]:
        module = read_module(text) if "programs" in path.parts else []
        if isinstance(module, list):
            continue
        for node in walk(module):
            below = [child.span for child in children(node)]
            assert all(node.span[0] <= s < e <= node.span[1] for s, e in below), path
            assert all(before[1] <= after[0] for before, after in pairwise(below)), path
            if isinstance(node, ast.Name):
                assert text[slice(*node.span)].upper() == node.key
            count += 1
    assert count > 3_000


# -------------------------------------------------------------------------- what goes wrong


def test_every_rule_becomes_something(krl: Grammar) -> None:
    """Each parser rule is built within a line or over lines; others are but names of nodes."""
    rules = {rule.name for rule in krl.parser_rules}
    built = set(RULES) | BLOCK_RULES | {"eol"}
    names = {kind.__name__[0].lower() + kind.__name__[1:] for kind in ast.TEMPLATES}
    assert set() == rules - built
    assert set() == built - rules - names


def test_all_failures_are_reported() -> None:
    """A text with two syntax errors gives both: path, place, token and what could have come."""
    found = failures_of("DEF A()\nX=(1\nIF 2\nEND\n", "cell/a.src")
    assert [("cell/a.src", 2, 5, 12, "\n"), ("cell/a.src", 3, 5, 17, "\n")] == [
        (f.path, f.line, f.column, f.offset, f.text) for f in found
    ]
    assert [("primary", False), ("ifStatement", False)] == [(f.rule, f.follows) for f in found]
    assert ")" in found[0].expected
    assert "THEN" not in found[0].expected
    assert "THEN" in found[1].expected
    assert [None, None] == [f.reason for f in found]


@pytest.mark.parametrize(
    "line",
    [
        "X=" + "(" * 3_000 + "1" + ")" * 3_000,
        "X=1" + "+(1" * 201 + ")" * 201,
        "X=" + "NOT " * 300 + "A",
    ],
)
def test_too_deep_an_expression_is_a_failure(line: str) -> None:
    """What is nested deeper than the limit is refused with its line, not crashed on."""
    found = failures_of(f"DEF A()\nHALT\n{line}\nEND\n", "a.src")
    assert [("a.src", 3, f"nested more than {MAX_DEPTH} deep", ())] == [
        (f.path, f.line, f.reason, f.expected) for f in found
    ]


@pytest.mark.parametrize(
    ("edits", "line", "rule"),
    [
        ([AddAlternative("simpleStatement", "DWELL caseValue")], "DWELL 1", "simpleStatement"),
        ([AddAlternative("simpleStatement", "DWELL")], "DWELL", "simpleStatement"),
        ([AddAlternative("goto", "DWELL sum sum")], "DWELL 1 2", "goto"),
        (
            [
                AddRule("halt", "dwell\n    : DWELL eol statement* ENDLOOP\n    ;"),
                AddAlternative("statement", "dwell eol"),
            ],
            "DWELL\nHALT\nENDLOOP",
            "dwell",
        ),
    ],
)
def test_what_has_no_node_is_named(edits: list[Edit], line: str, rule: str) -> None:
    """A construct is in the grammar before its node is here: the rule and what to do are said."""
    wider = apply(krl_grammar(), [AddToken("DWELL"), *edits])
    with pytest.raises(NoNode, match=f"no node for a form of {rule} .*CONTRIBUTING.*step 6"):
        Builder(Recognizer(wider)).read(f"DEF A()\n{line}\nEND\n")


@pytest.mark.parametrize("operator", ["+", "*", "AND", "EXOR", "==", ":"])
def test_a_chain_of_operators_is_no_nesting(operator: str) -> None:
    """Thousands of operands of equal rank are built, and printed as they were written."""
    text = (operator if operator == ":" else f" {operator} ").join(["A"] * 2_000)
    (assignment,) = statements(f"X={text}")
    assert isinstance(assignment, ast.Assignment)
    assert 1_999 == sum(isinstance(node, ast.Binary) for node in walk(assignment))
    assert text == expression(assignment.value)


def test_blocks_nest_without_limit() -> None:
    """Five thousand nested blocks are built."""
    (outer,) = statements(*["IF A THEN"] * 5_000, "HALT", *["ENDIF"] * 5_000)
    assert 5_000 == sum(isinstance(node, ast.If) for node in walk(outer))


def test_a_number_of_any_length_is_read() -> None:
    """Digits by the thousand neither fail nor take long; they are more than any number fits."""
    numbers = [
        node for s in statements(f"X={'9' * 50_000}", f"X={'0' * 5_000}8") for node in walk(s)
    ]
    assert [10**1_000, 8] == [n.value for n in numbers if isinstance(n, ast.IntegerLiteral)]


def test_the_grammar_is_loaded_once() -> None:
    """All of a process share one builder, and lines that are alike share their plan."""
    reader = builder()
    assert reader is builder()
    reader.read("DEF A()\nQ.R[1]=S\nEND\n")
    known = len(reader._plans)
    reader.read("DEF B()\n" + "T.U[2]=V\n" * 9 + "END\n")
    assert known == len(reader._plans)
