"""Conversion between the server's data and the types of the protocol.

Editors count lines and characters from 0, and characters in the units of UTF-16; the project counts
both from 1, in characters.
"""

from __future__ import annotations

from collections.abc import Iterable
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
    """An edit that a finding offers."""
    return lsp.CodeAction(
        title=title,
        kind=lsp.CodeActionKind.QuickFix,
        diagnostics=[of],
        edit=lsp.WorkspaceEdit(changes={uri: [edit]}),
        is_preferred=is_preferred,
    )


def path_of(uri: str) -> str:
    """The path of a file, or the address itself for what is no file."""
    path = to_fs_path(uri)
    return uri if path is None else Path(path).absolute().as_posix()


def characters(line: str, units: int) -> int:
    """So many units of UTF-16, as characters of a line."""
    count = 0
    for place, character in enumerate(line):
        if count >= units:
            return place
        count += 1 + (ord(character) > 0xFFFF)
    return len(line)


def _units(line: str, characters: int) -> int:
    """So many characters of a line, as units of UTF-16."""
    return sum(1 + (ord(character) > 0xFFFF) for character in line[:characters])


def _position(source: Source, line: int, column: int) -> lsp.Position:
    text = source.line(line) if line <= len(source.lines) else ""
    return lsp.Position(line=line - 1, character=_units(text, column - 1))


def range_of(source: Source, region: Region) -> lsp.Range:
    """A region as an editor has it."""
    return lsp.Range(
        start=_position(source, region.line, region.column),
        end=_position(source, region.end_line, region.end_column),
    )


def diagnostic(source: Source, found: Diagnostic) -> lsp.Diagnostic:
    """A finding with its reason, its remedy and the rules that say so."""
    said = [found.message, found.reason, found.fix.text if found.fix else ""]
    rules = f" [{', '.join(found.rules)}]" if found.rules else ""
    return lsp.Diagnostic(
        range=range_of(source, found.region),
        message="; ".join(part for part in said if part) + rules,
        severity=_SEVERITIES[found.severity],
        code=found.code,
        source="krl",
    )


def document_symbol(source: Source, found: Outline) -> lsp.DocumentSymbol:
    """A routine or a declaration, with what stands in it."""
    return lsp.DocumentSymbol(
        name=found.name,
        kind=_KINDS.get(found.kind, lsp.SymbolKind.Variable),
        detail=found.detail,
        range=range_of(source, found.whole),
        selection_range=range_of(source, found.region),
        children=[document_symbol(source, one) for one in found.inner],
    )


def workspace_symbol(source: Source, found: Outline) -> lsp.WorkspaceSymbol | None:
    """A declaration with its file; ``None`` for a path that is no address."""
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
    """A region of a file; ``None`` for a path that is no address."""
    uri = from_fs_path(source.path)
    return None if uri is None else lsp.Location(uri=uri, range=range_of(source, region))


def completion_item(found: Candidate, place: int) -> lsp.CompletionItem:
    """A name that can be written, the ``place``-th of them."""
    return lsp.CompletionItem(
        label=found.name,
        kind=_COMPLETED.get(found.kind, lsp.CompletionItemKind.Variable),
        detail=found.detail or None,
        sort_text=f"{place:06}",  # those nearby first
    )


def position_of(source: Source, offset: int) -> lsp.Position:
    """An offset as a place in an editor."""
    return _position(source, *source.place(offset))


def encoded(source: Source, tokens: Iterable[tuple[int, int, int, int]]) -> list[int]:
    """Semantic tokens as the protocol has them: five numbers each, relative to the one before."""
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
