"""The interrupts of one program: their declarations, states and pending events [INT-01 ff.].

The event of an interrupt is the edge from FALSE to TRUE of its condition, which is evaluated in
every interpolation cycle [INT-06, INT-18]. One event is stored while the interrupt cannot run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Final, Literal

from grammar.semantics.predefined import System
from grammar.semantics.types import Array, Structure
from interp.controller.state.messages import own_fault
from interp.port.requests import At, CodeHandle, DeclareInterrupt
from interp.values.values import ArrayValue, StructureValue, set_text, zero

#: The interrupt numbers that programs may use; 3 is used by the system, in files of the controller
#: [INT-02]. For the priorities of triggers see TRG-06.
_RANGES: Final = (range(1, 40), range(81, 129))


def is_usable(number: int) -> bool:
    """Return whether an interrupt can have this number [INT-02]."""
    return any(number in numbers for numbers in _RANGES)


@dataclass(slots=True, eq=False)
class Interrupt:
    """A declared interrupt and its state.

    An interrupt that is ``off`` is not evaluated. ``on`` means evaluated and executed, ``held``
    (DISABLE) evaluated, with its event stored [INT-07]. ``depth`` is that of the routine that
    declared it. ``was_true`` is the last value of its condition. ``has_come`` is set while its
    event is pending.
    """

    number: int
    at: At
    is_global: bool
    condition: CodeHandle
    action: CodeHandle
    state: Literal["off", "on", "held"] = "off"
    was_true: bool = False
    has_come: bool = False

    @property
    def depth(self) -> int:
        """The call depth of the declaring routine."""
        return self.at.depth


#: The number of elements in the list of interrupts.
_LISTED: Final = 64
#: INT_STATE in the list of interrupts; these codes are our choice (unconfirmed).
_STATES: Final = {"off": 0, "on": 1, "held": 2}


class Interrupts:
    """The interrupts of a program: at most ``most`` declared, ``active`` pending or running.

    They are in the order of their numbers, so the highest priority comes first.
    """

    def __init__(self, most: int, active: int) -> None:
        self._most = most
        self._active = active
        self._by_number: dict[int, Interrupt] = {}

    def __iter__(self) -> Iterator[Interrupt]:
        return iter(self._by_number.values())

    @property
    def is_watched(self) -> bool:
        """Whether any interrupt has a condition that must be evaluated."""
        return any(one.state != "off" for one in self._by_number.values())

    def declare(self, request: DeclareInterrupt) -> None:
        """Declare an interrupt, replacing one of the same number; faults for an invalid number."""
        if not is_usable(request.number):
            raise own_fault("interrupt_number")
        if request.number not in self._by_number and len(self._by_number) >= self._most:
            raise own_fault("interrupt_count")
        self._by_number[request.number] = Interrupt(
            request.number, request.at, request.is_global, request.condition, request.action
        )
        self._by_number = dict(sorted(self._by_number.items()))

    def switch(self, action: str, number: int | None, holds: Callable[[CodeHandle], bool]) -> None:
        """Execute ON, OFF, ENABLE or DISABLE; ``holds`` evaluates a condition."""
        if number is None:
            chosen = list(self)
        elif number in self._by_number:
            chosen = [self._by_number[number]]
        elif action in ("OFF", "DISABLE"):  # there is nothing to switch off (unconfirmed)
            return
        else:
            raise own_fault("interrupt_unknown")
        for one in chosen:
            match action:
                case "ON" if one.state == "off":
                    one.state, one.was_true = "on", holds(one.condition)
                case "ON" | "ENABLE" if one.state == "held":
                    one.state = "on"
                case "DISABLE" if one.state == "on":
                    one.state = "held"
                case "OFF":
                    one.state, one.has_come = "off", False

    def forget(self, depth: int) -> None:
        """Remove what a routine of this depth declared, unless it is GLOBAL [INT-04].

        Called when the routine ends. Depth 0 is ignored: the arm still moves when the advance run
        reaches the end of the program.
        """
        if depth == 0:
            return
        self._by_number = {
            number: one
            for number, one in self._by_number.items()
            if one.is_global or one.depth < depth
        }

    def watch(self, holds: Callable[[CodeHandle], bool], running: int) -> list[Interrupt]:
        """Evaluate all conditions once, and return the interrupts whose event has come now.

        ``running`` is the number of interrupt routines that run; faults if too many are pending or
        running.
        """
        come = []
        for one in self:
            if one.state == "off":
                continue
            is_true = holds(one.condition)
            if is_true and not one.was_true:
                come.append(one)
                one.has_come = True
            one.was_true = is_true
        if running + sum(one.has_come for one in self) > self._active:
            raise own_fault("interrupt_count")
        return come

    def next(self) -> Interrupt | None:
        """Return the pending interrupt with the highest priority that may run [INT-05]."""
        return next((one for one in self if one.has_come and one.state == "on"), None)


def interrupt_list(interrupts: Interrupts) -> ArrayValue:
    """Return the content of $RINT_LIST or $SINT_LIST: the interrupts in numerical order [INT-17].

    Entries without an interrupt have the number 0; INT_TYPE is 0 (unconfirmed).
    """
    entry = System.load().types["INT_INFO"]
    assert isinstance(entry, Structure)
    found = zero(Array(entry, (_LISTED,)))
    assert isinstance(found, ArrayValue)
    for place, one in enumerate(islice(interrupts, _LISTED), start=1):
        info = found.get(place)
        assert isinstance(info, StructureValue)
        info.set("INT_PRIO", one.number)
        info.set("INT_STATE", _STATES[one.state])
        info.set("PROG_LINE", one.at.line)
        name = info.get("PROG_NAME")
        assert isinstance(name, ArrayValue)
        set_text(name, module_name(one.at.file))
    return found


def module_name(file: str) -> str:
    """Return the name of a module in upper case, from the path of its file."""
    return file.replace("\\", "/").rpartition("/")[2].partition(".")[0].upper()
