"""The machine in C among others: memory, companions, what the core refuses, and own programs."""

from __future__ import annotations

import gc
import operator
import re
import weakref
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from conformance.differential.runs import facts_of
from grammar.syntax.source import Source
from interp import native
from interp.bench.kernels import Kernel, kernels_in
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.compiler.project import compile_program
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm import executor as vm
from interp.bytecode.vm.state import computed
from interp.executors import Prepared
from interp.port.requests import End, StopAdvance, Write
from interp.program.load import Limits, load

if TYPE_CHECKING:
    from interp.native._core import Core

_PROGRAMS = Path(__file__).resolve().parents[3] / "corpus" / "programs"

_SHARED = """\
bytecode 4
ask SHOW Write ("$SHOWN") in:INT
data M.I INT = 1
code MAIN routine "m.src" 1
begin
  LINE 2 A
  LOAD_DATA M.I
  ASK SHOW
A:
  LINE 3 B
  LOAD_DATA M.I
  ADD_CONSTANT 10
  STORE_DATA M.I
  LOAD_DATA M.I
  ASK SHOW
B:
  RETURN
end
"""


def test_companions_share_the_data_lists(native: type[vm.Machine]) -> None:
    """What one machine writes into the data lists the other one finds, in either direction."""
    one = native(verify(assemble(_SHARED)), "MAIN")
    first: Any = one.advance()
    other = one.companion("MAIN")
    second: Any = other.advance()
    values = [first.value, second.value]
    for running in (other, one):
        shown: Any = running.advance()
        values.append(shown.value)
    assert [1, 1, 11, 21] == values
    assert [21] == one.data() == other.data()
    del one
    gc.collect()
    assert isinstance(other.advance(), End)


def test_python_takes_two_operands_off_the_stack_of_c(native: type[vm.Machine]) -> None:
    """So it computes functions of two numbers that C does not know."""
    text = _SHARED.replace("  ADD_CONSTANT 10\n", "  PUSH_INT 10\n  ADD_INT\n")
    machine = native(verify(assemble(text)), "MAIN")
    machine.advance()
    stack = machine._state.stack
    for operand in (7, 3):
        stack.append(operand)
    computed(operator.sub, 2, stack, lambda: None)()
    assert (len(stack), stack[-1]) == (1, 4)


def test_memory_is_given_back(native: type[vm.Machine]) -> None:
    """A machine that nobody has any more goes, with its memory in C."""
    machine = native(verify(assemble(_SHARED)), "MAIN")
    machine.advance()
    gone = weakref.ref(machine)
    del machine
    gc.collect()
    assert gone() is None


def test_companions_need_the_same_image(core: type[Core]) -> None:
    """Machines of different programs cannot share their data lists."""
    good = verify(assemble(_SHARED))
    other = verify(assemble(_SHARED.replace("M.I", "M.J")))
    one = core(good.image, good.depths, False, 5, None)
    with pytest.raises(MemoryError):
        core(other.image, other.depths, False, 5, one)
    with pytest.raises(TypeError, match="a machine or None"):
        core(good.image, good.depths, False, 5, "one")  # type: ignore[arg-type]  # what is tested


def test_an_image_needs_what_the_verifier_found(core: type[Core]) -> None:
    """Another program may need more cells than the machine allots."""
    good = verify(assemble(_SHARED))
    with pytest.raises(MemoryError, match="the depths are another's"):
        core(good.image, good.depths[4:], False, 5, None)


def test_core_checks_what_leads_into_memory(core: type[Core]) -> None:
    """Cells, steps and code objects that there are not are refused."""
    good = verify(assemble(_SHARED))
    machine = core(good.image, good.depths, False, 5, None)
    for place in (-1, 10**9):
        with pytest.raises(IndexError):
            machine[place]
        with pytest.raises(IndexError):
            machine.run(place, 0)
        with pytest.raises(IndexError):
            machine.step(0, place)
        with pytest.raises(IndexError):
            machine.begin(place if place < 0 else 9)
    with pytest.raises(OverflowError):
        machine[0] = 2**31
    with pytest.raises(ValueError, match="the same number of cells"):
        machine[0:1] = [1, 2]
    with pytest.raises(IndexError):
        machine.close_frame()
    assert [1] == machine[0:1]


#: Programs with loops, motions, interrupts, texts and calls.
_OWN = (
    "assembly/KRC/R1/Program/Assembly.src",
    "gluing/KRC/R1/Program/glue_main.src",
    "machine_tending/KRC/R1/TP/DoorGuard/DoorGuard.src",
    "palletiser/KRC/R1/Program/SheetTeach.src",
    "spot_cell/KRC/R1/cell.src",
    "dialects/spline_shapes.src",
)


@pytest.mark.parametrize("name", _OWN)
def test_own_programs(native: type[vm.Machine], name: str) -> None:
    """Programs of the corpus ask and tell the same, with interrupts and faults on the way."""
    path = _PROGRAMS / name
    folder = [path, *sorted(path.parent.glob("*.dat"))]
    texts = [one.read_bytes().removeprefix(b"\xef\xbb\xbf").decode("latin-1") for one in folder]
    sources = [Source(text, one.name) for text, one in zip(texts, folder, strict=True)]
    compiled = compile_program(load(sources, path.name, strict=False))
    verified = verify(compiled.program)
    limits = Limits(statements=3_000, per_slice=100)
    for number in list(compiled.starts.values())[:4]:
        expected, actual = (
            facts_of(partial(kind, verified, number, limits), "1") for kind in (vm.Machine, native)
        )
        assert expected == actual


@pytest.mark.parametrize("kernel", kernels_in().values(), ids=list(kernels_in()))
def test_kernels_give_the_same(kernel: Kernel) -> None:
    """The kernels of the bench come to the same result in C as in Python."""
    text = f"DEF RUN()\n$OV_PRO = WORK(3)\nEND\n{kernel.krl}"
    program = Prepared(load([Source(text, "run.src")], "run.src"))
    results = []
    for name in ("vm", "native"):
        running = program.executor(name, Limits(per_slice=10**6))
        asked = running.advance()
        while isinstance(asked, StopAdvance):
            asked = running.advance()
        assert isinstance(asked, Write)
        results.append(asked.value)
    assert results[0] == results[1]


def test_includes_point_downwards() -> None:
    """A folder of C includes headers of those below it only."""
    below = {"program": 0, "image": 1, "vm": 1, "translator": 2, "c_backend": 2}
    for file in Path(native.__file__).parent.glob("*/*.[ch]"):
        for folder in re.findall(r'#include "(\w+)/', file.read_text(encoding="utf-8")):
            assert below[folder] < below[file.parent.name], f"{file} includes {folder}"
