"""The executors by name, and how each is made of a program that was checked.

Only what is asked for is imported: the machines need a compiled program, the tree interpreter none.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, Final

from interp.port.events import Sink
from interp.port.executor import Executor
from interp.program.load import CheckedProgram, Limits
from interp.values.faults import LinkError
from support.files.kept_values import kept

if TYPE_CHECKING:
    from interp.bytecode.verifier.verify import Verified

#: The reference first.
EXECUTORS: Final = ("tree", "vm", "native")
#: The machine in C with native code of the program: takes a C compiler, only where it is asked for.
COMPILED: Final = "compiled"
#: The packages that what is kept of a program depends on.
CODE: Final = ("grammar", "interp", "support")


def available() -> tuple[str, ...]:
    """The executors that can run here: without a compiler there was no machine in C to build."""
    from interp.native import AVAILABLE

    return EXECUTORS if AVAILABLE else EXECUTORS[:-1]


def is_available(name: str) -> bool:
    """Whether an executor can run here, `COMPILED` too."""
    from interp.native import AVAILABLE

    if name != COMPILED or not AVAILABLE:
        return name in available()
    from interp.native.c_backend.compiled import compiler

    return compiler() is not None


class Prepared:
    """A program for executors of any kind: compiled and verified where one needs it, and once.

    ``routine`` is what it begins with, by default the first one of its first file; ``submits`` may
    run beside it, as may those in files that end in .sub, which need no name here. ``notes`` says
    why the machine runs a program that native code was asked for. Where it ``is_kept`` what was
    verified is kept for the user: not where code may differ from its files, as with mutants.
    """

    def __init__(
        self,
        program: CheckedProgram,
        routine: str | None = None,
        submits: Iterable[str | None] = (),
        *,
        is_kept: bool = False,
    ) -> None:
        self.program = program
        self.routine = routine
        self._names = list(dict.fromkeys(name for name in (routine, *submits) if name))
        self._is_kept = is_kept
        self.notes: list[str] = []

    @cached_property
    def verified(self) -> Verified:
        """As bytecode that was verified; raises `LinkError`."""
        if not self._is_kept:
            return self._verified()
        program = self.program
        units = program.units.values()
        texts = (text for unit in units for text in (unit.module.path, unit.source.text))
        what = program.main.module.path, f"{program.is_strict} {self._names}", *texts
        return kept(CODE, what, self._verified)

    def _verified(self) -> Verified:
        from interp.bytecode.compiler import compile_program
        from interp.bytecode.verifier.verify import verify

        named = []
        for name in self._names:
            with suppress(LinkError):  # reported where an executor begins with it
                named.append(self.program.start(name))
        return verify(compile_program(self.program, named).program)

    def executor(self, name: str, limits: Limits, sink: Sink | None = None) -> Executor:
        """An executor of its own; raises `LinkError`, and `ValueError` for an unknown name."""
        match name:
            case "tree":
                from interp.tree import TreeExecutor

                return TreeExecutor(self.program, self.routine, limits, sink)
            case "vm":
                from interp.bytecode.vm.executor import Machine

                return Machine(self.verified, self.start, limits, sink)
            case "native" | "compiled":
                from interp.native import AVAILABLE

                if not AVAILABLE:
                    raise LinkError("the machine in C was not built: there was no C compiler")
                if name == COMPILED:
                    return self._compiled(limits, sink)
                from interp.native.machine import Machine as NativeMachine

                return NativeMachine(self.verified, self.start, limits, sink)
        raise ValueError(f"there is no executor {name}")

    def _compiled(self, limits: Limits, sink: Sink | None) -> Executor:
        """One with native code, else the machine that it is made for."""
        from interp.native.c_backend.compiled import CompiledMachine

        try:
            return CompiledMachine(self.verified, self.start, limits, sink)
        except OSError as error:
            self.notes.append(f"no native code: {error}; the machine in C runs the program")
            return self.executor("native", limits, sink)

    @property
    def start(self) -> str:
        """The routine to begin with; raises `LinkError` where there is none."""
        return self.program.start(self.routine).name
