"""Tables of ours are read by columns, and a malformed row is told with its place."""

import sys
from pathlib import Path

import pytest

from support.files.tables import TableError, read_table


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package whose tables lie in a folder."""
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "tables_of_a_test", raising=False)
    folder = tmp_path / "tables_of_a_test" / "data"
    folder.mkdir(parents=True)
    (folder.parent / "__init__.py").touch()
    return folder


def test_headings_come_first(package: Path) -> None:
    """A row has a cell for each heading, also an empty one at the end."""
    (package / "names.tsv").write_text("name\tmeaning\nA\tone\nB\t\n", encoding="utf-8")
    expected = [["name", "meaning"], ["A", "one"], ["B", ""]]
    assert expected == read_table("tables_of_a_test", "data/names.tsv")


def test_a_missing_cell_is_told(package: Path) -> None:
    """A row without a cell of the headings is told with file, line and counts."""
    (package / "short.tsv").write_text("name\tmeaning\nA\tone\nB\n", encoding="utf-8")
    with pytest.raises(TableError) as error:
        read_table("tables_of_a_test", "data/short.tsv")
    assert "tables_of_a_test/data/short.tsv:3: 1 cells, and 2 columns" == str(error.value)
