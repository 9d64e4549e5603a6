"""Debugging, the same on every executor: stops, steps, watches, block selection, going backwards.

================ ===================================================================================
module           what it is
================ ===================================================================================
`client`         who decides: what a debugger tells, and what it can be told to do
`debugger`       an executor around another one, which stops between statements
`conditions`     expressions over what is visible where a program has stopped
`open_routines`  which routines are open, and in which activation
`selection`      which lines a program can go on at
`backward`       motions travelled so far, and how each of them is undone
================ ===================================================================================
"""

from interp.debugging.client import (
    Backward,
    Breakpoint,
    Command,
    Frame,
    Go,
    Select,
    Step,
    Stop,
    Watch,
)
from interp.debugging.debugger import Client, Debugger

__all__ = [
    "Backward",
    "Breakpoint",
    "Client",
    "Command",
    "Debugger",
    "Frame",
    "Go",
    "Select",
    "Step",
    "Stop",
    "Watch",
]
