"""pytest plug-in that makes case files tests: ``pytest conformance/cases`` runs all of them.

A ``conftest.py`` next to the cases activates it: ``from conformance.pytest_plugin import
pytest_collect_file``. Each executor and robot is a separate item. By default all available
executors run without a robot; the environment variable KRL_CONFORM_SETUPS chooses others:
``tree/none vm/none tree/kinematic``.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import pytest

from conformance.evaluation.execution import EXECUTORS, FRONT, Setup, missing
from conformance.evaluation.verdicts import KnownFailures
from conformance.runner import Result, run_case
from conformance.suite.case import ENDINGS, Case, CaseError, read_case

_VARIABLE: Final = "KRL_CONFORM_SETUPS"


def pytest_collect_file(parent: pytest.Collector, file_path: Path) -> CaseFile | None:
    """Return a collector for a file that begins with front matter."""
    if file_path.suffix.lower() not in ENDINGS:
        return None
    with file_path.open("rb") as file:
        if file.read(2) != b";@":
            return None
    found: CaseFile = CaseFile.from_parent(parent, path=file_path)
    return found


class CaseFile(pytest.File):
    """A case, with an item for each executor and robot."""

    def collect(self) -> Iterator[CaseItem]:
        """Yield the items; raise `pytest.Collector.CollectError` for an unreadable case."""
        try:
            case = read_case(self.path, self.path.parent.parent)
        except CaseError as error:
            raise self.CollectError(str(error)) from error
        setups = _setups() if case.phase == "run" else [Setup(FRONT, "none")]
        for setup in setups:
            name = f"{case.path.stem}[{setup.executor}-{setup.robot}]"
            yield CaseItem.from_parent(self, name=name, case=case, setup=setup)


class _NotMet(Exception):
    """A case has failed."""


class CaseItem(pytest.Item):
    """A case on one executor and robot."""

    def __init__(self, *, case: Case, setup: Setup, **rest: Any) -> None:
        super().__init__(**rest)
        self.case = case
        self.setup_of_case = setup

    def runtest(self) -> None:
        """Run the case; verdicts other than pass and fail are skipped or expected failures."""
        (result,) = run_case(self.case, [self.setup_of_case], KnownFailures.load()).results
        match result.verdict:
            case "fail":
                raise _NotMet(_failure(self.case, result))
            case "skipped":
                pytest.skip(result.reason)
            case "unconfirmed" | "known-failure":
                pytest.xfail(f"{result.verdict}: {result.reason}")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], *_: Any) -> Any:
        """Return what was expected and observed, without a traceback of our own code."""
        if isinstance(excinfo.value, _NotMet):
            return str(excinfo.value)
        return super().repr_failure(excinfo)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the place of the case, and its fact."""
        return self.path, None, f"{self.name}: {self.case.title}"


def _failure(case: Case, result: Result) -> str:
    lines = [f"{case.title} [{', '.join(case.rules)}]", result.reason]
    for check in result.checks:
        if check.state == "unmet":
            code = case.line(check.file, check.line)
            lines += [f"  {check.file}:{check.line}: {code}", f"    expected: {check.text}"]
            lines.append(f"    seen:     {check.actual or 'nothing'}")
    return "\n".join(lines)


def _setups() -> list[Setup]:
    wanted = os.environ.get(_VARIABLE, "")
    if wanted:
        pairs = [word.partition("/") for word in wanted.split()]
        return [Setup(executor, robot or "none") for executor, _, robot in pairs]
    return [one for name in EXECUTORS if not missing(one := Setup(name, "none"))]
