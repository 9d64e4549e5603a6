"""The same input gives the same record, whatever the processes and the hashes of Python."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import Recognizer, State
from recovery.proposals.candidates import Candidate, CandidateFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.survey import survey_texts
from recovery.tuning import MOST_TRIED

DAMAGED = """DEFDAT ARM PUBLIC
DECL GLOBAL FRAME gfBlockBase[:}([(t1[3]
DECL INT nCount[2=]{{1
GLOBAL REAL rSpeed=,=\x84\x93 1.5
ENDDAT
"""
RECORD = """
import json, sys
from pathlib import Path
from grammar.notation.g4 import read_file
from recovery.analysis import analyse
from recovery.survey.survey import survey
found = survey([Path(sys.argv[1])], read_file(Path(sys.argv[2])), jobs=int(sys.argv[3]))
record = analyse(found, [], grammar_name="KRL.g4")
del record["seconds"], record["analysis_seconds"]
record["failures"] = list(record["failures"])
print(json.dumps(record))
"""


def candidates(monkeypatch: pytest.MonkeyPatch, *, backwards: bool) -> list[Candidate]:
    """Candidates for the first damaged line where the recogniser gives its sets in an order."""
    given = Recognizer.sites

    def in_order(recognizer: Recognizer, state: State) -> list[Configuration]:
        found = given(recognizer, state)
        return sorted(found, key=lambda c: (c[0], c[1].depth, c[1].positions()), reverse=backwards)

    grammar = read_file(GRAMMAR)
    found = survey_texts([("a.dat", DAMAGED)], grammar)
    line = LinePattern(found.forms[found.files[0].failures[0].form], ())
    with monkeypatch.context() as patched:
        patched.setattr(Recognizer, "sites", in_order)
        return CandidateFinder(Recognizer(grammar)).find_common([line], MOST_TRIED)


def test_the_order_of_configurations_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Configurations come as a set of interned objects; its order changes with their addresses."""
    forwards = candidates(monkeypatch, backwards=False)
    assert forwards
    assert forwards == candidates(monkeypatch, backwards=True)


def record_of(folder: Path, run: int) -> bytes:
    """The record of the damaged files, made in an order of the run and read with its hash seed."""
    folder.mkdir(parents=True)
    for place in range(4):
        at = (place + run) % 4
        text = DAMAGED if at % 2 else DAMAGED.replace("[", "(")
        (folder / f"{at}.dat").write_bytes(text.encode("cp1252", "replace"))
    return subprocess.run(
        [sys.executable, "-c", RECORD, ".", GRAMMAR, str(1 if run % 4 else 2)],
        cwd=folder,
        env=os.environ | {"PYTHONHASHSEED": str(run * 4711)},
        stdout=subprocess.PIPE,
        check=True,
    ).stdout


@pytest.mark.slow
def test_records_agree_over_hash_seeds_and_processes(tmp_path: Path) -> None:
    """Twenty surveys of damaged files, in one process and in two, are the same to the byte."""
    with ThreadPoolExecutor(2) as pool:
        runs = range(20)
        records = list(pool.map(record_of, (tmp_path / str(run) / "same" for run in runs), runs))
    assert records == [records[0]] * 20
