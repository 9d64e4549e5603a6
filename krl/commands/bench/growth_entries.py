"""The commands that `krl bench growth` measures, and the shapes of their inputs."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from grammar.generation.shapes import SHAPES, Shape
from krl.commands.bench.editor_messages import breakpoints, questions, session, tabs

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
    "lsp": GrowthEntry("lsp", said=session),
    "lsp questions": GrowthEntry("lsp", said=questions),
    "lsp tabs": GrowthEntry("lsp", {"files": _folder}, said=tabs),
    "debug watched": GrowthEntry(
        "debug --robot none --max-time 1 {file}",
        said=lambda _: b"watch I\nbreak 5 if I==-1\nstep\ncontinue\n",
    ),
    "debug adapter": GrowthEntry("debug --dap --robot none --max-time 1", said=breakpoints),
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
