"""Format lint of the hand-written negatives in ``corpus/negatives``."""

import re
from collections import Counter
from pathlib import Path

import pytest

NEGATIVES = Path(__file__).parents[3] / "corpus" / "negatives"
SUFFIXES = frozenset({".src", ".dat", ".sub"})
PHASES = frozenset({"parse", "check"})
TOPICS = "TYP|ARI|FCT|SCO|CTL|ADV|BLD|MOT|POS|ORI|SPL|TRG|INT|IOT|TIM|SUB|MSG|CON"
KEY_ORDER = ("reason", "phase", "rule", "line")
FRONT_MATTER = re.compile(r";@ (?P<key>[a-z]+): (?P<value>\S.*)")
RULE = re.compile(rf"(?:{TOPICS})-\d\d")
STEM = re.compile(r"[a-z0-9]+(?:_[a-z0-9]+)*")


def negatives() -> list[Path]:
    """Every file below the folder but its README, in a fixed order."""
    files = (path for path in NEGATIVES.rglob("*") if path.is_file())
    return sorted(path for path in files if path != NEGATIVES / "README.md")


def split(text: str) -> tuple[dict[str, str], str, list[str]]:
    """Front matter, body and the faults of form of one negative."""
    lines = text.splitlines()
    head = 0
    keys: list[str] = []
    matter: dict[str, str] = {}
    while head < len(lines) and lines[head].startswith(";@"):
        if match := FRONT_MATTER.fullmatch(lines[head]):
            keys.append(match["key"])
            matter[match["key"]] = match["value"]
        else:
            keys.append(lines[head])
        head += 1
    faults = []
    if keys not in ([*KEY_ORDER], [key for key in KEY_ORDER if key != "rule"]):
        faults.append(f"front matter {keys}")
    return matter, "\n".join(lines[head:]), faults


def lint(text: str) -> list[str]:
    """What is wrong with the text of one negative, nothing when it is well formed."""
    matter, body, faults = split(text)
    if not text.isascii() or "\r" in text or not text.endswith("\n") or text.endswith("\n\n"):
        faults.append("not ASCII with LF line ends")
    if matter.get("phase") not in PHASES:
        faults.append(f"phase {matter.get('phase')}")
    if "rule" in matter:
        rules = matter["rule"].split(", ")
        if len(set(rules)) != len(rules) or not all(RULE.fullmatch(rule) for rule in rules):
            faults.append(f"rule {matter['rule']}")
    last = text.count("\n")
    first = last - body.count("\n")
    line = matter.get("line", "")
    if not line.isdecimal() or not first <= int(line) <= last:
        faults.append(f"line {line} outside the program {first} to {last}")
    elif text.splitlines()[int(line) - 1].strip() == "":
        faults.append(f"line {line} is blank")
    if not body.strip() or ";@" in body:
        faults.append("no program behind the front matter")
    return faults


def repeated(values: list[str]) -> list[str]:
    """The values that occur more than once."""
    return [value for value, count in Counter(values).items() if count > 1]


GOOD = ";@ reason: a number is no statement\n;@ phase: parse\n;@ line: 5\nDEF NEG()\n  5\nEND\n"


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("5", "5", None),
        (";@ phase: parse\n", "", "front matter"),
        (";@ line: 5", ";@ rule: CTL-11, SCO-04\n;@ line: 6", None),
        (";@ line", ";@ note: old\n;@ line", "front matter"),
        (";@ reason:", ";@reason:", "front matter"),
        ("parse", "run", "phase"),
        (";@ line: 5", ";@ rule: CTL11\n;@ line: 6", "rule"),
        (";@ line: 5", ";@ rule: ABC-01\n;@ line: 6", "rule"),
        (";@ line: 5", ";@ rule: CTL-11, CTL-11\n;@ line: 6", "rule"),
        ("line: 5", "line: 3", "line 3"),
        ("line: 5", "line: 7", "line 7"),
        ("line: 5", "line: last", "line last"),
        ("  5\n", "\n", "line 5 is blank"),
        ("END\n", "END", "ASCII"),
        ("\n", "\r\n", "ASCII"),
        ("  5", "  \N{DEGREE SIGN}", "ASCII"),
        ("END", ";@ phase: check", "no program"),
    ],
)
def test_lint_names_the_fault(old: str, new: str, fault: str | None) -> None:
    """The lint passes a well-formed negative and names what is wrong with a broken one."""
    faults = lint(GOOD.replace(old, new))
    if fault is None:
        assert [] == faults
    else:
        assert any(fault in found for found in faults), faults


def test_every_negative_is_well_formed() -> None:
    """Keys, phase, rule IDs and line of every negative are valid."""
    faults = {
        path.relative_to(NEGATIVES).as_posix(): found
        for path in negatives()
        if (found := lint(path.read_bytes().decode("utf-8")))
    }
    assert {} == faults


def test_names_and_folders_follow_the_format() -> None:
    """A negative lies in a topic folder, its name is in snake case, its ending that of KRL."""
    wrong = [
        path.relative_to(NEGATIVES).as_posix()
        for path in negatives()
        if path.suffix not in SUFFIXES
        or not STEM.fullmatch(path.stem)
        or len(path.relative_to(NEGATIVES).parts) != 2
    ]
    assert [] == wrong


def test_there_are_enough_of_both_phases() -> None:
    """At least 200 negatives are there, two thirds to nine tenths of them for the grammar."""
    phases = Counter(
        split(path.read_text(encoding="utf-8"))[0].get("phase") for path in negatives()
    )
    assert phases.total() >= 200
    assert 0.66 <= phases["parse"] / phases.total() <= 0.9


def test_no_reason_is_given_twice() -> None:
    """Two negatives never state the same fact in the same words."""
    reasons = [split(path.read_text(encoding="utf-8"))[0].get("reason", "") for path in negatives()]
    assert [] == repeated([re.sub(r"\W+", " ", reason).lower() for reason in reasons])


def test_no_program_occurs_twice() -> None:
    """The programs behind the front matter differ in more than blanks."""
    bodies = [split(path.read_text(encoding="utf-8"))[1] for path in negatives()]
    assert [] == repeated([re.sub(r"[ \t]+", " ", body) for body in bodies])


def test_data_facts_lie_in_data_lists() -> None:
    """The ending of a file and the kind of its first block agree."""
    wrong = []
    for path in negatives():
        body = split(path.read_text(encoding="utf-8"))[1]
        if (path.suffix == ".dat") != bool(re.search(r"^DEFDAT\b", body, re.MULTILINE)):
            wrong.append(path.relative_to(NEGATIVES).as_posix())
    assert [] == wrong
