"""What the check says about programs that are right."""

from pathlib import Path

from grammar.check.project.batch import CheckOptions, check_paths
from grammar.generation.synthetic_corpus import write_cells

REPOSITORY = Path(__file__).parents[4]
#: Texts that are too long, indices that are a REAL, tautologies: what programs by chance do.
BY_CHANCE = {
    *("KRL206", "KRL213", "KRL215", "KRL408", "KRL411", "KRL418", "KRL506", "KRL516", "KSS1422"),
}


def graver(root: Path) -> set[tuple[str, str]]:
    found = check_paths([root], CheckOptions(stops=True), jobs=1).diagnostics
    return {(one.path.rpartition("/")[2], one.code) for one in found if one.severity != "note"}


def test_synthetic_programs(tmp_path: Path) -> None:
    """No error in programs made by chance, and no warning but of what they do."""
    write_cells(tmp_path, 150_000, seed=1)
    assert BY_CHANCE == {code for _, code in graver(tmp_path)}


def test_own_programs() -> None:
    """Nothing in the programs of the corpus but four places that are meant."""
    assert {
        ("paper_example.src", "KRL503"),
        ("signs.src", "KRL409"),
        ("soft_names.src", "KRL412"),
    } == graver(REPOSITORY / "corpus" / "programs")
