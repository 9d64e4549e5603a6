"""The bytecode machine in C: the same images, requests and events as `interp.bytecode.vm.executor`.

======================== ===========================================================================
file                     what it is
======================== ===========================================================================
`machine`                the executor: what the machine in Python does around instructions
``module.c``             the machine as a Python type
``image.c``              bytes to program: the header and the order of the sections
``reader.c``             the words of a section; nothing of them is trusted
``table_reader.c``       the tables of an image: types, requests, data lists
``code_object_reader.c`` the code objects of an image
``program.c``            the memory of a program, and why one is refused
``types.c``              what lies where in structures and arrays
``verify.c``             whether a program keeps the rules that the interpreter relies on
``stack_effects.c``      the steps that the effects of instructions are made of
``operand_checks.c``     the checks of what operands name
``translate.c``          instructions on a stack to register code, which ``register_code.h`` lists
``virtual_stack.c``      what lies on the stack while that is done
``translate_*.c``        the parts for control flow, for data movement and for arithmetic
``steps.h``              what each step of register code does
``run.c``                the interpreter: steps that call and leave
``dispatch.h``           how the interpreter goes from one step to the next
`register_code`          which registers steps use, and steps as text
`register_flow`          where steps lead and what registers hold
`compiled`               register code as native code, by a C compiler
``compiled.h``           what that is written with
``array_operations.h``   what steps do with arrays
``machine.c``            memory and frames
``numeric_functions.c``  predefined functions of numbers and poses
``text_functions.c``     predefined functions on texts
``cells.h``              cells
``*.gen.h``              what is generated from the instruction set
``fuzz.c``               a program that runs damaged images
======================== ===========================================================================

Where the package was installed without a C compiler, `AVAILABLE` is ``False`` and `machine` cannot
be imported. Everything else of the project works without it.
"""

from __future__ import annotations

from importlib.util import find_spec

#: Whether the machine in C was built.
AVAILABLE: bool = find_spec("interp.native._core") is not None
