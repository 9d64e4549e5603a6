"""Findings are values in a stable order, become records and text, and suggest what was meant."""

import json
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.diagnostics.codes import by_code
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region, diagnose, in_order, records
from grammar.diagnostics.did_you_mean import did_you_mean, nearest
from grammar.diagnostics.rendering import rendered, summary
from grammar.syntax.source import Source

TEXT = "DEF A()\n  $ORI_TYPE = #CONST\n\tWAIT SEC 1\nEND\n"


def finding(line: int = 2, column: int = 15, slug: str = "no-such-constant") -> Diagnostic:
    region = Region(line, column, line, column + 6)
    return diagnose(slug, "R1/a.src", region, "ORI_TYPE has no constant #CONST")


def text_of(diagnostic: Diagnostic, text: str = TEXT) -> list[str]:
    return list(rendered([(diagnostic, Source(text).line(diagnostic.region.line))]))


# ---------------------------------------------------------------------------------- values


def test_a_finding_takes_what_its_code_says() -> None:
    """Code, severity and rules come from the table."""
    found = finding()
    assert ("KSS2296", "error") == (found.code, found.severity)
    assert by_code()["KSS2296"].rules == found.rules


def test_what_is_given_counts_more() -> None:
    """Severity and rules of a finding may differ from those of its code."""
    found = diagnose("syntax", "a", Region(1, 1, 1, 1), "x", severity="note", rules=("TYP-05",))
    assert ("note", ("TYP-05",)) == (found.severity, found.rules)


def test_the_unconfirmed_is_no_error() -> None:
    """What rests on recollection is a warning at most."""
    place = Region(1, 1, 1, 1)
    error = diagnose("not-comparable", "a", place, "x", is_unconfirmed=True)
    note = diagnose("rounded", "a", place, "x", is_unconfirmed=True)
    assert ["warning", "note"] == [error.severity, note.severity]


def test_an_unknown_slug_is_a_mistake_of_ours() -> None:
    """There is no finding without a code."""
    with pytest.raises(KeyError):
        diagnose("no-such-slug", "a", Region(1, 1, 1, 1), "x")


def test_regions_come_from_spans() -> None:
    """The end of a region is the column behind its last character, in characters."""
    source = Source("ü = 1\r\nWAIT\n")
    assert Region(2, 1, 2, 5) == Region.of(source, (7, 11))
    assert Region(1, 1, 1, 2) == Region.of(source, (0, 1))
    assert Region(1, 3, 1, 3) == Region.of(source, (2, 2))


def test_order_does_not_depend_on_the_order_of_finding() -> None:
    """By path, place, code, message; the same finding stands once."""
    found = [finding(line, column) for line in (1, 3) for column in (9, 2)]
    found += [finding(1, 2, "syntax"), diagnose("syntax", "A.src", Region(9, 1, 9, 1), "x")]
    expected = in_order(found)
    assert ["A.src", *["R1/a.src"] * 5] == [one.path for one in expected]
    assert ["KRL001", "KSS2296"] == [one.code for one in expected[1:3]]
    assert [(1, 2), (1, 2), (1, 9), (3, 2), (3, 9)] == [
        (one.region.line, one.region.column) for one in expected[1:]
    ]
    for seed in range(5):
        shuffled = found * 2
        Random(seed).shuffle(shuffled)
        assert expected == in_order(shuffled)


def test_records_have_the_fields_that_were_agreed() -> None:
    """JSON has place, severity, code and message; more besides, nothing without a value."""
    edit = Fix("did you mean #CONSTANT?", Region(2, 15, 2, 21), "#CONSTANT")
    found = diagnose("no-such-constant", "a.src", Region(2, 15, 2, 21), "wrong", fix=edit)
    (record,) = json.loads(json.dumps([*records([found])]))
    expected = {
        "path": "a.src",
        "line": 2,
        "column": 15,
        "end_line": 2,
        "end_column": 21,
        "severity": "error",
        "code": "KSS2296",
        "message": "wrong",
        "reason": "",
        "rules": ["TYP-20", "TYP-16", "MSG-21"],
        "fix": {"text": "did you mean #CONSTANT?", "replacement": "#CONSTANT"},
    }
    assert expected == record
    assert next(records([finding()]))["fix"] is None
    assert not Fix("write it otherwise").is_edit


# ------------------------------------------------------------------------------------ text


def test_text_shows_line_caret_reason_and_fix() -> None:
    """A finding as people read it."""
    found = diagnose(
        *("no-such-constant", "R1/a.src", Region(2, 15, 2, 21), "ORI_TYPE has no #CONST"),
        reason="a constant belongs to its place",
        rules=("TYP-20",),
        fix=Fix("did you mean #CONSTANT?"),
    )
    assert [
        "R1/a.src:2:15: error KSS2296: ORI_TYPE has no #CONST",
        "  2 |   $ORI_TYPE = #CONST",
        "    |               ^^^^^^",
        "    = a constant belongs to its place",
        "    = did you mean #CONSTANT?",
        "",
    ] == text_of(found)
    verbose = list(rendered([(found, "")], is_verbose=True))
    assert "    = a constant belongs to its place [TYP-20]" in verbose


def test_caret_stands_under_its_place_behind_tabs() -> None:
    """A tab is shown as one blank, so that the caret fits."""
    found = diagnose("syntax", "a", Region(3, 7, 3, 10), "x")
    assert ["  3 |  WAIT SEC 1", "    |       ^^^"] == text_of(found)[1:3]


@pytest.mark.parametrize(
    ("region", "caret"),
    [
        (Region(4, 4, 4, 4), "   ^"),  # behind the last character
        (Region(4, 90, 4, 95), "   ^"),  # outside the line
        (Region(2, 3, 4, 1), "  ^^^^^^^^^^^^^^^^^^"),  # over several lines: to the end of the first
    ],
)
def test_caret_is_always_there(region: Region, caret: str) -> None:
    """A region without characters, or beyond the line, has one caret."""
    assert f"    | {caret}" == text_of(diagnose("syntax", "a", region, "x"))[2]


@pytest.mark.parametrize("column", [1, 60, 4_000, 9_990])
def test_long_lines_are_cut_around_the_caret(column: int) -> None:
    """Of a long line only the part around the caret is shown, and the caret stands under it."""
    line = "".join(chr(ord("a") + i % 26) for i in range(10_000))
    found = diagnose("syntax", "a", Region(1, column, 1, column + 3), "x")
    _, shown, caret, *_ = text_of(found, line)
    assert len(shown) < 130
    start, end = caret.index("^"), caret.rindex("^") + 1
    assert line[column - 1 : column + 2] == shown[start:end]
    assert (column > 40) == ("| …" in shown)
    assert (column < 9_000) == shown.endswith("…")


def test_wide_and_combining_characters_move_the_caret() -> None:
    """The caret counts the columns of a terminal, not characters."""
    found = diagnose("syntax", "a", Region(1, 5, 1, 6), "x")
    assert "    |     ^" == text_of(found, ";機\u0301é! ")[2]


def test_nothing_in_a_file_commands_the_terminal() -> None:
    """Escape sequences and signs that turn the text around are made visible, never sent."""
    nasty = "x = \x1b[31m \u202e \x00 \x07 \x9b"
    found = diagnose("syntax", f"{nasty}.src", Region(1, 1, 1, 3), nasty, fix=Fix(nasty))
    lines = text_of(found, nasty)
    assert all(line.isprintable() for line in lines)
    assert "  1 | x = �[31m � � � �" == lines[1]


def test_no_line_no_caret() -> None:
    """Where the source is not at hand the message stands alone."""
    place = Region(99, 1, 99, 1)
    assert ["a:99:1: error KRL001: x", ""] == text_of(diagnose("syntax", "a", place, "x"))


@given(st.text(max_size=200), st.integers(1, 220), st.integers(0, 30))
def test_rendering_never_fails(line: str, column: int, length: int) -> None:
    """Whatever a line holds, and wherever the region lies, it is shown in printable lines."""
    found = diagnose("syntax", "a", Region(1, column, 1, column + length), line)
    lines = list(rendered([(found, line)]))
    assert "" == lines[-1]
    assert all(text.isprintable() for text in lines)


def test_summary_counts() -> None:
    """How many of each, and none is said too."""
    assert "1 error, 2 notes" == summary({"note": 2, "error": 1})
    assert "no findings" == summary({})


# ---------------------------------------------------------------------------- did you mean


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("$ACT_TOL", ["$ACT_TOOL"]),
        ("$act_tool_", ["$ACT_TOOL", "$ACT_TOOL_C"]),
        ("ACT_TOOL", ["$ACT_TOOL"]),
        ("$ATC_TOOL", ["$ACT_TOOL", "$ACT_TOOL_C"]),  # two letters changed places
        ("$VLE", ["$VEL"]),
        ("$XYZ", []),
        ("$COMPLETELY_DIFFERENT", []),
        ("", []),
        ("X" * 10_000, []),
    ],
)
def test_nearest_names(name: str, expected: list[str]) -> None:
    """Names that differ by few slips, the likeliest first; never the name itself."""
    assert expected == nearest(name, ["$ACT_TOOL", "$ACT_TOOL_C", "$VEL", "$BASE"])


def test_a_name_is_not_its_own_mistake() -> None:
    """Letter case is no slip."""
    assert [] == nearest("$vel", ["$VEL"])


def test_short_names_are_not_turned_into_one_another() -> None:
    """A name of one letter is near to nothing."""
    assert [] == nearest("I", ["J", "K"])
    assert ["AB"] == nearest("AC", ["AB", "XY"])


def test_did_you_mean() -> None:
    """A question with up to three names that are equally near, as they are declared, each once."""
    names = ["SPEED1", "SPEED2", "SPEED3", "SPEED4"]
    fix = Fix("did you mean SPEED1, SPEED2 or SPEED3?", names=("SPEED1", "SPEED2", "SPEED3"))
    assert fix == did_you_mean("SPEED", names)
    one = Fix("did you mean Speed1?", names=("Speed1",))
    assert one == did_you_mean("SPEDE1", ["SPEED12", "Speed1"])
    assert one == did_you_mean("SPEDE1", ["Speed1", "Speed1"])
    assert did_you_mean("QUITE_ELSE", names) is None


WORDS = st.text("ABC_", min_size=1, max_size=9)


@given(WORDS, st.lists(WORDS, max_size=12))
def test_nearest_agrees_with_counting_slips(name: str, names: list[str]) -> None:
    """The names found are exactly those within the allowed number of slips."""
    slips = 1 if len(name) <= 4 else 2 if len(name) <= 8 else 3
    near = {n for n in names if 0 < _slips(name, n) <= slips and _slips(name, n) < len(name)}
    assert near == set(nearest(name, names, most=len(names)))


def _slips(one: str, other: str) -> int:
    """Optimal string alignment, written plainly."""
    table = [
        [i + j if i * j == 0 else 0 for j in range(len(other) + 1)] for i in range(len(one) + 1)
    ]
    for i, a in enumerate(one, 1):
        for j, b in enumerate(other, 1):
            best = min(table[i - 1][j], table[i][j - 1]) + 1
            best = min(best, table[i - 1][j - 1] + (a != b))
            if i > 1 and j > 1 and a == other[j - 2] and one[i - 2] == b:
                best = min(best, table[i - 2][j - 2] + 1)
            table[i][j] = best
    return table[-1][-1]
