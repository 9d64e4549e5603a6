"""Writes the images that fuzzing begins with into a folder: fuzz_seeds.py FOLDER."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

from grammar.syntax.source import Source
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.compiler import compile_program
from interp.bytecode.image.writer import write_image
from interp.bytecode.program import Program
from interp.bytecode.verifier.verify import verify
from interp.program.load import load
from interp.values.faults import LinkError
from support.files.decode import decode

ROOT = Path(__file__).resolve().parents[1]
#: Small images are damaged sooner where it matters.
LARGEST = 1 << 13


def main(folder: Path) -> int:
    """A program with something of everything, and the small ones of the corpus that compile."""
    folder.mkdir(parents=True, exist_ok=True)
    everything = runpy.run_path(str(ROOT / "tests" / "interp" / "bytecode" / "conftest.py"))
    _write(assemble(everything["EVERYTHING"]), folder / "everything.krlb")
    for file in sorted((ROOT / "corpus" / "programs").rglob("*.src")):
        decoded = decode(file.read_bytes())
        if isinstance(decoded, str):  # not KRL
            continue
        try:
            source = Source(decoded.text, file.name)
            program = compile_program(load([source], file.name)).program
        except LinkError:
            continue
        if program.codes:
            _write(program, folder / f"{file.stem}.krlb")
    return 0


def _write(program: Program, target: Path) -> None:
    verify(program)
    image = write_image(program)
    if len(image) < LARGEST:
        target.write_bytes(image)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
