"""The compiler: from checked programs to bytecode.

A `project` compiles routines as they are called, each into a code object of its own. The parts that
make the code of one are given those below them: `statements`, `control_flow` and `motions`, `calls`
with `predefined_calls`, `expressions`, `designators`, `memory` (loads and stores), `emitter`. What
leads upwards is a function that a part is given: expressions call routines, designators have
expressions for indices, blocks have statements in them.
"""

from interp.bytecode.compiler.context import Refusal
from interp.bytecode.compiler.project import Compiled, compile_program

__all__ = ["Compiled", "Refusal", "compile_program"]
