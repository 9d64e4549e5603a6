"""Channels: COPEN, CREAD, CWRITE and CCLOSE, with a peer that a script plays [FCT-08, ADV-07].

Data from the peer is queued until the program reads it. CREAD parses a text as `SREAD` does, and
CWRITE formats one as `SWRITE` does. The order of arguments is from a transcription of the manual:
CREAD(handle, state, mode, timeout, offset, format, variables …), CWRITE(handle, state, mode,
format, values …). Timeouts are in seconds. #SYNC and #ABS wait for data, #COND does not
(unconfirmed).
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Any, Final

from grammar.semantics.types import CHAR, REAL, Array
from interp.controller.state.clock import Clock, microseconds
from interp.controller.state.messages import own_fault
from interp.port.requests import Value
from interp.values.faults import fault
from interp.values.formats import LONGEST, sread, state_value, swrite
from interp.values.values import (
    ArrayValue,
    EnumValue,
    converted,
    empty,
    known,
    letters,
    set_text,
    text_of,
)
from support.lazy_dataclass import dataclass

#: Variables that contain the handle of a channel that is open from the start.
COMMANDS: Final = ("$CMD", "$FCT_CALL")


@dataclass(frozen=True, slots=True)
class Waiting:
    """CREAD must wait for data of a channel, until a time in µs; ``None`` waits without limit."""

    channel: str
    until: int | None


Arguments = Sequence[Value | None]
#: The new values of arguments, by position counted from 0.
Changes = Mapping[int, Value]


@dataclass(slots=True)
class Channels:
    """The state of all channels.

    ``listeners`` are called with the channel and the text whenever a program writes to a channel.
    """

    clock: Clock
    listeners: list[Callable[[str, str], None]] = field(default_factory=list)
    _handles: dict[int, str] = field(default_factory=dict)
    _data: dict[str, deque[str]] = field(default_factory=lambda: defaultdict(deque))
    _last: int = 0

    def receive(self, channel: str, text: str) -> None:
        """Queue a text that the peer of a channel sends."""
        self._data[channel.lstrip("$:")].append(letters(text))

    def has_data(self, channel: str) -> bool:
        """Return whether a channel has data to read."""
        return bool(self._data.get(channel))

    def open(self, arguments: Arguments) -> Changes:
        """COPEN(:NAME, handle): open a channel."""
        channel, _ = arguments
        return {1: self.opened(text_of(known(channel)).upper().lstrip(":"))}

    def opened(self, name: str) -> int:
        """Open a channel, and return its handle."""
        self._last += 1
        self._handles[self._last] = name
        return self._last

    def close(self, arguments: Arguments) -> Changes:
        """CCLOSE(handle, state): close a channel; unread data is lost."""
        handle, _ = arguments
        name = self._name(handle)
        self._handles = {handle: one for handle, one in self._handles.items() if one != name}
        self._data.pop(name, None)
        return {1: state_value("CMD_OK")}

    def write(self, arguments: Arguments) -> Changes:
        """CWRITE: send formatted values; a format without values is sent as it is.

        RET1 is not what it is for SWRITE [FCT-08].
        """
        match arguments:
            case (handle, _, _, pattern, *more):
                name = self._name(handle)
            case _:
                raise fault("argument")
        text, values = text_of(known(pattern)), [known(one) for one in more]
        is_written, hits = True, 0
        if values:
            _, changes = swrite(empty(Array(CHAR, (LONGEST,))), None, 0, text, *values)
            state: Any = changes[1]
            is_written, hits = state.get("RET1").name == "CMD_OK", state.get("HITS")
            text = text_of(changes[0])
        for listener in self.listeners:
            listener(name, text)
        return {1: state_value("DATA_OK" if is_written else "CMD_ABORT", hits, len(text))}

    def read(self, arguments: Arguments, since: int) -> Changes | Waiting:
        """CREAD, requested at the time ``since``; return `Waiting` if there is no data yet."""
        match arguments:
            case (handle, _, mode, limit, offset, pattern, *variables):
                name = self._name(handle)
            case _:
                raise fault("argument")
        if not self._data[name]:
            timeout = converted(known(limit), REAL)
            assert isinstance(timeout, float), "converted"
            until = since + microseconds(timeout) if timeout > 0 else None
            is_over = until is not None and self.clock.now >= until
            is_cyclic = isinstance(mode, EnumValue) and mode.name.upper() == "COND"
            if is_cyclic or is_over:
                return {1: state_value("CMD_TIMEOUT")}
            return Waiting(name, until)
        text = self._data[name].popleft()
        source = empty(Array(CHAR, (max(1, len(text)),)))
        assert isinstance(source, ArrayValue)
        set_text(source, text)
        _, changes = sread(source, None, known(offset), known(pattern), *variables)
        return {place if place == 1 else place + 2: value for place, value in changes.items()}

    def _name(self, handle: Value | None) -> str:
        if isinstance(handle, int) and handle in self._handles:
            return self._handles[handle]
        raise own_fault("channel")
