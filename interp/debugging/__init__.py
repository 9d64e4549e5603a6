"""Debugging on every executor: stops, steps, watches, block selection, backward motions."""

from interp.debugging.client import (
    Backward,
    Breakpoint,
    Command,
    Go,
    Select,
    StackFrame,
    StepCommand,
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
    "Go",
    "Select",
    "StackFrame",
    "StepCommand",
    "Stop",
    "Watch",
]
