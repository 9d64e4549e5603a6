"""The bytecode machine in C: the same images, requests and events as `interp.bytecode.vm.executor`.

=================== ================================================================================
file                what it is
=================== ================================================================================
`machine`           the executor: what the machine in Python does around its instructions, around C
``module.c``        the machine as a Python type
``image.c``         bytes to program: the header and the order of the sections
``reader.c``        the words of a section; nothing of them is trusted
``tables.c``        the tables of an image: types, requests, data lists
``codes.c``         the code objects of an image
``program.c``       the memory of a program, and why one is refused
``types.c``         what lies where in structures and arrays
``verify.c``        whether a program keeps the rules that the interpreter relies on
``stack_effects.c`` the part of it that knows what instructions do to the stack
``places.c``        the part of it that finds what operands name
``translate.c``     instructions on a stack to steps on registers, which ``steps.h`` lists
``held.c``          what lies on the stack while that is done
``control.c``       the part of it that decides where to go on
``elements.c``      the part of it that moves values
``computing.c``     the part of it that computes
``run.c``           the interpreter: what each step does
``dispatch.h``      what steps are written with
``blocks.h``        what steps do with arrays
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
