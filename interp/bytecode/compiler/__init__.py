"""The compiler: from checked programs to bytecode.

================== =================================================================================
module             what it is
================== =================================================================================
`project`          a whole program: which routines, for which arguments, actions and conditions
`data`             the data lists
`statements`       bodies of routines, plain statements, and which rule is for which statement
`control_flow`     blocks, IF, SWITCH, loops, GOTO, EXIT, RETURN
`motions`          statements that only ask the world
`calls`            calls of routines of the program
`predefined_calls` calls of what the controller brings along
`expressions`      values, operators, aggregates
`designators`      variables, members, elements: which places they are
`memory`           what reads cells, stores in them, tells of them
`context`          one code object in the making
`places`           where values are while code is made
`rooms`            how large copies of arrays of unknown size can be
`writer`           instructions, labels, frames
`tables`           types, texts, requests, functions and data of a program
================== =================================================================================
"""

from interp.bytecode.compiler.context import Refusal
from interp.bytecode.compiler.project import Compiled, compile_program

__all__ = ["Compiled", "Refusal", "compile_program"]
