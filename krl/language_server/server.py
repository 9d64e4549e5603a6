"""The language server: handles the requests of an editor with the modules of this folder."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, lsp_method
from pygls.uris import from_fs_path, to_fs_path

from grammar.diagnostics.diagnostic import Region
from grammar.syntax.formatter import FormatterDefect, formatter
from krl.language_server import protocol
from krl.language_server.calls import argument_hints, signature_at
from krl.language_server.hover import definition, found_at, hover
from krl.language_server.names import RenameError, completions, highlights, places, renaming
from krl.language_server.protocol import location, path_of, range_of
from krl.language_server.semantic_tokens import MODIFIERS, TYPES, semantic_tokens
from krl.language_server.symbols import folds, outline, wanted
from krl.language_server.workspace import AnalysedFile, OpenProject
from krl.running.project_folders import project_root

# Seconds without a change after which files without an open view are checked.
_PAUSE = 0.3

#: The answer to each request, by its method, with the options that an editor is told.
_ANSWERS: dict[str, tuple[Any, Callable[..., Any]]] = {}
_Answer = TypeVar("_Answer", bound=Callable[..., Any])


def server() -> LanguageServer:
    """Return a server that is not running yet; `start_io` runs it."""
    made = LanguageServer(
        "krl",
        metadata.version("krl-workbench"),
        lsp.TextDocumentSyncKind.Full,
        protocol_cls=_InUtf16,
    )
    _Handlers(made)
    return made


class _InUtf16(LanguageServerProtocol):
    """Uses UTF-16 positions, which every client supports, even if a client prefers bytes."""

    @lsp_method(lsp.INITIALIZE)
    def lsp_initialize(
        self, params: lsp.InitializeParams
    ) -> Generator[Any, Any, lsp.InitializeResult]:
        """Answer ``initialize`` with the capabilities of this server."""
        if params.capabilities.general is not None:
            params.capabilities.general.position_encodings = None
        return (yield from super().lsp_initialize(params))


def _answers(
    method: str,
    options: Any = None,
    *,
    about: Callable[[_Handlers, Any], Sequence[Any] | None] | None = None,
    nothing: Callable[[], Any] = lambda: None,
) -> Callable[[_Answer], _Answer]:
    """Register a method of `_Handlers` for a request of an editor.

    It gets what the request is ``about`` instead of the request; the answer is ``nothing()`` if
    there is no such thing.
    """

    def registered(answer: _Answer) -> _Answer:
        def answered(handlers: _Handlers, given: Any) -> Any:
            found = about(handlers, given) if about is not None else None
            return nothing() if found is None else answer(handlers, *found)

        _ANSWERS[method] = options, answer if about is None else answered
        return answer

    return registered


def _file(handlers: _Handlers, given: Any) -> tuple[AnalysedFile] | None:
    looked = handlers.project.look(path_of(given.text_document.uri))
    return None if looked is None else (looked,)


def _place(handlers: _Handlers, given: Any) -> tuple[AnalysedFile, int] | None:
    """Return the file and the offset of a request; ``None`` if the file has no such place."""
    looked = handlers.project.look(path_of(given.text_document.uri))
    if looked is None or given.position.line >= len(looked.source.lines):
        return None
    line = looked.source.line(given.position.line + 1)
    column = protocol.characters(line, given.position.character)
    return looked, looked.source.offset(given.position.line + 1, column + 1)


class _Handlers:
    """The session of one editor: its files, and the handlers of its requests."""

    def __init__(self, server: LanguageServer) -> None:
        self._server = server
        self.project = OpenProject()
        #: The URIs of open files by path, as the editor writes them.
        self._open: dict[str, str] = {}
        #: The files of settings that the editor was told to be refused.
        self._refused: set[Path] = set()
        self._is_read = False
        self._is_graded = False
        self._catching_up: asyncio.Task[None] | None = None
        for method, (options, answer) in _ANSWERS.items():
            server.feature(method, options)(partial(answer, self))

    # -- what happens to files

    @_answers(lsp.INITIALIZED)
    async def initialised(self, _given: lsp.InitializedParams) -> None:
        """Read the folders that the editor has open; requests are answered meanwhile."""
        folders: list[lsp.WorkspaceFolder] = []
        with suppress(RuntimeError):  # an editor that did not say `initialize` first
            folders += self._server.workspace.folders.values()
        for folder in folders:
            path = to_fs_path(folder.uri)
            if path is not None:
                count = 0
                for _ in self.project.add_folder(project_root(Path(path))):
                    count += 1
                    await asyncio.sleep(0)
                logging.getLogger(__name__).info("%d files below %s", count, path)
        self._is_read = True
        self._publish(*sorted(self._open))

    @_answers(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(self, given: lsp.DidOpenTextDocumentParams) -> None:
        """Use the editor's text of a file instead of the text on disk.

        Documents that are no files, such as older versions of one, belong to no project.
        """
        uri = given.text_document.uri
        if to_fs_path(uri) is None:
            return
        path = path_of(uri)
        self._open[path] = uri
        self.project.change(path, given.text_document.text)
        self.project.changed()  # an editor need not watch the settings
        self._publish(path)

    @_answers(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(self, given: lsp.DidChangeTextDocumentParams) -> None:
        """Use the new text of a file."""
        document = self._server.workspace.get_text_document(given.text_document.uri)
        path = path_of(document.uri)
        if path in self._open:
            self.project.change(path, document.source)
            self._publish(path)

    @_answers(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(self, given: lsp.DidCloseTextDocumentParams) -> None:
        """Use the text on disk again."""
        path = path_of(given.text_document.uri)
        uri = self._open.pop(path, None)
        if uri is not None:
            self.project.reload(path)
            self._tell(uri, [])
            self._publish()

    @_answers(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def changed_on_disk(self, given: lsp.DidChangeWatchedFilesParams) -> None:
        """Read the files that changed outside the editor."""
        for change in given.changes:
            self.project.changed_on_disk(path_of(change.uri), self._open)
        self._publish(*sorted(self._open))

    def _publish(self, *paths: str) -> None:
        """Publish the findings of open files; soon also those of all others that a change affects.

        Nothing is published before the folder is read, because names would be reported as missing.
        """
        if not self._is_read:
            return
        for path in paths:
            self._tell_file(path)
        self._tell_refused()
        if self._catching_up is not None:
            self._catching_up.cancel()
        self._catching_up = asyncio.get_running_loop().create_task(self._catch_up())

    async def _catch_up(self) -> None:
        """Check all files that a change affects, after a pause in typing; then publish."""
        if self._is_graded:
            await asyncio.sleep(_PAUSE)
        for _ in self.project.catch_up():
            await asyncio.sleep(0)
        self._is_graded = True
        for path in sorted(self._open):
            self._tell_file(path)
            await asyncio.sleep(0)

    def _tell_file(self, path: str) -> None:
        looked = self.project.look(path)
        if looked is not None and path in self._open:
            found = [protocol.diagnostic(looked.source, one) for one in looked.diagnostics]
            self._tell(self._open[path], found)

    def _tell_refused(self) -> None:
        refused = self.project.refused
        for file in self._refused | refused.keys():
            self._tell(file.as_uri(), [protocol.refusal(refused[file])] if file in refused else [])
        self._refused = {*refused}

    def _tell(self, uri: str, found: list[lsp.Diagnostic]) -> None:
        self._server.text_document_publish_diagnostics(
            lsp.PublishDiagnosticsParams(uri=uri, diagnostics=found)
        )

    # -- what is asked

    @_answers(lsp.TEXT_DOCUMENT_HOVER, about=_place)
    def hover(self, looked: AnalysedFile, offset: int) -> lsp.Hover | None:
        """Return the meaning of the word under the pointer, with rule and source."""
        said = hover(self.project, looked, offset)
        if said is None:
            return None
        text, region = said
        content = lsp.MarkupContent(kind=lsp.MarkupKind.Markdown, value=text)
        return lsp.Hover(contents=content, range=range_of(looked.source, region))

    @_answers(lsp.TEXT_DOCUMENT_DEFINITION, about=_place)
    def definition(self, looked: AnalysedFile, offset: int) -> lsp.Location | None:
        """Return the declaration of the name under the cursor."""
        found = definition(self.project, looked, offset)
        return None if found is None else location(*found)

    @_answers(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL, about=_file, nothing=list)
    def symbols(self, looked: AnalysedFile) -> list[lsp.DocumentSymbol]:
        """Return the routines and data of a file."""
        return [protocol.document_symbol(looked.source, one) for one in outline(looked)]

    @_answers(lsp.WORKSPACE_SYMBOL)
    def workspace_symbols(self, given: lsp.WorkspaceSymbolParams) -> list[lsp.WorkspaceSymbol]:
        """Return the routines and data of all files that match a query."""
        found = (protocol.workspace_symbol(*one) for one in wanted(self.project, given.query))
        return [one for one in found if one is not None]

    @_answers(lsp.TEXT_DOCUMENT_FOLDING_RANGE, about=_file, nothing=list)
    def folds(self, looked: AnalysedFile) -> list[lsp.FoldingRange]:
        """Return the folding ranges of a file: ;FOLD … ;ENDFOLD, routines and blocks."""
        return [
            lsp.FoldingRange(start_line=first - 1, end_line=last - 1)
            for first, last in folds(looked)
        ]

    @_answers(lsp.TEXT_DOCUMENT_FORMATTING)
    def formatting(self, given: lsp.DocumentFormattingParams) -> list[lsp.TextEdit] | None:
        """Return the edit that lays the file out as `krl format`; nothing if it cannot be read."""
        source = self.project.source(path_of(given.text_document.uri))
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

    @_answers(
        lsp.TEXT_DOCUMENT_COMPLETION,
        lsp.CompletionOptions(trigger_characters=["$", "#", "."]),
        about=_place,
        nothing=list,
    )
    def completion(self, looked: AnalysedFile, offset: int) -> list[lsp.CompletionItem]:
        """Return the names that can be written at the cursor."""
        found = completions(looked, offset)
        return [protocol.completion_item(one, place) for place, one in enumerate(found)]

    @_answers(
        lsp.TEXT_DOCUMENT_SIGNATURE_HELP,
        lsp.SignatureHelpOptions(trigger_characters=["(", ","]),
        about=_place,
    )
    def signature(self, looked: AnalysedFile, offset: int) -> lsp.SignatureHelp | None:
        """Return the parameters of the routine whose arguments are being typed."""
        found = signature_at(looked, offset)
        if found is None:
            return None
        parameters = [lsp.ParameterInformation(one) for one in found.parameters]
        said = lsp.SignatureInformation(found.label, parameters=parameters)
        return lsp.SignatureHelp([said], active_signature=0, active_parameter=found.active)

    @_answers(lsp.TEXT_DOCUMENT_INLAY_HINT)
    def hints(self, given: lsp.InlayHintParams) -> list[lsp.InlayHint]:
        """Return parameter names as inlay hints for arguments."""
        looked = self.project.look(path_of(given.text_document.uri))
        if looked is None:
            return []
        first, last = given.range.start.line + 1, given.range.end.line + 1
        return [
            lsp.InlayHint(
                protocol.position_of(looked.source, place),
                f"{name}:",
                kind=lsp.InlayHintKind.Parameter,
                padding_right=True,
            )
            for place, name in argument_hints(looked, first, last)
        ]

    @_answers(
        lsp.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL,
        lsp.SemanticTokensLegend(list(TYPES), list(MODIFIERS)),
        about=_file,
        nothing=lambda: lsp.SemanticTokens([]),
    )
    def tokens(self, looked: AnalysedFile) -> lsp.SemanticTokens:
        """Return the semantic token of each name."""
        return lsp.SemanticTokens(protocol.encoded(looked.source, semantic_tokens(looked)))

    @_answers(lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, about=_place, nothing=list)
    def highlight(self, looked: AnalysedFile, offset: int) -> list[lsp.DocumentHighlight]:
        """Return the places in this file of the name under the cursor."""
        found = found_at(looked, offset)
        regions = [] if found is None else sorted(highlights(looked, found))
        return [lsp.DocumentHighlight(range_of(looked.source, one)) for one in regions]

    @_answers(lsp.TEXT_DOCUMENT_REFERENCES, about=_place, nothing=list)
    def references(self, looked: AnalysedFile, offset: int) -> list[lsp.Location]:
        """Return all places of a name."""
        return [
            one
            for path, region in places(self.project, looked, offset)
            if (source := self.project.source(path)) and (one := location(source, region))
        ]

    @_answers(lsp.TEXT_DOCUMENT_PREPARE_RENAME, about=_place)
    def can_be_renamed(self, looked: AnalysedFile, offset: int) -> lsp.Range | None:
        """Return the range of the name to rename, or ``None`` if no file declares it."""
        found = found_at(looked, offset)
        if found is None or found.module is None:
            return None
        line, column = looked.source.place(offset)
        for one in highlights(looked, found):
            if one.line == line and one.column <= column <= one.end_column:
                return range_of(looked.source, one)
        return None

    @_answers(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    def rename(self, given: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        """Return the edits that rename a name; an invalid new name is reported to the editor."""
        asked = _place(self, given)
        if asked is None:
            return None
        try:
            found = renaming(self.project, *asked, given.new_name)
        except RenameError as error:
            raise JsonRpcInvalidParams(str(error)) from None
        changes: dict[str, list[lsp.TextEdit]] = {}
        for path, region in found:
            source, uri = self.project.source(path), from_fs_path(path)
            if source is not None and uri is not None:
                edit = lsp.TextEdit(range=range_of(source, region), new_text=given.new_name)
                changes.setdefault(uri, []).append(edit)
        return lsp.WorkspaceEdit(changes=changes)

    @_answers(lsp.TEXT_DOCUMENT_CODE_ACTION)
    def actions(self, given: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        """Return the fixes of findings in a range, and comments that suppress them."""
        uri = given.text_document.uri
        looked = self.project.look(path_of(uri))
        if looked is None:
            return []
        source, lines = looked.source, (given.range.start.line, given.range.end.line)
        found = []
        for one in looked.diagnostics:
            if not lines[0] <= one.region.line - 1 <= lines[1]:
                continue
            shown = protocol.diagnostic(source, one)
            is_safe = one.fix is not None and one.fix.is_edit
            for text, region, written in one.edits:
                edit = lsp.TextEdit(range=range_of(source, region), new_text=written)
                found.append(protocol.action(text, uri, edit, shown, is_preferred=is_safe))
            if source.comment(one.region.line) is None:
                end = len(source.line(one.region.line)) + 1
                place = Region(one.region.line, end, one.region.line, end)
                text = f" ; krl: ignore[{one.code}]"
                edit = lsp.TextEdit(range=range_of(source, place), new_text=text)
                found.append(protocol.action(f"ignore {one.code} here", uri, edit, shown))
        return found
