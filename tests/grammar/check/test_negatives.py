"""Every written negative of phase ``check`` is rejected, at the line that it names.

Rejected means an error, or a warning where the fact rests on recollection alone.
"""

from pathlib import Path

import pytest

from grammar.check.framework import check
from grammar.semantics.link import File, link
from grammar.semantics.rules import is_confirmed
from grammar.syntax.build import read_module
from grammar.syntax.source import Source

NEGATIVES = Path(__file__).parents[3] / "corpus" / "negatives"
ALL = [
    path
    for path in sorted(NEGATIVES.rglob("*.*"))
    if ";@ phase: check" in path.read_text(encoding="utf-8")
]


def matter(text: str, key: str) -> str:
    """A value of the front matter, empty where it is missing."""
    head = f";@ {key}: "
    return next((line[len(head) :] for line in text.splitlines() if line.startswith(head)), "")


@pytest.mark.parametrize("path", ALL, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_negative(path: Path) -> None:
    """The program is rejected at its line and nowhere else, as gravely as its rules allow."""
    text = path.read_text(encoding="utf-8")
    source = Source(text, f"NEG{path.suffix}")
    syntax = read_module(text, source.path)
    assert not isinstance(syntax, list)
    workspace = link([File(source.path, syntax)], is_complete=True)
    found = [one for one in check(workspace, lambda _module: source) if one.severity != "note"]
    assert [int(matter(text, "line"))] == sorted({one.region.line for one in found})
    rules = matter(text, "rule").split(", ") if matter(text, "rule") else []
    assert not is_confirmed(rules) or "error" in {one.severity for one in found}


def test_there_are_negatives() -> None:
    """The corpus has more than a hundred facts for the checker."""
    assert len(ALL) > 100
