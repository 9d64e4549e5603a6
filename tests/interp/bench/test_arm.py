"""The program of the bench: motions as real ones are, and the strategies compared on it."""

import pytest

from interp.robot.api.batch import BatchCore

pytest.importorskip("ruckig")
pytest.importorskip("scipy")

from interp.bench.arm import drive, motions


def test_the_program_has_all_kinds_of_motion() -> None:
    """It is as long as asked for, begins with a PTP of axes, and blends most of its motions."""
    program = motions(200)
    assert list(range(1, 201)) == [motion.number for motion in program]
    assert {"PTP", "LIN", "CIRC"} == {motion.kind for motion in program}
    assert "A1" in program[0].target
    assert 0.75 < sum(bool(motion.criteria) for motion in program) / 200 < 0.9


def test_a_batch_costs_time() -> None:
    """A program that takes time between its motions is later at its end in batches.

    How much is what the first batch waits for: five motions more than with look-ahead, 12 ms each.
    """
    program = motions(8)
    ahead, _ = drive(program, "none", thinking=12_000)
    batched, _ = drive(program, "none", BatchCore, thinking=12_000)
    assert 12_000 <= batched - ahead <= 12_000 * 8
    at_once, _ = drive(program, "none", BatchCore)
    assert at_once < batched
