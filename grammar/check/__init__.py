"""The static checks: types, declarations, calls, control flow, places, and what stops the robot.

`framework` has `check` for a workspace and `check_module` for a file, and lists all checks. Each
check is a function from a `context.Context` to findings, in a module of its own:

=============== ====================================================================================
module          what it finds
=============== ====================================================================================
`statements`    types of what statements are made of; it types the expressions of a program, with
                `expressions`, `aggregates`, `calls` and `assignments`
`initials`      initial values: their types, order and places; it types those of a data list
`declarations`  sizes, GLOBAL, `signals`, imports, parameters, names of modules
`twice`         names that are declared twice or hide others
`unknowns`      names that nothing declares
`names`         lengths of names
`flow`          EXIT, GOTO and labels, functions without RETURN, what is never reached
`places`        declarations and instructions out of place; what submit programs and interrupt
                routines may not do
`splines`       what spline blocks may not hold, and what belongs into them
`limits`        numbers of interrupts, limits of triggers, cyclical flags
`entries`       BRAKE and RESUME outside of interrupts, programs that begin with no complete PTP
`stops`         what stops the advance run or makes a blend impossible; only on demand
=============== ====================================================================================
"""
