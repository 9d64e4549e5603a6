"""The paper's strategy: queue motions until one cannot be blended, then execute the batch.

The alternative is the incremental look-ahead of `interp.robot.api.control_core`, where a motion is
planned as soon as it is known. A batch is planned with all its blends known, but its first motion
waits until the program has come to its last: that delay is what the strategy costs. A fault is
found late too, when the arm is asked for the batch, and then none of it is executed.
"""

from __future__ import annotations

from interp.robot.api.commands import Command, CommandState, MotionCommand, Transaction
from interp.robot.api.control_core import ControlCore, Switch
from interp.robot.arm import Arm
from interp.values.faults import Fault

_MOST_HELD = 256
"""Motions in a batch: a program may loop over approximated motions for ever (a choice of ours)."""


class BatchCore(ControlCore):
    """A control core that holds transactions with motions back and loads them as one.

    The batch goes when its last motion has no approximation criterion, with `release`, or once so
    many motions are held that it might never. What has no motion and no link to the batch is loaded
    at once. Held motions are not `pending`: the program continues, however deep its advance
    run may be.
    """

    def __init__(self, arm: Arm, switch: Switch, cycle: int) -> None:
        super().__init__(arm, switch, cycle)
        self._held: list[Transaction] = []

    def load(self, now: int, transaction: Transaction) -> int | None:
        """Hold a transaction back, or load it with all that is held.

        Raises as `ControlCore.load` does; where the fault is one of the batch, all that was held is
        cancelled.
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
        """Execute what is held: the arm will stand behind it. Raises as `load` does."""
        self._advance(now)
        if self._held:
            self._load_batch(now)

    def discard(self, now: int) -> None:
        """Forget what is not travelled yet, and what is held."""
        super().discard(now)
        self._cancel_held()

    @property
    def held(self) -> int:
        """How many motions wait for the batch to go."""
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
