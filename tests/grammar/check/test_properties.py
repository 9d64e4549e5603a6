"""What holds for every program: names and folds change no verdict."""

import re
from collections.abc import Callable
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics.link import File, link
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from tests.grammar.check.workspace_check import check

CORPUS = Path(__file__).parents[3] / "corpus"
NEGATIVES = sorted(
    path
    for path in (CORPUS / "negatives").rglob("*.*")
    if ";@ phase: check" in path.read_text(encoding="utf-8")
)
#: Words of these programs that their authors chose, of those that a name could be.
OWN = frozenset(
    """COUNT LIMIT LIST GRID PLACE SHIFT SPEED DONE JOB MASK TOTAL WORK WALL COLOUR_T PART_T READY
    ORIGIN FIRST HEIGHT LENGTH LETTER LAST_PART""".split()
)


def checked(text: str, path: str) -> list[tuple[int, str, str]]:
    """Line, code and severity of what is found in a file alone."""
    source = Source(text, path)
    module = read_module(text, path)
    assert not isinstance(module, list)
    found = check(link([File(path, module)], is_complete=True), lambda _module: source)
    return [(one.region.line, one.code, one.severity) for one in found]


def renamed(text: str, name: Callable[[str], str]) -> str:
    """A program with other names for what it declares itself."""
    return re.sub(
        r"(?<![\w$#])\w+", lambda word: name(word[0]) if word[0].upper() in OWN else word[0], text
    )


@given(path=st.sampled_from(NEGATIVES), suffix=st.sampled_from(["_X", "Q", "_7", "$"]))
def test_renaming_changes_no_verdict(path: Path, suffix: str) -> None:
    """What a program calls its own things does not matter."""
    text = path.read_text(encoding="utf-8")
    other = renamed(text, lambda word: f"Z{word}{suffix}")
    assert checked(text, f"NEG{path.suffix}") == checked(other, f"NEG{path.suffix}")


@given(path=st.sampled_from(NEGATIVES), is_lower=st.booleans())
def test_letter_case_changes_no_verdict(path: Path, is_lower: bool) -> None:
    """Letter case does not tell names apart [TYP-05]."""
    text = path.read_text(encoding="utf-8")
    other = "".join(
        line if line.startswith(";") else (line.lower() if is_lower else line.swapcase())
        for line in text.splitlines(keepends=True)
    )
    assert checked(text, f"NEG{path.suffix}") == checked(other, f"NEG{path.suffix}")


@given(
    path=st.sampled_from(NEGATIVES), width=st.integers(0, 6), ending=st.sampled_from(["\n", "\r\n"])
)
def test_folds_change_no_verdict(path: Path, width: int, ending: str) -> None:
    """Folds and comments are nothing to the controller, and so are spaces at a line's ends."""
    lines = path.read_text(encoding="utf-8").splitlines()
    text = "\n".join(lines) + "\n"
    other = ending.join(
        f"{' ' * width}{line.strip()} ; fold{ending};FOLD a{ending};ENDFOLD" for line in lines
    )
    moved = [
        ((line - 1) * 3 + 1, code, grave)
        for line, code, grave in checked(text, f"NEG{path.suffix}")
    ]
    assert moved == checked(other, f"NEG{path.suffix}")
