"""Verdicts: the outcome of a case on one executor and robot, and the known failures.

==============  ==================================================================================
pass            no expectation is unmet, and one about something that happens is met
fail            an expectation is not met, or executors differ, or a known failure passes
unconfirmed     an expectation is not met, but its basis is not certain enough to fail an executor
known-failure   an expectation is not met, and ``known_failures.toml`` gives the reason
skipped         no expectation could be evaluated, or only what does not happen was seen
==============  ==================================================================================
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Final, Literal, get_args

from conformance.evaluation.evaluator import Check

Verdict = Literal["pass", "fail", "unconfirmed", "known-failure", "skipped"]
VERDICTS: Final[tuple[Verdict, ...]] = get_args(Verdict)
_FILE: Final = Path(__file__).parents[1] / "known_failures.toml"


@dataclass(frozen=True, slots=True)
class Known:
    """A known failure: the case, patterns of executors and robots, and the reason."""

    case: str
    reason: str
    executor: str = "*"
    robot: str = "*"


@dataclass(frozen=True, slots=True)
class KnownFailures:
    """All known failures."""

    entries: tuple[Known, ...] = ()

    @staticmethod
    def load(path: Path = _FILE) -> KnownFailures:
        """Return the known failures in a file; raise `ValueError` for a malformed file."""
        data: Mapping[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
        try:
            return KnownFailures(tuple(Known(**entry) for entry in data.get("known", ())))
        except TypeError as error:
            raise ValueError(f"{path}: {error}") from error

    def reason(self, case: str, executor: str, robot: str) -> str:
        """Return the reason of a known failure; "" if the failure is not known."""
        for one in self.entries:
            if (
                one.case == case
                and fnmatchcase(executor, one.executor)
                and fnmatchcase(robot, one.robot)
            ):
                return one.reason
        return ""

    def of_no_case(self, names: Iterable[str]) -> list[str]:
        """Return entries about cases that do not exist."""
        known = set(names)
        return [one.case for one in self.entries if one.case not in known]


def verdict_of(checks: Sequence[Check], known: str = "") -> tuple[Verdict, str]:
    """Return the verdict of a case and its reason, from the checks of its expectations."""
    unmet = [one for one in checks if one.state == "unmet"]
    if unmet:
        first = next((one for one in unmet if one.is_sure), unmet[0])
        reason = f"line {first.line}: {first.text}; seen: {first.actual or 'nothing'}"
        if known:
            return "known-failure", known
        return ("fail" if first.is_sure else "unconfirmed"), reason
    main = [one for one in checks if not one.is_absence] or checks
    if all(one.state == "open" for one in main):
        return "skipped", main[0].actual if main else "nothing is expected"
    if known:
        return "fail", f"it passes, though it is listed as a known failure: {known}"
    return "pass", ""
