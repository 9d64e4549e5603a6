"""Control flow as jumps: blocks with their labels, branches, loops.

A loop begins anew at each pass. What is told of a branch is which way was taken.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from contextlib import suppress

from grammar.semantics.types import CHAR, INT, REAL, Enumeration, Type
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain
from interp.bytecode.compiler.code_writer import Label
from interp.bytecode.compiler.context import Context, Ended
from interp.bytecode.compiler.motions import Motions
from interp.bytecode.compiler.places import Cells, DataCells, Formal, Place, Scalar
from interp.values.values import letters

__all__ = ["ControlFlow"]


class ControlFlow(Motions):
    """Makes the code of statements that hold others, and of those that leave them."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._labels: list[dict[str, Label]] = []
        self._exits: list[Label] = []

    @abstractmethod
    def statement(self, node: ast.Statement) -> None:
        """Any statement."""

    def block(self, body: Sequence[ast.Statement]) -> None:
        """The statements of a block, with the labels that GOTO finds there."""
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
                    self.writer.place(labels[statement.name.key])
            else:
                self.statement(statement)
        self._labels.pop()

    def begin(self, node: ast.Node, end: Label) -> None:
        """A statement begins, or a loop anew; where it ends early it goes on at ``end``."""
        self.context.line = self.context.unit.line(node)
        self.emit(Op.LINE, self.context.line, end)

    def _told(self, way: int) -> None:
        self.emit(Op.TELL_BRANCH, way)

    # ----------------------------------------------------------------------- branches

    def if_statement(self, node: ast.If, end: Label) -> None:
        """IF."""
        otherwise = Label()
        self.unless(node.condition, otherwise)
        self._told(1)
        self.block(node.body)
        self.emit(Op.JUMP, end)
        self.writer.place(otherwise)
        self._told(0)
        self.block(node.otherwise or ())

    def switch(self, node: ast.Switch, end: Label) -> None:
        """SWITCH."""
        selector = self.operand(node.selector, INT)
        if not isinstance(selector, Scalar):
            raise self.fail("operand")
        branches = [Label() for _ in node.branches]
        try:
            self._choose(node, selector.type, branches)
            self._told(0)
            self.block(node.default or ())
            self.emit(Op.JUMP, end)
        except Ended:
            pass
        for number, (branch, label) in enumerate(zip(node.branches, branches, strict=True), 1):
            self.writer.place(label)
            self._told(number)
            self.block(branch.body)
            self.emit(Op.JUMP, end)

    def _choose(self, node: ast.Switch, type_: Type, branches: Sequence[Label]) -> None:
        """Go on at one of the labels, or behind: by constants, or by comparing one by one."""
        pairs = [
            (value, label)
            for branch, label in zip(node.branches, branches, strict=True)
            for value in branch.values
        ]
        words = [self._word_of(value, type_) for value, _ in pairs]
        if None not in words:
            for word, (_, label) in zip(words, pairs, strict=True):
                assert word is not None, "looked at"
                self.emit(Op.CASE, word, label)
            self.emit(Op.DROP)
            return
        kept = Cells(self.writer.temporary(type_), type_)
        self.emit(Op.STORE_LOCAL, kept.offset)
        for value, label in pairs:
            self._case(kept, value, label)

    def _word_of(self, node: ast.Expression, type_: Type) -> int | None:
        """The word of a literal of exactly this type, which CASE can tell apart."""
        match node, type_:
            case ast.EnumConstant(), Enumeration():
                meant = self.context.unit.checked.enumerations.get(node, type_)
                keys = [constant.upper() for constant in type_.constants]
                if meant == type_ and node.name.key in keys:
                    return keys.index(node.name.key)
            case ast.StringLiteral(text=text), _ if type_ == CHAR and len(letters(text)) == 1:
                return ord(letters(text))
            case _ if type_ == INT:
                return self.literal_integer(node)
        return None

    def _case(self, kept: Cells, node: ast.Expression, label: Label) -> None:
        """Go on at the label where the value kept is this one."""
        self.load(kept)
        between = self.writer.here
        wanted = kept.type if isinstance(kept.type, Enumeration) else INT
        right = self.operand(node, wanted)
        selection = self.selected("==", kept.type, right.type)
        for step in selection.conversions[0]:
            self.writer.insert(between, Op[step.name.upper()])
        for step in selection.conversions[1]:
            self.emit(Op[step.name.upper()])
        assert selection.primitive is not None, "relations do something"
        if selection.primitive.operands[0] == "ENUM" and kept.type != right.type:
            self.unlike(selection.primitive)
        else:
            self.emit(Op[selection.primitive.name.upper()])
        self.emit(Op.JUMP_IF, label)

    # ----------------------------------------------------------------------- loops

    def while_loop(self, node: ast.While, end: Label) -> None:
        """WHILE."""
        test, done = Label(), Label()
        self.writer.place(test)
        self.unless(node.condition, done)
        self._told(1)
        self._pass(node.body, end)
        self.begin(node, end)
        self.emit(Op.JUMP, test)
        self.writer.place(done)
        self._told(0)

    def repeat_loop(self, node: ast.Repeat, end: Label) -> None:
        """REPEAT."""
        again, go_on = Label(), Label()
        self.writer.place(again)
        self._pass(node.body, end)
        self.begin(node.condition, end)
        self.unless(node.condition, go_on)
        self._told(1)
        self.emit(Op.JUMP, end)
        self.writer.place(go_on)
        self._told(0)
        self.emit(Op.JUMP, again)

    def endless_loop(self, node: ast.Loop, end: Label) -> None:
        """LOOP."""
        again = Label()
        self.writer.place(again)
        self._pass(node.body, end)
        self.begin(node, end)
        self.emit(Op.JUMP, again)

    def _pass(self, body: Sequence[ast.Statement], end: Label) -> None:
        """What is done in each pass of a loop."""
        self._exits.append(end)
        self.block(body)
        self._exits.pop()

    # ----------------------------------------------------------------------- FOR

    def for_loop(self, node: ast.For, end: Label) -> None:
        """FOR."""
        step = self._step(node.step)
        counter = self.variable(node.counter)
        if step is None or not isinstance(counter, Cells | DataCells) or counter.type != INT:
            self._general_for(node, counter, step, end)
            return
        self._store_integer(counter, node.first)
        last = self._limit(node.last)
        body, again = Label(), Label()
        self.load(counter)
        self.load(last)
        self.emit(Op.UNLESS_LE_INT if step > 0 else Op.UNLESS_GE_INT, end)
        self.emit(Op.JUMP, body)
        self.writer.place(again)
        self.tell(counter)
        self.writer.place(body)
        self._pass(node.body, end)
        self.begin(node, end)
        if isinstance(counter, Cells):
            self.emit(Op.FOR_LOCAL, counter.offset, last.offset, step, again)
        else:
            self.emit(Op.FOR_DATA, counter.address, last.offset, step, again)
        self.tell(counter)

    def _step(self, node: ast.Expression | None) -> int | None:
        """The step, if it is known and not zero; else it is kept, and `_general_for` finds it."""
        if node is None:
            return 1
        number = self.literal_integer(node)
        return number if number else None

    def _limit(self, node: ast.Expression) -> Cells:
        self.integer(node)
        last = Cells(self.writer.temporary(INT), INT)
        self.emit(Op.STORE_LOCAL, last.offset)
        return last

    def _store_integer(self, counter: Place, node: ast.Expression) -> None:
        """Give the counter a number, rounded if need be, and tell it."""
        ready = self.ready(counter)
        behind = self.writer.here
        self.integer(node)
        self.store(ready, Scalar(INT), behind)
        self.tell(ready)

    def _general_for(self, node: ast.For, counter: Place, known: int | None, end: Label) -> None:
        """A loop whose counter is anywhere, or whose step is known when it runs."""
        step = Cells(self.writer.temporary(INT), INT)
        if node.step is None or known is not None:
            self.emit(Op.PUSH_INT, known or 1)
        else:
            self.integer(node.step)
        self.emit(Op.STORE_LOCAL, step.offset)
        self._store_integer(counter, node.first)
        last = self._limit(node.last)
        test, down, body = Label(), Label(), Label()
        self.writer.place(test)
        self.load(step)
        self.emit(Op.PUSH_INT, 0)
        self.emit(Op.UNLESS_GT_INT, down)
        with suppress(Ended):  # the other direction ends as this one does
            self._compare(counter, last, ">", body, end)
        self.writer.place(down)
        self._compare(counter, last, "<", body, end)
        self.writer.place(body)
        self._pass(node.body, end)
        self.begin(node, end)
        self._count(counter, step)
        self.emit(Op.JUMP, test)

    def _compare(
        self, counter: Place, last: Cells, operator: str, go_on: Label, end: Label
    ) -> None:
        """Leave the loop where the counter is beyond its last value."""
        value = self.load(counter)
        if not isinstance(value, Scalar):
            raise self.fail("operand")
        selection = self.selected(operator, value.type, INT)
        for step in selection.conversions[0]:
            self.emit(Op[step.name.upper()])
        self.load(last)
        for step in selection.conversions[1]:
            self.emit(Op[step.name.upper()])
        assert selection.primitive is not None, "relations do something"
        self.emit(Op[selection.primitive.name.upper()])
        self.emit(Op.JUMP_IF, end)
        self.emit(Op.JUMP, go_on)

    def _count(self, counter: Place, step: Cells) -> None:
        """Add the step to the counter."""
        ready = self.ready(counter)
        behind = self.writer.here
        value = self.load(counter)
        assert isinstance(value, Scalar), "compared before"
        if value.type not in (INT, REAL):
            raise self.fail("operand")
        self.load(step)
        if value.type == REAL:
            self.emit(Op.INT_TO_REAL)
        self.emit(Op.ADD_INT if value.type == INT else Op.ADD_REAL)
        self.store(ready, value, behind)
        self.tell(ready)

    # ----------------------------------------------------------------------- jumps

    def exit_loop(self, _node: ast.Exit, _end: Label) -> None:
        """EXIT."""
        if not self._exits:
            raise self.unlinked("EXIT outside of a loop")
        self.emit(Op.JUMP, self._exits[-1])

    def goto(self, node: ast.Goto, _end: Label) -> None:
        """GOTO."""
        for labels in reversed(self._labels):
            if node.label.key in labels:
                self.emit(Op.JUMP, labels[node.label.key])
                return
        raise self.unlinked(f"the label {node.label.key} is not there to go to")

    def return_statement(self, node: ast.Return, _end: Label) -> None:
        """RETURN."""
        type_ = self.context.result
        if node.value is None or type_ is None:
            if type_ is not None:
                raise self.unlinked("RETURN without a value")
            self.emit(Op.RETURN)
        elif isinstance(type_, Plain):
            self.convert(self.value(node.value, type_), type_)
            self.emit(Op.RETURN_VALUE)
        else:
            assert self.context.target is not None, "a large result has a place"
            self.assign(Formal(self.context.target, type_), node.value)
            self.emit(Op.RETURN)
