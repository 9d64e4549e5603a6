"""The ways through a routine, as a graph."""

import pytest

from grammar.check.analysis.control_flow_graph import FlowGraph, FlowNode, flow_graph
from grammar.syntax import ast
from grammar.syntax.build import read_module


def ways(*lines: str, is_exhaustive: bool = False) -> FlowGraph:
    module = read_module("\n".join(["DEF A()", *lines, "END", ""]))
    assert isinstance(module, ast.Module)
    assert isinstance(module.content, ast.Program)
    return flow_graph(module.content.routines[0], lambda _: is_exhaustive)


def shape(found: FlowGraph) -> dict[str, list[str]]:
    """What can come after each place, statements by their kinds, meeting places left out."""

    def name(step: FlowNode) -> str:
        kind = type(step.statement).__name__
        return f"{kind} test" if step.is_test else kind

    def after(step: FlowNode) -> list[str]:
        names: list[str] = []
        for following in found.after[step]:
            if following is found.end:
                names.append("end")
            elif following.statement is None:
                names += after(following)
            else:
                names.append(name(following))
        return sorted(names)

    return {name(step): after(step) for step in found.reached() if step.statement is not None}


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (("HALT",), {"Halt": ["end"]}),
        (("RETURN", "HALT"), {"Return": []}),
        (
            ("IF $IN[1] THEN", "HALT", "ENDIF"),
            {"If": ["Halt", "end"], "Halt": ["end"]},
        ),
        (
            ("IF $IN[1] THEN", "HALT", "ELSE", "CONTINUE", "ENDIF"),
            {"If": ["Continue", "Halt"], "Halt": ["end"], "Continue": ["end"]},
        ),
        (("LOOP", "HALT", "ENDLOOP"), {"Loop": ["Halt"], "Halt": ["Loop"]}),
        (("LOOP", "EXIT", "ENDLOOP"), {"Loop": ["Exit"], "Exit": ["end"]}),
        (
            ("WHILE $IN[1]", "HALT", "ENDWHILE"),
            {"While": ["Halt", "end"], "Halt": ["While"]},
        ),
        (("WHILE (TRUE)", "HALT", "ENDWHILE"), {"While": ["Halt"], "Halt": ["While"]}),
        (
            ("REPEAT", "HALT", "UNTIL $IN[1]"),
            {"Repeat": ["Halt"], "Halt": ["Repeat test"], "Repeat test": ["Repeat", "end"]},
        ),
        (
            ("REPEAT", "HALT", "UNTIL FALSE"),
            {"Repeat": ["Halt"], "Halt": ["Repeat test"], "Repeat test": ["Repeat"]},
        ),
        (
            ("SWITCH $ACT_TOOL", "CASE 1", "HALT", "CASE 2", "CONTINUE", "ENDSWITCH"),
            {"Switch": ["Continue", "Halt", "end"], "Halt": ["end"], "Continue": ["end"]},
        ),
        (
            ("GOTO B", "HALT", "B:", "CONTINUE"),
            {"Goto": ["Label"], "Label": ["Continue"], "Continue": ["end"]},
        ),
    ],
)
def test_what_comes_after_each_statement(
    lines: tuple[str, ...], expected: dict[str, list[str]]
) -> None:
    """Blocks lead into their bodies and past them, loops back, jumps to where they say."""
    assert expected == shape(ways(*lines))


def test_exhaustive_switch_has_no_way_past_it() -> None:
    """Who knows that a SWITCH names all values there are can say so."""
    found = ways("SWITCH $ACT_TOOL", "CASE 1", "RETURN", "ENDSWITCH", is_exhaustive=True)
    assert found.end not in found.reached()


def test_each_statement_knows_its_block_and_the_one_before() -> None:
    """Steps stand in the order of the text, with the one before in the same list."""
    found = ways("HALT", "LOOP", "CONTINUE", "EXIT", "ENDLOOP")
    halt, loop, continue_, exit_ = (step for step, _, _ in found.steps)
    assert [(None, None), (halt, None), (None, loop), (continue_, loop)] == [
        (before, inside) for _, before, inside in found.steps
    ]
    assert isinstance(exit_.statement, ast.Exit)
