"""Code for control flow: blocks with labels, branches, loops.

Each pass of a loop begins with the statement anew. The trace event of a branch says which branch
was taken.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

from grammar.semantics.types import CHAR, INT, Enumeration, Type
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain
from interp.bytecode.compiler.code_writer import Label
from interp.bytecode.compiler.emitter import Ended
from interp.bytecode.compiler.expressions import CodeMaker, Expressions
from interp.bytecode.compiler.locations import (
    FixedCells,
    FrameCells,
    Location,
    ReferenceParameter,
    Scalar,
)
from interp.values.values import letters


class ControlFlow(CodeMaker):
    """Generates code for statements that contain others, and for jumps.

    ``statement`` generates code for any statement.
    """

    def __init__(
        self, expressions: Expressions, statement: Callable[[ast.Statement], None]
    ) -> None:
        super().__init__(expressions)
        self._statement = statement
        self._labels: list[dict[str, Label]] = []
        self._exits: list[Label] = []

    def block(self, body: Sequence[ast.Statement]) -> None:
        """Generate the statements of a block, with its labels for GOTO."""
        labels: dict[str, Label] = {}
        for statement in body:
            if isinstance(statement, ast.Label):
                labels.setdefault(statement.name.key, Label())
        self._labels.append(labels)
        placed: set[str] = set()
        for statement in body:
            if isinstance(statement, ast.Label):
                if statement.name.key not in placed:
                    placed.add(statement.name.key)
                    self._writer.place(labels[statement.name.key])
            else:
                self._statement(statement)
        self._labels.pop()

    def begin(self, node: ast.Node, end: Label) -> None:
        """Begin a statement or a pass of a loop; if it ends early, it continues at ``end``."""
        self._context.line = self._context.unit.line(node)
        self._emit(Op.LINE, self._context.line, end)

    def _branch(self, way: int) -> None:
        self._emit(Op.TELL_BRANCH, way)

    # ----------------------------------------------------------------------- branches

    def if_statement(self, node: ast.If, end: Label) -> None:
        """Generate IF."""
        otherwise = Label()
        self._expressions.unless(node.condition, otherwise)
        self._branch(1)
        self.block(node.body)
        self._emit(Op.JUMP, end)
        self._writer.place(otherwise)
        self._branch(0)
        self.block(node.otherwise or ())

    def switch(self, node: ast.Switch, end: Label) -> None:
        """Generate SWITCH."""
        selector = self._expressions.operand(node.selector, INT)
        if not isinstance(selector, Scalar):
            raise self._emitter.fail("operand")
        branches = [Label() for _ in node.branches]
        try:
            self._choose(node, selector.type, branches)
            self._branch(0)
            self.block(node.default or ())
            self._emit(Op.JUMP, end)
        except Ended:
            pass
        for number, (branch, label) in enumerate(zip(node.branches, branches, strict=True), 1):
            self._writer.place(label)
            self._branch(number)
            self.block(branch.body)
            self._emit(Op.JUMP, end)

    def _choose(self, node: ast.Switch, type_: Type, branches: Sequence[Label]) -> None:
        """Generate jumps to the branches: by CASE for constants, otherwise by comparisons."""
        pairs = [
            (value, label)
            for branch, label in zip(node.branches, branches, strict=True)
            for value in branch.values
        ]
        words = [self._word_of(value, type_) for value, _ in pairs]
        if None not in words:
            for word, (_, label) in zip(words, pairs, strict=True):
                assert word is not None, "looked at"
                self._emit(Op.CASE, word, label)
            self._emit(Op.DROP)
            return
        kept = FrameCells(self._writer.temporary(type_), type_)
        self._emit(Op.STORE_LOCAL, kept.offset)
        for value, label in pairs:
            self._case(kept, value, label)

    def _word_of(self, node: ast.Expression, type_: Type) -> int | None:
        """Return the word of a literal of exactly this type for CASE, or ``None``."""
        match node, type_:
            case ast.EnumConstant(), Enumeration():
                meant = self._context.unit.checked.enumerations.get(node, type_)
                keys = [constant.upper() for constant in type_.constants]
                if meant == type_ and node.name.key in keys:
                    return keys.index(node.name.key)
            case ast.StringLiteral(text=text), _ if type_ == CHAR and len(letters(text)) == 1:
                return ord(letters(text))
            case _ if type_ == INT:
                return self._expressions.literal_integer(node)
        return None

    def _case(self, kept: FrameCells, node: ast.Expression, label: Label) -> None:
        """Generate a jump to the label if the selector is equal to a value."""
        selector = self._memory.load(kept)
        self._expressions.joined("==", selector, partial(self._expressions.operand, node))
        self._emit(Op.JUMP_IF, label)

    # ----------------------------------------------------------------------- loops

    def while_loop(self, node: ast.While, end: Label) -> None:
        """Generate WHILE [CTL-01]."""
        test, done = Label(), Label()
        self._writer.place(test)
        self._expressions.unless(node.condition, done)
        self._branch(1)
        self._pass(node.body, end)
        self.begin(node, end)
        self._emit(Op.JUMP, test)
        self._writer.place(done)
        self._branch(0)

    def repeat_loop(self, node: ast.Repeat, end: Label) -> None:
        """Generate REPEAT."""
        again, go_on = Label(), Label()
        self._writer.place(again)
        self._pass(node.body, end)
        self.begin(node.condition, end)
        self._expressions.unless(node.condition, go_on)
        self._branch(1)
        self._emit(Op.JUMP, end)
        self._writer.place(go_on)
        self._branch(0)
        self._emit(Op.JUMP, again)

    def endless_loop(self, node: ast.Loop, end: Label) -> None:
        """Generate LOOP."""
        again = Label()
        self._writer.place(again)
        self._pass(node.body, end)
        self.begin(node, end)
        self._emit(Op.JUMP, again)

    def _pass(self, body: Sequence[ast.Statement], end: Label) -> None:
        """Generate the body of a loop."""
        self._exits.append(end)
        self.block(body)
        self._exits.pop()

    # ----------------------------------------------------------------------- FOR

    def for_loop(self, node: ast.For, end: Label) -> None:
        """Generate FOR [CTL-05, CTL-06]."""
        step = self._step(node.step)
        counter = self._designators.variable(node.counter)
        if step is None or not isinstance(counter, FixedCells) or counter.type != INT:
            self._general_for(node, counter, step, end)
            return
        self._store_integer(counter, node.first)
        last = self._limit(node.last)
        body, again = Label(), Label()
        self._memory.load(counter)
        self._memory.load(last)
        self._emit(Op.UNLESS_LE_INT if step > 0 else Op.UNLESS_GE_INT, end)
        self._emit(Op.JUMP, body)
        self._writer.place(again)
        self._memory.tell(counter)
        self._writer.place(body)
        self._pass(node.body, end)
        self.begin(node, end)
        self._emit(counter.count, counter.offset, last.offset, step, again)
        self._memory.tell(counter)

    def _step(self, node: ast.Expression | None) -> int | None:
        """Return the step if it is a constant other than zero, otherwise ``None``."""
        if node is None:
            return 1
        number = self._expressions.literal_integer(node)
        return number if number else None

    def _limit(self, node: ast.Expression) -> FrameCells:
        self._expressions.integer(node)
        last = FrameCells(self._writer.temporary(INT), INT)
        self._emit(Op.STORE_LOCAL, last.offset)
        return last

    def _store_integer(self, counter: Location, node: ast.Expression) -> None:
        """Generate the assignment of a number, rounded if necessary, to the counter; trace it."""
        ready = self._memory.ready(counter)
        behind = self._writer.here
        self._expressions.integer(node)
        self._memory.store(ready, Scalar(INT), behind)
        self._memory.tell(ready)

    def _general_for(self, node: ast.For, counter: Location, known: int | None, end: Label) -> None:
        """Generate a loop with any kind of counter, or with a step that is not constant."""
        step = FrameCells(self._writer.temporary(INT), INT)
        if node.step is None or known is not None:
            self._emit(Op.PUSH_INT, known or 1)
        else:
            self._expressions.integer(node.step)
        self._emit(Op.STORE_LOCAL, step.offset)
        self._store_integer(counter, node.first)
        last = self._limit(node.last)
        test, down, body = Label(), Label(), Label()
        self._writer.place(test)
        self._memory.load(step)
        self._emit(Op.PUSH_INT, 0)
        self._emit(Op.UNLESS_GT_INT, down)
        with suppress(Ended):  # the other direction ends as this one does
            self._compare(counter, last, ">", body, end)
        self._writer.place(down)
        self._compare(counter, last, "<", body, end)
        self._writer.place(body)
        self._pass(node.body, end)
        self.begin(node, end)
        self._count(counter, step)
        self._emit(Op.JUMP, test)

    def _compare(
        self, counter: Location, last: FrameCells, operator: str, go_on: Label, end: Label
    ) -> None:
        """Generate a jump out of the loop if the counter is beyond its last value."""
        self._expressions.joined(operator, self._memory.load(counter), self._loaded(last))
        self._emit(Op.JUMP_IF, end)
        self._emit(Op.JUMP, go_on)

    def _count(self, counter: Location, step: FrameCells) -> None:
        """Generate the addition of the step to the counter."""
        ready = self._memory.ready(counter)
        behind = self._writer.here
        value = self._expressions.joined("+", self._memory.load(counter), self._loaded(step))
        self._memory.store(ready, value, behind)
        self._memory.tell(ready)

    def _loaded(self, cell: FrameCells) -> Callable[[Type], Scalar]:
        """Return what pushes the value of a cell."""

        def push(_wanted: Type) -> Scalar:
            self._memory.load(cell)
            return Scalar(cell.type)

        return push

    # ----------------------------------------------------------------------- jumps

    def exit_loop(self, _node: ast.Exit, _end: Label) -> None:
        """Generate EXIT."""
        if not self._exits:
            raise self._emitter.unlinked("EXIT outside of a loop")
        self._emit(Op.JUMP, self._exits[-1])

    def goto(self, node: ast.Goto, _end: Label) -> None:
        """Generate GOTO."""
        for labels in reversed(self._labels):
            if node.label.key in labels:
                self._emit(Op.JUMP, labels[node.label.key])
                return
        raise self._emitter.unlinked(f"the label {node.label.key} is not there to go to")

    def return_statement(self, node: ast.Return, _end: Label) -> None:
        """Generate RETURN."""
        type_ = self._context.result
        if node.value is None or type_ is None:
            if type_ is not None:
                raise self._emitter.unlinked("RETURN without a value")
            self._emit(Op.RETURN)
        elif isinstance(type_, Plain):
            self._memory.convert(self._expressions.value(node.value, type_), type_)
            self._emit(Op.RETURN_VALUE)
        else:
            assert self._context.target is not None, "a large result has a place"
            self._expressions.assign(ReferenceParameter(self._context.target, type_), node.value)
            self._emit(Op.RETURN)
