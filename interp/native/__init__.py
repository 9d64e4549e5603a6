"""The bytecode machine in C: the same images, requests and events as `interp.bytecode.vm`.

=================== ================================================================================
file                what it is
=================== ================================================================================
`machine`           the executor: what the machine in Python does around its instructions, around C
``module.c``        the machine as a Python type
``image.c``         bytes to program; nothing of them is trusted
``types.c``         what lies where in structures and arrays
``verify.c``        whether a program keeps the rules that the interpreter relies on
``translate.c``     instructions on a stack to steps on registers, which ``steps.h`` lists
``held.c``          what lies on the stack while that is done
``elements.c``      the part of it that moves values
``run.c``           the interpreter
``machine.c``       memory and frames
``functions.c``     functions of numbers and poses
``texts.c``         functions on texts
``cells.h``         cells
``isa.gen.h``       the instruction set, made from its table
``fuzz.c``          a program that runs damaged images
=================== ================================================================================

Where the package was installed without a C compiler, `AVAILABLE` is ``False`` and `machine` cannot
be imported. Everything else of the project works without it.
"""

from __future__ import annotations

from importlib.util import find_spec

__all__ = ["AVAILABLE"]

#: Whether the machine in C was built.
AVAILABLE: bool = find_spec("interp.native._core") is not None
