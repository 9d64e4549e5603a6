"""What an editor sends to the language server or the debug adapter: input of `krl bench growth`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

#: A message of an editor: its method, whether it is a request, its parameters.
_Message = tuple[str, bool, Any]
_AT_CURSOR: Final = (
    *("hover", "definition", "completion", "signatureHelp", "documentHighlight", "references"),
    *("prepareRename", "rename"),
)


def _opened(file: Path, text: str) -> _Message:
    document = {"uri": file.as_uri(), "languageId": "krl", "version": 1, "text": text}
    return "textDocument/didOpen", False, {"textDocument": document}


def session(file: Path) -> bytes:
    """Return the messages of an editor that opens a file, requests its features, and exits."""
    uri = {"uri": file.as_uri()}
    text = file.read_text(encoding="utf-8")
    changed = {
        "textDocument": {**uri, "version": 2},
        "contentChanges": [{"text": text + "; changed\n"}],
    }
    asked = ("documentSymbol", "semanticTokens/full", "foldingRange", "formatting")
    wanted = {"textDocument": uri, "options": {"tabSize": 2, "insertSpaces": True}}
    return _session(
        [
            _opened(file, text),
            *((f"textDocument/{what}", True, wanted) for what in asked),
            ("textDocument/didChange", False, changed),
            ("textDocument/documentSymbol", True, wanted),
        ]
    )


def questions(file: Path) -> bytes:
    """Return the messages of an editor that asks about the longest line of a file, and all lines.

    The cursor is in the middle of the line, then at its end.
    """
    uri = {"uri": file.as_uri()}
    text = file.read_text(encoding="utf-8")
    lines = text.split("\n")
    number = max(range(len(lines)), key=lambda number: len(lines[number]))
    ends = {"start": {"line": 0, "character": 0}, "end": {"line": len(lines), "character": 0}}
    whole = {"textDocument": uri, "range": ends, "context": {"diagnostics": []}}
    said = [_opened(file, text)]
    for column in (len(lines[number]) // 2, len(lines[number])):
        place = {"line": number, "character": column}
        at = {"textDocument": uri, "position": place, "newName": "Q"}
        at["context"] = {"includeDeclaration": True}
        said += [(f"textDocument/{what}", True, at) for what in _AT_CURSOR]
    said += [(f"textDocument/{what}", True, whole) for what in ("codeAction", "inlayHint")]
    return _session([*said, ("workspace/symbol", True, {"query": "A"})])


def tabs(folder: Path) -> bytes:
    """Return the messages of an editor that opens all files of a folder."""
    files = sorted(folder.rglob("*.src"))
    return _session([_opened(file, file.read_text(encoding="utf-8")) for file in files])


def _session(said: Sequence[_Message]) -> bytes:
    """Return the messages of an editor from its start to its end, framed."""
    start: dict[str, Any] = {"processId": None, "rootUri": None, "capabilities": {}}
    whole: list[_Message] = [
        ("initialize", True, start),
        ("initialized", False, {}),
        *said,
        ("shutdown", True, None),
        ("exit", False, None),
    ]
    return _framed(
        {"jsonrpc": "2.0", "method": method, "params": params}
        | ({"id": number} if is_request else {})
        for number, (method, is_request, params) in enumerate(whole)
    )


def breakpoints(file: Path) -> bytes:
    """Return the messages of an editor that sets a breakpoint on each line of a program."""
    source = {"path": str(file)}
    lines = file.read_text(encoding="utf-8").count("\n")
    asked: dict[str, Any] = {
        "initialize": {},
        "launch": {"program": str(file)},
        "setBreakpoints": {
            "source": source,
            "breakpoints": [{"line": line + 1} for line in range(lines)],
        },
        "breakpointLocations": {"source": source, "line": 1, "endLine": lines},
        "configurationDone": {},
        "disconnect": {},
    }
    return _framed(
        {"seq": number, "type": "request", "command": name, "arguments": arguments}
        for number, (name, arguments) in enumerate(asked.items(), 1)
    )


def _framed(messages: Iterable[Mapping[str, Any]]) -> bytes:
    bodies = (json.dumps(one).encode() for one in messages)
    return b"".join(b"Content-Length: %d\r\n\r\n%b" % (len(body), body) for body in bodies)
