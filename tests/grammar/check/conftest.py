"""Programs that say themselves what a check has to find.

A comment ``;> KSS2296 KRL405? KRL209-`` at the end of a line names the codes that are found on it:
errors, warnings with a question mark, notes with a minus. Nothing else is found in the file.
"""

import re
from collections.abc import Callable, Mapping

import pytest

from grammar.check.project.framework import Checked, check_module
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.link import File, Project, link
from grammar.semantics.scopes import Module
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from tests.grammar.check.workspace_check import check

EXPECTED = re.compile(r";>(.*)")
MARKS = {"error": "", "warning": "?", "note": "-"}

#: Files by path, and whether the project is known to be complete.
Find = Callable[..., list[Diagnostic]]
Table = list[tuple[str, int, str]]


def sources(files: Mapping[str, str]) -> dict[str, Source]:
    return {path: Source(text, path) for path, text in files.items()}


def linked(files: Mapping[str, str], *, is_complete: bool | None) -> list[tuple[Project, Module]]:
    read = [File(path, _read(text, path)) for path, text in files.items()]
    return list(link(read, is_complete=is_complete).modules())


def _read(text: str, path: str) -> ast.Module:
    module = read_module(text, path)
    assert not isinstance(module, list), module
    return module


def find(
    files: Mapping[str, str],
    *,
    is_complete: bool | None = True,
    packages: frozenset[str] | None = None,
) -> list[Diagnostic]:
    """What the check of some files finds."""
    texts = sources(files)
    read = [File(path, _read(text, path)) for path, text in files.items()]
    analysis = link(read, is_complete=is_complete, packages=packages)
    return check(analysis, lambda module: texts[module.path])


def expected_in(files: Mapping[str, str]) -> Table:
    """What the comments of some files say is found."""
    return sorted(
        (path, number, code)
        for path, text in files.items()
        for number, line in enumerate(text.splitlines(), 1)
        for marked in EXPECTED.findall(line)
        for code in marked.split()
    )


#: What becomes of data: fragments of programs leave much unused and without a value.
OF_DATA = ("KRL117", "KRL217", "KRL409", "KRL515", "KRL516", "KRL704")


def found_in(
    diagnostics: list[Diagnostic], *, with_data: bool = False, ignored: tuple[str, ...] = ()
) -> Table:
    """The same from findings; codes of what stops the robot are another check's affair."""
    left_out = ("KRL6", *ignored) if with_data else ("KRL6", *OF_DATA, *ignored)
    return sorted(
        (one.path, one.region.line, one.code + MARKS[one.severity])
        for one in diagnostics
        if not one.code.startswith(left_out)
    )


@pytest.fixture(scope="session")
def agrees() -> Callable[..., None]:
    """Asserts that a file, or files by path, give what their comments say.

    A text alone is read as ``NEG.src``, one that begins with DEFDAT as ``NEG.dat``. What becomes of
    data counts only where that is asked for.
    """

    def assert_agrees(
        given: str | Mapping[str, str],
        *,
        is_complete: bool | None = True,
        packages: frozenset[str] | None = None,
        with_data: bool = False,
        ignored: tuple[str, ...] = (),
    ) -> None:
        if isinstance(given, str):
            text = given.strip()
            given = {"NEG.dat" if text.startswith("DEFDAT") else "NEG.src": text}
        assert expected_in(given) == found_in(
            find(given, is_complete=is_complete, packages=packages),
            with_data=with_data,
            ignored=ignored,
        )

    return assert_agrees


@pytest.fixture(scope="session")
def finds() -> Find:
    """What the check of files, by path, finds."""
    return find


@pytest.fixture(scope="session")
def checked() -> Callable[..., Checked]:
    """A file checked, with what is known of its tree, beside others of its project."""

    def check_one(
        text: str, path: str = "NEG.src", others: Mapping[str, str] | None = None
    ) -> Checked:
        files = {path: text, **(others or {})}
        for project, module in linked(files, is_complete=True):
            if module.path == path:
                return check_module(project, module, Source(text, path))
        raise AssertionError(path)

    return check_one
