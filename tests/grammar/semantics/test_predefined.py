"""What the controller brings along is in tables that fit together, and is found by any release."""

import re

import pytest

from grammar.diagnostics.codes import by_code, by_slug, code, of_message
from grammar.semantics.predefined import System
from grammar.semantics.rules import is_confirmed, tiers
from grammar.semantics.types import INT, REAL, SCALARS, UNKNOWN, Array, Enumeration, Structure
from support.files.tables import read_table

SOURCES = {"S2", "S3", "S5", "S6", "D3", "R"}


def rows(table: str) -> list[dict[str, str]]:
    columns, *found = read_table("grammar", f"system/{table}")
    return [dict(zip(columns, row, strict=True)) for row in found]


@pytest.fixture(scope="module")
def system() -> System:
    return System.load()


def structure(system: System, name: str) -> Structure:
    found = system.types[name]
    assert isinstance(found, Structure)
    return found


def enumeration(system: System, name: str) -> Enumeration:
    found = system.types[name]
    assert isinstance(found, Enumeration)
    return found


# ------------------------------------------------------------------------------- the tables


@pytest.mark.parametrize("release", [None, "4.1", "8.3", "8.6", "12.0"])
def test_every_entry_can_be_made(release: str | None) -> None:
    """Every row of every table gives an entry of its name, in every release."""
    system = System.load(release)
    assert list(system.variables) == [entry.name.upper() for entry in system.variables.values()]
    assert list(system.functions) == [entry.name.upper() for entry in system.functions.values()]
    assert len(system.types) == len(list(system.types.values()))
    assert all(message == system.message(message.number) for message in system.messages)


def test_messages_that_say_the_same_are_those_that_we_do_not_report(system: System) -> None:
    """The other one is a message of the same phase with the same text, and has no such other."""
    codes = {entry.code for entry in by_slug().values()}
    pairs = [(one, one.same_as) for one in system.messages if one.same_as is not None]
    assert 2 == len(pairs)
    for one, number in pairs:
        other = system.message(number)
        assert other is not None
        assert (one.phase, one.text) == (other.phase, other.text)
        assert other.same_as is None
        assert {f"KSS{number}"} == codes & {f"KSS{number}", f"KSS{one.number}"}


@pytest.mark.parametrize(
    "table", ["variables.tsv", "types.tsv", "channels.tsv", "functions.tsv", "messages.tsv"]
)
def test_every_row_has_a_known_source(table: str) -> None:
    """A source is a key of the README or a rule that there is."""
    named = {key for row in rows(table) for key in row["source"].split()}
    assert set() == named - SOURCES - set(tiers())
    assert all(row["source"] for row in rows(table))


@pytest.mark.parametrize("table", ["variables.tsv", "types.tsv", "channels.tsv", "functions.tsv"])
def test_names_are_sorted_and_stand_once_a_release(table: str) -> None:
    """System names come before those of files, sorted; a name twice has releases, newest first."""
    found = [(row.get("file", ""), row["name"].upper()) for row in rows(table)]
    if table == "variables.tsv":
        found = [("" if name.startswith("$") else file, name) for file, name in found]
    else:
        found = [("", name) for _, name in found]
    assert sorted(found) == found
    starts: dict[str, list[str]] = {}
    for row in rows(table):
        starts.setdefault(row["name"].upper(), []).append(row.get("releases", ""))
    twice = {name: ranges for name, ranges in starts.items() if len(ranges) > 1}
    assert all(
        ranges[0].endswith("..") and ranges[-1].startswith("..") for ranges in twice.values()
    )


def test_names_are_names_of_krl() -> None:
    """Every name of a variable or function can be written in a program [TYP-05]."""
    names = [row["name"] for table in ("variables", "functions") for row in rows(f"{table}.tsv")]
    assert [] == [name for name in names if not re.fullmatch(r"\$?[A-Z_][A-Z0-9_$]*", name)]


def test_structures_and_enumerations_repeat_no_name(system: System) -> None:
    """Components of a structure, and constants of an enumeration, stand once each."""
    for entry in system.types.values():
        if isinstance(entry, Structure):
            names = [member.name.upper() for member in entry.members]
        elif isinstance(entry, Enumeration):
            names = [constant.upper() for constant in entry.constants]
        else:
            continue
        assert names
        assert len(names) == len(set(names)), entry


def test_twins_are_read_only_and_of_the_same_type(system: System) -> None:
    """A variable and its twin in the main run have one type; programs do not write the twin."""
    twins = [
        (entry, system.variables[entry.twin]) for entry in system.variables.values() if entry.twin
    ]
    assert len(twins) > 30
    for entry, twin in twins:
        assert entry.type == twin.type, entry.name
        assert "read" == twin.access, twin.name
    assert system.variables["$OUT"].twin is None  # $OUT_C is no value of the main run [ADV-11]


def test_rules_that_stop_the_advance_run_are_rules() -> None:
    """What stops the advance run names the rule that says so."""
    stops = [row["stops"].split()[-1] for row in rows("variables.tsv") if row["stops"]]
    stops += [row["stops"] for row in rows("functions.tsv") if row["stops"]]
    assert {"ADV-04", "ADV-05", "ADV-06", "ADV-07", "FCT-09"} == set(stops)


# --------------------------------------------------------------------------------- the facts


def test_what_a_file_declares_is_open(system: System) -> None:
    """Types and sizes of a delivered $config.dat may be others in another one."""
    tools = system.variables["TOOL_DATA"]
    assert ("$config.dat", Array(system.types["FRAME"], (None,))) == (tools.file, tools.type)
    assert UNKNOWN == structure(system, "PDAT").member("SOMETHING_NEWER")
    assert "SOMETHING_NEWER" in enumeration(system, "BAS_COMMAND")
    assert "SOMETHING_NEWER" not in structure(system, "POS")
    assert "" == system.variables["$VEL"].file


def test_releases_differ() -> None:
    """KSS 4.1 had 16 timers [TIM-02]; axis velocities were not REAL before 8.6 [MOT-02]."""
    assert Array(INT, (16,)) == System.load("KSS 4.1.5").variables["$TIMER"].type
    assert Array(INT, (64,)) == System.load("4.2").variables["$TIMER"].type
    assert UNKNOWN == System.load("8.3").variables["$VEL_AXIS"].type
    assert Array(REAL, (6,)) == System.load("8.6").variables["$VEL_AXIS"].type
    assert "$SAFETY_SW" not in System.load("5.6").variables
    assert "$SAFETY_SW" in System.load().variables


@pytest.mark.parametrize("release", ["", "new", "8", "v8,6"])
def test_a_release_has_two_numbers(release: str) -> None:
    """What is no release is said so."""
    with pytest.raises(ValueError, match="not a release"):
        System.load(release)


def test_names_are_found_in_any_letter_case(system: System) -> None:
    """Letter case does not tell names apart [TYP-05]."""
    assert system.variables["$Pos_Act"] is system.variables["$POS_ACT"]
    assert "e6pos" in system.types
    assert "$pos_act" in system.variables
    assert None not in system.variables
    assert all(name not in system.types for name in SCALARS)


def test_a_system_is_made_once() -> None:
    """The same release gives the same object."""
    assert System.load("8.6") is System.load("8.6")


# ------------------------------------------------------------------------ rules and codes


def test_unconfirmed_is_what_rests_on_recollection_alone() -> None:
    """R and X, alone or together, confirm nothing; R with a measurement does."""
    assert not is_confirmed(["ARI-10"])
    assert not is_confirmed(["BLD-07"])  # R+X
    assert is_confirmed(["ARI-03"])  # R+D
    assert is_confirmed(["ARI-10", "ARI-11"])
    assert is_confirmed([])
    with pytest.raises(KeyError):
        is_confirmed(["ARI-99"])


def test_tiers() -> None:
    """The tiers are those that the rules have."""
    assert {"P", "T", "F", "D", "R", "X", "R+D", "R+X"} == set(tiers().values())


def test_codes_stand_once_and_say_something() -> None:
    """Code and slug are unique; title, explanation and rules are there and real."""
    codes = list(by_slug().values())
    assert len(codes) == len(by_code())
    for entry in codes:
        assert re.fullmatch(r"KRL[0-79]\d\d|KSS[1-9]\d{1,4}", entry.code)
        assert re.fullmatch(r"[a-z]+(-[a-z]+)*", entry.slug)
        assert entry.title
        assert not entry.title.endswith(".")
        assert entry.explanation.endswith(".")
        assert set(entry.rules) <= set(tiers())
    assert sorted(codes, key=lambda entry: (entry.code[:3] == "KRL", int(entry.code[3:]))) == codes


def test_codes_of_the_controller_are_its_messages(system: System) -> None:
    """A code with a number of the controller has that message, and shares rules with it."""
    for entry in by_slug().values():
        if entry.code.startswith("KSS"):
            message = system.message(int(entry.code[3:]))
            assert message is not None, entry.code
            assert set(entry.rules) & set(message.source), entry.code
    assert code("no-such-constant") == of_message(2296)
    assert of_message(1123) is None
