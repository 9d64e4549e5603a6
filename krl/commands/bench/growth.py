"""`krl bench growth`: how the cost of each command grows with its input, by the input's shape."""

from __future__ import annotations

import json
import os
import random
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.console import Console
from rich.markup import escape

from grammar.generation.shapes import SHAPES, Shape
from krl.errors import BAD_INPUT, FINE, InputError, run
from krl.terminal.options import JobsOption, JsonOption, all_cores
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures
from support.files.untrusted import json_of, read_text

if TYPE_CHECKING:
    from support.measure.cost_by_size import Growth

_AIM: Final = 1.15
_SMALLEST: Final = 8_000
_PROGRAM: Final = "DEF A()\nEND\n"
_ONE_TEST: Final = '[[test]]\nname = "one"\nexpect = [\n'
_A_TEST: Final = _ONE_TEST + '"ends before 1"]\n'
_CASE: Final = ";@ rule: ADV-03\n;@ title: A case\n;@ phase: run\nDEF a()\n"

#: Writes an input of about the given number of characters into a folder, and returns its path.
_Writer = Callable[[Path, int], Path]


def _archive(folder: Path, size: int) -> Path:
    """Return an archive with many small members."""
    path = folder / "a.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for i in range(max(1, size // 100)):
            archive.writestr(f"KRC/R1/Program/A{i}.src", _PROGRAM.replace("A", f"A{i}"))
    return path


def _written(shape: Shape) -> _Writer:
    def write(folder: Path, size: int) -> Path:
        path = folder / shape.name
        path.write_text(shape.text(size), encoding="ascii", newline="")
        return path

    return write


def _shapes(shapes: Mapping[str, Shape], name: str | None = None) -> dict[str, _Writer]:
    """Return functions that write files of these shapes, by title; ``name`` is the file name."""
    return {
        title: _written(shape if name is None else replace(shape, name=name))
        for title, shape in shapes.items()
    }


_PROGRAMS: Final = _shapes(SHAPES)
_G4: Final = "grammar G;\nfile : a* EOF ;\na : 'X'"
_G4_END: Final = " ;\nX : 'X' ;\nNAME : [A-Z]+ ;\n"


def _messages(file: Path) -> bytes:
    """Return the messages of an editor that opens a file, requests its features, and exits."""
    uri = {"uri": file.as_uri()}
    text = file.read_text(encoding="ascii")
    opened = {"textDocument": {**uri, "languageId": "krl", "version": 1, "text": text}}
    changed = {
        "textDocument": {**uri, "version": 2},
        "contentChanges": [{"text": text + "; changed\n"}],
    }
    asked = ("documentSymbol", "semanticTokens/full", "foldingRange", "formatting")
    wanted = {"textDocument": uri, "options": {"tabSize": 2, "insertSpaces": True}}
    said: list[tuple[str, bool, Any]] = [
        ("initialize", True, {"processId": None, "rootUri": None, "capabilities": {}}),
        ("initialized", False, {}),
        ("textDocument/didOpen", False, opened),
        *((f"textDocument/{what}", True, wanted) for what in asked),
        ("textDocument/didChange", False, changed),
        ("textDocument/documentSymbol", True, wanted),
        ("shutdown", True, None),
        ("exit", False, None),
    ]
    bodies = [
        json.dumps(
            {"jsonrpc": "2.0", "method": method, "params": params}
            | ({"id": number} if is_request else {})
        ).encode()
        for number, (method, is_request, params) in enumerate(said)
    ]
    return b"".join(b"Content-Length: %d\r\n\r\n%b" % (len(body), body) for body in bodies)


@dataclass(frozen=True, slots=True)
class _Entry:
    """A command and its input.

    Its words may contain the placeholders ``{file}``, ``{other}`` (the same file without some
    lines), ``{out}`` and ``{small}``. ``before`` are commands that make the input and are not
    measured; their output is at ``{printed}``; shapes that they reject are omitted. ``said`` gives
    the standard input.
    """

    words: str
    inputs: Mapping[str, _Writer] = field(default_factory=lambda: _PROGRAMS)
    before: tuple[str, ...] = ()
    said: Callable[[Path], bytes] = lambda _: b""


_COMPILE: Final = "compile -o {out}.krlb {file}"
_RUN: Final = "run --robot none --max-time 1"
_FAILING: Final = {
    name: shape for name, shape in SHAPES.items() if "never" in name or "lines" in name
}

_ENTRIES: Final[Mapping[str, _Entry]] = {
    "check": _Entry("check --no-cache {file}"),
    "check sarif": _Entry("check --no-cache --format sarif --out {out}.sarif {file}"),
    "format": _Entry("format --check {file}"),
    "recover": _Entry("recover --jobs 1 --no-start --out {out} {file}"),
    "recover start": _Entry("recover --jobs 1 --out {out} {file}"),
    "recover auto": _Entry("recover --auto --jobs 1 --out {out} {file}", _shapes(_FAILING)),
    "growth": _Entry("growth --jobs 1 --out {out} {file}"),
    "compile": _Entry(_COMPILE),
    "disasm": _Entry("disasm {out}.krlb", before=(_COMPILE,)),
    "asm": _Entry("asm -o {out}.krlb {printed}", before=(_COMPILE, "disasm {out}.krlb")),
    "run": _Entry(_RUN + " --trace {out}.jsonl {file}"),
    "run page": _Entry(_RUN + " --html {out}.html {file}"),
    "debug": _Entry(
        "debug --robot none --max-time 1 {file}", said=lambda _: b"step\n" * 20 + b"continue\n"
    ),
    "lsp": _Entry("lsp", said=_messages),
    "diff": _Entry("diff {file} {small}"),
    "diff both": _Entry("diff {file} {other}"),
    "check archive": _Entry("check --no-cache {file}", {"members": _archive}),
    "test": _Entry(
        "test {file}",
        _shapes(
            {
                "tests": Shape('[[test]]\nname = "{i}"\nexpect = ["ends before 1"]\n', "", ""),
                "expectations": Shape('"out {i} never",\n', _ONE_TEST, "]\n"),
                "inputs of a test": Shape('"t=0.{i} IN[1]=TRUE",\n', "io = [\n", "]\n" + _A_TEST),
                "statements before": Shape('"$FLAG[1] = TRUE",\n', "before = [\n", "]\n" + _A_TEST),
            },
            "test_a.toml",
        ),
    ),
    "conform": _Entry(
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
    "recover grammar": _Entry(
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
    "run inputs": _Entry(
        "run --robot none --max-time 1 --io {file} {small}",
        _shapes(
            {
                "inputs by time": Shape("t=0.{i} IN[1]=TRUE\n", "", ""),
                "inputs by output": Shape("on OUT[{i}]=TRUE after 0.2 IN[7]=TRUE\n", "", ""),
            },
            "io.txt",
        ),
    ),
    "check settings": _Entry(
        "check --no-cache --settings {file} {small}",
        _shapes({"excluded": Shape('"a{i}/*",\n', "exclude = [\n", "]\n")}, "krl.toml"),
    ),
}


def growth(
    entry: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this command; repeatable.")
    ] = None,
    shape: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Only inputs of this shape; repeatable."),
    ] = None,
    largest: Annotated[
        int, typer.Option(min=32, metavar="KB", help="Largest size of an input.")
    ] = 512,
    json_file: JsonOption = None,
    jobs: JobsOption = None,
    minutes: Annotated[
        float | None,
        typer.Option(
            min=0, metavar="N", help="Start nothing after N minutes; --json FILE continues later."
        ),
    ] = None,
    seed: Annotated[int, typer.Option(metavar="N", help="Seed of the order.")] = 1,
) -> int:
    """Measure how CPU time and memory of each command grow with its input.

    Inputs of each shape have the sizes n, 2n and 4n, where n is the size at which a command takes a
    fifth of a second, and twice as long as for an empty input. A slope is the exponent: 1 is
    linear, 2 quadratic, 0 constant. Each measurement runs in a process of its own. All of them take
    hours: --entry and --shape select some, and with --minutes the results in FILE are not measured
    again.
    """
    check_files(json_file)
    begun = time.monotonic()
    tasks = [
        (name, title)
        for name in _chosen("--entry", entry, _ENTRIES)
        for title in _ENTRIES[name].inputs
        if not shape or title in shape
    ]
    if not tasks:
        raise InputError(f"--shape {shape[0] if shape else ''}: no such shape")
    rows = _kept(json_file) if minutes is not None else []
    known = {(row["entry"], row["shape"]) for row in rows}
    tasks = [task for task in tasks if task not in known]
    random.Random(seed).shuffle(tasks)

    def one(task: tuple[str, str]) -> Growth | None:
        if minutes is not None and time.monotonic() - begun > minutes * 60:
            raise TimeoutError
        return _isolated(*task, largest)

    with (
        progress_bar("measuring", len(tasks)) as advance,
        ThreadPoolExecutor(all_cores(jobs)) as threads,
        suppress(TimeoutError),
    ):
        for task, found in zip(tasks, threads.map(one, tasks), strict=True):
            rows.append(_row(*task, found))
            rows.sort(key=lambda row: (list(_ENTRIES).index(row["entry"]), row["shape"]))
            write_json({"bench": "growth", "aim": _AIM, "rows": rows}, json_file, indent=1)
            advance()
    measured = [row for row in rows if row["costs"]]
    if not measured:
        raise InputError("nothing to measure: no such shape can be made for the command")
    _print(measured)
    return FINE


def _kept(record: Path | None) -> list[dict[str, Any]]:
    """Return the rows of an earlier record."""
    if record is None or not record.is_file():
        return []
    try:
        known: Any = json_of(read_text(record))
        rows = known["rows"]
        return [row for row in rows if row["entry"] in _ENTRIES and row["shape"] and "costs" in row]
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(f"{record}: not a record of krl bench growth") from None


def _chosen(option: str, wanted: list[str] | None, known: Mapping[str, object]) -> list[str]:
    if unknown := set(wanted or ()) - set(known):
        raise InputError(f"{option} {min(unknown)}: not one of {', '.join(known)}")
    return [name for name in known if not wanted or name in wanted]


def _isolated(entry: str, shape: str, largest: int) -> Growth | None:
    from support.measure.isolated import call_isolated

    return call_isolated(_measure, entry, shape, largest)


class _Unmade(Exception):
    """The input of a command cannot be made from a shape."""


def _measure(entry: str, shape: str, largest: int) -> Growth | None:
    from krl.commands.app import app
    from support.measure.cost_by_size import measure_growth

    chosen = _ENTRIES[entry]
    with tempfile.TemporaryDirectory() as place, Path(os.devnull).open("w") as nowhere:
        for stream in (1, 2):  # also output that bypasses Python
            os.dup2(nowhere.fileno(), stream)
        root = Path(place)
        numbers = count()

        def prepare(size: int) -> list[str]:
            # a folder for each, because results cached by path would distort the measurement, and a
            # program is read with all files beside and below it
            folder = root / str(next(numbers))
            for name in ("given", "less", "small"):
                (folder / name).mkdir(parents=True)
            file = chosen.inputs[shape](folder / "given", size)
            small, other = folder / "small" / "small.src", folder / "less" / file.name
            small.write_text(_PROGRAM, encoding="ascii")
            if "{other}" in chosen.words:
                lines = file.read_text(encoding="ascii").splitlines(keepends=True)
                kept = (line for number, line in enumerate(lines) if number % 7 != 3)
                other.write_text("".join(kept), encoding="ascii")
            places = {
                "file": file,
                "other": other,
                "small": small,
                "out": folder / "out",
                "printed": folder / "printed",
            }

            def filled(words: str) -> list[str]:
                return [word.format(**places) for word in words.split()]

            for words in chosen.before:
                with places["printed"].open("w") as printed:
                    os.dup2(printed.fileno(), 1)
                    status = krl(filled(words))
                    sys.stdout.flush()
                    os.dup2(nowhere.fileno(), 1)
                if status == BAD_INPUT:
                    raise _Unmade
            said = folder / "said"
            said.write_bytes(chosen.said(file))
            with said.open("rb") as stream:
                os.dup2(stream.fileno(), 0)
            sys.stdin = os.fdopen(0, encoding="utf-8", closefd=False)
            return filled(chosen.words)

        def krl(words: list[str]) -> int:
            return run(app(*words), words)

        try:
            return measure_growth(prepare, krl, _SMALLEST, largest * 1_000)
        except _Unmade:
            return None


def _row(entry: str, shape: str, found: Growth | None) -> dict[str, Any]:
    """Return a row of the record; without costs if the input cannot be made from the shape."""
    if found is None:
        return {"entry": entry, "shape": shape, "costs": []}
    return {
        "entry": entry,
        "shape": shape,
        "time_slope": found.time_slope,
        "memory_slope": found.memory_slope,
        "base": asdict(found.base),
        "costs": [asdict(cost) for cost in found.costs],
    }


def _print(rows: list[dict[str, Any]]) -> None:
    console = Console(highlight=False)
    steep = [
        row
        for row in rows
        if any(slope is None or slope > _AIM for slope in (row["time_slope"], row["memory_slope"]))
    ]
    table = figures(("command: shape", "time", "memory", "largest", "seconds", "peak"))
    for row in sorted(
        rows, key=lambda row: -(9.0 if row["time_slope"] is None else row["time_slope"])
    )[: max(10, len(steep))]:
        last = row["costs"][-1]
        table.add_row(
            escape(f"{row['entry']}: {row['shape']}"),
            _slope(row["time_slope"]),
            _slope(row["memory_slope"]),
            f"{last['size'] / 1_000:,.0f} kB",
            f"{last['seconds']:.2f}",
            f"{last['peak'] / 1e6:,.0f} MB",
        )
    console.print(table)
    console.print(
        f"{len(rows) - len(steep)} of {len(rows)} grow with an exponent of at most {_AIM}."
    )


def _slope(slope: float | None) -> str:
    return "too slow" if slope is None else f"{slope:.2f}"
