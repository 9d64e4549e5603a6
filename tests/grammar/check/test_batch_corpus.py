"""The check has nothing to say about programs that are right."""

from pathlib import Path

from grammar.check.batch import CheckOptions, check_paths
from grammar.generation.cells.writing import write_cells
from grammar.notation.generate import GRAMMAR

PROGRAMS = GRAMMAR.parents[1] / "corpus" / "programs"
#: The program of the paper has an interrupt of the number 3, which is the system's today [INT-02].
KNOWN = {
    ("paper_example.src", "KRL503"),
    # these show how the language is written, and do nothing
    ("signs.src", "KRL409"),
    ("soft_names.src", "KRL412"),
}
#: What is written by chance assigns variables to themselves, waits for them, and sets any voltage.
POINTLESS = {"KRL411", "KRL412", "KSS1422"}


def graver(root: Path) -> set[tuple[str, str]]:
    found = check_paths([root], CheckOptions(stops=True), jobs=1).diagnostics
    return {(one.path.rpartition("/")[2], one.code) for one in found if one.severity != "note"}


def test_own_programs() -> None:
    """No error and no warning in the programs of the corpus but those that are known."""
    assert KNOWN == graver(PROGRAMS)


def test_synthetic_programs(tmp_path: Path) -> None:
    """Nor in programs that are made to be right, but for what does nothing."""
    write_cells(tmp_path, 200_000, seed=7)
    assert POINTLESS == {code for _, code in graver(tmp_path)}
