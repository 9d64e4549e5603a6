"""Diagnostics as SARIF 2.1.0, the format that editors and code hosts read.

There is one run, whose rules are the codes that occur. Columns count characters. A file that was
given by a relative path has a relative URI.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any
from urllib.parse import quote

from grammar.diagnostics.codes import DiagnosticCode, by_code
from grammar.diagnostics.diagnostic import Diagnostic, Region, in_order

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def sarif(diagnostics: Iterable[Diagnostic], version: str) -> dict[str, Any]:
    """Return a SARIF log of findings; ``version`` is that of the tool."""
    found = in_order(diagnostics)
    rules = [by_code()[name] for name in sorted({diagnostic.code for diagnostic in found})]
    indices = {rule.code: index for index, rule in enumerate(rules)}
    driver = {"name": "krl", "version": version, "rules": [_rule(rule) for rule in rules]}
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "results": [_result(one, indices[one.code]) for one in found],
    }
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _rule(code: DiagnosticCode) -> dict[str, Any]:
    return {
        "id": code.code,
        "name": "".join(word.capitalize() for word in code.slug.split("-")),
        "shortDescription": {"text": code.title},
        "fullDescription": {"text": code.explanation},
        "defaultConfiguration": {"level": code.severity},
        "properties": {"slug": code.slug, "tags": list(code.rules)},
    }


def _result(diagnostic: Diagnostic, index: int) -> dict[str, Any]:
    fix = diagnostic.fix
    said = (diagnostic.message, diagnostic.reason, fix.text if fix else "")
    result: dict[str, Any] = {
        "ruleId": diagnostic.code,
        "ruleIndex": index,
        "level": diagnostic.severity,
        "message": {"text": " ".join(_sentence(text) for text in said if text)},
        "locations": [
            {
                "physicalLocation": {
                    "artifactLocation": _artifact(diagnostic.path),
                    "region": _region(diagnostic.region),
                }
            }
        ],
        "properties": {"rules": list(diagnostic.rules)},
    }
    if diagnostic.edits:
        result["fixes"] = [_fix(*edit, diagnostic.path) for edit in diagnostic.edits]
    return result


def _fix(text: str, region: Region, replacement: str, path: str) -> dict[str, Any]:
    edit = {"deletedRegion": _region(region), "insertedContent": {"text": replacement}}
    change = {"artifactLocation": _artifact(path), "replacements": [edit]}
    return {"description": {"text": text}, "artifactChanges": [change]}


def _region(region: Region) -> dict[str, int]:
    return {
        "startLine": region.line,
        "startColumn": region.column,
        "endLine": region.end_line,
        "endColumn": region.end_column,
    }


def _artifact(path: str) -> dict[str, str]:
    """Return the location of a file by its URI; relative ones are relative to ``%SRCROOT%``."""
    drive = path[:2] if re.match(r"[A-Za-z]:/", path) else ""
    # A name that is no Unicode, which some systems have, must not end in a traceback.
    uri = quote(path[len(drive) :], errors="replace")
    if drive:
        return {"uri": f"file:///{drive}{uri}"}
    if path.startswith("/"):
        return {"uri": f"file:{uri}" if path.startswith("//") else f"file://{uri}"}
    return {"uri": uri, "uriBaseId": "%SRCROOT%"}


def _sentence(text: str) -> str:
    return text if text.endswith((".", "?", "!")) else f"{text}."
