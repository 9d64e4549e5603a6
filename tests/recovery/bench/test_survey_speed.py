"""The bench of the survey: what it records, never how fast it was."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from recovery.bench import survey_speed
from recovery.bench.survey_speed import measure, steps
from support.files.discovery import IngestError

VALID = "DEF fetch()\nDECL INT count\ncount = 1 + 12\nEND\n"
FAILING = "DEF store()\nfold = = 3\ncount = 1\nEND\n"


@pytest.fixture(scope="module")
def grammar() -> Grammar:
    """The grammar in force."""
    return read_file(GRAMMAR)


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two programs, a copy of one, and a file that is no KRL."""
    folder = tmp_path_factory.mktemp("corpus")
    for name, text in (("a", VALID), ("b", FAILING), ("copy", VALID), ("other", "1 2 3\n")):
        (folder / f"{name}.src").write_text(text, encoding="utf-8", newline="\n")
    return folder


@pytest.fixture(scope="module")
def record(corpus: Path, grammar: Grammar) -> dict[str, Any]:
    """A measurement on the corpus; ``told`` is how often it said that it goes on."""
    told: list[None] = []
    found = measure([corpus], grammar, rounds=1, on_step=lambda: told.append(None))
    return {**found, "told": len(told)}


def test_each_content_counts_once(record: dict[str, Any]) -> None:
    """Copies and files that are no KRL are not part of what was measured on."""
    assert 2 == record["files"]
    assert 1 == record["parsed"]
    assert len(VALID) + len(FAILING) == record["bytes"]
    assert 1 == record["failures"]


def test_speeds_are_bytes_over_seconds(record: dict[str, Any]) -> None:
    """Speeds are in bytes of the files a second, and all of them are there."""
    assert pytest.approx(record["bytes"] / record["seconds"]) == record["bytes_per_s"]
    assert all(record[f"{kind}_bytes_per_s"] > 0 for kind in ("warm", "recognise"))


def test_phases_make_up_the_survey(record: dict[str, Any]) -> None:
    """The phases are named, and their shares are all of the time."""
    names = [phase["name"] for phase in record["phases"]]
    expected = "reading decoding building lexing recognising failures recording".split()
    assert expected == names
    assert pytest.approx(1) == sum(phase["share"] for phase in record["phases"])


def test_antlr_reads_the_same_bytes(record: dict[str, Any]) -> None:
    """ANTLR stands beside the recogniser on the valid text, and apart on the failing one."""
    valid, failing = record["antlr"]["valid"], record["antlr"]["failing"]
    assert 1 == valid["files"]
    assert (1, len(FAILING)) == (failing["files"], failing["bytes"])
    assert record["ratio_vs_antlr_python"] == valid["ratio"]
    for side in (valid, failing):
        assert pytest.approx(side["antlr_seconds"] / side["our_seconds"]) == side["ratio"]


def test_steps_are_reported_beforehand(record: dict[str, Any]) -> None:
    """As many steps are reported as `steps` says."""
    assert steps(rounds=1) == record["told"]


def test_unchanged_files_are_not_read_again(
    record: dict[str, Any], corpus: Path, grammar: Grammar, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The figure for unchanged files is of surveys that follow one with the same cache."""
    caches: list[Path | None] = []
    known = {
        "_surveyed": survey_speed._Surveyed(2.0, 1.0, 2, 1, record["bytes"], 1),
        "_phased": {one["name"]: one["seconds"] for one in record["phases"]},
        "_beside_antlr": record["antlr"],
    }

    def noting(function: Callable[..., Any], *arguments: Any) -> Any:
        if function is not survey_speed._kept:
            return known[function.__name__]
        caches.append(arguments[2])
        return [9.0, 3.0, 2.0][len(caches) - 1]

    monkeypatch.setattr(survey_speed, "call_isolated", noting)
    found = measure([corpus], grammar, rounds=2)
    assert 3 == len(caches)
    assert 1 == len(set(caches))
    assert pytest.approx(2e6 / record["bytes"]) == found["unchanged_s_per_mb"]


def test_files_that_are_no_krl_are_nothing_to_measure_on(tmp_path: Path, grammar: Grammar) -> None:
    """Without a single KRL file there is a clear refusal."""
    (tmp_path / "table.dat").write_text("1 2 3\n", encoding="utf-8")
    with pytest.raises(IngestError, match="none of the files is KRL"):
        measure([tmp_path], grammar)
