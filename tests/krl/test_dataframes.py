"""Results as tables."""

from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture
def dataframes() -> ModuleType:
    """The module, which has all of pandas in memory: imported where it is tested only."""
    pytest.importorskip("pandas")
    from krl import dataframes

    return dataframes


def test_a_survey_becomes_tables(dataframes: ModuleType, tmp_path: Path) -> None:
    """Clusters, proposals and failures belong together by the id of the cluster."""
    (tmp_path / "a.src").write_text("DEF A()\nWAT 1\nEND\n", encoding="utf-8")
    (tmp_path / "none").mkdir()
    survey = dataframes.record(
        "recover", tmp_path / "a.src", "--no-start", "--out", tmp_path / "out",
        "--negatives", tmp_path / "none", "--jobs", "1",
    )  # fmt: skip
    found = dataframes.clusters(survey)
    assert [1] == found["files"].tolist()
    assert ["WAT 1"] == dataframes.failures(survey)["text"].str.strip().tolist()
    assert set(dataframes.proposals(survey)["cluster"]) <= set(found["id"])


def test_what_cannot_be_done_is_reported(dataframes: ModuleType, tmp_path: Path) -> None:
    """Status 2 is an error with the line that the command said."""
    with pytest.raises(dataframes.CommandError, match="missing"):
        dataframes.record("recover", tmp_path / "missing")


def test_a_trace_and_nightly_runs_become_tables(dataframes: ModuleType, tmp_path: Path) -> None:
    """Lines of JSON become rows, whatever fields their events have."""
    trace = tmp_path / "t.jsonl"
    trace.write_text(
        '{"t":0,"task":"robot","kind":"out","at":"a:1","number":2,"value":true}\n'
        '{"t":5,"task":"robot","kind":"end","at":"a:2"}\n',
        encoding="utf-8",
    )
    assert [0, 5] == dataframes.trace(trace)["t"].tolist()
    history = tmp_path / "h.jsonl"
    history.write_text('{"date":"2031-05-06","bench":{"vm.x":2.5}}\nbroken\n', encoding="utf-8")
    assert [2.5] == dataframes.nightly_runs(history)["bench.vm.x"].tolist()
