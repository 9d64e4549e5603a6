"""`krl test`: unit tests of robot programs, which pytest collects, runs and reports."""

import xml.etree.ElementTree as ET
from importlib import metadata
from itertools import takewhile
from pathlib import Path
from typing import Annotated

import typer

from krl.errors import InputError
from krl.extras import ARM, expected_extras
from krl.running.run_options import ExecutorOption
from support.files.atomic_write import write_atomic

_NO_TEST = "no test of a robot program: test_*.toml or test_*.src"
_PLUGIN = "krl.program_tests.pytest_plugin"
#: The exit statuses of pytest if all tests passed, some failed, and there was none.
_PASSED, _FAILED, _NONE = 0, 1, 5


def run_tests(
    paths: Annotated[list[str] | None, typer.Argument(metavar="[PATH]...")] = None,
    select: Annotated[str | None, typer.Option("-k", metavar="WORDS")] = None,
    stop: Annotated[bool, typer.Option("-x")] = False,
    processes: Annotated[str | None, typer.Option("-n", metavar="N")] = None,
    update: bool = False,
    executor: ExecutorOption = None,
    junit: Annotated[Path | None, typer.Option(metavar="FILE.xml")] = None,
    cov_html: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    lcov: Path | None = None,
) -> int:
    """Run unit tests of robot programs: `test_*.toml` and `test_*.src` below the paths.

    Arguments after `--` are passed to pytest, which runs the tests; `pytest PATH` collects them
    too. Exit status 0 if all pass, 1 if one fails, 2 if a file cannot be used or there is no test.

    Options:
        paths: Test files and folders; default: the current folder.
        select: Only tests with these words in their name.
        stop: Stop at the first test that fails.
        processes: Number of processes (pytest-xdist).
        update: Record the expected results of recorded tests again.
        junit: Write results as JUnit XML.
        cov_html: Write a page of covered lines and branches.
        lcov: Write coverage for lcov.
    """
    files = [Path(word.partition("::")[0]) for word in takewhile(_is_path, paths or ())]
    for file in files:
        if not file.exists():
            raise InputError(f"{file}: no such file or folder")
    # KRL has no assert statements, and pytest would rewrite those of our own modules
    arguments = ["--assert=plain", "-o", "python_files=", "-o", "junit_suite_name=krl"]
    for option, value in (
        ("-k", select),
        ("-n", processes),
        ("--krl-executor", executor and executor.value),
        ("--junitxml", junit),
        ("--krl-cov-html", cov_html),
        ("--krl-lcov", lcov),
    ):
        arguments += [] if value is None else [option, str(value)]
    arguments += ["-x"] * stop + ["--krl-update"] * update
    with expected_extras("pytest", *ARM, *["xdist"] * (processes is not None)):
        import pytest

        from krl.program_tests.test_files import is_test_file

        for file in files:
            if not file.is_dir() and not is_test_file(file):
                raise InputError(f"{file}: {_NO_TEST}")
        installed = metadata.entry_points(group="pytest11")
        if all(one.value != _PLUGIN for one in installed):  # a checkout that was not installed
            arguments += ["-p", _PLUGIN]
        status = int(pytest.main([*arguments, *(paths or ["."])]))
    if junit is not None and junit.is_file():
        write_atomic(junit, _in_order(junit.read_bytes()))
    if status == _NONE:
        raise InputError(_NO_TEST)
    return status if status in (_PASSED, _FAILED) else 2


def _is_path(word: str) -> bool:
    return not word.startswith("-")


def _in_order(report: bytes) -> bytes:
    """Return a JUnit report with tests sorted by file and name; processes end in any order."""
    whole = ET.fromstring(report)
    for suite in whole:
        suite[:] = sorted(suite, key=lambda test: (test.get("classname", ""), test.get("name", "")))
    return bytes(ET.tostring(whole, encoding="utf-8", xml_declaration=True))
