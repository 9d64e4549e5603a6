"""Expectations about the path of a motion: where it goes, how fast, how well it is followed."""

from __future__ import annotations

from conformance.expectations import Expectation
from conformance.judging_trace import Judged, Marks
from conformance.observation import Observation

__all__ = ["judge_path"]


def judge_path(one: Expectation, seen: Observation, marks: Marks) -> Judged:
    """Whether an expectation about the path is met."""
    return "open", "no path was recorded"
