"""Conversion between the project's data and the types of the protocol.

Editors count lines and characters from 0, and characters in UTF-16 code units; the project counts
both from 1, in characters.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

from lsprotocol import types as lsp
from pygls.uris import from_fs_path, to_fs_path

from grammar.diagnostics.diagnostic import Diagnostic, Region
from grammar.semantics.symbols import Kind
from grammar.syntax.source import Source
from krl.language_server.names import Candidate
from krl.language_server.symbols import Outline

_SEVERITIES = {
    "error": lsp.DiagnosticSeverity.Error,
    "warning": lsp.DiagnosticSeverity.Warning,
    "note": lsp.DiagnosticSeverity.Information,
}
_KINDS = {
    Kind.ROUTINE: lsp.SymbolKind.Function,
    Kind.EXTERNAL: lsp.SymbolKind.Function,
    Kind.CONSTANT: lsp.SymbolKind.Constant,
    Kind.STRUCTURE: lsp.SymbolKind.Struct,
    Kind.ENUMERATION: lsp.SymbolKind.Enum,
    Kind.CHANNEL: lsp.SymbolKind.Interface,
    Kind.SIGNAL: lsp.SymbolKind.Event,
}

_COMPLETED: dict[Kind | None, lsp.CompletionItemKind] = {
    None: lsp.CompletionItemKind.Keyword,
    Kind.ROUTINE: lsp.CompletionItemKind.Function,
    Kind.EXTERNAL: lsp.CompletionItemKind.Function,
    Kind.CONSTANT: lsp.CompletionItemKind.Constant,
    Kind.STRUCTURE: lsp.CompletionItemKind.Struct,
    Kind.ENUMERATION: lsp.CompletionItemKind.Enum,
    Kind.ENUM_CONSTANT: lsp.CompletionItemKind.EnumMember,
    Kind.MEMBER: lsp.CompletionItemKind.Field,
}


def action(
    title: str, uri: str, edit: lsp.TextEdit, of: lsp.Diagnostic, *, is_preferred: bool = False
) -> lsp.CodeAction:
    """Return the edit of a finding as a code action."""
    return lsp.CodeAction(
        title=title,
        kind=lsp.CodeActionKind.QuickFix,
        diagnostics=[of],
        edit=lsp.WorkspaceEdit(changes={uri: [edit]}),
        is_preferred=is_preferred,
    )


def path_of(uri: str) -> str:
    """Return the path of a file, or the URI itself if it is not a file."""
    path = to_fs_path(uri)
    return uri if path is None else Path(path).absolute().as_posix()


def characters(line: str, units: int) -> int:
    """Return the number of characters in the first ``units`` UTF-16 code units of a line."""
    count = 0
    for place, character in enumerate(line):
        if count >= units:
            return place
        count += 1 + (ord(character) > 0xFFFF)
    return len(line)


@lru_cache(maxsize=16)
def _wide(line: str) -> tuple[int, ...]:
    """Return the places of the characters of a line that are two UTF-16 code units each."""
    return tuple(place for place, one in enumerate(line) if ord(one) > 0xFFFF)


def _units(line: str, characters: int) -> int:
    """Return the number of UTF-16 code units in the first ``characters`` of a line."""
    characters = min(characters, len(line))
    return characters if line.isascii() else characters + bisect_left(_wide(line), characters)


def _position(source: Source, line: int, column: int) -> lsp.Position:
    text = source.line(line) if line <= len(source.lines) else ""
    return lsp.Position(line=line - 1, character=_units(text, column - 1))


def range_of(source: Source, region: Region) -> lsp.Range:
    """Return a region as a range of the protocol."""
    return lsp.Range(
        start=_position(source, region.line, region.column),
        end=_position(source, region.end_line, region.end_column),
    )


def diagnostic(source: Source, found: Diagnostic) -> lsp.Diagnostic:
    """Return a finding with its reason, its fix and its rules."""
    said = [found.message, found.reason, found.fix.text if found.fix else ""]
    rules = f" [{', '.join(found.rules)}]" if found.rules else ""
    return lsp.Diagnostic(
        range=range_of(source, found.region),
        message="; ".join(part for part in said if part) + rules,
        severity=_SEVERITIES[found.severity],
        code=found.code,
        source="krl",
    )


def refusal(message: str) -> lsp.Diagnostic:
    """Return why a file of settings cannot be used, for its beginning."""
    start = lsp.Position(line=0, character=0)
    return lsp.Diagnostic(
        range=lsp.Range(start=start, end=start),
        message=message,
        severity=_SEVERITIES["error"],
        source="krl",
    )


def document_symbol(source: Source, found: Outline) -> lsp.DocumentSymbol:
    """Return a routine or a declaration with its inner declarations."""
    return lsp.DocumentSymbol(
        name=found.name,
        kind=_KINDS.get(found.kind, lsp.SymbolKind.Variable),
        detail=found.detail,
        range=range_of(source, found.whole),
        selection_range=range_of(source, found.region),
        children=[document_symbol(source, one) for one in found.inner],
    )


def workspace_symbol(source: Source, found: Outline) -> lsp.WorkspaceSymbol | None:
    """Return a declaration with its file, or ``None`` if its path has no URI."""
    place = location(source, found.region)
    if place is None:
        return None
    return lsp.WorkspaceSymbol(
        name=found.name,
        kind=_KINDS.get(found.kind, lsp.SymbolKind.Variable),
        location=place,
        container_name=source.name,
    )


def location(source: Source, region: Region) -> lsp.Location | None:
    """Return a region of a file, or ``None`` if its path has no URI."""
    uri = from_fs_path(source.path)
    return None if uri is None else lsp.Location(uri=uri, range=range_of(source, region))


def completion_item(found: Candidate, place: int) -> lsp.CompletionItem:
    """Return a completion item; ``place`` is its rank."""
    return lsp.CompletionItem(
        label=found.name,
        kind=_COMPLETED.get(found.kind, lsp.CompletionItemKind.Variable),
        detail=found.detail or None,
        sort_text=f"{place:06}",  # those nearby first
    )


def position_of(source: Source, offset: int) -> lsp.Position:
    """Return an offset as a position of the protocol."""
    return _position(source, *source.place(offset))


def encoded(source: Source, tokens: Iterable[tuple[int, int, int, int]]) -> list[int]:
    """Return semantic tokens as encoded by the protocol: five relative numbers each."""
    data: list[int] = []
    line = character = 0
    for offset, length, type_, modifiers in tokens:
        at = position_of(source, offset)
        if at.line != line:
            character = 0
        units = _units(source.text[offset : offset + length], length)
        data += [at.line - line, at.character - character, units, type_, modifiers]
        line, character = at.line, at.character
    return data
