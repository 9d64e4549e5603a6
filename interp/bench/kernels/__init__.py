"""Kernels for `interp.bench.executor_speed`: small programs in KRL, and the same in Lua.

Each file ``NAME.src`` has a function ``WORK`` that takes an amount and gives a number by which it
can be told whether the work was done right; ``NAME.lua`` returns such a function. `KERNELS` says
how much work an amount is, and how much is enough to be measured on a fast machine.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import resources
from types import MappingProxyType

__all__ = ["KERNELS", "Kernel"]


@dataclass(frozen=True, slots=True)
class Kernel:
    """A kernel: ``full`` is the amount that is measured, ``small`` one for slow machines.

    ``work`` gives the work of an amount, counted in ``unit``.
    """

    name: str
    unit: str
    full: int
    small: int
    work: Callable[[int], int]

    @property
    def krl(self) -> str:
        """The source of ``WORK`` in KRL."""
        return self._text("src")

    @property
    def lua(self) -> str:
        """The same as a chunk in Lua that returns the function."""
        return self._text("lua")

    def _text(self, ending: str) -> str:
        file = resources.files(__package__).joinpath(f"{self.name}.{ending}")
        return file.read_text(encoding="utf-8")


def _calls_of_fibonacci(number: int) -> int:
    """How often the function is called in all."""
    calls, before = 1, 1
    for _ in range(number - 1):
        calls, before = calls + before + 1, calls
    return calls


def _same(amount: int) -> int:
    return amount


#: All kernels by name, in the order of the table that shows them.
KERNELS: Mapping[str, Kernel] = MappingProxyType(
    {
        kernel.name: kernel
        for kernel in (
            Kernel("sieve", "element", 10, 1, lambda rounds: rounds * 81_900),
            Kernel("loop", "pass", 5_000_000, 20_000, _same),
            Kernel("fibonacci", "call", 30, 16, _calls_of_fibonacci),
            Kernel("matrix", "product", 150, 20, lambda size: size**3),
            Kernel("texts", "letter pair", 5_000, 10, lambda lines: lines * 40),
            Kernel("structures", "move", 5_000, 5, lambda steps: steps * 100),
            Kernel("jumps", "pass", 5_000_000, 20_000, _same),
            Kernel("calls", "pass", 1_000_000, 2_000, _same),
        )
    }
)
