"""What the page of coverage says."""

from pathlib import Path

from reports.programs.coverage_page import CoveredFile, write_coverage_page


def test_files_are_named_below_the_folder_that_they_share(tmp_path: Path) -> None:
    """A narrow window has no room for the same folders again and again."""
    files = [CoveredFile(f"/cell/R1/{n}.src", "HALT\n", {1: 1}, {}, {}) for n in ("a", "sub/b")]
    page = write_coverage_page(files, 1, tmp_path).read_text(encoding="utf-8")
    assert "below /cell/R1" in page
    assert [">a.src<", ">sub/b.src<"] == [n for n in (">a.src<", ">sub/b.src<") if n in page]


def test_one_file_has_its_name(tmp_path: Path) -> None:
    """What shares no folder is named whole."""
    files = [CoveredFile("a.src", "HALT\n", {1: 1}, {}, {})]
    page = write_coverage_page(files, 1, tmp_path).read_text(encoding="utf-8")
    assert ">a.src<" in page
    assert "below" not in page
