"""What the check says about programs that are right."""

from pathlib import Path

import pytest

from grammar.check.project.batch import CheckOptions, check_paths
from grammar.check.project.report import CheckReport
from grammar.generation.synthetic_corpus import write_cells

REPOSITORY = Path(__file__).parents[4]
#: Texts that are too long, indices that are a REAL, tautologies: what programs by chance do.
BY_CHANCE = {
    *("KRL206", "KRL213", "KRL215", "KRL408", "KRL411", "KRL418", "KRL506", "KRL516", "KSS1422"),
}


@pytest.fixture(scope="module")
def own() -> CheckReport:
    """The report of our own programs."""
    return reported(REPOSITORY / "corpus" / "programs")


def reported(root: Path) -> CheckReport:
    return check_paths([root], CheckOptions(stops=True), jobs=1)


def graver(report: CheckReport) -> set[tuple[str, str]]:
    found = report.diagnostics
    return {(one.path.rpartition("/")[2], one.code) for one in found if one.severity != "note"}


def test_synthetic_programs(tmp_path: Path) -> None:
    """No error in programs made by chance, and no warning but of what they do."""
    write_cells(tmp_path, 150_000, seed=1)
    assert BY_CHANCE == {code for _, code in graver(reported(tmp_path))}


def test_own_programs(own: CheckReport) -> None:
    """Nothing in the programs of the corpus but three places that are meant.

    The example of the paper has an interrupt of number 3, which INT-02 gives to the system. The
    others show how the language is written, and do nothing.
    """
    assert {
        ("paper_example.src", "KRL503"),
        ("signs.src", "KRL409"),
        ("soft_names.src", "KRL412"),
    } == graver(own)


def test_findings_lie_in_their_text(own: CheckReport) -> None:
    """Every region is a part of a line of its file."""
    found = list(own.located())
    assert found
    for one, line in found:
        region = one.region
        assert region.line == region.end_line
        assert 1 <= region.column <= region.end_column <= len(line) + 1
