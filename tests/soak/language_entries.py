"""Entry points that read programs: `krl check`, `krl format`, `krl lsp`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.soak.foundry import Foundry
from tests.soak.given import Entry, Given, archive, krl, program
from tests.soak.kept import damaged


def check_again(folder: Path, foundry: Foundry) -> Given:
    """Findings that were kept, and damaged."""
    damaged(folder, foundry, "check")
    return krl("check", folder / "in", "--cache", folder / "out" / "cache")


def editor(folder: Path, foundry: Foundry) -> Given:
    """An editor that says strange things to the language server, and then goes."""
    uri = (folder / "a.src").as_uri()
    document: dict[str, Any] = {"uri": uri}
    text = foundry.program().decode("utf-8", "replace")
    opened = {**document, "languageId": "krl", "version": 1, "text": text}
    place = {"line": foundry.chance.randrange(40), "character": foundry.chance.randrange(90)}
    asked = {"textDocument": document, "position": place}
    said: list[tuple[str, Any]] = [
        ("initialize", {"processId": None, "rootUri": folder.as_uri(), "capabilities": {}}),
        ("initialized", {}),
        ("textDocument/didOpen", {"textDocument": opened}),
        ("textDocument/hover", asked),
        ("textDocument/definition", asked),
        ("textDocument/documentSymbol", {"textDocument": document}),
        ("textDocument/foldingRange", {"textDocument": document}),
        ("textDocument/formatting", {"textDocument": document, "options": {"tabSize": 2}}),
        ("textDocument/didChange", {"textDocument": opened, "contentChanges": [{"text": text}]}),
        ("textDocument/didClose", {"textDocument": document}),
    ]
    messages = [
        {"jsonrpc": "2.0", "id": number, "method": method, "params": params}
        for number, (method, params) in enumerate(said)
    ]
    first = foundry.chance.choice([0, 1, 3])
    return Given(["lsp"], _framed(messages[:first]) + foundry.messages(messages[first:]))


def _framed(messages: list[Any]) -> bytes:
    bodies = [json.dumps(message).encode() for message in messages]
    return b"".join(b"Content-Length: %d\r\n\r\n" % len(body) + body for body in bodies)


ENTRIES = {
    "check": Entry(
        110,
        "a program, its name strange too",
        lambda d, f: krl("check", "--no-cache", "--", program(d, f)),
    ),
    "check archive": Entry(80, "an archive", lambda d, f: krl("check", archive(d, f))),
    "check sarif": Entry(
        40,
        "a program, findings as SARIF",
        lambda d, f: krl("check", "--format", "sarif", "--", program(d, f)),
    ),
    "check json": Entry(
        30,
        "a program, findings as JSON",
        lambda d, f: krl("check", "--format", "json", "--", program(d, f)),
    ),
    "check cache": Entry(20, "findings kept from an earlier check", check_again),
    "format": Entry(
        50, "a program, compared", lambda d, f: krl("format", "--check", "--", program(d, f))
    ),
    "format files": Entry(
        30, "a program, written anew", lambda d, f: krl("format", "--", program(d, f))
    ),
    "lsp": Entry(3, "what an editor says", editor),
}
