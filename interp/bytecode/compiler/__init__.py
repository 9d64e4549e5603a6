"""The compiler: from checked programs to bytecode.

=============== ====================================================================================
module          what it is
=============== ====================================================================================
`project`       a whole program: which routines, for which arguments, actions and conditions
`data`          the data lists
`statements`    control flow and all statements that are no motion
`motions`       statements that only ask the world
`calls`         calls of routines and of what the controller brings along
`expressions`   values, operators, places
`memory`        what reads cells, stores in them, tells of them
`context`       one code object in the making
`places`        where values are while code is made
`writer`        instructions, labels, frames
`tables`        types, texts, requests, functions and data of a program
=============== ====================================================================================
"""

from interp.bytecode.compiler.context import Refusal
from interp.bytecode.compiler.project import Compiled, compile_program

__all__ = ["Compiled", "Refusal", "compile_program"]
