"""The commands that `krl bench growth` measures, and the shapes of their inputs."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from grammar.generation.shapes import SHAPES, Shape

PROGRAM: Final = "DEF A()\nEND\n"
_ONE_TEST: Final = '[[test]]\nname = "one"\nexpect = [\n'
_A_TEST: Final = _ONE_TEST + '"ends before 1"]\n'
_CASE: Final = ";@ rule: ADV-03\n;@ title: A case\n;@ phase: run\nDEF a()\n"

#: Writes an input of about the given number of characters into a folder, and returns its path.
Writer = Callable[[Path, int], Path]


def _archive(folder: Path, size: int) -> Path:
    """Return an archive with many small members."""
    path = folder / "a.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for i in range(max(1, size // 100)):
            archive.writestr(f"KRC/R1/Program/A{i}.src", PROGRAM.replace("A", f"A{i}"))
    return path


def _folder(folder: Path, size: int) -> Path:
    """Return a folder with many small files that name one another."""
    count = max(1, size // 100)
    for i in range(count):
        text = f"DEF A{i}()\nINT I\nI=1\nA{(i + 1) % count}()\nEND\n"
        (folder / f"A{i}.src").write_text(text, encoding="ascii", newline="")
    return folder


def _written(shape: Shape) -> Writer:
    def write(folder: Path, size: int) -> Path:
        path = folder / shape.name
        path.write_text(shape.text(size), encoding="utf-8", newline="")
        return path

    return write


def _shapes(shapes: Mapping[str, Shape], name: str | None = None) -> dict[str, Writer]:
    """Return functions that write files of these shapes, by title; ``name`` is the file name."""
    return {
        title: _written(shape if name is None else replace(shape, name=name))
        for title, shape in shapes.items()
    }


def _beside_program(inputs: Mapping[str, Writer]) -> dict[str, Writer]:
    """Return functions that also write a program into the folder of the file."""

    def beside(writer: Writer) -> Writer:
        def write(folder: Path, size: int) -> Path:
            (folder / "a.src").write_text(PROGRAM, encoding="ascii", newline="")
            return writer(folder, size)

        return write

    return {title: beside(writer) for title, writer in inputs.items()}


_PROGRAMS: Final = _shapes(SHAPES)
_G4: Final = "grammar G;\nfile : a* EOF ;\na : 'X'"
_G4_END: Final = " ;\nX : 'X' ;\nNAME : [A-Z]+ ;\n"


#: A message of an editor: its method, whether it is a request, its parameters.
_Message = tuple[str, bool, Any]
_AT_CURSOR: Final = (
    *("hover", "definition", "completion", "signatureHelp", "documentHighlight", "references"),
    *("prepareRename", "rename"),
)


def _opened(file: Path, text: str) -> _Message:
    document = {"uri": file.as_uri(), "languageId": "krl", "version": 1, "text": text}
    return "textDocument/didOpen", False, {"textDocument": document}


def _messages(file: Path) -> bytes:
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


def _questions(file: Path) -> bytes:
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


def _breakpoints(file: Path) -> bytes:
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


@dataclass(frozen=True, slots=True)
class GrowthEntry:
    """A command and its input.

    Its words may contain the placeholders ``{file}``, ``{other}`` (the same file without some
    lines), ``{out}`` and ``{small}``. ``before`` are commands that make the input and are not
    measured; their output is at ``{printed}``; shapes that they reject are omitted. ``said`` gives
    the standard input.
    """

    words: str
    inputs: Mapping[str, Writer] = field(default_factory=lambda: _PROGRAMS)
    before: tuple[str, ...] = ()
    said: Callable[[Path], bytes] = lambda _: b""


_COMPILE: Final = "compile -o {out}.krlb {file}"
_RUN: Final = "run --robot none --max-time 1"
_FAILING: Final = {
    name: shape for name, shape in SHAPES.items() if "never" in name or "lines" in name
}

ENTRIES: Final[Mapping[str, GrowthEntry]] = {
    "check": GrowthEntry("check --no-cache {file}"),
    "check sarif": GrowthEntry("check --no-cache --format sarif --out {out}.sarif {file}"),
    "format": GrowthEntry("format --check {file}"),
    "recover": GrowthEntry("recover --jobs 1 --no-start --out {out} {file}"),
    "recover start": GrowthEntry("recover --jobs 1 --out {out} {file}"),
    "recover auto": GrowthEntry("recover --auto --jobs 1 --out {out} {file}", _shapes(_FAILING)),
    "growth": GrowthEntry("growth --jobs 1 --out {out} {file}"),
    "compile": GrowthEntry(_COMPILE),
    "disasm": GrowthEntry("disasm {out}.krlb", before=(_COMPILE,)),
    "asm": GrowthEntry("asm -o {out}.krlb {printed}", before=(_COMPILE, "disasm {out}.krlb")),
    "run": GrowthEntry(_RUN + " --trace {out}.jsonl {file}"),
    "run page": GrowthEntry(_RUN + " --html {out}.html {file}"),
    "debug": GrowthEntry(
        "debug --robot none --max-time 1 {file}", said=lambda _: b"step\n" * 20 + b"continue\n"
    ),
    "lsp": GrowthEntry("lsp", said=_messages),
    "lsp questions": GrowthEntry("lsp", said=_questions),
    "lsp tabs": GrowthEntry("lsp", {"files": _folder}, said=tabs),
    "debug watched": GrowthEntry(
        "debug --robot none --max-time 1 {file}",
        said=lambda _: b"watch I\nbreak 5 if I==-1\nstep\ncontinue\n",
    ),
    "debug adapter": GrowthEntry("debug --dap --robot none --max-time 1", said=_breakpoints),
    "diff": GrowthEntry("diff {file} {small}"),
    "diff both": GrowthEntry("diff {file} {other}"),
    "check archive": GrowthEntry("check --no-cache {file}", {"members": _archive}),
    "test": GrowthEntry(
        "test {file}",
        _beside_program(
            _shapes(
                {
                    "tests": Shape('[[test]]\nname = "{i}"\nexpect = ["ends before 1"]\n', "", ""),
                    "expectations": Shape('"out {i} never",\n', _ONE_TEST, "]\n"),
                    "inputs of a test": Shape(
                        '"t=0.{i} IN[1]=TRUE",\n', "io = [\n", "]\n" + _A_TEST
                    ),
                    "statements before": Shape(
                        '"$FLAG[1] = TRUE",\n', "before = [\n", "]\n" + _A_TEST
                    ),
                },
                "test_a.toml",
            )
        ),
    ),
    "conform": GrowthEntry(
        "conform --executor tree --robot none --jobs 1 {file}",
        _shapes(
            {
                "expectations": Shape("  I={i} ;> value I {i}\n", _CASE + "  INT I\n", "END\n"),
                "lines of a case": Shape(
                    "  I={i}\n", _CASE + "  INT I\n  I=0 ;> runs 1\n", "END\n"
                ),
            }
        ),
    ),
    "recover grammar": GrowthEntry(
        "recover --jobs 1 --no-start --out {out} --grammar {file} {small}",
        _shapes(
            {
                "rules": Shape("r{i} : 'X' NAME ;\n", _G4 + " ;\n", _G4_END[3:]),
                "alternatives": Shape(" | 'X' NAME", _G4, _G4_END),
                "a long sequence": Shape(" NAME", _G4, _G4_END),
                "optional parts": Shape("r{i} : 'X'? NAME? ;\n", _G4 + " ;\n", _G4_END[3:]),
                "brackets in brackets": Shape("(", _G4 + " ", _G4_END, "NAME", ")"),
            },
            "G.g4",
        ),
    ),
    "run inputs": GrowthEntry(
        "run --robot none --max-time 1 --io {file} {small}",
        _shapes(
            {
                "inputs by time": Shape("t=0.{i} IN[1]=TRUE\n", "", ""),
                "inputs by output": Shape("on OUT[{i}]=TRUE after 0.2 IN[7]=TRUE\n", "", ""),
            },
            "io.txt",
        ),
    ),
    "check settings": GrowthEntry(
        "check --no-cache --settings {file} {small}",
        _shapes({"excluded": Shape('"a{i}/*",\n', "exclude = [\n", "]\n")}, "krl.toml"),
    ),
}
