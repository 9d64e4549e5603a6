"""Tables that the packages bring along as data: tab-separated values below a line of headings."""

from importlib import resources


class TableError(ValueError):
    """A table of ours is malformed: file, line and reason."""


def read_table(package: str, path: str) -> list[list[str]]:
    """Return the cells of each row of a table in a package, by columns; the headings come first.

    A row with another number of cells than there are headings raises `TableError`.
    """
    text = resources.files(package).joinpath(*path.split("/")).read_text(encoding="utf-8")
    rows = [line.split("\t") for line in text.splitlines()]
    for number, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            wrong = f"{len(row)} cells, and {len(rows[0])} columns"
            raise TableError(f"{package.replace('.', '/')}/{path}:{number}: {wrong}")
    return rows
