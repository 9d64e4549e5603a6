"""The bytecode machine in C: the same images, requests and events as `interp.bytecode.vm.executor`.

=============== ====================================================================================
`machine`       the executor: what the machine in Python does around instructions
``module.c``    the machine as a Python type, ``_core``; ``fuzz.c`` runs it on damaged images
``load.c``      from an image to a machine, by the folders below
`c_backend`     register code as native code, by way of C and the compiler at hand
``translator/`` from instructions on a stack to register code
``vm/``         register code: its steps (``register_code.h``) and what they do (``steps.h``), the
                interpreter (``run.c``), memory and frames, predefined functions
``verifier/``   whether a program keeps the rules that the interpreter relies on
``image/``      from bytes to a program; nothing of them is trusted
``program/``    a program in memory: cells, types, instructions
=============== ====================================================================================

Includes point downwards. ``*.gen.h`` is generated from the instruction set.

Where the package was installed without a C compiler, `AVAILABLE` is ``False`` and `machine` cannot
be imported. Everything else of the project works without it.
"""

from __future__ import annotations

from importlib.util import find_spec

#: Whether the machine in C was built.
AVAILABLE: bool = find_spec("interp.native._core") is not None
