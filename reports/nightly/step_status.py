"""The status of a step of a nightly run: one line, whose first words say how the step ended.

=============  ===================================================================================
ok, findings   it ended, with the exit status 0 or 1
failed: …      it ended with another exit status, or by a signal
flaky: …       it failed, and ended when it was tried once more
cut off …      it did not end within its share of the time
not run …      no time was left for it, or not enough
=============  ===================================================================================
"""

from typing import Final

from reports.rendering.number_format import counted
from reports.rendering.record_fields import Record, nested, text

FAILED: Final = "failed: "
FLAKY: Final = "flaky: "
CUT_OFF: Final = "cut off "
NOT_RUN: Final = "not run"
_ENDED: Final = ("ok", "findings")


def has_ended(status: str) -> bool:
    """Return whether a step ended as it should."""
    return status in _ENDED


def has_failed(status: str) -> bool:
    """Return whether a step neither ended as it should nor lacked the time."""
    return not has_ended(status) and not status.startswith(NOT_RUN)


def incomplete(steps: Record) -> str:
    """Return a sentence on the steps that were not run, "" if there are none.

    ``steps`` are the states of all steps by name.
    """
    left = [name for name in steps if text(nested(steps, name), "status").startswith(NOT_RUN)]
    return f"incomplete: {counted(len(left), 'step')} not run: {', '.join(left)}" if left else ""
