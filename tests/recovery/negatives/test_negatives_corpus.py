"""The hand-written negatives in ``corpus/negatives``: what is asked of them beyond being read."""

import re
from collections import Counter
from pathlib import Path

from grammar.semantics.rules import tiers
from recovery.negatives.negatives import load

NEGATIVES = Path(__file__).parents[3] / "corpus" / "negatives"
#: Each with its place below the folder.
WRITTEN = {str(one.path and one.path.relative_to(NEGATIVES)): one for one in load(NEGATIVES)}
PATH = re.compile(r"\w+[/\\][a-z0-9]+(_[a-z0-9]+)*\.(src|dat|sub)")
KEYS = re.compile(r";@ reason: .+\n;@ phase: .+\n(;@ rule: .+\n)?;@ line: .+\n(?!;@)")


def repeated(values: list[str]) -> list[str]:
    """The values that occur more than once."""
    return [value for value, count in Counter(values).items() if count > 1]


def is_plain(text: bytes) -> bool:
    """ASCII with LF line ends, of which the last line has one."""
    return text.isascii() and b"\r" not in text and re.search(rb"[^\n]\n\Z", text) is not None


def test_every_negative_is_well_formed() -> None:
    """Its text is plain, its keys are in order, its rules are known and its line says something."""
    assert [] == [
        path
        for path, one in WRITTEN.items()
        if not is_plain((NEGATIVES / path).read_bytes())
        or not KEYS.match(one.text)
        or len({*one.rules} & {*tiers()}) != len(one.rules)
        or one.line is None
        or not one.text.splitlines()[one.line - 1].strip()
    ]


def test_names_and_folders_follow_the_format() -> None:
    """A negative lies in a topic folder, its name is in snake case, its ending that of KRL."""
    there = [path.relative_to(NEGATIVES) for path in NEGATIVES.rglob("*") if path.is_file()]
    assert {*WRITTEN, "README.md"} == {str(path) for path in there}
    assert [] == [path for path in WRITTEN if not PATH.fullmatch(path)]


def test_there_are_enough_of_both_phases() -> None:
    """At least 200 negatives are there, two thirds to nine tenths of them for the grammar."""
    phases = Counter(one.phase for one in WRITTEN.values())
    assert phases.total() >= 200
    assert 0.66 <= phases["parse"] / phases.total() <= 0.9


def test_no_reason_is_given_twice() -> None:
    """Two negatives never state the same fact in the same words."""
    reasons = [re.sub(r"\W+", " ", one.reason).lower() for one in WRITTEN.values()]
    assert [] == repeated(reasons)


def test_no_program_occurs_twice() -> None:
    """The programs behind the front matter differ in more than blanks."""
    bodies = [KEYS.sub("", one.text) for one in WRITTEN.values()]
    assert [] == repeated([re.sub(r"[ \t]+", " ", body) for body in bodies])


def test_data_facts_lie_in_data_lists() -> None:
    """The ending of a file and the kind of its first block agree."""
    assert [] == [
        path
        for path, one in WRITTEN.items()
        if path.endswith(".dat") != bool(re.search(r"^DEFDAT\b", one.text, re.MULTILINE))
    ]
