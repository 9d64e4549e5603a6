"""Which files belong together, and what a name means in each of them."""

import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from grammar.notation.generate import GRAMMAR
from grammar.semantics.link import File, Project, Workspace, link
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Resolution, resolve
from grammar.semantics.scopes import Answer, Found, Module, NotFound, Reason, Undetermined
from grammar.semantics.symbol_table import table_of
from grammar.semantics.types import REAL, UNKNOWN, Array, Structure, Type
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.references import Space
from grammar.syntax.walk import walk

CORPUS = GRAMMAR.parents[1] / "corpus"
BROKEN = "?"


def file(path: str, text: str, origin: str = "") -> File:
    """A file to link; a ``?`` stands for one that cannot be read."""
    if text == BROKEN:
        return File(path, None, origin)
    module = read_module(text)
    assert isinstance(module, ast.Module), module
    return File(path, module, origin)


def workspace(texts: Mapping[str, str], is_complete: bool | None = None) -> Workspace:
    return link([file(path, text) for path, text in texts.items()], is_complete=is_complete)


def project(texts: Mapping[str, str], is_complete: bool | None = None) -> Project:
    (only,) = workspace(texts, is_complete).projects
    return only


def module(of: Project, path: str) -> Module:
    return next(module for module in of.modules if module.path == path)


def resolved(of: Project, path: str) -> Resolution:
    return resolve(of, module(of, path))


def use(of: Project, path: str, name: str, nth: int = -1) -> Answer:
    """The answer for the ``nth`` place of a name in a file, by default the last one."""
    answers = sorted(resolved(of, path).answers.items(), key=lambda item: item[0].span)
    return [answer for node, answer in answers if node.text == name][nth]


def declared_in(answer: Answer) -> str | None:
    """The path of the file that declares what was found."""
    assert isinstance(answer, Found), answer
    return answer.module.path if answer.module else None


def dat(name: str, *lines: str) -> str:
    return "\n".join((f"DEFDAT {name}", *lines, "ENDDAT", ""))


def src(head: str, *lines: str) -> str:
    return "\n".join((f"DEF {head}", *lines, "END", ""))


# ------------------------------------------------------------------------------------- scopes


def test_names_in_any_letter_case() -> None:
    """TYP-05: files, modules and names belong together whatever their letter case."""
    of = project({"Job.SRC": src("JOB()", "Count=1"), "JOB.dat": dat("job", "INT cOUNT=1")})
    assert "JOB.dat" == declared_in(use(of, "Job.SRC", "Count"))


def test_what_the_controller_has_is_not_hidden_by_ext() -> None:
    """EXTP of a predefined routine in a list of the controller leaves its name the routine's."""
    of = project(
        {
            "a.src": src("A()", "ERR_CLEAR($ERR)"),
            "$operate.dat": dat("$OPERATE", "EXTP ERR_CLEAR (ERROR_T PERR :OUT)"),
        }
    )
    answer = use(of, "a.src", "ERR_CLEAR")
    assert isinstance(answer, Found)
    assert answer.module is None


# ------------------------------------------------------------------------- types and members


def test_structures_in_a_circle() -> None:
    """A structure that holds itself, at once or by way of another, ends as an unknown type."""
    of = project({"a.dat": dat("A", "STRUC P_T Q_T Q", "STRUC Q_T P_T P", "STRUC S_T S_T S")})
    scope = of.scope(module(of, "a.dat"))
    for key in ("P_T", "Q_T", "S_T"):
        found = scope.own(Space.TYPE, key)
        assert found is not None
        assert isinstance(of.types.of(found), Structure)
        assert key == str(of.types.of(found))


def test_structures_of_many_structures() -> None:
    """Types are made once: wide circles and long chains of structures take no time."""
    members = ",".join(f"M{number}" for number in range(50))
    circle = [f"STRUC C{number} C{(number + 1) % 5} {members}" for number in range(5)]
    chain = [f"STRUC D{number} D{number + 1} A,B" for number in range(2_000)]
    of = project({"a.dat": dat("A", *circle, *chain, "STRUC D2000 INT N")})
    scope = of.scope(module(of, "a.dat"))
    for key in ("C0", "D0"):
        found = scope.own(Space.TYPE, key)
        assert found is not None
        assert key == str(of.types.of(found))


def test_found_is_one_object() -> None:
    """The same symbol is the same object, from wherever it is looked up."""
    of = project({"g.dat": dat("G PUBLIC", "DECL GLOBAL INT N=1"), "a.src": src("A()", "N=1")})
    near, far = (of.scope(module(of, path)).find(Space.VALUE, "N") for path in ("g.dat", "a.src"))
    assert near is far


def test_declared_system_data_come_before_what_is_predefined() -> None:
    """The machine data of the backup are those of its own release."""
    of = project({"$machine.dat": dat("$MACHINE PUBLIC", "INT $NUM_AX=6"), "a.src": src("A()")})
    assert "$machine.dat" == declared_in(of.scope(of.modules[1]).find(Space.VALUE, "$NUM_AX"))


# ----------------------------------------------------------------------------------- projects


def roots(of: Workspace) -> dict[str, list[str]]:
    return {found.root: [module.path for module in found.modules] for found in of.projects}


def test_two_backups_see_nothing_of_one_another() -> None:
    """Each backup of a call has data, routines and system data of its own."""
    one = {
        "one/KRC/R1/System/$config.dat": dat("$CONFIG", "INT N=1"),
        "one/KRC/R1/Program/a.src": src("A()", "N=1", "B()"),
        "one/KRC/R1/Program/b.src": src("B()"),
    }
    other = {path.replace("one/", "other/"): text for path, text in one.items()}
    other["other/KRC/R1/System/$config.dat"] = dat("$CONFIG", "REAL M=1.0")
    both = workspace(one | other)
    assert {"one/KRC": list(one), "other/KRC": list(other)} == roots(both)
    first, second = both.projects
    assert () == first.clashes + second.clashes
    path = "Program/a.src"
    assert "one/KRC/R1/System/$config.dat" == declared_in(use(first, f"one/KRC/R1/{path}", "N"))
    assert isinstance(use(second, f"other/KRC/R1/{path}", "N"), Undetermined)
    assert "other/KRC/R1/Program/b.src" == declared_in(use(second, f"other/KRC/R1/{path}", "B"))


def test_system_data_of_r1_and_steu_are_shared() -> None:
    """Both drives of a controller are one project, in any letter case and without KRC too."""
    of = project(
        {
            "cell/Steu/Mada/$custom.dat": dat("$CUSTOM PUBLIC", "INT N=1"),
            "cell/R1/Program/a.src": src("A()", "N=1"),
            "cell/R1/cell.src": src("CELL()", "A()"),
        }
    )
    assert "cell" == of.root
    assert of.is_controller
    assert "cell/Steu/Mada/$custom.dat" == declared_in(use(of, "cell/R1/Program/a.src", "N"))


def test_loose_files_with_several_configs() -> None:
    """A $CONFIG begins a project where there are several of them."""
    config = dat("$CONFIG", "INT N=1")
    found = workspace(
        {
            "one/System/$config.dat": config,
            "one/a.src": src("A()"),
            "two/$config.dat": config,
            "two/deep/a.src": src("A()"),
            "c.src": src("C()"),
        }
    )
    assert {"one": 2, "two": 2, "": 1} == {of.root: len(of.modules) for of in found.projects}


def test_origins_are_never_mixed() -> None:
    """Files of two origins are two projects, whatever their paths."""
    files = [file("a.src", src("A()", "B()"), "one"), file("b.src", src("B()"), "two")]
    first, second = link(files).projects
    assert isinstance(use(first, "a.src", "B"), Undetermined)
    assert "two" not in {module.path for module in second.modules}


def test_data_list_without_a_program() -> None:
    """A data list alone is a module: its GLOBAL data count, and its own names are looked up."""
    of = project({"points.dat": dat("POINTS PUBLIC", "DECL GLOBAL INT N=1", "DECL INT M=2")})
    assert () == resolved(of, "points.dat").open_uses
    assert of.data_of(of.modules[0]) is None


def test_same_module_in_two_folders() -> None:
    """The nearer one counts; between two that are equally near nobody can tell."""
    of = project(
        {
            "old/lib.src": src("LIB()"),
            "new/lib.src": src("LIB(N:IN)"),
            "new/deep/a.src": src("A()", "LIB(1)"),
            "c.src": src("C()", "LIB(1)"),
        }
    )
    assert "new/lib.src" == declared_in(use(of, "new/deep/a.src", "LIB"))
    answer = use(of, "c.src", "LIB")
    assert isinstance(answer, Undetermined)
    assert (Reason.AMBIGUOUS, 2) == (answer.reason, len(answer.candidates))
    (clash,) = of.clashes
    assert ["old/lib.src", "new/lib.src"] == list(map(declared_in, clash.declarations))


def test_data_lists_are_paired_within_their_folder() -> None:
    """Of two modules with the same name each has the data list beside it."""
    of = project(
        {
            **{f"{folder}/a.src": src("A()", "N=1") for folder in ("x", "y", "z")},
            **{f"{folder}/a.dat": dat("A", "INT N=1") for folder in ("x", "y")},
        },
        is_complete=True,
    )
    assert ["x/a.dat", "y/a.dat"] == [declared_in(use(of, f"{at}/a.src", "N")) for at in "xy"]
    assert isinstance(use(of, "z/a.src", "N"), NotFound)


# -------------------------------------------------------------------------------- what is missing


def test_every_use_of_an_unknown_name_is_open() -> None:
    """A name that is missing everywhere has an open use wherever it stands, in the file's order."""
    of = project({"a.src": src("A()", "VENDOR(1)", "N=1", "vendor(2)")})
    uses = resolved(of, "a.src").open_uses
    assert ["VENDOR", "N", "vendor"] == [use.name.text for use in uses]
    assert {"a.src"} == {use.module.path for use in uses}


def test_labels_and_members_are_open_too() -> None:
    """A label has its space; a member that its structure does not have has none."""
    of = project({"a.src": src("A()", "DECL FRAME F", "GOTO NOWHERE", "F.Q=1")})
    uses = resolved(of, "a.src").open_uses
    assert [(Space.LABEL, "NOWHERE"), (None, "Q")] == [(use.space, use.name.text) for use in uses]


def test_vendor_call_with_ext_counts_as_unknown() -> None:
    """What EXT announces and no file has is unknown as a whole, though its signature is known."""
    of = project({"a.src": src("A()", "EXT WORK (INT :IN)", "WORK(1)")})
    assert 1 == len(resolved(of, "a.src").open_uses)  # the announcement itself is no use


# ------------------------------------------------------------------------------- laws and costs


def test_tables_from_a_cache() -> None:
    """A file takes part with its tables alone; it can be referred to and is not resolved."""
    kept = file("b.src", src("B()"))
    assert kept.syntax is not None
    files = [file("a.src", src("A()", "B()")), File("b.src", None, table=table_of(kept.syntax))]
    (of,) = link(files).projects
    assert "b.src" == declared_in(use(of, "a.src", "B"))


def test_equal_files_share_their_tables() -> None:
    """Two copies of a module may share one table and remain two modules."""
    text = file("x/a.src", src("A()"))
    assert text.syntax is not None
    table = table_of(text.syntax)
    files = [File(f"{folder}/a.src", text.syntax, folder, table) for folder in ("x", "y")]
    paths = [declared_in(use(of, of.modules[0].path, "A")) for of in link(files).projects]
    assert ["x/a.src", "y/a.src"] == paths


def test_own_corpus_has_no_unresolved_names(corpus: Mapping[Path, str]) -> None:
    """Open are only calls of packages that a cell does not hold; whole backups have none at all."""
    programs = CORPUS / "programs"
    files = []
    for path, text in corpus.items():
        if programs in path.parents:
            place, read = path.relative_to(programs), read_module(text)
            tree = read if isinstance(read, ast.Module) else None
            files.append(File(place.as_posix(), tree, place.parts[0]))
    found = link(files)
    for of in found.projects:
        uses = [use for module in of.modules for use in resolve(of, module).open_uses]
        assert {Space.ROUTINE} >= {use.space for use in uses}, of.root
        assert not of.is_complete or not uses
    assert 3 <= sum(of.is_complete for of in found.projects)


def test_every_use_has_an_answer() -> None:
    """Variables, calls, types and labels all have answers, wherever in a statement they stand."""
    lines = (
        *("DECL T_T V", "INTERRUPT DECL 20+V WHEN V DO F(V)", "PTP V:V C_PTP", "WAIT FOR V"),
        *("TRIGGER WHEN PATH=V DELAY=V DO V=V PRIO=-1", "FOR V=V TO V STEP V", "ENDFOR", "F(,V)"),
        *("SPLINE WITH V=V", "SPL V WITH V=V", "TIME_BLOCK PART=V", "ENDSPLINE", "V[V,V].V=-V"),
        *("SWITCH V", "CASE V", "V[]=(V)", "DEFAULT", "RETURN V", "ENDSWITCH", "GOTO L", "L:"),
    )
    of = project({"a.src": src("A()", *lines)})
    tree = of.modules[0].syntax
    assert tree is not None
    answers = resolved(of, "a.src").answers
    names = [
        node.name if isinstance(node, ast.Variable | ast.Call | ast.Label) else node.label
        for node in walk(tree)
        if isinstance(node, ast.Variable | ast.Call | ast.Label | ast.Goto)
    ]
    assert len(lines) < len(names)
    assert all(name in answers for name in names)


@pytest.mark.parametrize(("release", "expected"), [("8.6", Array(REAL, (6,))), ("8.5", UNKNOWN)])
def test_release_of_the_controller(release: str, expected: Type) -> None:
    """What is predefined is that of the release which is asked for."""
    (of,) = link([file("a.src", src("A()", "$ACC_AXIS[1]=1"))], System.load(release)).projects
    found = use(of, "a.src", "$ACC_AXIS")
    assert isinstance(found, Found)
    assert expected == of.types.of(found)


def calls(files: list[File]) -> int:
    """How many calls it takes to link files and to look up all their names."""
    made = 0

    def count(_frame: object, event: str, _given: object) -> None:
        nonlocal made
        made += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        for of in link(files).projects:
            for one in of.modules:
                resolve(of, one)
    finally:
        sys.setprofile(before)
    return made


def test_cost_of_a_long_file() -> None:
    """Ten times the text takes ten times as many steps to link and resolve, and not a hundred."""
    names = [f"DECL INT N{number}" for number in range(50)]

    def of(count: int) -> list[File]:
        body = [f"N{number % 50}=N{number % 49}+F(B.X)" for number in range(count)]
        return [file("a.src", src("A()", *names, "DECL FRAME B", *body))]

    assert 12 * calls(of(300)) > calls(of(3_000))


def test_cost_of_many_copies() -> None:
    """Ten times as many copies of a module, and callers, take ten times the steps and not more."""
    lib, caller = file("lib.src", src("LIB()")), file("a.src", src("A()", *["LIB()"] * 20))

    def of(count: int) -> list[File]:
        return [
            File(f"{folder}/{number}/{name}", some.syntax)
            for folder, name, some in (("copies", "lib.src", lib), ("callers", "a.src", caller))
            for number in range(count)
        ]

    assert 12 * calls(of(40)) > calls(of(400))
