"""`krl bench growth`: how the cost of each command grows with its input, by the input's shape."""

from __future__ import annotations

import os
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.console import Console
from rich.markup import escape

from grammar.generation.shapes import SHAPES, Shape
from krl.errors import FINE, InputError, run
from krl.options import JobsOption, JsonOption, all_cores
from krl.output_files import check_files, write_json
from krl.progress import progress_bar
from krl.text_table import figures

if TYPE_CHECKING:
    from support.measure.growth import Growth

__all__ = ["growth"]

_AIM: Final = 1.15
_SMALLEST: Final = 8_000
_PROGRAM: Final = "DEF A()\nEND\n"

#: Writes what a command reads, of about so many characters, into a folder.
_Writer = Callable[[Path, int], Path]


def _archive(folder: Path, size: int) -> Path:
    """An archive with many small members."""
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
    """Files of these shapes, or such files with another name."""
    return {
        title: _written(shape if name is None else replace(shape, name=name))
        for title, shape in shapes.items()
    }


_PROGRAMS: Final = _shapes(SHAPES)
_G4: Final = "grammar G;\nfile : a* EOF ;\na : 'X'"
_G4_END: Final = " ;\nNAME : [A-Z]+ ;\n"


@dataclass(frozen=True, slots=True)
class _Entry:
    """A command, and what it reads.

    Its words may have the places ``{file}``, ``{out}`` and ``{small}``. ``before`` is a
    command that makes what is read, and is not measured.
    """

    words: str
    inputs: Mapping[str, _Writer] = field(default_factory=lambda: _PROGRAMS)
    before: str = ""


_ENTRIES: Final[Mapping[str, _Entry]] = {
    "check": _Entry("check --no-cache {file}"),
    "format": _Entry("format --check {file}"),
    "recover": _Entry("recover --jobs 1 --no-start --out {out} {file}"),
    "compile": _Entry("compile -o {out}.krlb {file}"),
    "disasm": _Entry("disasm {out}.krlb", before="compile -o {out}.krlb {file}"),
    "run": _Entry("run --robot none --max-time 1 --trace {out}.jsonl {file}"),
    "diff": _Entry("diff {file} {small}"),
    "check archive": _Entry("check --no-cache {file}", {"members": _archive}),
    "recover grammar": _Entry(
        "recover --jobs 1 --no-start --out {out} --grammar {file} {small}",
        _shapes(
            {
                "rules": Shape("r{i} : 'W{i}' NAME ;\n", _G4 + " ;\n", _G4_END[3:]),
                "alternatives": Shape(" | 'W{i}' NAME", _G4, _G4_END),
                "a long sequence": Shape(" NAME", _G4, _G4_END),
                "optional parts": Shape(" 'W{i}'?", _G4, _G4_END),
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
        list[str] | None,
        typer.Option(metavar="NAME", help="Only this command; may be repeated."),
    ] = None,
    shape: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Only inputs of this shape; may be repeated."),
    ] = None,
    largest: Annotated[
        int, typer.Option(min=32, metavar="KB", help="No input is larger than this.")
    ] = 512,
    json_file: JsonOption = None,
    jobs: JobsOption = None,
) -> int:
    """Measure how CPU time and memory of each command grow with its input.

    Inputs of each shape have the sizes n, 2n and 4n, where n is what takes a fifth of a second. A
    slope is the exponent: 1 is linear, 2 quadratic, 0 nothing. Each is measured in a process of its
    own; the whole takes some 20 minutes of a core.
    """
    check_files(json_file)
    tasks = [
        (name, title)
        for name in _chosen("--entry", entry, _ENTRIES)
        for title in _ENTRIES[name].inputs
        if not shape or title in shape
    ]
    if not tasks:
        raise InputError(f"--shape {shape[0] if shape else ''}: no such shape")
    rows: list[dict[str, Any]] = []
    with (
        progress_bar("measuring", len(tasks)) as advance,
        ThreadPoolExecutor(all_cores(jobs)) as threads,
    ):
        waiting = [threads.submit(_isolated, *task, largest) for task in tasks]
        for (name, title), one in zip(tasks, waiting, strict=True):
            rows.append(_row(name, title, one.result()))
            advance()
    write_json({"bench": "growth", "aim": _AIM, "rows": rows}, json_file, indent=1)
    _print(rows)
    return FINE


def _chosen(option: str, wanted: list[str] | None, known: Mapping[str, object]) -> list[str]:
    if unknown := set(wanted or ()) - set(known):
        raise InputError(f"{option} {min(unknown)}: not one of {', '.join(known)}")
    return [name for name in known if not wanted or name in wanted]


def _isolated(entry: str, shape: str, largest: int) -> Growth:
    from support.measure.isolated import call_isolated

    return call_isolated(_measure, entry, shape, largest)


def _measure(entry: str, shape: str, largest: int) -> Growth:
    from krl.commands.app import app
    from support.measure.growth import measure_growth

    chosen = _ENTRIES[entry]
    with tempfile.TemporaryDirectory() as folder, Path(os.devnull).open("w") as nowhere:
        for stream in (1, 2):  # also what is written below Python
            os.dup2(nowhere.fileno(), stream)
        root = Path(folder)
        (root / "small.src").write_text(_PROGRAM, encoding="ascii")
        places = {"out": str(root / "out"), "small": str(root / "small.src")}

        def filled(words: str) -> list[str]:
            return [word.format(**places) for word in words.split()]

        def krl(words: list[str]) -> int:
            return run(app(*words), words)

        def prepare(size: int) -> list[str]:
            places["file"] = str(chosen.inputs[shape](root, size))
            if chosen.before:
                krl(filled(chosen.before))
            return filled(chosen.words)

        return measure_growth(prepare, krl, _SMALLEST, largest * 1_000)


def _row(entry: str, shape: str, found: Growth) -> dict[str, Any]:
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
    for row in sorted(rows, key=lambda row: -(row["time_slope"] or 9.0))[: max(10, len(steep))]:
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
