"""What option packages declare for a project."""

from grammar.semantics.link import File, Project, link
from grammar.semantics.scopes import Found, Undetermined
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.references import Space


def project(*texts: str, packages: frozenset[str] | None = frozenset()) -> Project:
    files = []
    for number, text in enumerate(texts):
        syntax = read_module(text, f"M{number}.src")
        assert isinstance(syntax, ast.Module)
        files.append(File(f"M{number}.src", syntax))
    (linked,) = link(files, packages=packages).projects
    return linked


CALLS = "DEF M0()\nDECL EKI_STATUS RET\nRET = EKI_OPEN({})\nEND\n".format('"A"')


def test_a_called_package_is_there() -> None:
    """One routine that is called and not declared brings all routines and types of its package."""
    known = project(CALLS)
    assert frozenset({"EKI"}) == known.packages
    scope = known.scope(known.modules[0])
    assert isinstance(scope.find(Space.ROUTINE, "EKI_GETREAL"), Found)
    status = scope.find(Space.TYPE, "EKI_STATUS")
    assert isinstance(status, Found)
    assert isinstance(scope.find(Space.ROUTINE, "RSI_CREATE"), Undetermined)


def test_a_package_is_named() -> None:
    """A package that is named is there though nothing of it is called."""
    known = project("DEF M0()\nEND\n", packages=frozenset({"RSI"}))
    assert isinstance(known.scope(known.modules[0]).find(Space.ROUTINE, "RSI_CREATE"), Found)


def test_files_count_more() -> None:
    """What a file declares is meant, and a project that declares the routine needs no package."""
    own = "DEF M1()\nEND\nGLOBAL DEF EKI_OPEN(A:IN)\nDECL INT A\nEND\n"
    known = project(CALLS, own)
    assert frozenset() == known.packages
    found = known.scope(known.modules[0]).find(Space.ROUTINE, "EKI_OPEN")
    assert isinstance(found, Found)
    assert found.module is not None


def test_a_run_knows_no_packages() -> None:
    """Where packages are not asked for, nothing is declared that no file has."""
    known = project(CALLS, packages=None)
    scope = known.scope(known.modules[0])
    assert isinstance(scope.find(Space.ROUTINE, "EKI_OPEN"), Undetermined)


def test_every_controller_has_bas() -> None:
    """Routines of inline forms are known without their files, and only where they are missing."""
    text = "DEF M0()\nBAS(#INITMOV, 0)\nEND\n"
    known = project(text)
    found = known.scope(known.modules[0]).find(Space.ROUTINE, "BAS")
    assert isinstance(found, Found)
    assert found.module is None
    known = project(text, "DEF M1()\nEND\nGLOBAL DEF BAS(A:IN)\nEND\n")
    found = known.scope(known.modules[0]).find(Space.ROUTINE, "BAS")
    assert isinstance(found, Found)
    assert found.module is not None
