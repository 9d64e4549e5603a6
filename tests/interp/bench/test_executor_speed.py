"""The bench of the executors."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from interp.bench.executor_speed import (
    MEASURED,
    MeasurementError,
    measure_executors,
    steps,
)
from interp.bench.kernels import Kernel, kernels_in
from interp.executors import available

SUM = """; What is added up.
DEFFCT INT WORK(N:IN)
   DECL INT N, I, SUM
   SUM = 0
   FOR I = 1 TO N
      SUM = SUM + {}
   ENDFOR
   RETURN SUM
ENDFCT
"""


@pytest.fixture(autouse=True)
def _little_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first amount is enough: what is stated here does not hang on how long it takes."""
    monkeypatch.setattr("interp.bench.executor_speed._LEAST", 0.0)
    monkeypatch.setattr("interp.bench.executor_speed._CONTROLLED", 0.0)
    monkeypatch.setattr("interp.bench.executor_speed._COUNTS", (2, 80))
    monkeypatch.setattr("interp.bench.executor_speed._REQUESTS", 200)


def test_record_of_the_bench(tmp_path: Path) -> None:
    """Every executor that is here has a time, and the means are those of the ratios."""
    (tmp_path / "sum.src").write_text(SUM.format("N"))
    (tmp_path / "sum.py").write_text("def work(n):\n    return n * n\n")
    kernels = list(kernels_in(tmp_path).values())
    told: list[None] = []
    record = measure_executors(kernels, rounds=1, on_step=lambda: told.append(None))
    json.dumps(record, allow_nan=False)
    assert steps(kernels) == len(told)
    (row,) = record["kernels"]
    assert set(MEASURED) == set(row["ns"])
    assert all(row["ns"][name] > 0 for name in (*available(), "python"))
    assert row["ns"]["lua"] is None
    assert set(available()) <= set(row["start_ms"])
    assert math.isclose(row["ns"]["tree"] / row["ns"]["vm"], record["vm_vs_tree"])
    assert set(available()) == set(record["request_us"])
    assert all(times > 0 for times in record["controlled_vs_bare"].values())


def test_results_that_differ(tmp_path: Path) -> None:
    """A kernel that does something else in another language is not measured."""
    (tmp_path / "sum.src").write_text(SUM.format("N"))
    (tmp_path / "sum.py").write_text("def work(n):\n    return n * n + 1\n")
    with pytest.raises(MeasurementError, match="the results differ"):
        measure_executors(list(kernels_in(tmp_path).values()), rounds=1)


def test_kernel_that_fails(tmp_path: Path) -> None:
    """A kernel that fails at once is named with the line and the fault."""
    (tmp_path / "index.src").write_text(
        SUM.format("N").replace("RETURN", "SUM = 7 / (1 - N)\nRETURN")
    )
    with pytest.raises(MeasurementError, match="index: tree stops at line 8: division by zero"):
        measure_executors(list(kernels_in(tmp_path).values()), rounds=1)


def test_amount_that_fails_at_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a kernel cannot do more, the most that it does is measured."""
    monkeypatch.setattr("interp.bench.executor_speed._LEAST", math.inf)
    (tmp_path / "index.src").write_text(
        SUM.format("N").replace("RETURN", "SUM = 7 / (4 - N)\nRETURN")
    )
    record = measure_executors(list(kernels_in(tmp_path).values()), rounds=1)
    assert [3] == [row["amount"] for row in record["kernels"]]


@pytest.mark.parametrize("kernel", kernels_in().values(), ids=list(kernels_in()))
def test_kernels_in_three_languages(kernel: Kernel) -> None:
    """Each kernel of this project is a function in KRL, in Lua and in C."""
    assert "DEFFCT INT WORK(N:IN)" in kernel.krl
    others = [file.read_text() for ending in (".lua", ".c") if (file := kernel.beside(ending))]
    assert [True, True] == [
        mark in text for mark, text in zip(("return work", "int work(int n)"), others, strict=True)
    ]
