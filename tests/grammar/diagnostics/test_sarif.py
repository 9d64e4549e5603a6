"""Findings as SARIF: every object has what the schema of SARIF 2.1.0 asks for, and nothing else."""

from typing import Any
from urllib.parse import unquote, urlsplit

import pytest
from jsonschema import Draft202012Validator

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


PLAIN: dict[str, dict[str, Any]] = {
    "str": {"type": "string"},
    "uri": {"type": "string", "pattern": "^[!-~]*$"},
    "count": {"type": "integer", "minimum": 1},
    "index": {"type": "integer", "minimum": 0},
    "level": {"enum": ["none", "note", "warning", "error"]},
    "bag": {"properties": {"tags": {"uniqueItems": True, "items": {"type": "string"}}}},
}


def schema(kind: str) -> dict[str, Any]:
    """The JSON Schema of what a property is."""
    if kind.startswith("["):
        inner = schema(kind[1:].rstrip("+").rstrip("]"))
        return {"type": "array", "items": inner, "minItems": int(kind.endswith("+"))}
    return {"$ref": f"#/$defs/{kind}"} if kind in OBJECTS else PLAIN.get(kind, {"const": kind})


def objects() -> dict[str, Any]:
    """The JSON Schema of a log."""
    found = {}
    for name, properties in OBJECTS.items():
        fields = dict(each.split(":", 1) for each in properties.split())
        found[name] = {
            "type": "object",
            "properties": {key.rstrip("*"): schema(kind) for key, kind in fields.items()},
            "required": [key.rstrip("*") for key in fields if key.endswith("*")],
            "additionalProperties": False,
        }
    return {"$defs": found, **schema("log")}


def violations(log: Any) -> list[str]:
    """Where a log is not what the schema asks for."""
    return [error.message for error in Draft202012Validator(objects()).iter_errors(log)]


def place(line: int = 3) -> Region:
    return Region(line, 5, line, 9)


def findings() -> list[Diagnostic]:
    edit = Fix("did you mean #CONSTANT?", place(), "#CONSTANT")
    return [
        diagnose("no-such-constant", "R1/a b.src", place(), "wrong", reason="why", fix=edit),
        diagnose("no-such-constant", "R1/a b.src", place(4), "wrong", fix=Fix("otherwise")),
        diagnose("rounded", "R1/a b.src", Region(1, 1, 2, 1), "is rounded"),
    ]


def test_no_findings_is_a_log_as_well() -> None:
    """A clean run has an empty list of results."""
    log = sarif([], "1.0")
    assert [] == violations(log)
    assert [] == log["runs"][0]["results"]


def test_every_code_makes_a_valid_rule() -> None:
    """All codes of the table can be rules; results point at theirs."""
    log = sarif([diagnose(slug, "a.src", place(), "x") for slug in by_slug()], "1.0")
    assert [] == violations(log)
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
    assert [] == violations(log)
    location = log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    artifact = location["artifactLocation"]
    assert uri == artifact["uri"]
    assert uri.startswith("file:") == ("uriBaseId" not in artifact)
    if not uri.startswith("file:") and path.isprintable():
        assert ("", path) == (urlsplit(uri).scheme, unquote(uri))
