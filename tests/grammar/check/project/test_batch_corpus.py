"""The check has nothing to say about programs that are made to be right."""

from pathlib import Path

from grammar.check.project.batch import CheckOptions, check_paths
from grammar.generation.cells.writing import write_cells

#: What is written by chance assigns variables to themselves, waits for them, and sets any voltage.
POINTLESS = {"KRL411", "KRL412", "KSS1422"}


def graver(root: Path) -> set[tuple[str, str]]:
    found = check_paths([root], CheckOptions(stops=True), jobs=1).diagnostics
    return {(one.path.rpartition("/")[2], one.code) for one in found if one.severity != "note"}


def test_synthetic_programs(tmp_path: Path) -> None:
    """No error and no warning in programs made by chance, but for what does nothing."""
    write_cells(tmp_path, 200_000, seed=7)
    assert POINTLESS == {code for _, code in graver(tmp_path)}
