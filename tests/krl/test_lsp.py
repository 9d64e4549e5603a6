"""`krl lsp`, driven by a real client over pipes."""

import asyncio
import io
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

lsp = pytest.importorskip("lsprotocol.types")
pytest.importorskip("pygls")

from pygls.lsp.client import LanguageClient  # noqa: E402 - only where it is installed

from grammar.syntax.formatter import formatter  # noqa: E402 - behind the one above
from krl.commands.lsp import Bounded  # noqa: E402
from krl.errors import InputError  # noqa: E402
from krl.language_server.semantic_tokens import TYPES  # noqa: E402

PROGRAM = """DEF Cell()
  ; »ä𝄞« before the name
  HALT
  Fetch(nParts)
$OUT[7]=TRUE
  CONTINUE
  nPart = 2
END

DEF Fetch(n:IN)
  INT n
END
"""
DATA = "DEFDAT Cell\n  DECL INT nParts=8 ; how many are on the pallet\nENDDAT\n"


class _Editor(LanguageClient):
    """A client that keeps the findings it is sent."""

    def __init__(self) -> None:
        super().__init__("test", "1")
        self.found: dict[str, list[Any]] = {}
        self.news = asyncio.Event()

        def hear(given: Any) -> None:
            self.found[given.uri.rpartition("/")[2]] = given.diagnostics
            self.news.set()

        self.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(hear)

    async def diagnostics(self, name: str, wanted: Callable[[list[Any]], bool]) -> list[Any]:
        """The findings of a file, once they are as wanted."""
        while not (name in self.found and wanted(self.found[name])):
            self.news.clear()
            await self.news.wait()
        return self.found[name]


@dataclass
class _Heard:
    """What the server said in one session."""

    before: list[tuple[int, int, str]] = field(default_factory=list)
    after: list[Any] = field(default_factory=list)
    hover: dict[str, str] = field(default_factory=dict)
    places: dict[str, tuple[str, int, int]] = field(default_factory=dict)
    symbols: list[tuple[str, list[str]]] = field(default_factory=list)
    set_out: str = ""
    files: set[str] = field(default_factory=set)
    more: dict[str, Any] = field(default_factory=dict)


async def _session(editor: Any, folder: Path, heard: _Heard) -> None:
    """Open Cell.src, ask, type a declaration."""
    uri = (folder / "Cell.src").as_uri()
    await editor.start_io(sys.executable, "-m", "krl", "lsp")
    await editor.initialize_async(
        lsp.InitializeParams(
            # as Neovim says it, which would rather count bytes
            capabilities=lsp.ClientCapabilities(
                general=lsp.GeneralClientCapabilities(position_encodings=["utf-8", "utf-16"])
            ),
            workspace_folders=[lsp.WorkspaceFolder(uri=folder.as_uri(), name="cell")],
            root_uri=folder.as_uri(),
        )
    )
    editor.initialized(lsp.InitializedParams())
    for one, text in (
        (f"git:{folder.as_posix()}/Cell.src?HEAD", PROGRAM),
        (f"{folder.as_uri()}/(2).src", "DEF Two()\n  HALT\nEND\n"),
        (uri, PROGRAM),
    ):
        item = lsp.TextDocumentItem(uri=one, language_id="krl", version=1, text=text)
        editor.text_document_did_open(lsp.DidOpenTextDocumentParams(text_document=item))
    heard.before = [
        (one.range.start.line, one.range.start.character, one.code)
        for one in await editor.diagnostics("Cell.src", bool)
        if one.code == "KRL101"
    ]
    for word in ("CONTINUE", "$OUT", "nParts"):
        hover = await editor.text_document_hover_async(lsp.HoverParams(**_at(uri, word)))
        heard.hover[word] = "" if hover is None else hover.contents.value
    for word in ("nParts", "Fetch"):
        found = await editor.text_document_definition_async(lsp.DefinitionParams(**_at(uri, word)))
        start = found.range.start
        heard.places[word] = found.uri.rpartition("/")[2], start.line, start.character
    document = lsp.TextDocumentIdentifier(uri=uri)
    listed = await editor.text_document_document_symbol_async(
        lsp.DocumentSymbolParams(text_document=document)
    )
    heard.symbols = [(one.name, [inner.name for inner in one.children]) for one in listed]
    edits = await editor.text_document_formatting_async(
        lsp.DocumentFormattingParams(
            text_document=document, options=lsp.FormattingOptions(tab_size=2, insert_spaces=True)
        )
    )
    heard.set_out = edits[0].new_text
    editor.text_document_did_change(
        lsp.DidChangeTextDocumentParams(
            text_document=lsp.VersionedTextDocumentIdentifier(uri=uri, version=2),
            content_changes=[
                lsp.TextDocumentContentChangeWholeDocument(
                    text=PROGRAM.replace("DEF Cell()\n", "DEF Cell()\n  DECL INT nPart\n")
                )
            ],
        )
    )
    await editor.diagnostics("Cell.src", lambda found: all(one.code != "KRL101" for one in found))
    heard.after = [one for one in editor.found["Cell.src"] if one.code == "KRL101"]
    heard.more = await _asked(editor, uri)
    heard.files = {*editor.found}
    await editor.shutdown_async(None)
    editor.exit(None)
    await editor.stop()


async def _asked(editor: Any, uri: str) -> dict[str, Any]:
    """The text with a declaration more, which moves lines down by one."""
    document = lsp.TextDocumentIdentifier(uri=uri)
    whole = lsp.Range(start=lsp.Position(0, 0), end=lsp.Position(99, 0))
    fetch = lsp.Position(line=4, character=3)
    hints = await editor.text_document_inlay_hint_async(lsp.InlayHintParams(document, whole))
    marks = await editor.text_document_document_highlight_async(
        lsp.DocumentHighlightParams(document, fetch)
    )
    tokens = await editor.text_document_semantic_tokens_full_async(
        lsp.SemanticTokensParams(document)
    )
    found = await editor.workspace_symbol_async(lsp.WorkspaceSymbolParams("fth"))
    help_ = await editor.text_document_signature_help_async(
        lsp.SignatureHelpParams(document, lsp.Position(line=4, character=8))
    )
    name = await editor.text_document_prepare_rename_async(
        lsp.PrepareRenameParams(position=fetch, text_document=document)
    )
    folds = await editor.text_document_folding_range_async(lsp.FoldingRangeParams(document))
    return {
        "hints": [(one.position.line, one.position.character, one.label) for one in hints],
        "marks": [(one.range.start.line, one.range.start.character) for one in marks],
        "tokens": [
            (tokens.data[n + 2], TYPES[tokens.data[n + 3]]) for n in range(0, len(tokens.data), 5)
        ],
        "symbols": [(one.name, one.location.uri.rpartition("/")[2]) for one in found],
        "help": (help_.signatures[0].label, help_.active_parameter),
        "name": (name.start.character, name.end.character),
        "folds": [(one.start_line, one.end_line) for one in folds],
    }


@pytest.fixture(scope="module")
def heard(tmp_path_factory: pytest.TempPathFactory) -> _Heard:
    """One session with a real server; starting one takes seconds."""
    folder = tmp_path_factory.mktemp("cell")
    (folder / "Cell.dat").write_text(DATA, encoding="utf-8")
    (folder / "Cell.src").write_text(PROGRAM, encoding="utf-8")
    said = _Heard()
    asyncio.run(_session(_Editor(), folder, said))
    return said


def _at(uri: str, word: str) -> dict[str, Any]:
    line = next(n for n, text in enumerate(PROGRAM.splitlines()) if word in text)
    column = PROGRAM.splitlines()[line].index(word) + 1
    position = lsp.Position(line=line, character=column)
    return {"text_document": lsp.TextDocumentIdentifier(uri=uri), "position": position}


def test_findings_come_while_one_types(heard: _Heard) -> None:
    """A name that is declared nowhere is told; declaring it in the text takes the finding away."""
    assert [(6, 2)] == [place[:2] for place in heard.before]
    assert [] == heard.after


def test_findings_are_those_of_files(heard: _Heard) -> None:
    """Each file has them under the URI that the editor uses; what is no file has none."""
    assert {"(2).src", "Cell.src"} == heard.files


def test_hover_shows_rule_and_source(heard: _Heard) -> None:
    """A keyword and a system variable are told with their rules, a name with its declaration."""
    assert "ADV-08" in heard.hover["CONTINUE"]
    assert "stops the advance run when written [ADV-05" in heard.hover["$OUT"]
    assert "INT nParts" in heard.hover["nParts"]
    assert "how many are on the pallet" in heard.hover["nParts"]
    assert "Cell.dat:2" in heard.hover["nParts"]


def test_definitions_are_found_across_files(heard: _Heard) -> None:
    """A variable leads to its data list, a call to the routine."""
    assert {"nParts": ("Cell.dat", 1, 11), "Fetch": ("Cell.src", 9, 4)} == heard.places


def test_symbols_are_listed(heard: _Heard) -> None:
    """Routines are listed with their data."""
    assert [("Cell", []), ("Fetch", ["n"])] == heard.symbols


def test_calls_are_reported(heard: _Heard) -> None:
    """The parameter of each argument, and what the routine takes whose arguments one types."""
    assert [(4, 8, "n:")] == heard.more["hints"]
    assert ("DEF Fetch(n:IN INT)", 0) == heard.more["help"]


def test_names_are_distinguished(heard: _Heard) -> None:
    """Places in the file, kinds for colours, the region to be renamed, names that fit a query."""
    assert [(4, 2), (10, 4)] == heard.more["marks"]
    assert (4, "function") == heard.more["tokens"][0]
    assert {(5, "function"), (6, "variable"), (1, "parameter")} < set(heard.more["tokens"])
    assert (2, 7) == heard.more["name"]
    assert [("Fetch", "Cell.src")] == heard.more["symbols"]


def test_routines_are_folded(heard: _Heard) -> None:
    """Down to the line before their end."""
    assert [(0, 7), (10, 11)] == heard.more["folds"]


def test_formatting_is_that_of_krl_format(heard: _Heard) -> None:
    """A file is set out as `krl format` sets it out."""
    assert formatter().layout(PROGRAM) == heard.set_out
    assert PROGRAM != heard.set_out


def test_a_message_larger_than_any_is_refused() -> None:
    """The length is a claim: nothing of that size is laid out in memory."""
    command = [sys.executable, "-m", "krl", "lsp"]
    said = b"Content-Length: 1000000000000\r\n\r\n{}"
    done = subprocess.run(command, input=said, capture_output=True, check=False)
    assert 2 == done.returncode
    assert done.stderr.decode().startswith("krl: a message of 1,000,000,000,000 bytes")


def test_a_line_without_an_end_is_refused() -> None:
    """Nor is what stands before a message read to its end."""
    with pytest.raises(InputError, match="a line of more than 1,000 bytes"):
        Bounded(io.BytesIO(b"x" * 5_000)).readline()
