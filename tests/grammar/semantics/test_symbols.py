"""What one file declares, from its content alone."""

import pickle

from grammar.semantics.symbol_table import table_of
from grammar.semantics.symbols import Access, Kind, ModuleTable, Symbol, TypeReference
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.references import Space


def tables(text: str) -> ModuleTable:
    module = read_module(text)
    assert isinstance(module, ast.Module), module
    return table_of(module)


def in_list(*lines: str, head: str = "DEFDAT JOB") -> ModuleTable:
    return tables("\n".join((head, *lines, "ENDDAT", "")))


def in_routine(*lines: str, head: str = "DEF JOB()") -> ModuleTable:
    end = "ENDFCT" if "DEFFCT" in head else "END"
    return tables("\n".join((head, *lines, end, "")))


def found(table: ModuleTable, space: Space, key: str) -> Symbol:
    symbol = table.table.find(space, key)
    assert symbol is not None
    return symbol


def test_place_of_a_declaration() -> None:
    """A symbol has the span of its name, not that of the whole declaration."""
    text = "DEFDAT JOB\nDECL INT FIRST, SECOND\nENDDAT\n"
    start, end = found(tables(text), Space.VALUE, "SECOND").span
    assert "SECOND" == text[start:end]


def test_calls_of_a_file() -> None:
    """A table tells what a file calls, statements, expressions, triggers and interrupts alike."""
    table = in_routine(
        *("A()", "N=B(C(1))", "INTERRUPT DECL 21 WHEN $IN[1] DO D()"),
        *("TRIGGER WHEN DISTANCE=0 DELAY=0 DO E() PRIO=-1", "PTP F()", "WAIT FOR g()"),
    )
    assert frozenset("ABCDEFG") == table.calls


def test_channel() -> None:
    """A channel has a space of its own."""
    table = in_list("CHANNEL :LINK :SER_1 $PSER_1", head="DEFDAT $CUSTOM PUBLIC")
    symbol = found(table, Space.CHANNEL, "LINK")
    assert (Kind.CHANNEL, Access.GLOBAL) == (symbol.kind, symbol.access)


def test_system_variables_keep_their_meaning() -> None:
    """Only data lists of the controller declare system variables, and none makes $OUT a signal."""
    lines = ["INT $NUM_AX", "SIGNAL $ALARM_STOP $OUT[9]", "SIGNAL $OUT $OUT[1]", "BOOL $OURS"]
    delivered = in_list(*lines, head="DEFDAT $MACHINE PUBLIC").table
    assert ["$NUM_AX", "$ALARM_STOP", "$OURS"] == list(delivered.spaces[Space.VALUE])
    for one in (in_list(*lines).table, in_routine(*lines).routines[0].table):
        assert ["$OURS"] == list(one.spaces[Space.VALUE])


def test_tables_can_be_kept() -> None:
    """Tables come back from a pickle with the same names, types and modes."""
    text = "DEF A(X:IN)\nDECL INT X\nSIGNAL S $IN[1]\nB(X)\nEND\n"
    table = tables(text)
    kept = pickle.loads(pickle.dumps(table))
    assert isinstance(kept, ModuleTable)
    (parameter,) = kept.routines[0].routine.parameters
    assert ("X", "IN", TypeReference("INT")) == (parameter.name, parameter.mode, parameter.type)
    assert parameter is kept.routines[0].table.find(Space.VALUE, "X")
    assert (table.calls, table.span) == (kept.calls, kept.span)


def test_tables_do_not_hold_the_statements() -> None:
    """What is kept grows with what is declared, not with what is done."""
    short, long = (pickle.dumps(in_routine(*["$OUT[1]=TRUE"] * count)) for count in (1, 200))
    assert len(short) == len(long)


def test_deep_nesting() -> None:
    """Thousands of nested blocks are searched without recursion."""
    deep = 3_000
    table = in_routine(*["LOOP"] * deep, "X:", *["ENDLOOP"] * deep)
    assert ["X"] == list(table.routines[0].table.spaces[Space.LABEL])
