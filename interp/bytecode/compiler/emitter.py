"""Instructions of one code object, with the types and requests they name, and early ends."""

from __future__ import annotations

from grammar.semantics.types import Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.context import Context
from interp.bytecode.program import Argument, Ask
from interp.values.faults import FAULTS, LinkError


class Ended(Exception):
    """What comes next on this way is never reached, so nothing more of it is made."""


class Emitter:
    """Emits instructions into one code object."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.writer = context.writer
        self.emit = context.writer.emit

    def ask(self, request: str, *parts: Argument) -> None:
        """Make a request of what lies on the stack."""
        self.emit(Op.ASK, self.context.tables.ask(Ask(request, parts, None)))

    # ----------------------------------------------------------------------- types

    def number(self, type_: Type) -> int:
        """The number of a type; refuses what no variable can be of."""
        try:
            return self.context.tables.number(type_)
        except LinkError as error:
            raise self.refuse(str(error)) from None

    def closed(self, type_: Type) -> Type:
        """The type as the program has it."""
        return self.context.tables.types[self.number(type_)]

    # ----------------------------------------------------------------------- ends

    def fail(self, slug: str) -> Ended:
        """The program faults here; what comes back is to be raised."""
        self.emit(Op.FAIL, FAULTS[slug].code)
        return Ended()

    def unlinked(self, reason: str) -> Ended:
        """The program ends here with a `LinkError`, on every executor."""
        self.context.note(reason, is_missing=True)
        return self._ended(reason)

    def refuse(self, reason: str) -> Ended:
        """The program ends here because it cannot be compiled."""
        self.context.note(reason, is_missing=False)
        return self._ended(reason)

    def _ended(self, reason: str) -> Ended:
        text = reason.encode("latin-1", errors="replace").decode("latin-1")
        self.emit(Op.UNLINKED, self.context.tables.text(text))
        return Ended()
