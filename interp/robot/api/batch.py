"""The batch strategy of the paper: queue motions until one cannot be blended, then execute them.

The alternative is the incremental look-ahead of `interp.robot.api.control_core`, in which a motion
is planned as soon as it is known. A batch is planned with all its blends known, but its first
motion waits until the program has reached its last one: this delay is the cost of the strategy. A
fault is detected late too, when the batch is planned, and then no motion of it is executed.
"""

from __future__ import annotations

from interp.robot.api.commands import Command, CommandState, MotionCommand, Transaction
from interp.robot.api.control_core import ControlCore, Switch
from interp.robot.arm import Arm
from interp.values.faults import Fault

#: The largest number of motions in a batch: a program may loop over blended motions.
_MOST_HELD = 256


class BatchCore(ControlCore):
    """A control core that collects transactions with motions, and loads them as one.

    The batch is loaded when its last motion has no approximation criterion, at `release`, or when
    it has become too long. A transaction without motions and without a link to the batch is loaded
    at once. Collected motions are not `pending`: the program continues, whatever the depth of its
    advance run.
    """

    def __init__(self, arm: Arm, switch: Switch, cycle: int) -> None:
        super().__init__(arm, switch, cycle)
        self._held: list[Transaction] = []

    def load(self, now: int, transaction: Transaction) -> int | None:
        """Collect a transaction, or load it with all collected ones.

        Raises as `ControlCore.load` does; if a motion of the batch causes the fault, all collected
        commands are cancelled.
        """
        self._advance(now)
        motions = [command for command in transaction.unlinked() if _is_motion(command)]
        if not motions and not self._joins(transaction):
            return super().load(now, transaction)
        self._check(_joined((*self._held, transaction)))
        last = motions[-1] if motions else None
        waits = not isinstance(last, MotionCommand) or bool(last.motion.criteria)
        if waits and self.held + len(motions) < _MOST_HELD:
            self._held.append(transaction)
            return None
        return self._load_batch(now, transaction)

    def release(self, now: int) -> None:
        """Load the batch, because the arm will stop after it. Raises as `load` does."""
        self._advance(now)
        if self._held:
            self._load_batch(now)

    def discard(self, now: int) -> None:
        """Discard what is not travelled yet, and the batch."""
        super().discard(now)
        self._cancel_held()

    @property
    def held(self) -> int:
        """The number of motions in the batch."""
        commands = (command for held in self._held for command in held.commands)
        return sum(map(_is_motion, commands))

    def _load_batch(self, now: int, *more: Transaction) -> int | None:
        batch = _joined((*self._held, *more))
        try:
            at = super().load(now, batch)
        except Fault:
            self._cancel_held()
            raise
        self._held = []
        return at

    def _cancel_held(self) -> None:
        held, self._held = self._held, []
        for command in (command for transaction in held for command in transaction.commands):
            if not command.state.is_over:
                self._finish(command, CommandState.CANCELLED, "cancelled")

    def _joins(self, transaction: Transaction) -> bool:
        held = {command for one in self._held for command in one.commands}
        return any(
            command in held
            for link in transaction.links
            for command in (link.event.command, link.command)
        )


def _is_motion(command: Command) -> bool:
    return isinstance(command, MotionCommand)


def _joined(transactions: tuple[Transaction, ...]) -> Transaction:
    joined = Transaction()
    for transaction in transactions:
        joined.commands += transaction.commands
        joined.links += transaction.links
    return joined
