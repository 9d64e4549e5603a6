"""The executors by name, and their creation from a checked program.

Only the needed modules are imported: the machines need a compiled program, the tree interpreter
does not.
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

#: The names of all executors, the reference executor first.
EXECUTORS: Final = ("tree", "vm", "native")
#: The machine in C with native code of the program; it needs a C compiler, so it is optional.
COMPILED: Final = "compiled"
#: The packages on whose code a cached program depends.
CODE: Final = ("grammar", "interp", "support")


def available() -> tuple[str, ...]:
    """Return the executors that can run here: the machine in C needs a compiler at installation."""
    from interp.native import AVAILABLE

    return EXECUTORS if AVAILABLE else EXECUTORS[:-1]


def is_available(name: str) -> bool:
    """Return whether an executor can run here; `COMPILED` is accepted too."""
    from interp.native import AVAILABLE

    if name != COMPILED or not AVAILABLE:
        return name in available()
    from interp.native.c_backend.shared_objects import compiler

    return compiler() is not None


class Prepared:
    """A program for executors of any kind; it is compiled and verified at most once, if needed.

    ``routine`` is the routine to begin with, by default the first one of the main file. ``submits``
    are further routines that may run beside it; those in files that end in .sub need not be named.
    ``notes`` says why the machine runs a program for which native code was requested. With
    ``is_kept`` the verified program is cached for the user; this is wrong if the code may differ
    from its files, as with mutants.
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
        """The program as verified bytecode; raises `LinkError`."""
        if not self._is_kept:
            return self._verified()
        program = self.program
        units = program.units.values()
        texts = (text for unit in units for text in (unit.module.path, unit.source.text))
        what = program.main.module.path, f"{program.is_strict} {self._names}", *texts
        return kept(CODE, what, self._verified)

    def _verified(self) -> Verified:
        from interp.bytecode.compiler.project import compile_program
        from interp.bytecode.verifier.verify import verify

        named = []
        for name in self._names:
            with suppress(LinkError):  # the executor that begins with it reports the error
                named.append(self.program.start(name))
        return verify(compile_program(self.program, named).program)

    def executor(self, name: str, limits: Limits, sink: Sink | None = None) -> Executor:
        """Return a new executor; raise `LinkError`, and `ValueError` for an unknown name."""
        match name:
            case "tree":
                from interp.tree.executor import TreeExecutor

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
        """Return an executor with native code, or the machine in C if that is impossible."""
        from interp.native.c_backend.compiled import CompiledMachine

        try:
            return CompiledMachine(self.verified, self.start, limits, sink)
        except OSError as error:
            self.notes.append(f"no native code: {error}; the machine in C runs the program")
            return self.executor("native", limits, sink)

    @property
    def start(self) -> str:
        """The name of the routine to begin with; raises `LinkError` if there is none."""
        return self.program.start(self.routine).name
