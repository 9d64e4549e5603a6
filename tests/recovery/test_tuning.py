"""Tuning constants stand in one place, each with what it rests on."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import recovery
from recovery import tuning

FOLDER = Path(recovery.__file__).parent
#: Modules that only report what was found.
REPORTS = ("induced_ledger", "induction_folder", "target_comparison")
HEURISTIC = [
    *(FOLDER / "survey" / name for name in ("suspected_keywords.py", "unreserved_keywords.py")),
    *(
        path
        for folder in ("proposals", "clustering", "reproducer", "induction")
        for path in sorted((FOLDER / folder).rglob("*.py"))
        if path.stem not in REPORTS
    ),
]
BASES = re.compile(r"\b(?:bound|revised: \d|not measured|measured: |looks through)", re.IGNORECASE)


def is_number(value: ast.expr | None) -> bool:
    """Whether an expression is made of numbers alone."""
    parts = list(ast.walk(value)) if value is not None else []
    values = [part.value for part in parts if isinstance(part, ast.Constant)]
    made_of = ast.Constant | ast.UnaryOp | ast.BinOp | ast.operator | ast.unaryop
    return bool(values) and all(
        isinstance(part, made_of) and not isinstance(getattr(part, "value", 0), str | bytes | bool)
        for part in parts
    )


@pytest.mark.parametrize("path", HEURISTIC, ids=lambda path: path.stem)
def test_no_module_of_the_search_has_a_numeric_constant_of_its_own(path: Path) -> None:
    """Numbers of the search are looked for, and changed, in `recovery.tuning`."""
    module = ast.parse(path.read_text(encoding="utf-8"))
    found = [
        ast.unparse(statement)
        for statement in module.body
        if isinstance(statement, ast.Assign | ast.AnnAssign) and is_number(statement.value)
    ]
    assert [] == found


def test_each_constant_says_what_it_rests_on() -> None:
    """The comment over a constant, or over the row it stands in, ends in one of the bases."""
    text = Path(tuning.__file__).read_text(encoding="utf-8")
    rows = re.findall(r"^((?:#: .*\n)+)((?:[A-Z_]+ = .*\n)+)", text, re.MULTILINE)
    described = [name for _, row in rows for name in re.findall(r"^[A-Z_]+", row, re.MULTILINE)]
    assert [name for name in vars(tuning) if name.isupper()] == described
    assert [] == [row for comment, row in rows if not BASES.search(comment.replace("\n#:", ""))]
