"""The language server itself: what an editor asks, translated for `krl.language_server` and back.

Editors count lines and characters from 0, and characters in the units of UTF-16; the project counts
both from 1, in characters. Nothing else happens here.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from grammar.diagnostics.diagnostic import Diagnostic, Region
from grammar.semantics.symbols import Kind
from grammar.syntax.formatter import FormatterDefect, formatter
from grammar.syntax.source import Source
from krl.language_server.hover import Outline, definition, hover, outline
from krl.language_server.names import RenameError, completions, places, renaming
from krl.language_server.workspace import Looked, OpenProject
from krl.program_loading import project_root

__all__ = ["server"]

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
    Kind.ROUTINE: lsp.CompletionItemKind.Function,
    Kind.EXTERNAL: lsp.CompletionItemKind.Function,
    Kind.CONSTANT: lsp.CompletionItemKind.Constant,
    Kind.STRUCTURE: lsp.CompletionItemKind.Struct,
    Kind.ENUMERATION: lsp.CompletionItemKind.Enum,
    Kind.ENUM_CONSTANT: lsp.CompletionItemKind.EnumMember,
    Kind.MEMBER: lsp.CompletionItemKind.Field,
}
_AtPlace = (
    lsp.HoverParams
    | lsp.DefinitionParams
    | lsp.CompletionParams
    | lsp.ReferenceParams
    | lsp.RenameParams
)


def server() -> LanguageServer:
    """A server that has not begun yet: `start_io` runs it."""
    made = LanguageServer("krl", metadata.version("krl-workbench"), lsp.TextDocumentSyncKind.Full)
    _Desk(made)
    return made


class _Desk:
    """One editor's session: its files, and the answers to what it asks."""

    def __init__(self, server: LanguageServer) -> None:
        self._server = server
        self._project = OpenProject()
        self._open: set[str] = set()
        answers: dict[str, Callable[[Any], Any]] = {
            lsp.INITIALIZED: self.initialised,
            lsp.TEXT_DOCUMENT_DID_OPEN: self.opened,
            lsp.TEXT_DOCUMENT_DID_CHANGE: self.changed,
            lsp.TEXT_DOCUMENT_DID_CLOSE: self.closed,
            lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES: self.changed_on_disk,
            lsp.TEXT_DOCUMENT_HOVER: self.hover,
            lsp.TEXT_DOCUMENT_DEFINITION: self.definition,
            lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL: self.symbols,
            lsp.TEXT_DOCUMENT_FOLDING_RANGE: self.folds,
            lsp.TEXT_DOCUMENT_FORMATTING: self.formatting,
            lsp.TEXT_DOCUMENT_CODE_ACTION: self.actions,
            lsp.TEXT_DOCUMENT_REFERENCES: self.references,
            lsp.TEXT_DOCUMENT_RENAME: self.rename,
        }
        for method, answer in answers.items():
            server.feature(method)(_plain(answer))
        signs = lsp.CompletionOptions(trigger_characters=["$", "#", "."])
        server.feature(lsp.TEXT_DOCUMENT_COMPLETION, signs)(_plain(self.completion))

    # -- what happens to files

    def initialised(self, _given: lsp.InitializedParams) -> None:
        """Take in the folders that the editor has open."""
        for folder in self._server.workspace.folders.values():
            path = to_fs_path(folder.uri)
            if path is not None:
                count = self._project.add_folder(project_root(Path(path)))
                logging.getLogger(__name__).info("%d files below %s", count, path)

    def opened(self, given: lsp.DidOpenTextDocumentParams) -> None:
        """A file is open in the editor: its text counts, not the disk's."""
        path = _path(given.text_document.uri)
        self._open.add(path)
        self._project.change(path, given.text_document.text)
        self._publish()

    def changed(self, given: lsp.DidChangeTextDocumentParams) -> None:
        """Something was typed."""
        document = self._server.workspace.get_text_document(given.text_document.uri)
        self._project.change(_path(document.uri), document.source)
        self._publish()

    def closed(self, given: lsp.DidCloseTextDocumentParams) -> None:
        """A file is closed: what is on the disk counts again."""
        path = _path(given.text_document.uri)
        self._open.discard(path)
        self._project.reload(path)
        self._tell(given.text_document.uri, [])
        self._publish()

    def changed_on_disk(self, given: lsp.DidChangeWatchedFilesParams) -> None:
        """Files changed outside the editor."""
        for change in given.changes:
            path = _path(change.uri)
            if path not in self._open:
                self._project.reload(path)
        self._publish()

    def _publish(self) -> None:
        """Findings of all open files: a declaration in one may be missed in another."""
        for path in sorted(self._open):
            looked = self._project.look(path)
            uri = from_fs_path(path)
            if looked is not None and uri is not None:
                self._tell(uri, [_diagnostic(looked.source, one) for one in looked.diagnostics])

    def _tell(self, uri: str, found: list[lsp.Diagnostic]) -> None:
        self._server.text_document_publish_diagnostics(
            lsp.PublishDiagnosticsParams(uri=uri, diagnostics=found)
        )

    # -- what is asked

    def hover(self, given: lsp.HoverParams) -> lsp.Hover | None:
        """What the word under the pointer means, with rule and source."""
        asked = self._asked(given)
        if asked is None:
            return None
        looked, offset = asked
        said = hover(self._project, looked, offset)
        if said is None:
            return None
        text, region = said
        content = lsp.MarkupContent(kind=lsp.MarkupKind.Markdown, value=text)
        return lsp.Hover(contents=content, range=_range(looked.source, region))

    def definition(self, given: lsp.DefinitionParams) -> lsp.Location | None:
        """Where the name under the cursor is declared."""
        asked = self._asked(given)
        found = None if asked is None else definition(self._project, *asked)
        if found is None:
            return None
        source, uri = self._project.source(found.path), from_fs_path(found.path)
        if source is None or uri is None:
            return None
        return lsp.Location(uri=uri, range=_range(source, found.region))

    def symbols(self, given: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
        """Routines and data of a file."""
        looked = self._project.look(_path(given.text_document.uri))
        if looked is None:
            return []
        return [_symbol(looked.source, one) for one in outline(looked)]

    def folds(self, given: lsp.FoldingRangeParams) -> list[lsp.FoldingRange]:
        """The ;FOLD … ;ENDFOLD of a file."""
        source = self._project.source(_path(given.text_document.uri))
        if source is None:
            return []
        return [
            lsp.FoldingRange(start_line=fold.first - 1, end_line=fold.last - 1)
            for fold in source.folds
            if fold.last is not None
        ]

    def formatting(self, given: lsp.DocumentFormattingParams) -> list[lsp.TextEdit] | None:
        """The file set out as `krl format` does; nothing for one that cannot be read."""
        source = self._project.source(_path(given.text_document.uri))
        if source is None:
            return None
        try:
            text = formatter().layout(source.text, source.path)
        except FormatterDefect:
            return None
        if not isinstance(text, str) or text == source.text:
            return None
        whole = lsp.Range(
            start=lsp.Position(line=0, character=0),
            end=lsp.Position(line=len(source.lines), character=0),
        )
        return [lsp.TextEdit(range=whole, new_text=text)]

    def completion(self, given: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        """The names that can be written where one types."""
        asked = self._asked(given)
        found = [] if asked is None else completions(*asked)
        return [
            lsp.CompletionItem(
                label=one.name,
                kind=_COMPLETED.get(one.kind, lsp.CompletionItemKind.Variable),
                detail=one.detail or None,
                sort_text=f"{place:06}",  # those nearby first
            )
            for place, one in enumerate(found)
        ]

    def references(self, given: lsp.ReferenceParams) -> list[lsp.Location]:
        """All places of a name."""
        asked = self._asked(given)
        found = [] if asked is None else places(self._project, *asked)
        return [
            lsp.Location(uri=uri, range=_range(source, region))
            for path, region in found
            if (source := self._project.source(path)) and (uri := from_fs_path(path))
        ]

    def rename(self, given: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        """Another name in all places of one; what is wrong with it is told the editor."""
        asked = self._asked(given)
        if asked is None:
            return None
        try:
            found = renaming(self._project, *asked, given.new_name)
        except RenameError as error:
            raise JsonRpcInvalidParams(str(error)) from None
        changes: dict[str, list[lsp.TextEdit]] = {}
        for path, region in found:
            source, uri = self._project.source(path), from_fs_path(path)
            if source is not None and uri is not None:
                edit = lsp.TextEdit(range=_range(source, region), new_text=given.new_name)
                changes.setdefault(uri, []).append(edit)
        return lsp.WorkspaceEdit(changes=changes)

    def actions(self, given: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        """The edits of findings in a range, and comments that silence these."""
        uri = given.text_document.uri
        looked = self._project.look(_path(uri))
        if looked is None:
            return []
        source, lines = looked.source, (given.range.start.line, given.range.end.line)
        found = []
        for one in looked.diagnostics:
            if not lines[0] <= one.region.line - 1 <= lines[1]:
                continue
            shown = _diagnostic(source, one)
            fix = one.fix
            if fix is not None and fix.region is not None and fix.replacement is not None:
                edit = lsp.TextEdit(range=_range(source, fix.region), new_text=fix.replacement)
                found.append(_action(fix.text, uri, edit, shown, is_preferred=True))
            if source.comment(one.region.line) is None:
                end = len(source.line(one.region.line)) + 1
                place = Region(one.region.line, end, one.region.line, end)
                text = f" ; krl: ignore[{one.code}]"
                edit = lsp.TextEdit(range=_range(source, place), new_text=text)
                found.append(_action(f"ignore {one.code} here", uri, edit, shown))
        return found

    def _asked(self, given: _AtPlace) -> tuple[Looked, int] | None:
        """The file that is asked about, and the offset in it; ``None`` for a place it has not."""
        looked = self._project.look(_path(given.text_document.uri))
        if looked is None or given.position.line >= len(looked.source.lines):
            return None
        line = looked.source.line(given.position.line + 1)
        column = _characters(line, given.position.character)
        return looked, looked.source.offset(given.position.line + 1, column + 1)


def _action(
    title: str, uri: str, edit: lsp.TextEdit, of: lsp.Diagnostic, *, is_preferred: bool = False
) -> lsp.CodeAction:
    return lsp.CodeAction(
        title=title,
        kind=lsp.CodeActionKind.QuickFix,
        diagnostics=[of],
        edit=lsp.WorkspaceEdit(changes={uri: [edit]}),
        is_preferred=is_preferred,
    )


def _plain(answer: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A function of its own: the server marks what it is given, and a method cannot be marked."""

    def ask(given: Any) -> Any:
        return answer(given)

    return ask


def _path(uri: str) -> str:
    """The path of a file, or the address itself for what is no file."""
    path = to_fs_path(uri)
    return uri if path is None else Path(path).absolute().as_posix()


def _characters(line: str, units: int) -> int:
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


def _range(source: Source, region: Region) -> lsp.Range:
    return lsp.Range(
        start=_position(source, region.line, region.column),
        end=_position(source, region.end_line, region.end_column),
    )


def _diagnostic(source: Source, found: Diagnostic) -> lsp.Diagnostic:
    said = [found.message, found.reason, found.fix.text if found.fix else ""]
    rules = f" [{', '.join(found.rules)}]" if found.rules else ""
    return lsp.Diagnostic(
        range=_range(source, found.region),
        message="; ".join(part for part in said if part) + rules,
        severity=_SEVERITIES[found.severity],
        code=found.code,
        source="krl",
    )


def _symbol(source: Source, found: Outline) -> lsp.DocumentSymbol:
    return lsp.DocumentSymbol(
        name=found.name,
        kind=_KINDS.get(found.kind, lsp.SymbolKind.Variable),
        detail=found.detail,
        range=_range(source, found.whole),
        selection_range=_range(source, found.region),
        children=[_symbol(source, one) for one in found.inner],
    )
