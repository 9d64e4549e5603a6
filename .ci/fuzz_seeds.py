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
from interp.native._core import Core
from interp.program.load import load
from interp.values.faults import LinkError
from support.files.decode import decode

ROOT = Path(__file__).resolve().parents[1]
#: Small images are damaged sooner where it matters.
LARGEST = 1 << 13

#: Elements of arrays in a frame, in a data list and of a caller, by one, two and three indices.
ARRAYS = """DEF ARRAYS()
   DECL INT I, A[2,3,4], B[3]
   FOR I = 1 TO 2
      A[I,I,I] = D[I,I,I] + E[I,I] + V[I] + B[I]
      D[I,I,I] = A[I,I,I] + 1
      A[I,I,I] = I
      D[I,I,I] = 7
      E[I,I] = I
      P[I].Z = 2.0
      V[I] = 5
      V[N] = N
      P[I].X = P[I].Y + R
      TOTAL(A[,,], V[I], I)
      TOTAL(D[,,], E[I,I], I)
   ENDFOR
   FOR N = 1 TO 3
      B[N] = N
   ENDFOR
   FOR N = 3 TO 1 STEP -1
      V[N] = B[N]
   ENDFOR
   N = 2
END
DEF TOTAL(A[,,]:OUT, S:OUT, I:IN)
   DECL INT A[,,], S, I
   A[I,I,I] = A[1,I,I] + S
   S = A[2,I,1]
END
"""
DATA = """DEFDAT ARRAYS
DECL INT D[2,3,4], E[2,3], V[3], N=1
DECL REAL R=0.5
DECL POS P[3]
ENDDAT
"""


def main(folder: Path) -> int:
    """Programs with something of everything, and small ones of the corpus and of cases.

    Of the cases, of which there are many, those that have a step of the machine that no other has.
    """
    folder.mkdir(parents=True, exist_ok=True)
    everything = runpy.run_path(str(ROOT / "tests" / "interp" / "bytecode" / "conftest.py"))
    known = _write(assemble(everything["EVERYTHING"]), folder / "everything.krlb")
    arrays = [Source(ARRAYS, "arrays.src"), Source(DATA, "arrays.dat")]
    known |= _write(compile_program(load(arrays, "arrays.src")).program, folder / "arrays.krlb")
    programs = sorted((ROOT / "corpus" / "programs").rglob("*.src"))
    for file in (*programs, *sorted((ROOT / "conformance" / "cases").rglob("*.src"))):
        decoded = decode(file.read_bytes())
        if isinstance(decoded, str):  # not KRL
            continue
        try:
            source = Source(decoded.text, file.name)
            program = compile_program(load([source], file.name)).program
        except LinkError:
            continue
        if program.codes:
            seen = frozenset[str]() if file in programs else known
            known |= _write(program, folder / f"{file.stem}.krlb", seen)
    return 0


def _write(program: Program, target: Path, known: frozenset[str] = frozenset()) -> frozenset[str]:
    """Write an image that is small and has steps that are not ``known``; its steps."""
    verify(program)
    image = write_image(program)
    steps = frozenset(name for name, *_ in Core(image, 0, 1, None).steps())
    if len(image) >= LARGEST or steps <= known:
        return frozenset()
    target.write_bytes(image)
    return steps


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
