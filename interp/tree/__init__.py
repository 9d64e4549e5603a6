"""The tree interpreter: the readable reference executor, in which each routine is a generator."""

from interp.tree.executor import TreeExecutor
from interp.tree.memory import system_values

__all__ = ["TreeExecutor", "system_values"]
