"""The pytest plug-in: ``test_*.toml`` and ``test_*.src`` are tests of robot programs.

It comes with the installed package, so ``pytest tests/cell`` collects them. The packages that run
programs are only imported if there is such a file.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from krl.hidden_packages import hiding_package

if TYPE_CHECKING:
    from krl.program_tests.test_files import ProgramTest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of `krl test` to pytest."""
    group = parser.getgroup("krl", "tests of robot programs in KRL")
    group.addoption("--krl-executor", choices=("tree", "vm", "native"), help="who executes them")
    group.addoption("--krl-update", action="store_true", help="record what tests do anew")
    group.addoption("--krl-cov-html", type=Path, metavar="DIR", help="page of lines and branches")
    group.addoption("--krl-lcov", type=Path, metavar="FILE", help="coverage in the form of lcov")


def pytest_configure(config: pytest.Config) -> None:
    """Register the summary of coverage and recordings in the reporting process."""
    config.pluginmanager.register(_Summary(config), "krl_summary")


def pytest_collect_file(parent: pytest.Collector, file_path: Path) -> ProgramTestFile | None:
    """Return a collector if the file has tests of robot programs."""
    if not file_path.name.lower().startswith("test_") or file_path.suffix.lower() not in (
        ".toml",
        ".src",
    ):
        return None
    if hiding := hiding_package():  # tests are imported from folders with packages of their own
        raise parent.CollectError(hiding)
    from krl.errors import one_line
    from krl.program_tests.test_files import is_test_file

    if not is_test_file(file_path):
        return None
    # pytest prints names and writes them to JUnit as they are, and a name may steer a terminal
    root = parent.config.rootpath
    place = file_path.relative_to(root) if file_path.is_relative_to(root) else file_path
    plain = one_line(place.as_posix()).replace("::", ":")
    found: ProgramTestFile = ProgramTestFile.from_parent(parent, path=file_path, nodeid=plain)
    return found


class ProgramTestFile(pytest.File):
    """A test file with an item for each test."""

    @cached_property
    def tests(self) -> tuple[ProgramTest, ...]:
        """The tests of the file; raises `krl.program_tests.test_files.TestFileError`."""
        from krl.program_tests.test_files import read_tests

        return read_tests(self.path)

    def collect(self) -> Iterator[ProgramTestItem]:
        """Yield the items; raises `pytest.Collector.CollectError` if that is impossible."""
        from krl.errors import InputError, one_line
        from krl.extras import ARM, need
        from krl.program_tests.test_files import TestFileError

        try:
            need(*ARM)
            tests = self.tests
        except (InputError, TestFileError) as error:
            raise self.CollectError(one_line(str(error))) from error
        for test in tests:
            yield ProgramTestItem.from_parent(self, name=one_line(test.name), test=test)


class _Failed(Exception):
    """A test has failed; the message is the text to print."""


class ProgramTestItem(pytest.Item):
    """A test of a robot program."""

    def __init__(self, *, test: ProgramTest, **rest: Any) -> None:
        super().__init__(**rest)
        self.test = test
        self.coverage: Any = None
        self.recorded: tuple[str, ...] = ()

    def runtest(self) -> None:
        """Run the test; raises `_Failed` with what was not as expected."""
        from krl.program_tests.execution import run_test
        from krl.program_tests.test_files import TestFileError

        file = self.getparent(ProgramTestFile)
        assert file is not None, "items are made by files"
        options = self.config.option
        try:
            outcome = run_test(
                self.test, file.tests, executor=options.krl_executor, update=options.krl_update
            )
        except TestFileError as error:
            raise _Failed(str(error)) from error
        if options.krl_cov_html is not None or options.krl_lcov is not None:
            self.coverage = {outcome.files[path]: one for path, one in outcome.coverage.items()}
        self.recorded = outcome.recorded
        if outcome.failures:
            raise _Failed("\n".join(outcome.failures))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], *_: Any) -> Any:
        """Return what was expected and observed, without a traceback."""
        from krl.errors import shown

        if isinstance(excinfo.value, _Failed):
            return "\n".join(map(shown, _from_here(self.config, str(excinfo.value)).split("\n")))
        return super().repr_failure(excinfo)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the location and the name of the test."""
        from krl.errors import one_line

        return Path(one_line(str(self.path))), self.test.line - 1, self.name


def _from_here(config: pytest.Config, text: str) -> str:
    """Return a text with paths relative to where pytest was called."""
    return text.replace(f"{config.invocation_params.dir}{os.sep}", "")


class _Summary:
    """Collects coverage and recordings with the reports of tests, and sums them up."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._records: list[Any] = []
        self._recorded: list[str] = []

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item) -> Generator[None, Any, Any]:
        """Attach coverage and recordings to the report, which is sent to the main process."""
        report = yield
        if isinstance(item, ProgramTestItem) and report.when == "call":
            report.krl_coverage, report.krl_recorded = item.coverage, item.recorded
        return report

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Collect them from the report of a test, from this process or another."""
        if getattr(report, "krl_coverage", None):
            self._records.append(report.krl_coverage)
        self._recorded += getattr(report, "krl_recorded", ())

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Write the requested files and name them; print what was recorded."""
        if self._recorded:
            from krl.errors import shown

            for line in self._recorded:
                terminalreporter.write_line(shown(_from_here(self._config, line)))
        html, lcov = self._config.option.krl_cov_html, self._config.option.krl_lcov
        if html is None and lcov is None:
            return
        from krl.program_tests.coverage_files import covered_files
        from reports.programs.coverage_page import write_coverage_page, write_lcov

        files = covered_files(self._records)
        if html is not None:
            page = write_coverage_page(files, len(self._records), html)
            terminalreporter.write_line(f"coverage: {page}")
        if lcov is not None:
            write_lcov(files, lcov)
            terminalreporter.write_line(f"coverage: {lcov}")
