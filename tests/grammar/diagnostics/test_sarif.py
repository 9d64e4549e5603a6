"""Findings as SARIF: every object has what the schema of SARIF 2.1.0 asks for, and nothing else."""

import json
from typing import Any
from urllib.parse import unquote, urlsplit

import pytest

from grammar.diagnostics.codes import by_slug
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region, diagnose
from grammar.diagnostics.sarif import sarif

#: The objects of SARIF 2.1.0 that we write: their properties, with what each is. A star marks those
#: that must be there; others than these may not. A list with a plus has at least one element.
OBJECTS: dict[str, str] = {
    "log": "$schema:uri version*:2.1.0 runs*:[run]",
    "run": "tool*:tool results:[result] columnKind:unicodeCodePoints",
    "tool": "driver*:driver",
    "driver": "name*:str version:str rules:[rule]",
    "rule": (
        "id*:str name:str shortDescription:text fullDescription:text "
        "defaultConfiguration:configuration properties:bag"
    ),
    "text": "text*:str",
    "configuration": "level:level",
    "result": (
        "ruleId:str ruleIndex:index level:level message*:text "
        "locations:[location] fixes:[fix] properties:bag"
    ),
    "location": "physicalLocation:place",
    "place": "artifactLocation*:artifact region:region",
    "artifact": "uri:uri uriBaseId:str",
    "region": "startLine:count startColumn:count endLine:count endColumn:count",
    "fix": "description:text artifactChanges*:[change]+",
    "change": "artifactLocation*:artifact replacements*:[replacement]+",
    "replacement": "deletedRegion*:region insertedContent:text",
}


def violations(value: Any, kind: str, at: str = "log") -> list[str]:
    """Where a value is not what the schema asks for."""
    if kind in OBJECTS:
        if not isinstance(value, dict):
            return [f"{at}: not an object"]
        pairs = [field.split(":", 1) for field in OBJECTS[kind].split()]
        fields = {name.rstrip("*"): what for name, what in pairs}
        needed = {name.rstrip("*") for name, _ in pairs if name.endswith("*")}
        found = [f"{at}: no {name}" for name in needed - set(value)]
        found += [f"{at}: {name} is not allowed" for name in set(value) - set(fields)]
        for name in set(value) & set(fields):
            found += violations(value[name], fields[name], f"{at}.{name}")
        return found
    if kind.startswith("["):
        if not isinstance(value, list) or (kind.endswith("+") and not value):
            return [f"{at}: not a list, or an empty one"]
        inner = kind[1:].rstrip("+").rstrip("]")
        return [v for i, item in enumerate(value) for v in violations(item, inner, f"{at}[{i}]")]
    return [] if _is_plain(value, kind) else [f"{at}: {value!r} is no {kind}"]


def _is_plain(value: Any, kind: str) -> bool:
    match kind:
        case "str":
            return isinstance(value, str)
        case "uri":
            return isinstance(value, str) and value.isascii() and " " not in value
        case "count" | "index":
            return type(value) is int and value >= (kind == "count")
        case "level":
            return value in ("none", "note", "warning", "error")
        case "bag":
            tags = value.get("tags", [])
            return len(tags) == len(set(tags)) and all(isinstance(tag, str) for tag in tags)
    return bool(value == kind)


def place(line: int = 3) -> Region:
    return Region(line, 5, line, 9)


def findings() -> list[Diagnostic]:
    edit = Fix("did you mean #CONSTANT?", place(), "#CONSTANT")
    return [
        diagnose("no-such-constant", "R1/a b.src", place(), "wrong", reason="why", fix=edit),
        diagnose("no-such-constant", "R1/a b.src", place(4), "wrong", fix=Fix("otherwise")),
        diagnose("rounded", "R1/a b.src", Region(1, 1, 2, 1), "is rounded"),
    ]


@pytest.mark.parametrize(
    ("way", "name", "value"),
    [
        ([], "tool", None),
        ([], "colour", "red"),
        (["results", 1], "level", "fatal"),
        (["results", 1], "message", "text"),
        (["results", 1, "fixes", 0], "artifactChanges", []),
        (["results", 1, "locations", 0, "physicalLocation", "region"], "startLine", 0),
        (["results", 1, "locations", 0, "physicalLocation", "artifactLocation"], "uri", "a b"),
        (["tool", "driver", "rules", 0, "properties"], "tags", ["A", "A"]),
    ],
)
def test_the_check_finds_what_is_wrong(way: list[str | int], name: str, value: object) -> None:
    """The schema above refuses what is missing, additional or of another kind."""
    log = json.loads(json.dumps(sarif(findings(), "1.0")))
    assert [] == violations(log, "log")
    spoiled = log["runs"][0]
    for step in way:
        spoiled = spoiled[step]
    if value is None:
        del spoiled[name]
    else:
        spoiled[name] = value
    assert 1 == len(violations(log, "log"))


def test_no_findings_is_a_log_as_well() -> None:
    """A clean run has an empty list of results."""
    log = sarif([], "1.0")
    assert [] == violations(log, "log")
    assert [] == log["runs"][0]["results"]


def test_every_code_makes_a_valid_rule() -> None:
    """All codes of the table can be rules; results point at theirs."""
    log = sarif([diagnose(slug, "a.src", place(), "x") for slug in by_slug()], "1.0")
    assert [] == violations(log, "log")
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert len(by_slug()) == len(rules) == len({rule["id"] for rule in rules})
    assert all(rules[result["ruleIndex"]]["id"] == result["ruleId"] for result in run["results"])


def test_rules_are_those_of_the_findings() -> None:
    """A rule has its code, name, title, explanation and usual severity."""
    rules = sarif(findings(), "1.0")["runs"][0]["tool"]["driver"]["rules"]
    assert ["KRL209", "KSS2296"] == [rule["id"] for rule in rules]
    assert "NoSuchConstant" == rules[1]["name"]
    assert {"level": "error"} == rules[1]["defaultConfiguration"]


def test_results_are_in_order_and_say_everything() -> None:
    """Message, reason and advice are one text; an edit is a fix besides."""
    rounded, first, second = sarif(reversed(findings()), "1.0")["runs"][0]["results"]
    assert ["note", "error", "error"] == [r["level"] for r in (rounded, first, second)]
    assert "wrong. why. did you mean #CONSTANT?" == first["message"]["text"]
    (change,) = first["fixes"][0]["artifactChanges"]
    assert [{"text": "#CONSTANT"}] == [r["insertedContent"] for r in change["replacements"]]
    assert "fixes" not in second
    assert "wrong. otherwise." == second["message"]["text"]


def test_regions_are_ours() -> None:
    """Lines and columns count from 1, the end is behind the last character."""
    region = sarif(findings(), "1.0")["runs"][0]["results"][0]["locations"][0]
    expected = {"startLine": 1, "startColumn": 1, "endLine": 2, "endColumn": 1}
    assert expected == region["physicalLocation"]["region"]


@pytest.mark.parametrize(
    ("path", "uri"),
    [
        ("R1/Program/main.src", "R1/Program/main.src"),
        ("a b#1%.src", "a%20b%231%25.src"),
        ("$config.dat", "%24config.dat"),
        ("x:y.src", "x%3Ay.src"),
        ("../größe.src", "../gr%C3%B6%C3%9Fe.src"),
        ("/home/a b.src", "file:///home/a%20b.src"),
        ("C:/KRC/a.src", "file:///C:/KRC/a.src"),
        ("//server/share/a.src", "file://server/share/a.src"),
        ("broken\udcff.src", "broken%3F.src"),
    ],
)
def test_files_are_uris(path: str, uri: str) -> None:
    """Relative paths stay relative; whatever a name holds, the URI is a valid one."""
    log = sarif([diagnose("syntax", path, place(), "x")], "1.0")
    assert [] == violations(log, "log")
    location = log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    artifact = location["artifactLocation"]
    assert uri == artifact["uri"]
    assert uri.startswith("file:") == ("uriBaseId" not in artifact)
    if not uri.startswith("file:") and path.isprintable():
        assert ("", path) == (urlsplit(uri).scheme, unquote(uri))
