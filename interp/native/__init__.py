"""The bytecode machine in C: the same images, requests and events as `interp.bytecode.vm.executor`.

=============== ====================================================================================
`machine`       the executor: what the Python machine does around instructions
``module.c``    the machine as a Python type, ``_core``
``load.c``      loads an image into a machine, with the folders below
`c_backend`     compiles register code to native code, by way of C and the installed C compiler
``translator/`` translates stack instructions to register code
``vm/``         register code: its steps (``register_code.h``) and their effects (``steps.h``), the
                interpreter (``run.c``), memory and frames, predefined functions
``image/``      reads an image into a program
``program/``    a program in memory: cells, types, instructions
=============== ====================================================================================

Includes point downwards. ``*.gen.h`` is generated from the instruction set.

If the package was installed without a C compiler, `AVAILABLE` is ``False`` and `machine` cannot be
imported. Everything else works without it.
"""

from __future__ import annotations

from importlib.util import find_spec

#: Whether the machine in C was built.
AVAILABLE: bool = find_spec("interp.native._core") is not None
