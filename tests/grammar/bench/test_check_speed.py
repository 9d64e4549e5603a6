"""The bench of the check: what its record says."""

from pathlib import Path

import pytest

from grammar.bench import check_speed
from grammar.bench.check_speed import measure_check, steps
from support.files.discovery import IngestError

PHASES = "loading decoding parsing building tables linking resolving checking"


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process for each figure is what makes a bench true and a test slow."""
    monkeypatch.setattr(
        check_speed, "call_isolated", lambda function, *arguments: function(*arguments)
    )


def test_record(tmp_path: Path) -> None:
    """Figures agree with one another, and every phase took some of the time."""
    text = "DEF A()\nDECL INT N\nN = $ACT_TOOL + 1\nEXIT\n$OUT[N] = TRUE\nEND\n"
    (tmp_path / "A.src").write_text(text, encoding="utf-8", newline="\n")
    told: list[int] = []
    record = measure_check([tmp_path], rounds=1, on_step=lambda: told.append(1))
    assert steps(1) == len(told)
    assert (1, len(text), 1) == (record["files"], record["bytes"], record["projects"])
    assert {"warning": 1} == record["findings"]
    assert record["seconds"] == pytest.approx(record["s_per_mb"] * len(text) / 1e6)
    assert PHASES.split() == [phase["name"] for phase in record["phases"]]
    assert 1 == pytest.approx(sum(phase["share"] for phase in record["phases"]))
    assert all(phase["seconds"] > 0 for phase in record["phases"])
    assert min(record["unchanged_s_per_mb"], record["one_changed_seconds"]) > 0


def test_nothing_to_measure_on(tmp_path: Path) -> None:
    """A folder without programs, or with none that is KRL, is said before all else."""
    with pytest.raises(IngestError):
        measure_check([tmp_path], rounds=1)
    (tmp_path / "A.src").write_bytes(b"\0" * 100)
    with pytest.raises(IngestError, match="none of the files is KRL"):
        measure_check([tmp_path], rounds=1)
