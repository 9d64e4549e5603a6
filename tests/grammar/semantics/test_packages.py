"""The table of option packages can be read, and says what it means."""

from grammar.semantics.packages import PackageParameter, load_packages
from grammar.semantics.predefined import System
from grammar.semantics.types import SCALARS
from grammar.syntax import ast
from grammar.syntax.build import read_module


def test_types_are_known() -> None:
    """Each type that a routine or a variable names is the controller's or a package's."""
    packages, system = load_packages(), System.load()
    named = {one.result for one in packages.routines.values() if one.result}
    named |= {one.type for one in packages.variables.values()}
    named |= {
        parameter.type for one in packages.routines.values() for parameter in one.parameters
    } - {"?"}
    unknown = named - set(SCALARS) - set(packages.types) - {n for n in named if n in system.types}
    assert set() == unknown


def test_declarations_are_krl() -> None:
    """The declarations of types can be read as KRL."""
    types = [one.declaration for one in load_packages().types.values()]
    found = read_module("\n".join(["DEFDAT X PUBLIC", *types, "ENDDAT", ""]))
    assert isinstance(found, ast.Module)


def test_nothing_is_reported_twice() -> None:
    """What a package brings along is no function of the controller itself."""
    assert [] == [name for name in load_packages().routines if name in System.load().functions]


def test_optional_parameters() -> None:
    """A parameter with a question mark behind IN may be left out."""
    assert (
        PackageParameter("CHANNEL", "CHAR", True, False, False),
        PackageParameter("PATH", "CHAR", True, False, True),
        PackageParameter("LENGTH", "INT", False, False, True),
    ) == load_packages().routines["EKI_SEND"].parameters
