"""What one file declares, from its content alone."""

import pickle

import pytest

from grammar.semantics.symbol_table import table_of
from grammar.semantics.symbols import (
    Access,
    ImportSymbol,
    Kind,
    ModuleTable,
    RoutineSymbol,
    SignalSymbol,
    Symbol,
    TypeReference,
    TypeSymbol,
)
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


def local(table: ModuleTable, key: str, space: Space = Space.VALUE) -> Symbol:
    symbol = table.routines[0].table.find(space, key)
    assert symbol is not None
    return symbol


def test_names_are_found_in_any_letter_case() -> None:
    """TYP-05: a name declared in mixed case is found by its upper case, and keeps its spelling."""
    assert "PartCount" == found(in_list("DECL INT PartCount=1"), Space.VALUE, "PARTCOUNT").name


def test_place_of_a_declaration() -> None:
    """A symbol has the span of its name, not that of the whole declaration."""
    text = "DEFDAT JOB\nDECL INT FIRST, SECOND\nENDDAT\n"
    start, end = found(tables(text), Space.VALUE, "SECOND").span
    assert "SECOND" == text[start:end]


def test_variables_of_one_declaration_share_its_type() -> None:
    """Each declarator has its own array sizes and the type that is written once."""
    table = in_list("DECL REAL SPEED, LIMITS[3,2]")
    assert TypeReference("REAL") == found(table, Space.VALUE, "SPEED").type
    written = found(table, Space.VALUE, "LIMITS").type
    assert written is not None
    assert written.indices is not None
    assert ("REAL", 2) == (written.name, len(written.indices))


def test_constant_keeps_its_value() -> None:
    """TYP-07: a constant has its value, of which array sizes may be made; a variable has none."""
    table = in_list("DECL CONST INT MOST=12", "DECL INT NOW=5")
    most, now = (found(table, Space.VALUE, key) for key in ("MOST", "NOW"))
    assert (Kind.CONSTANT, Kind.VARIABLE) == (most.kind, now.kind)
    assert isinstance(most.value, ast.IntegerLiteral)
    assert (12, None) == (most.value.value, now.value)


@pytest.mark.parametrize(
    ("head", "declaration", "access"),
    [
        ("DEFDAT JOB PUBLIC", "DECL GLOBAL INT N=1", Access.GLOBAL),
        ("DEFDAT JOB PUBLIC", "DECL INT N=1", Access.MODULE),
        ("DEFDAT JOB", "DECL GLOBAL INT N=1", Access.MODULE),
        ("DEFDAT JOB", "DECL INT N=1", Access.MODULE),
        ("DEFDAT $CONFIG", "DECL INT N=1", Access.GLOBAL),
        ("DEFDAT $MACHINE PUBLIC", "INT N=1", Access.GLOBAL),
        ("DEFDAT JOB PUBLIC", "GLOBAL SIGNAL N $IN[1]", Access.GLOBAL),
    ],
)
def test_how_far_data_are_seen(head: str, declaration: str, access: Access) -> None:
    """SCO-04: both PUBLIC and GLOBAL make data global; the controller's own lists need neither."""
    assert access is found(in_list(declaration, head=head), Space.VALUE, "N").access


def test_how_far_types_are_seen() -> None:
    """SCO-04: a type is seen as far as its declaration says, with all its members."""
    table = in_list("GLOBAL STRUC PART_T INT NO", "ENUM HUE_T RED", head="DEFDAT JOB PUBLIC")
    part, hue = (found(table, Space.TYPE, key) for key in ("PART_T", "HUE_T"))
    assert (Access.GLOBAL, Access.MODULE) == (part.access, hue.access)


def test_first_routine_is_global() -> None:
    """SCO-01: the first routine is global without the word, others with it only."""
    table = tables("DEF A()\nEND\nDEF B()\nEND\nGLOBAL DEF C()\nEND\n")
    seen = [routine.routine.access for routine in table.routines]
    assert [Access.GLOBAL, Access.MODULE, Access.GLOBAL] == seen


def test_parameter_takes_its_type_from_the_body() -> None:
    """SCO-06: the declaration of a parameter is no second name; what is not said is OUT."""
    table = in_routine("DECL INT COUNT", "DECL CHAR NAME[]", head="DEF JOB(COUNT:IN,NAME[],NEW)")
    routine = table.routines[0].routine
    assert ["IN", "OUT", "OUT"] == [parameter.mode for parameter in routine.parameters]
    written = [parameter.type for parameter in routine.parameters]
    assert [TypeReference("INT"), TypeReference("CHAR", (None,)), None] == written
    assert () == table.routines[0].table.duplicates
    assert Kind.PARAMETER is local(table, "COUNT").kind


def test_array_parameter_whose_declaration_has_no_brackets() -> None:
    """SCO-07: the brackets of the head make an array of what the body declares without them."""
    table = in_routine("DECL INT LIST", head="DEF JOB(LIST[,]:OUT)")
    assert TypeReference("INT", (None, None)) == local(table, "LIST").type


def test_parameter_declared_twice_in_the_body() -> None:
    """The first declaration of a parameter gives its type, the second one is a duplicate."""
    table = in_routine("DECL INT COUNT", "DECL REAL COUNT", head="DEF JOB(COUNT:IN)")
    (duplicate,) = table.routines[0].table.duplicates
    assert (Kind.PARAMETER, Kind.VARIABLE) == (duplicate.first.kind, duplicate.second.kind)
    assert TypeReference("INT") == local(table, "COUNT").type


def test_parameter_named_twice() -> None:
    """A parameter stands once in a list; both are in the signature."""
    table = in_routine("DECL INT A", head="DEF JOB(A:IN,a:IN)")
    (duplicate,) = table.routines[0].table.duplicates
    assert ("A", "a") == (duplicate.first.name, duplicate.second.name)
    assert 2 == len(table.routines[0].routine.parameters)


def test_result_of_a_function() -> None:
    """TYP-17: a function has the type of its result, an array too; a DEF has none."""
    (function,) = in_routine("RETURN T[]", head="DEFFCT CHAR[128] JOB(T[])").routines
    assert function.routine.type is not None
    assert "CHAR" == function.routine.type.name
    assert function.routine.type.indices is not None
    assert in_routine().routines[0].routine.type is None


def test_duplicates_differ_by_letter_case_only() -> None:
    """TYP-05: two spellings of one name are a duplicate; the first declaration counts."""
    table = in_list("DECL INT COUNT=1", "DECL REAL Count=2")
    (duplicate,) = table.table.duplicates
    assert ("COUNT", "Count") == (duplicate.first.name, duplicate.second.name)
    assert duplicate.first is found(table, Space.VALUE, "COUNT")


def test_spaces_do_not_meet() -> None:
    """A variable, a type, a label and a routine may be called alike."""
    table = in_routine("ENUM JOB X", "DECL INT JOB", "JOB:")
    assert () == table.routines[0].table.duplicates
    kinds = [local(table, "JOB", space).kind for space in (Space.TYPE, Space.VALUE, Space.LABEL)]
    assert [Kind.ENUMERATION, Kind.VARIABLE, Kind.LABEL] == kinds


def test_structure_and_enumeration_of_one_name() -> None:
    """The name of a type is declared once."""
    (duplicate,) = in_list("STRUC PART_T INT NO", "ENUM PART_T RED").table.duplicates
    assert (Kind.STRUCTURE, Kind.ENUMERATION) == (duplicate.first.kind, duplicate.second.kind)


def test_members_in_their_order() -> None:
    """A structure has its members in order, each with the type of its group."""
    part = found(in_list("STRUC PART_T INT NO, REAL WIDTH, GAP[2]"), Space.TYPE, "PART_T")
    assert isinstance(part, TypeSymbol)
    written = {key: member.type.name for key, member in part.members.items() if member.type}
    assert {"NO": "INT", "WIDTH": "REAL", "GAP": "REAL"} == written
    assert list(written) == list(part.members)


def test_constants_of_enumerations_are_no_names() -> None:
    """TYP-16: two enumerations may share constants, and no constant is found by its name."""
    table = in_list("ENUM HUE_T RED, GREEN", "ENUM LAMP_T GREEN, OFF")
    assert () == table.table.duplicates
    hue, lamp = (found(table, Space.TYPE, key) for key in ("HUE_T", "LAMP_T"))
    assert isinstance(hue, TypeSymbol)
    assert isinstance(lamp, TypeSymbol)
    assert (["RED", "GREEN"], ["GREEN", "OFF"]) == (list(hue.members), list(lamp.members))
    assert table.table.find(Space.VALUE, "GREEN") is None


def test_member_and_constant_twice() -> None:
    """A name stands once in a structure, and once in an enumeration."""
    table = in_list("STRUC PART_T INT NO, REAL NO", "ENUM HUE_T RED, GREEN, Red")
    seconds = [
        (duplicate.second.kind, duplicate.second.name) for duplicate in table.table.duplicates
    ]
    assert [(Kind.MEMBER, "NO"), (Kind.ENUM_CONSTANT, "Red")] == seconds


def test_signal_knows_what_it_stands_for() -> None:
    """IOT-03: a signal has a first and, for a group, a last input or output."""
    group = found(in_list("SIGNAL CODE $IN[1] TO $IN[8]"), Space.VALUE, "CODE")
    assert isinstance(group, SignalSymbol)
    assert isinstance(group.first, ast.Subscript)
    assert isinstance(group.last, ast.Subscript)


def test_external_routine_has_a_signature() -> None:
    """SCO-10: EXT announces a routine with the types and modes of its parameters."""
    table = in_routine("EXT WORK (TASK_T :IN,REAL :OUT)", "EXTFCT INT SIZE (CHAR T[] :IN)")
    work, size = (local(table, key, Space.ROUTINE) for key in ("WORK", "SIZE"))
    assert isinstance(work, RoutineSymbol)
    signature = [(p.type.name, p.mode) for p in work.parameters if p.type]
    assert [("TASK_T", "IN"), ("REAL", "OUT")] == signature
    assert (Kind.EXTERNAL, Kind.EXTERNAL, TypeReference("INT")) == (work.kind, size.kind, size.type)


def test_routine_of_the_controller_is_no_external_one() -> None:
    """SCO-10: EXTP and EXTFCTP write routines of the controller, of which no module is missing."""
    table = in_list("EXTFCTP INT SIZE(CHAR T[80] :IN)", head="DEFDAT $OPERATE PUBLIC")
    assert Kind.ROUTINE is found(table, Space.ROUTINE, "SIZE").kind


def test_import_names_a_module_and_a_variable() -> None:
    """ADV-05: IMPORT has a name and type of its own, and where the value comes from."""
    symbol = found(in_list("IMPORT INT MINE IS /R1/Other..THEIRS"), Space.VALUE, "MINE")
    assert isinstance(symbol, ImportSymbol)
    assert isinstance(symbol.source, ast.Variable)
    assert ("OTHER", "THEIRS") == (symbol.module, symbol.source.name.key)


def test_declarations_inside_blocks_are_seen() -> None:
    """A misplaced declaration is an error of its own, so its name is known nevertheless."""
    table = in_routine("LOOP", "IF TRUE THEN", "DECL INT DEEP", "ENDIF", "DONE:", "ENDLOOP")
    assert Kind.VARIABLE is local(table, "DEEP").kind
    assert Kind.LABEL is local(table, "DONE", Space.LABEL).kind


def test_label_twice() -> None:
    """A label stands once in a routine, wherever it stands, and again in another one."""
    table = tables("DEF A()\nX:\nIF TRUE THEN\nX:\nENDIF\nEND\nDEF B()\nX:\nEND\n")
    assert [1, 0] == [len(routine.table.duplicates) for routine in table.routines]


def test_labels_and_declarations_in_all_branches() -> None:
    """ELSE, CASE and DEFAULT are searched like any block."""
    table = in_routine(
        *("IF TRUE THEN", "A:", "ELSE", "B:", "ENDIF"),
        *("SWITCH N", "CASE 1", "C:", "CASE 2", "D:", "DEFAULT", "E:", "ENDSWITCH"),
    )
    assert list("ABCDE") == list(table.routines[0].table.spaces[Space.LABEL])


def test_routine_twice() -> None:
    """A routine is defined once in a module; the tables of both are there."""
    table = tables("DEF A()\nEND\nDEF B()\nX:\nEND\nDEF b()\nY:\nEND\n")
    (duplicate,) = table.table.duplicates
    assert ("B", "b") == (duplicate.first.name, duplicate.second.name)
    assert [[], ["X"], ["Y"]] == [list(r.table.spaces[Space.LABEL]) for r in table.routines]


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
