"""The tree interpreter: the legible reference, one generator for each routine that runs.

=============== ====================================================================================
module          what it is
=============== ====================================================================================
`executor`      the port: the stack of routines, interrupts, RESUME
`statements`    control flow and all statements that are no motion
`motions`       statements that only ask the world: motions, triggers, interrupts, cyclic signals
`calls`         calls of routines and of what the controller brings along
`expressions`   values of literals, operators, aggregates
`designators`   variables, members, elements, and access to them
`places`        where values are: in the program or in the world
`names`         variables by a text that names them
`memory`        the data lists and what they begin with
`run`           what routines share: statements counted, ON_ERROR_PROCEED, codes handed out
=============== ====================================================================================
"""

from interp.tree.executor import TreeExecutor
from interp.tree.memory import system_values

__all__ = ["TreeExecutor", "system_values"]
