"""A name is unknown when what could declare it has been read, however much else is missing."""

from collections.abc import Callable

import pytest

from grammar.check.analysis.spelling import spelling_of
from grammar.check.project.project_check import CheckOptions, Content, found_in_project, recheck
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.link import File, link
from grammar.syntax.build import read_module
from grammar.syntax.source import Source, names_in_text
from tests.grammar.check.workspace_check import check

Agrees = Callable[..., None]

CONFIG = "DEFDAT $CONFIG\nDECL GLOBAL INT PARTS=0\nENDDAT\n"
DATA = "DEFDAT CELL\nDECL INT GRIPPED=0\nENDDAT\n"


def test_a_backup_with_its_config_knows_its_variables(agrees: Agrees) -> None:
    """With $CONFIG read an undeclared variable is an error, though a package is missing."""
    cell = """DEF CELL()
  PACKAGE_CALL(1) ;> KRL701-
  GRIPPED = 1
  GRIPED = 1 ;> KRL101
  PARTS = WHOLLY_UNKNOWN ;> KRL101
END"""
    files = {"R1/System/$config.dat": CONFIG, "R1/cell.dat": DATA, "R1/cell.src": cell}
    agrees(files, is_complete=None)


def test_channels_of_the_controller_are_known(agrees: Agrees) -> None:
    """The delivered ones are; others are in $custom.dat, so without it no channel is an error."""
    cell = """DEF CELL()
  INT H
  COPEN(:SER_2, H)
  COPEN(:CMD, H)
  COPEN(:PRINTER, H) ;> KRL{}
END"""
    files = {"R1/System/$config.dat": CONFIG, "R1/cell.src": cell.format("701-")}
    agrees(files, is_complete=None)
    agrees(files)
    custom = {"STEU/Mada/$custom.dat": "DEFDAT $CUSTOM\nENDDAT\n"}
    agrees(files | custom | {"R1/cell.src": cell.format("101")})


@pytest.mark.parametrize(("is_complete", "mark"), [(True, ""), (None, "?")])
def test_a_type_is_local_to_another_routine(
    agrees: Agrees, is_complete: bool | None, mark: str
) -> None:
    """A type that another routine of the file declares cannot be seen here; told where it is."""
    first = f"DEF NEG()\nDECL POINT_T A ;> KRL103{mark}\nDECL POINT_T B\nEND"
    other = "DEF WORK()\nSTRUC POINT_T INT X\nDECL POINT_T A\nA.X = 1\nEND"
    agrees(f"{first}\n{other}", is_complete=is_complete)


def test_a_variable_that_a_data_list_sets_whole(agrees: Agrees) -> None:
    """It is one mistake, whether the variable is declared or not."""
    data = "DEFDAT CELL\nSPOT={A 1} ;> KSS2039\nDECL INT N\nN=1 ;> KSS2039\nENDDAT\n"
    for is_complete in (True, None):
        agrees({"R1/System/$config.dat": CONFIG, "cell.dat": data}, is_complete=is_complete)


def test_without_config_only_a_slip_is_reported(agrees: Agrees) -> None:
    """Where $CONFIG is missing a slip is a warning, and any other name is a note."""
    cell = """DEF CELL()
  GRIPPED = 1
  GRIPED = 1 ;> KRL101?
  GRIPPED = WHOLLY_UNKNOWN ;> KRL701-
  $OV_RPO = 1 ;> KRL113?
END"""
    agrees({"cell.dat": DATA, "cell.src": cell}, is_complete=None)


def test_an_ext_that_is_a_slip_is_reported(agrees: Agrees) -> None:
    """In $CONFIG as in a program; a routine that is there or called is announced rightly."""
    config = """DEFDAT $CONFIG
  EXT WELD_SEMA(INT :IN) ;> KRL117?
  EXT WELD_SEAM(INT :IN)
  EXT WELD_SEEM(INT :IN)
  EXT GRIPPER(INT :IN)
ENDDAT"""
    weld = "DEF WELD_SEAM(N :IN)\nINT N\n$OUT[N] = TRUE\nEND"
    cell = (
        "DEF CELL()\nEXT WELD_SEMA(INT :IN) ;> KRL117?\nWELD_SEAM(1)\nWELD_SEEM(1) ;> KRL701-\nEND"
    )
    files = {"R1/System/$config.dat": config, "R1/weld_seam.src": weld, "R1/cell.src": cell}
    agrees(files, with_data=True)


def test_a_constant_without_its_mark_is_reported() -> None:
    """A name that nothing declares where a constant of that name fits is told with its #."""
    text = "DEF CELL()\n$IPO_MODE = BASE\n$ORI_TYPE = VAR\nEND\n"
    syntax = read_module(text, "cell.src")
    assert not isinstance(syntax, list)
    found = check(link([File("cell.src", syntax)]), lambda _: Source(text, "cell.src"))
    assert ["did you mean #BASE?", "did you mean #VAR?"] == [
        one.fix.text for one in found if one.code == "KRL101" and one.fix
    ]


@pytest.mark.parametrize(("other", "mark"), [("jbPart", "701-"), ("HOME", "101?")])
def test_small_letters_that_another_name_begins_with_are_a_prefix(
    agrees: Agrees, other: str, mark: str
) -> None:
    """Whether the other name is declared, or that prefix is written more than once."""
    data = "DEFDAT B PUBLIC\nDECL GLOBAL INT gbToolReady=0, {}=0\nENDDAT\n"
    lines = ["DEF A() ;> KRL702-", f"jbToolReady = 1 ;> KRL{mark}", "END"]
    agrees({"b.dat": data.format(other), "a.src": "\n".join(lines)}, is_complete=None)
    lines.insert(1, f"INT {other}")
    agrees({"b.dat": data.format("NEXT"), "a.src": "\n".join(lines)}, is_complete=None)


@pytest.mark.parametrize(
    ("declared", "line"),
    [
        ("TAKE_2, TAKE_21", "TAKE_22 = 1"),
        ("GRIPE, GRIPPED", "GRIPED = 1\nGRIPED = 2\nGRIPED = 3"),
        ("TAKE_2", "TAKE_22 = 1\nTAKE_22 = = 2"),
    ],
)
def test_a_name_is_swapped_with_one_that_is_near_alone(declared: str, line: str) -> None:
    """Of several that are near none is meant for certain, nor where a line may declare the name."""
    data = f"DEFDAT CELL\nDECL INT {declared}\nENDDAT\n"
    found = found_in({"cell.dat": data, "cell.src": f"DEF CELL()\n{line}\nEND\n"})
    assert "KRL101" not in [code for *_, code in found]


@pytest.mark.parametrize(("modules", "code"), [("AB", "KRL101"), ("ABC", "KRL701")])
def test_data_of_many_modules_are_missing(
    finds: Callable[..., list[Diagnostic]], modules: str, code: str
) -> None:
    """What three modules use was declared in a file that has gone."""
    files = {"R1/System/$config.dat": CONFIG}
    for name in modules:
        files[f"R1/{name}.dat"] = f"DEFDAT {name}\nENDDAT\n"
        files[f"R1/{name}.src"] = f"DEF {name}()\nLOST = 1\nEND\n"
    found = [one.code for one in finds(files, is_complete=None) if "LOST" in one.message]
    assert {code} == set(found)


def test_what_several_modules_declare_is_not_missing(
    finds: Callable[..., list[Diagnostic]],
) -> None:
    """Which of two is meant is unknown, and that one of them is there is not."""
    files = {
        f"{name}/{name}.dat": f"DEFDAT {name} PUBLIC\nDECL GLOBAL INT PARTS=0\nENDDAT\n"
        for name in "BC"
    }
    files["a.src"] = "DEF A()\nPARTS = 1\nEND\n"
    found = finds(files, is_complete=None)
    assert [] == [one for one in found if one.path == "a.src" and one.code == "KRL701"]


def test_a_slip_of_a_routine_is_a_warning(agrees: Agrees) -> None:
    """A routine that is not there is probably the one that is called nearly so."""
    cell = """DEF CELL()
  OPEN_GRIPPER()
  OPEN_GRIPER() ;> KRL102?
END
DEF OPEN_GRIPPER()
END"""
    agrees({"cell.src": cell}, is_complete=None)


@pytest.mark.parametrize(
    ("call", "is_slip"),
    [
        ("BASS (#INITMOV, 0)", True),
        ("BSA(#PTP_PARAMS, 100)", True),
        ("P0(#EXT_PGNO)", True),
        ("RIS_MOVECORR()", True),
        ("BAS(#INITMOV, 0)", False),
        ("BASS(#OPEN)", False),
        ("GAS(3)", False),
    ],
)
def test_what_inline_forms_call_is_known_by_its_arguments(
    finds: Callable[..., list[Diagnostic]], call: str, is_slip: bool
) -> None:
    """BAS is too short a name to be known by its letters; packages are known without a call."""
    found = finds({"a.src": f"DEF A()\n{call}\nEND\n"}, is_complete=None)
    assert is_slip == any(one.code == "KRL102" for one in found)


@pytest.mark.parametrize(("name", "is_slip"), [("POS_ACT", True), ("HOME", False)])
def test_a_position_called_home_is_no_folder(
    finds: Callable[..., list[Diagnostic]], name: str, is_slip: bool
) -> None:
    """The dollar sign is missed where a motion could go to what has one."""
    found = finds({"a.src": f"DEF A()\nPTP {name}\nEND\n"}, is_complete=None)
    assert is_slip == any(one.severity == "warning" for one in found)


def test_a_slip_in_a_declaration_that_leaves_a_global_name(agrees: Agrees) -> None:
    """A local name that nothing uses is near one of another file that the routine uses."""
    config = "DEFDAT CELL PUBLIC\nGLOBAL INT PLACE=1\nENDDAT"
    cell = """DEF CELL()
  INT PLAEC, SPARE ;> KRL117? KRL117-
  PLACE = 2
END"""
    agrees({"cell.dat": config, "cell.src": cell}, with_data=True)


def test_what_is_used_again_and_again_is_no_slip(agrees: Agrees) -> None:
    """A name that is written more than twice is called so; one that is near it is the slip."""
    cell = """DEF CELL()
  SPEEDS = 1 ;> KRL701-
  SPEEDS = 2
  SPEEDS = 3
  SPEDS = 4 ;> KRL101?
END"""
    agrees({"cell.src": cell, "cell.dat": DATA}, is_complete=None)


def test_names_in_series_are_no_slips(agrees: Agrees) -> None:
    """Several names near one and the same are a series of which some are elsewhere."""
    cell = """DEF CELL()
  FINEST()
  FINERT() ;> KRL701-
  FINEAT() ;> KRL701-
  FINEXT() ;> KRL701-
END
DEF FINEST()
END"""
    agrees({"cell.src": cell}, is_complete=None)


@pytest.mark.parametrize(("name", "severity"), [("HIDDEN", "note"), ("ABSENT", "warning")])
def test_a_damaged_list_declares_none_but_its_words(name: str, severity: str) -> None:
    """Of a data list that cannot be read only the words in it may be declared."""
    damaged = "DEFDAT OTHER PUBLIC\nDECL GLOBAL INT HIDDEN=\nENDDAT\n"
    cell = f"DEF CELL()\n  {name} = 1\nEND\n"
    files = [File("R1/other.dat", None, words=names_in_text(damaged))]
    for path, text in (("R1/System/$config.dat", CONFIG), ("R1/cell.src", cell)):
        module = read_module(text, path)
        assert not isinstance(module, list)
        files.append(File(path, module))
    found = check(link(files), lambda module: Source(cell, module.path))
    assert [severity] == [one.severity for one in found if name in one.message]


def test_a_slip_in_the_declaration(finds: Callable[..., list[Diagnostic]]) -> None:
    """What nothing uses and is one letter off what is used again and again is declared wrongly."""
    lines = ["DEF U()", "INT CUNTER, LIMIT", "COUNTER = 1", "COUNTER = COUNTER + LIMIT", "END"]
    found = finds({"U.src": "\n".join(lines)}, is_complete=None)
    grave = [(one.region.line, one.code, one.severity) for one in found if one.severity != "note"]
    assert (2, "KRL101", "warning") in grave
    assert {2} == {line for line, code, _ in grave if code == "KRL101"}


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("DECL E6PO P", "KRL103"),
        ("DECL IINT N", "KRL103"),
        ("$OUT[1] = FALS", "KRL101"),
        ("$OUT[1] = TRUEE", "KRL101"),
        ("ER_RCLEAR($ERR)", "KRL102"),
        ("$OUT305[1] = TRUE", "KRL113"),
        ("PTP $POS_AC", "KRL113"),
        ("BOUT[1] = TRUE", "KRL101"),
        ("FDAT_AC = FHOME", "KRL101"),
        ("DECL IT N", "KRL103"),
        ("FDAT_ACT.TOOL_N = 1", "KSS2125"),
    ],
)
def test_slips_of_words_of_the_language(
    finds: Callable[..., list[Diagnostic]], line: str, code: str
) -> None:
    """What is one letter away from what every program has is that, though files are missing."""
    found = finds({"U.src": f"DEF U()\n{line}\nEND\n"}, is_complete=None)
    assert [("warning", code)] == [(one.severity, one.code) for one in found if one.code == code]


def test_the_rarer_of_two_spellings_is_the_slip(finds: Callable[..., list[Diagnostic]]) -> None:
    """Of two names that differ by a slip, and that no file at hand declares, one is used more."""
    text = "DEF U()\nSTATION = 1\nSTAITON = 2\nSTATION = 3\nEND\n"
    found = finds({"U.src": text}, is_complete=None)
    assert [3] == [one.region.line for one in found if one.severity == "warning"]


@pytest.mark.parametrize(
    ("declared", "used", "line"),
    [("GRIPPER_OPNE", "GRIPPER_OPEN", 3), ("GRIPPER_OPEN", "GRIPPER_OPNE", 4)],
)
def test_other_names_show_which_of_two_is_misspelt(
    finds: Callable[..., list[Diagnostic]], declared: str, used: str, line: int
) -> None:
    """Of a declaration that nothing uses and a use that nothing declares one is spelt as others."""
    text = f"DEF U()\nINT TOOL_OPEN\nINT {declared}\nTOOL_OPEN = {used}\nEND\n"
    found = finds({"U.src": text}, is_complete=True)
    assert [line] == [one.region.line for one in found if one.code == "KRL101"]


@pytest.mark.parametrize(("also", "is_told"), [("", True), (", TDEFAULT", False)])
def test_no_slip_of_what_stands_beside_it(
    finds: Callable[..., list[Diagnostic]], also: str, is_told: bool
) -> None:
    """An unused declaration is no slip of a name that the same list declares as well."""
    files = {f"{name}.dat": f"DEFDAT {name}\nINT TDEFAULT\nENDDAT\n" for name in "AB"}
    files["C.dat"] = f"DEFDAT C\nINT TMDEFAULT{also}\nENDDAT\n"
    found = finds(files, is_complete=None)
    assert ["KRL117"] * is_told == [one.code for one in found if one.severity == "warning"]


@pytest.mark.parametrize(
    ("name", "is_told"),
    [("SUCCES", True), ("SUCCESSES", False), ("GRIPPER_OPNE3", True), ("GRIPPER_OPEN3", False)],
)
def test_what_nothing_uses_and_others_write_otherwise_is_misspelt(
    finds: Callable[..., list[Diagnostic]], name: str, is_told: bool
) -> None:
    """A declaration that nothing uses is a slip of what each list has, or of a series of names."""
    series = "DEFDAT V\nDECL INT GRIPPER_OPEN1\nDECL INT GRIPPER_OPEN2\nENDDAT\n"
    files = {"U.dat": f"DEFDAT U\nDECL INT {name}\nENDDAT\n", "V.dat": series}
    found = [one.code for one in finds(files, is_complete=None) if one.severity == "warning"]
    assert ["KRL117"] * is_told == found


@pytest.mark.parametrize(("used", "line"), [("PART", 2), ("PRAT", 1)])
def test_a_misspelt_parameter_is_reported_where_the_slip_is(
    finds: Callable[..., list[Diagnostic]], used: str, line: int
) -> None:
    """What the body uses is right: the name in the head, or that of the declaration."""
    text = f"DEF U(PART:IN)\nINT PRAT\n$OUT[{used}] = TRUE\nEND\n"
    found = finds({"U.src": text}, is_complete=True)
    assert [line] == [one.region.line for one in found if one.code == "KRL115"]


def test_slips_in_lists_of_the_controller(finds: Callable[..., list[Diagnostic]]) -> None:
    """A list of the controller that declares nearly what the tables have declares it wrongly."""
    text = "DEFDAT $MACHINE PUBLIC\nSIGNAL $BRAKS_OK $IN[3]\nINT $NOT_IN_ANY_TABLE=3\nENDDAT\n"
    found = finds({"$machine.dat": text}, is_complete=None)
    assert [2] == [one.region.line for one in found if one.code == "KRL113"]


def test_slips_in_components_of_unknown_structures(
    finds: Callable[..., list[Diagnostic]],
) -> None:
    """A component that is written once, and nearly so again and again, is a slip."""
    lines = [f"M[{n}].PLACEPOS = {n}" for n in range(1, 4)]
    twice = ["M[6].PLACEPSO = 6"] * 2
    text = "\n".join(["DEF U()", *lines, "M[4].PLCAEPOS = 4", "M[5].OTHER = 5", *twice, "END"])
    found = finds({"U.src": text}, is_complete=None)
    assert [(5, "KSS2125", "warning")] == [
        (one.region.line, one.code, one.severity) for one in found if one.severity != "note"
    ]


def test_a_program_without_its_list_is_not_certain(
    finds: Callable[..., list[Diagnostic]],
) -> None:
    """With $CONFIG and its own list read a name is unknown for certain; without its list likely.

    A program that is called like the name may have a list that declares it.
    """
    files = {
        "R1/System/$config.dat": "DEFDAT $CONFIG\nENDDAT\n",
        "R1/Program/u.src": "DEF U()\nABSENT = 1\nELSEWHERE()\nEND\n",
    }
    without = finds(files, is_complete=None)
    whole = finds({**files, "R1/Program/u.dat": "DEFDAT U\nENDDAT\n"}, is_complete=None)
    files |= {"R1/Program/u.dat": "DEFDAT U\nENDDAT\n", "R1/TP/absent_user.src": "DEF A()\nEND\n"}
    other = finds(files, is_complete=None)
    severities = [
        [one.severity for one in found if one.code == "KRL101"] for found in (without, whole, other)
    ]
    assert [["warning"], ["error"], []] == severities


def test_many_names_that_nothing_declares_are_missed_not_misspelt(agrees: Agrees) -> None:
    """More than a few unknown names mean that what declares them is missing; a slip is told yet."""
    cell = """DEF CELL()
  GRIPED = 1 ;> KRL101
  WHITE = 1 ;> KRL701-
  YELLOW = 1 ;> KRL701-
  ORANGE = 1 ;> KRL701-
  PURPLE = 1 ;> KRL701-
  PACKAGE_CALL(1) ;> KRL701-
END"""
    data = "DEFDAT CELL\nDECL INT GRIPPED=0\nENDDAT\n"
    files = {"R1/System/$config.dat": CONFIG, "R1/cell.dat": data, "R1/cell.src": cell}
    agrees(files, is_complete=None)


def test_two_names_that_are_used_once_each_and_one_slip_apart(agrees: Agrees) -> None:
    """Where nothing declares either the second is told, but not of names that people pair.

    Nor is it of short names.
    """
    cell = """DEF CELL() ;> KRL702-
  CONVEYOR = 1 ;> KRL701-
  CONVEOYR = 1 ;> KRL101?
  LEFT_A = 1 ;> KRL701-
  LEFT_B = 1 ;> KRL701-
  STAPL = 1 ;> KRL701-
  STPAL = 1 ;> KRL701-
END"""
    agrees({"cell.src": cell}, is_complete=None)


@pytest.mark.parametrize(("config", "mark"), [({}, "?"), ({"R1/System/$config.dat": CONFIG}, "")])
def test_a_slip_in_the_data_list(agrees: Agrees, config: dict[str, str], mark: str) -> None:
    """What the program uses often and its list does not have is one slip away from what it has.

    Of several such names the declarations are missing, or have other names.
    """
    data = f"DEFDAT CELL\nDECL INT RECIEVED=0 ;> KRL101{mark}\nENDDAT\n"
    lines = ["DEF CELL()", *["RECEIVED = 2"] * 5, "END"]
    files = {**config, "R1/cell.dat": data, "R1/cell.src": "\n".join(lines)}
    agrees(files, is_complete=None)
    files["R1/cell.dat"] = "DEFDAT CELL\nDECL INT RECIEVED=0, DELIVERD=0\nENDDAT\n"
    told = ["RECEIVED = 2", "DELIVERED = 2"]
    lines = ["DEF CELL()", *[f"{one} ;> KRL101{mark}" for one in told], *told * 4, "END"]
    agrees({**files, "R1/cell.src": "\n".join(lines)}, is_complete=None)


def test_a_slip_in_what_is_global(agrees: Agrees) -> None:
    """What nothing uses and is one slip away from what others use often is declared wrongly."""
    cell = "\n".join(["DEF CELL()", *["RESETCLOCK()"] * 4, "END"])
    clock = "DEF RESETCLOK() ;> KRL102?\nEND"
    agrees({"cell.src": cell, "resetclok.src": clock}, is_complete=None)
    used = cell.replace("CLOCK()", "CLOCK() ;> KRL701-", 1)
    files = {"cell.src": used, "resetclok.src": clock.replace(";> KRL102?", "")}
    agrees({**files, "user.src": "DEF USER()\nRESETCLOK()\nEND"}, is_complete=None)


ENUM = "DEFDAT $CONFIG PUBLIC\nGLOBAL ENUM JOB PICK, PLCAE ;> KSS2296\nDECL GLOBAL JOB J\nENDDAT\n"
PLACES = "DEF A()\nJ = #PLACE\nIF J==#PLACE THEN\nHALT\nENDIF\nEND\n"


def test_a_slip_in_a_constant_is_reported_where_it_is_declared(agrees: Agrees) -> None:
    """What several places call otherwise, and nothing as it is declared, is one finding."""
    b = PLACES.replace("A()", "B()")
    agrees({"$config.dat": ENUM, "a.src": PLACES, "b.src": b}, is_complete=None)


def test_a_slip_in_a_component_is_reported_where_it_is_declared(agrees: Agrees) -> None:
    """A component that nothing uses, and that all uses spell otherwise, is one finding."""
    data = "STRUC PART BOOL FUOND, INT SIZE ;> KSS2125\nDECL PART P={FOUND FALSE,SIZE 0}\n"
    list_ = f"DEFDAT CELL\n{data}ENDDAT\n"
    cell = "DEF CELL()\nP.FOUND = TRUE\nIF P.FOUND THEN\nHALT\nENDIF\nEND"
    agrees({"cell.dat": list_, "cell.src": cell}, is_complete=None)
    lines = [f"{line} ;> KSS2125" if "P.FOUND" in line else line for line in cell.split("\n")]
    lines[1:1] = ["P.FUOND = TRUE"]
    data = data.replace(" ;> KSS2125", "").replace("SIZE 0}", "SIZE 0} ;> KSS2125")
    agrees(
        {"cell.dat": f"DEFDAT CELL\n{data}ENDDAT\n", "cell.src": "\n".join(lines)},
        is_complete=None,
    )


def test_a_component_is_called_like_a_variable_of_the_file(agrees: Agrees) -> None:
    """A component of an unknown structure is a slip of what it is assigned to; a plural is none."""
    cell = """DEF CELL()
  INT LAYERS, PALLET
  LAYERS = RECIPE.LYAERS ;> KRL701- KSS2125?
  PALLET = RECIPE.PALLETS + RECIPE.LAYER + LAYERS + PALLET
END"""
    agrees({"cell.src": cell}, is_complete=None, ignored=("KRL702",))


def test_a_slip_in_a_constant_whose_enumeration_is_missing(agrees: Agrees) -> None:
    """It is one slip away from one that is used more often, or declared, or of the controller."""
    cell = """DEF CELL()
  MOVE_TO(#STATION_LEFT) ;> KRL701-
  MOVE_TO(#STATION_LEFT)
  MOVE_TO(#STATOIN_LEFT) ;> KSS2296?
  MOVE_TO(#STATION_RIGHT)
  MOVE_TO(#PLCAE) ;> KSS2296?
  MOVE_TO(#PTP_PARAMSS) ;> KSS2296?
  BAS(#PTP_PARRAMS, 10) ;> KRL701- KSS2296?
  BAS(#PTP_PARAMS, 10)
END"""
    places = "DEFDAT PLACES PUBLIC\nGLOBAL ENUM JOB PICK, PLACE\nENDDAT\n"
    agrees({"cell.src": cell, "places.dat": places}, is_complete=None)
    series = "\n".join(f"MOVE_TO(#PLACE_{one})" for one in ("1", "2", "2", "A", "B", "B"))
    told = series.replace("1)", "1) ;> KRL701-")
    agrees({"cell.src": f"DEF CELL()\n{told}\nEND"}, is_complete=None)


def test_an_s_too_many(agrees: Agrees) -> None:
    """It is a slip in all names but those of data, of which there may be one and several."""
    cell = """DEF CELL()
  DECL STATIONS TODO ;> KRL103?
  DECL STATION DONE
  FETCHS() ;> KRL102?
  FETCH()
  GRIPPED = 1
  GRIPPEDS = 1 ;> KRL701-
  MOVE_TO(#PLACES) ;> KSS2296? KRL701-
END
DEF FETCH()
END"""
    data = DATA.replace("DECL", "ENUM STATION PICK, PLACE\nDECL", 1)
    agrees({"cell.dat": data, "cell.src": cell}, is_complete=None)


def test_each_list_has_its_own_slips(agrees: Agrees) -> None:
    """What one list declares is not what other programs call alike."""
    files: dict[str, str] = {}
    for name in "AB":
        data = f"DEFDAT {name}\nENUM JOB PICK, PLCAE ;> KSS2296\nDECL JOB J\n"
        data += "DECL INT RECIEVED=0 ;> KRL101?\nENDDAT\n"
        program = PLACES.replace("A()", f"{name}()\n" + "RECEIVED = 1\n" * 5)
        files |= {f"{name}.dat": data, f"{name}.src": program}
    other = "DEF C() ;> KRL702-\nRECEIVED = 1 ;> KRL701-\nEND\n"
    agrees({**files, "C.src": other}, is_complete=None)


def test_a_slip_in_the_use_of_a_constant(agrees: Agrees) -> None:
    """Where the constant is used as it is declared, its other uses are wrong."""
    b = "DEF B()\nJ = #PLCAE\nEND\n"
    a = PLACES.replace("PLACE\n", "PLACE ;> KSS2296\n").replace("THEN", "THEN ;> KSS2296")
    agrees(
        {"$config.dat": ENUM.replace(";> KSS2296", ""), "a.src": a, "b.src": b}, is_complete=None
    )


@pytest.mark.parametrize(
    ("declared", "name"), [("XP17233", "XP1723"), ("kOBOT_ON", "ROBOT_ON"), ("TAKE_2", "TAKE_22")]
)
def test_any_slip_is_one_where_the_list_has_what_nothing_uses(
    agrees: Agrees, declared: str, name: str
) -> None:
    """Names that could be of a series are slips where the program leaves what is declared out."""
    data = f"DEFDAT CELL\nDECL INT {declared}=0\nENDDAT\n"
    cell = f"DEF CELL()\n{name} = 1 ;> KRL101?\nEND"
    agrees({"cell.dat": data, "cell.src": cell}, is_complete=None)


def test_what_nothing_uses_is_meant_before_what_is_used(agrees: Agrees) -> None:
    """Of similar declarations the one without a use is misspelt, and is told itself."""
    data = """DEFDAT CELL
DECL INT POSE_ALFA, POSE_BLFA
DECL INT POSE_CLFB ;> KRL101?
ENDDAT
"""
    cell = "DEF CELL()\nPOSE_ALFA = 1\nPOSE_BLFA = 1\nPOSE_CLFA = 1\nPOSE_CLFA = 2\nEND"
    agrees({"cell.dat": data, "cell.src": cell}, is_complete=None)


@pytest.mark.parametrize("declared", ["eki_status", "EKI_STATUS"])
def test_a_wrong_letter_in_a_prefix(agrees: Agrees, declared: str) -> None:
    """It is told where no other name has that prefix, in any letter case."""
    cell = f"DEF CELL()\nINT {declared}, eki_mode\nrki_status = 1 ;> KRL101?\nEND"
    agrees({"cell.src": cell}, is_complete=None, ignored=("KRL702",))


def test_a_declaration_with_a_wrong_letter_in_its_prefix(agrees: Agrees) -> None:
    """It is told where the prefix of the use is usual and that of the declaration is not."""
    cell = """DEF CELL()
ROS_INIT()
ROS_INIT()
ROS_OPEN()
END
DEF TOS_INIT() ;> KRL102?
END
DEF ROS_OPEN()
END"""
    agrees({"cell.src": cell}, is_complete=None)


def test_two_undeclared_names_are_not_slips_of_one_another(agrees: Agrees) -> None:
    """Where other numbers are written the name with the usual letters is the right one."""
    cell = """DEF CELL()
PTP CNC_POINT1
PTP CNC_POINT2
PTP CNC_POINT3
PTP CNC_POIT4 ;> KRL101?
PTP CNC_POINT4
END"""
    agrees({"cell.src": cell}, is_complete=None, ignored=("KRL701", "KRL702"))


def test_a_suggested_name_has_the_letter_case_of_the_misspelt_one() -> None:
    """Spelling compares names in upper case."""
    texts = ["DEF A()\ngPointOne = 1\nEND\n", "DEF B()\ngPointOne = 1\nEND\n"]
    assert "gPointOne" == spelling_of(Source(text, text) for text in texts).meant("gPoitOne")


def test_a_sign_is_not_suggested_for_a_name_with_another_mistake(
    finds: Callable[..., list[Diagnostic]],
) -> None:
    """A variable in scope is nearer than a system variable that also lacks its dollar sign."""
    cell = "DEF CELL()\nINT OU\nOU = 1\nOUU = OU\nOUTT = OU\nIN[1] = TRUE\nEND"
    fixes = [one.fix.text for one in finds({"cell.src": cell}) if one.code == "KRL101" and one.fix]
    assert ["did you mean OU?", "did you mean $IN?"] == fixes


def found_in(files: dict[str, str]) -> list[tuple[str, int, str]]:
    """The errors and warnings in files that need not be readable."""
    contents = [Content(path, "", text.encode()) for path, text in files.items()]
    found = found_in_project(contents, recheck(contents, CheckOptions(), {}))
    return [(one.path, one.region.line, one.code) for one in found if one.severity != "note"]


CUT = "DEFDAT $CONFIG\nDECL GLOBAL INT PARTS=0\nDECL GLOBAL IN"
UNREAD = "DEFDAT CELL PUBLIC )\nDECL GLOBAL INT GRIPPED=0\nENDDAT\n"


@pytest.mark.parametrize(("line", "count"), [("J = N", 0), ("J = K", 1)])
def test_a_line_that_cannot_be_read_does_not_miss_a_data_list(line: str, count: int) -> None:
    """A name shows that the data list is missing only if no unreadable line may declare it."""
    contents = [Content("cell.src", "", f"DEF CELL()\nINT J N\n{line}\nEND\n".encode())]
    found = found_in_project(contents, recheck(contents, CheckOptions(), {}))
    assert count == [one.code for one in found].count("KRL702")


@pytest.mark.parametrize("other", ["J = = #PLCAE\nEND\n", "HALT\n"])
def test_what_cannot_be_read_may_use_a_declaration(other: str) -> None:
    """Then it has no slip for certain, and the uses are told."""
    found = found_in({"$config.dat": ENUM, "a.src": PLACES, "b.src": f"DEF B()\n{other}"})
    assert [2, 3] == [line for path, line, _ in found if path == "a.src"]
    assert "$config.dat" not in [path for path, *_ in found]


@pytest.mark.parametrize(("line", "is_slip"), [("HALT", True), ("CUNTER = = 1", False)])
def test_a_line_that_cannot_be_read_may_use_a_variable(line: str, is_slip: bool) -> None:
    """Then it is not declared by a slip for certain."""
    found = found_in({"a.src": f"DEF A()\nINT CUNTER\nCOUNTER = 1\nCOUNTER = 2\n{line}\nEND\n"})
    assert is_slip == (("a.src", 2, "KRL101") in found)


@pytest.mark.parametrize(("more", "count"), [("", 1), (", PLAEC", 0)])
def test_a_slip_has_one_name_that_is_near(more: str, count: int) -> None:
    """Of two declarations that are near neither is wrong for certain."""
    found = found_in({"$config.dat": ENUM.replace("PLCAE", f"PLCAE{more}"), "a.src": PLACES})
    assert count == [path for path, *_ in found].count("$config.dat")
    uses = "PLACE = 1\n" * 5 + "END\n"
    data = f"DEFDAT B PUBLIC\nDECL GLOBAL INT PLCAE{more}\nENDDAT\n"
    assert count == [
        path for path, *_ in found_in({"a.src": f"DEF A()\n{uses}", "b.dat": data})
    ].count("b.dat")
    found = found_in({"a.src": f"DEF A()\nINT PLCAE{more}\n{uses}"})
    assert count == [line for _, line, _ in found].count(2)


def test_a_slip_in_a_declaration_that_moved() -> None:
    """Findings that were kept lead to the file that declares it now."""
    slip = "DECL GLOBAL INT RECIEVED=0\n"
    program = "DEF A()\n" + "RECEIVED = 1\n" * 5 + "END\n"
    one, two = (
        [
            Content(path, "", text.encode())
            for path, text in (
                ("a.src", program),
                ("b.dat", f"DEFDAT B PUBLIC\n{first}ENDDAT\n"),
                ("c.dat", f"DEFDAT C PUBLIC\n{second}ENDDAT\n"),
            )
        ]
        for first, second in ((slip, ""), ("", slip))
    )
    known = recheck(one, CheckOptions(), {})
    found = found_in_project(two, recheck(two, CheckOptions(), {0: known[0]}))
    assert ["c.dat"] == [diagnostic.path for diagnostic in found if diagnostic.severity != "note"]


WATCHED = "DEF A()\nINTERRUPT DECL 5 WHEN $IN[1] DO B()\n"
MAIN = "DEF MAIN()\n  GRIPPED = 1\n  PARTS = OTHERS\n  CELL(1)\nEND\n"


OPEN = "DEFDAT $CONFIG PUBLIC\nGLOBAL ENUM JOB PICK, {}\nGLOBAL STRUC BOX INT SIDE, {}\nENDDAT\n"
JOBS = "DEF A()\nDECL JOB J\nDECL BOX B\nJ=#PICK\nJ=#PALCE\nJ=5\nB.HIGH=1\nB.SIDE=TRUE\nEND\n"


def test_a_type_whose_line_is_damaged_is_one_with_other_members() -> None:
    """What is read of its line is known, and what is lost may be anything."""
    damaged = found_in({"$config.dat": OPEN.format("5", "REAL"), "a.src": JOBS})
    config = [("$config.dat", line, "KRL001") for line in (2, 3)]
    wrong = [("a.src", line, "KSS1446") for line in (6, 8)]
    assert [*config, *wrong] == damaged


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        ({"R1/System/$config.dat": CUT, "R1/main.src": MAIN}, [("R1/System/$config.dat", 3)]),
        ({"cell.dat": UNREAD, "main.src": MAIN}, [("cell.dat", 1)]),
        ({"cell.src": "DEF CELL(A:IN =)\nEND\n", "main.src": MAIN}, [("cell.src", 1)]),
        ({"a.src": "DEF A()\nGOTO FAR\nX = 1\n;FOLD\n"}, [("a.src", 4)]),
        ({"a.src": WATCHED}, [("a.src", 2)]),
        ({"a.src": f"{WATCHED}INTERRUPT ON ON 5\nEND\nDEF B()\nEND\n"}, [("a.src", 3)]),
        (
            {"a.src": f"{WATCHED}END\n", "b.src": "DEFFCT (\nINTERRUPT ON 5\n$OUT[1]=TRUE\n"},
            [("b.src", 1)],
        ),
    ],
)
def test_what_is_damaged_is_reported_alone(
    files: dict[str, str], expected: list[tuple[str, int]]
) -> None:
    """What a damaged line or a cut file may have declared is missed nowhere else."""
    assert expected == [(path, line) for path, line, _ in found_in(files)]


def test_a_missing_data_list_may_hide_what_is_global() -> None:
    """Where a program lacks its own data, those of others with such names have no certain type."""
    config = "DEFDAT $CONFIG\nDECL GLOBAL INT I[20]\nENDDAT\n"
    main = "DEF MAIN()\n  UNKNOWN_A = UNKNOWN_B\n  I = 1\nEND\n"
    files = {"R1/System/$config.dat": config, "R1/main.src": main}
    assert [] == found_in(files)
    assert [("R1/main.src", 3, "KSS2052")] == found_in(
        {**files, "R1/main.dat": "DEFDAT MAIN\nDECL INT UNKNOWN_A\nDECL INT UNKNOWN_B=0\nENDDAT\n"}
    )


def test_a_type_that_is_not_at_hand_may_have_a_constant() -> None:
    """What it has is unknown, so the initial value of its variable is no slip of another name."""
    main = "DEF MAIN()\n  HALT\nEND\n"
    data = "DEFDAT MAIN\nDECL {} X=#GIVE_STOPP\nENUM OWN GIVE_STOP, GIVE_WAY\nENDDAT\n"
    for type_, expected in (
        ("REMOTE", []),
        ("OWN", [("main.dat", 2, "KSS2296")]),
    ):
        assert expected == found_in({"main.src": main, "main.dat": data.format(type_)})


@pytest.mark.parametrize(
    ("name", "mark"),
    [("rte", "101?"), ("rett", "101?"), ("rat", "101?"), ("et", "101?"), ("ran", "701-")],
)
def test_a_short_variable_may_be_a_slip(agrees: Agrees, name: str, mark: str) -> None:
    """One with two other letters may be another variable, whose file is missing."""
    cell = f"""DEF CELL()
  INT RET
  RET = 1
  IF RET == 1 THEN
    {name} = 2 ;> KRL{mark}
  ENDIF
END"""
    agrees({"R1/cell.src": cell, "R1/cell.dat": DATA}, is_complete=None)
