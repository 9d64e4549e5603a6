"""The bench of the executors."""

from __future__ import annotations

import json
import math

import pytest

from interp.bench.executor_speed import MEASURED, measure_executors, steps
from interp.bench.kernels import KERNELS
from interp.executors import available


def test_record_of_the_bench() -> None:
    """Every executor that is here has a time, and the means are those of the ratios."""
    told: list[None] = []
    record = measure_executors(["fibonacci"], rounds=1, on_step=lambda: told.append(None))
    json.dumps(record, allow_nan=False)
    assert steps(["fibonacci"]) == len(told)
    (row,) = record["kernels"]
    assert set(MEASURED) == set(row["ns"])
    assert all(row["ns"][name] > 0 for name in available())
    assert math.isclose(row["ns"]["tree"] / row["ns"]["vm"], record["vm_vs_tree"])
    assert set(available()) == set(record["request_us"])
    if record["native"]:
        assert record["native_vs_tree"] > record["vm_vs_tree"] > 1


def test_work_of_a_recursion() -> None:
    """What is counted of Fibonacci numbers is how often the function is called."""

    def calls(number: int) -> int:
        return 1 if number < 2 else 1 + calls(number - 1) + calls(number - 2)

    assert [calls(n) for n in (1, 2, 5, 9)] == [KERNELS["fibonacci"].work(n) for n in (1, 2, 5, 9)]


@pytest.mark.parametrize("name", KERNELS)
def test_kernels_are_there_twice(name: str) -> None:
    """Each kernel is a function in KRL and one in Lua."""
    kernel = KERNELS[name]
    assert "DEFFCT INT WORK(N:IN)" in kernel.krl
    assert kernel.lua.rstrip().endswith("return work")
    assert kernel.work(kernel.small) < kernel.work(kernel.full)
