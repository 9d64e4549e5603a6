"""Every written negative of phase ``check`` is rejected, at the line that it names.

Rejected means an error, or a warning where the fact rests on recollection alone.
"""

from pathlib import Path

import pytest

from grammar.semantics.link import File, link
from grammar.semantics.rules import is_confirmed
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from tests.grammar.check.workspace_check import check

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


@pytest.mark.parametrize("topic", sorted({path.parent for path in ALL}), ids=lambda one: one.name)
def test_negatives(topic: Path) -> None:
    """Each program is rejected at its line and nowhere else, as gravely as its rules allow."""
    rejected = {path.stem: _rejected(path) for path in ALL if path.parent == topic}
    assert {} == {name: found for name, found in rejected.items() if found}


def _rejected(path: Path) -> str:
    """What is wrong with how a program is rejected, or nothing."""
    text = path.read_text(encoding="utf-8")
    source = Source(text, f"NEG{path.suffix}")
    syntax = read_module(text, source.path)
    assert not isinstance(syntax, list)
    workspace = link([File(source.path, syntax)], is_complete=True)
    found = [one for one in check(workspace, lambda _module: source) if one.severity != "note"]
    lines = sorted({one.region.line for one in found})
    if [int(matter(text, "line"))] != lines:
        return f"found on lines {lines}"
    rules = matter(text, "rule").split(", ") if matter(text, "rule") else []
    is_grave = "error" in {one.severity for one in found}
    return "no error" if is_confirmed(rules) and not is_grave else ""


def test_there_are_negatives() -> None:
    """The corpus has more than a hundred facts for the checker."""
    assert len(ALL) > 100
