"""Emits instructions with types and requests, and ends code that can only fail."""

from __future__ import annotations

from grammar.semantics.types import Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.context import Context
from interp.bytecode.program import Argument, Ask
from interp.values.faults import FAULTS, LinkError


class Ended(Exception):
    """Raised after an instruction that always ends the program: what follows is unreachable."""


class Emitter:
    """Emits instructions into one code object."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.writer = context.writer
        self.emit = context.writer.emit

    def ask(self, request: str, *parts: Argument) -> None:
        """Emit a request with the operands on the stack."""
        self.emit(Op.ASK, self.context.tables.ask(Ask(request, parts, None)))

    # ----------------------------------------------------------------------- types

    def number(self, type_: Type) -> int:
        """Return the number of a type; refuses a type that no variable can have."""
        try:
            return self.context.tables.number(type_)
        except LinkError as error:
            raise self.refuse(str(error)) from None

    def closed(self, type_: Type) -> Type:
        """Return the type as it is stored in the program."""
        return self.context.tables.types[self.number(type_)]

    # ----------------------------------------------------------------------- ends

    def fail(self, slug: str) -> Ended:
        """Emit a fault; return what to raise."""
        self.emit(Op.FAIL, FAULTS[slug].code)
        return Ended()

    def unlinked(self, reason: str) -> Ended:
        """End the program here with a `LinkError`, on every executor; return what to raise."""
        self.context.note(reason, is_missing=True)
        return self._ended(reason)

    def refuse(self, reason: str) -> Ended:
        """End the program here because it cannot be compiled; return what to raise."""
        self.context.note(reason, is_missing=False)
        return self._ended(reason)

    def _ended(self, reason: str) -> Ended:
        text = reason.encode("latin-1", errors="replace").decode("latin-1")
        self.emit(Op.UNLINKED, self.context.tables.text(text))
        return Ended()
