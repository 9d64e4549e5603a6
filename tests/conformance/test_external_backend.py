"""Executors and robots of others prove themselves; those that are wrong do not."""

from dataclasses import replace
from typing import Any

import pytest

from conformance import external_backend
from conformance.external_backend import NotConforming, prove
from conformance.suite.case import Case
from interp.port.requests import Request, Wait
from interp.robot.simulation.robot import KinematicRobot
from interp.tree.executor import TreeExecutor


@pytest.fixture(autouse=True)
def _cases_are_read_once(own_cases: list[Case], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(external_backend, "find_cases", lambda _folder: own_cases)


class Hasty(TreeExecutor):
    """Waits half as long."""

    def advance(self, reply: Any = None) -> Request:
        """As ours, but for its waits."""
        request = super().advance(reply)
        return (
            replace(request, seconds=request.seconds / 2) if isinstance(request, Wait) else request
        )


def test_executor_that_does_as_ours_conforms() -> None:
    """One line is all it takes."""
    proof = prove(executor=TreeExecutor, select=["io/wait_seconds", "control/exit_for"])
    proof.assert_conforms()
    assert 2 == len(proof.results)


def test_executor_that_does_otherwise_is_reported_where() -> None:
    """The cases that fail are named, those that it meets are not."""
    proof = prove(executor=Hasty, select=["io/wait_seconds", "control/exit_for"])
    with pytest.raises(NotConforming, match=r"io/wait_seconds: wait_seconds\.src:5") as raised:
        proof.assert_conforms()
    assert "exit_for" not in str(raised.value)


def test_robot_that_does_as_ours_conforms() -> None:
    """A robot is asked for paths."""
    proof = prove(robot=lambda _machine, cycle: KinematicRobot(cycle), select=["motion/lin_speed"])
    proof.assert_conforms()


def test_cases_that_are_all_skipped_prove_nothing() -> None:
    """An executor alone has no path to show."""
    with pytest.raises(NotConforming, match="no case could be evaluated"):
        prove(executor=TreeExecutor, select=["motion/tracking_lin"]).assert_conforms()
    with pytest.raises(ValueError, match="give an executor"):
        prove()
