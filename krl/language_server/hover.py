"""Hover texts: the meaning of a name, and where it is declared."""

from __future__ import annotations

import re
from collections.abc import Sequence

from conformance.suite.registry import registry
from grammar.diagnostics.diagnostic import Diagnostic, Region
from grammar.diagnostics.explanations import explanation
from grammar.semantics.predefined import PredefinedFunction, System, SystemVariable
from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Kind
from grammar.syntax.source import Source
from krl.language_server.symbols import signature
from krl.language_server.workspace import AnalysedFile, OpenProject

_WORD = re.compile(r"\$?[A-Za-z_][A-Za-z0-9_$]*")
_MOST_RULES = 6
_TIERS = {
    "P": "manual or KUKA's own file",
    "T": "transcription of a manual",
    "F": "practitioners",
    "D": "measured on controller files",
    "R": "recollection, unconfirmed",
    "X": "unknown origin, unconfirmed",
}


def definition(
    project: OpenProject, looked: AnalysedFile, offset: int
) -> tuple[Source, Region] | None:
    """Return where the name at an offset is declared, or ``None`` if no file declares it."""
    found = found_at(looked, offset)
    if found is None or found.module is None:
        return None
    source = project.source(found.module.path)
    if source is None:
        return None
    return source, Region.of(source, found.symbol.span)


def hover(project: OpenProject, looked: AnalysedFile, offset: int) -> tuple[str, Region] | None:
    """Return the hover text for the word at an offset as Markdown, and the region of the word.

    Findings at that place are explained first, with the message number of the controller.
    """
    found = _findings(looked, offset)
    word = _word_at(looked.source, offset)
    meant = found_at(looked, offset)
    said = None
    if meant is not None and meant.module is not None:
        said = _declared(project, looked, meant)
    elif word is not None:
        said = _predefined(word[0].upper())
    parts = [*map(_explained, found), *([said] if said else [])]
    if not parts:
        return None
    region = word[1] if word is not None else found[0].region
    return "\n\n---\n\n".join(parts), region


def _findings(looked: AnalysedFile, offset: int) -> list[Diagnostic]:
    place = looked.source.place(offset)
    return [
        one
        for one in looked.diagnostics
        if (one.region.line, one.region.column)
        <= place
        <= (one.region.end_line, one.region.end_column)
    ]


def _explained(found: Diagnostic) -> str:
    known = explanation(found.code)
    if known is None:
        return found.message
    lines = [f"**{found.code}** {known.code.title}", known.code.explanation]
    if known.message is not None:
        lines.append(f"message of the controller: {known.message}")
    return "\n\n".join([*lines, *_cited(found.rules, "")])


def _word_at(source: Source, offset: int) -> tuple[str, Region] | None:
    line, column = source.place(offset)
    for found in _WORD.finditer(source.line(line)):
        if found.start() <= column - 1 <= found.end():
            return found.group(), Region(line, found.start() + 1, line, found.end() + 1)
    return None


def found_at(looked: AnalysedFile, offset: int) -> Found | None:
    """Return the declaration of the name at an offset or ending there, or ``None``."""
    return next(
        (found for name, found in looked.names() if name.span[0] <= offset <= name.span[1]), None
    )


def _declared(project: OpenProject, looked: AnalysedFile, found: Found) -> str:
    assert found.module is not None, "asked only of what a file declares"
    symbol = found.symbol
    path = found.module.path
    source = project.source(path)
    place = path.rpartition("/")[2]
    lines = [f"```krl\n{signature(symbol)}\n```"]
    if source is not None:
        number = source.place(symbol.span[0])[0]
        comment = source.comment(number)
        place = f"{place}:{number}"
        if comment is not None:
            lines.append(comment.text.lstrip("; "))
    lines.append(f"{symbol.kind.value}, {place}")
    if looked.project is not None and symbol.kind in (Kind.VARIABLE, Kind.CONSTANT):
        lines.append(f"seen from: {symbol.access.value}")
    return "\n\n".join(lines)


def _predefined(key: str) -> str | None:
    """Return the text for a system variable, predefined routine or keyword, with its rules."""
    system = System.load()
    variable, function = system.variables.get(key), system.functions.get(key)
    if variable is not None:
        return "\n\n".join([*_variable(variable), *_cited(variable.source, key)])
    if function is not None:
        return "\n\n".join([*_function(function), *_cited(function.source, key)])
    rules = _cited((), key)
    return "\n\n".join([f"`{key}`", *rules]) if rules else None


def _variable(variable: SystemVariable) -> list[str]:
    lines = [f"```krl\n{variable.type} {variable.name}\n```"]
    if variable.meaning not in ("", "-"):
        lines.append(variable.meaning)
    if variable.access == "read":
        lines.append("write-protected")
    stops = {"read": variable.stops_on_read, "written": variable.stops_on_write}
    for how, rules in stops.items():
        if rules:
            lines.append(f"stops the advance run when {how} [{', '.join(rules)}]")
    if variable.twin:
        lines.append(f"value in the main run: `{variable.twin}`")
    return lines


def _function(function: PredefinedFunction) -> list[str]:
    parameters = [f"{one.name}:{one.mode} {one.type}" for one in function.parameters]
    if function.more is not None:
        parameters.append(f"{function.more.mode} …".lstrip())
    result = f"{function.result} " if function.result is not None else ""
    lines = [f"```krl\n{result}{function.name}({', '.join(parameters)})\n```"]
    if function.meaning not in ("", "-"):
        lines.append(function.meaning)
    if function.stops:
        lines.append(f"stops the advance run [{', '.join(function.stops)}]")
    return lines


def _cited(source: Sequence[str], word: str) -> list[str]:
    """Return the rules in a table row, then those that mention the word, with their tiers.

    FOR stands behind another keyword in WAIT FOR: rules of which all mentions are such come last.
    """
    rules = registry()
    named = re.compile(rf"(?<![\w$]){re.escape(word)}(?!\w)")
    alone = re.compile(rf"(?<![A-Z]{{2}} ){named.pattern}")
    wanted = [rules[key] for key in source if key in rules]
    mention = [
        rule for rule in rules.values() if rule not in wanted and named.search(rule.statement)
    ]
    wanted += sorted(mention, key=lambda rule: alone.search(rule.statement) is None)
    return [
        f"**{rule.id}** {rule.statement} *({_tier(rule.tier)})*" for rule in wanted[:_MOST_RULES]
    ]


def _tier(tier: str) -> str:
    return "; ".join(_TIERS.get(letter, letter) for letter in tier.split("+"))
