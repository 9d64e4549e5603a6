"""The tree interpreter: the readable reference executor, in which each routine is a generator.

=============== ====================================================================================
module          contents
=============== ====================================================================================
`executor`      the port: the call stack, actions of interrupts, RESUME
`statements`    control flow and all other statements that are no motion
`motions`       statements that make requests: motions, triggers, interrupts, cyclic signals
`calls`         calls of routines and of predefined functions
`expressions`   values of literals, operators, aggregates
`designators`   variables, members, elements, and access to them
`places`        storage locations, in the program or in the controller
`names`         look-up of variables by their name as text
`memory`        the data lists and their initial values
`run`           state that routines share: statement counts, ON_ERROR_PROCEED, code handles
=============== ====================================================================================
"""

from interp.tree.executor import TreeExecutor
from interp.tree.memory import system_values

__all__ = ["TreeExecutor", "system_values"]
