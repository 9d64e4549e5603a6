"""The machine in C as an executor.

C executes the instructions. What goes beyond cells is done by the Python code of
`interp.bytecode.vm.executor`: requests and replies, the trace, functions that C does not have, and
the counting of slices. So both machines behave alike. To that code, the memory in C looks like the
state of the Python machine, and a run in C looks like an operation: it runs until Python has to do
something, and returns the operation that does it.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from typing import Final, cast, overload

from grammar.semantics.types import BOOL, INT, Enumeration
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Raw
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.vm import executor as vm
from interp.bytecode.vm.frames import Frames
from interp.bytecode.vm.names import InFrame, Names
from interp.bytecode.vm.services import Services
from interp.bytecode.vm.state import Call, Completion, OperandStack, Operation, State, raising, then
from interp.bytecode.vm.threaded_code import ThreadedCode
from interp.native._core import Core
from interp.port.events import Kind, wanting
from interp.port.executor import Reader
from interp.port.inspection import RELATIONS, Breaks, Guard
from interp.port.requests import Request
from interp.program.load import Limits
from interp.values.faults import FAULTS, LinkError, fault


class _Stop(IntEnum):
    """Why C has stopped; must agree with ``enum krl_stop``."""

    STEP = 0
    LINE = 1
    FAULT = 2
    LEFT = 3
    ACTION = 4
    END = 5
    BREAK = 7


class _Matter(IntEnum):
    """What Python has to do at a step; must agree with ``enum krl_matter``."""

    INSTRUCTION = 0
    CALL = 1
    LEAVE = 2


#: The kinds of events as ``enum krl_traced`` has them.
_TRACED: Mapping[Kind, int] = {"line": 1, "assign": 2, "call": 4, "return": 8, "branch": 16}
#: A statement at which C stops whatever holds.
_UNGUARDED: Final = (-1, 0, False, 0)
#: The first relation that asks for an order.
_ORDER: Final = RELATIONS.index("<")
_SLUGS = [slug for slug, _ in sorted(FAULTS.items(), key=lambda item: item[1].code)]


class _Stack:
    """The operand stack of the current frame while C has stopped: the cells below ``top``.

    Only items at the top are accessed, as slices that begin at a negative index.
    """

    __slots__ = ("_core",)

    def __init__(self, core: Core) -> None:
        self._core = core

    def __len__(self) -> int:
        return self._core.top - self._core.floor

    @overload
    def __getitem__(self, where: int) -> Raw | None: ...
    @overload
    def __getitem__(self, where: slice) -> list[Raw | None]: ...
    def __getitem__(self, where: int | slice) -> Raw | list[Raw | None] | None:
        core = self._core
        if isinstance(where, slice):
            return core[core.top + where.start : core.top]
        return core[core.top + where]

    def __setitem__(self, where: int, raw: Raw | None) -> None:
        core = self._core
        core[core.top + where] = raw

    def __delitem__(self, where: slice) -> None:
        core = self._core
        core.top = (core.top if where.start < 0 else core.floor) + where.start

    def append(self, raw: Raw | None) -> None:
        """Push an item."""
        core = self._core
        core[core.top] = raw
        core.top += 1

    def pop(self) -> Raw | None:
        """Take the item at the top off, and return it."""
        core = self._core
        core.top -= 1
        return core[core.top]


class _Calls:
    """The open calls, as far as Python needs them."""

    __slots__ = ("_core",)

    def __init__(self, core: Core) -> None:
        self._core = core

    def __len__(self) -> int:
        return self._core.open

    def __getitem__(self, where: int) -> Call:
        code, first, statement, serial = self._core.call(where % self._core.open)
        return _nowhere, code, first, 0, statement, serial


class _State(Core):
    """The state of the machine in C, with the interface of `interp.bytecode.vm.state.State`."""

    __slots__ = ("calls", "completion", "reader", "request", "site", "stack")

    base = 0  # where nothing lies on the stack that is not the frame's

    def __init__(
        self,
        _image: bytes,
        _depths: bytes,
        _traced: int,
        _most_calls: int,
        _beside: Core | None,
    ) -> None:
        self.stack: OperandStack = _Stack(self)
        self.calls = _Calls(self)
        self.reader: Reader | None = None
        self.request: Request | None = None
        self.completion: Completion | None = None
        self.site: object = None

    @property
    def cells(self) -> Core:
        """The memory."""
        return self


def _nowhere() -> None:
    """Stand for the return address of an open call, which only C knows."""


class _Body:
    """The operations of a code object, by index of the instruction."""

    __slots__ = ("_code", "_threaded")

    def __init__(self, threaded: _NativeCode, code: int) -> None:
        self._threaded = threaded
        self._code = code

    def __getitem__(self, place: int) -> Operation:
        return self._threaded.at(self._code, place)


class _NativeCode:
    """Runs code objects in C, in place of `interp.bytecode.vm.threaded_code.ThreadedCode`."""

    def __init__(self, program: Program, state: _State, services: Services) -> None:
        self._program = program
        self._state = state
        self._services = services
        self.entries = [self.at(number, 0) for number in range(len(program.codes))]
        self._outside: dict[int, Operation] = {}

    def body(self, number: int) -> _Body:
        """Return the operations of a code object."""
        return _Body(self, number)

    def at(self, code: int, place: int) -> Operation:
        """Return the operation that runs from an instruction on."""
        return self._running(self._state.step(code, place))

    def _running(self, step: int, is_begun: bool = False) -> Operation:
        run = self._state.run
        return lambda: self._stopped(run(step, is_begun))

    def _stopped(self, stop: int) -> Operation | None:
        """Return the operation for which C has stopped."""
        why = stop & 7
        if why <= _Stop.LINE:
            operation = self._outside.get(stop)
            if operation is None:
                operation = self._outside[stop] = self._made(stop >> 3, _Stop(why))
            return operation
        if why == _Stop.FAULT:
            code = stop >> 3
            raise fault(_SLUGS[code]) if code < len(_SLUGS) else self._services.overrun()
        if why == _Stop.BREAK:
            counter = self._services.counter
            if self._state.reader is None:
                counter.ask_at(counter.begun)
            return self._stopped(stop & ~7 | _Stop.LINE)
        if why == _Stop.ACTION:
            return self._services.leave_action
        return self._services.finish if why == _Stop.END else None

    def _made(self, step: int, why: _Stop) -> Operation:
        """Return the operation for a step that Python executes; C continues after it."""
        matter, place, statement = self._state.about(step)
        services = self._services
        code = self._state.code
        if why is _Stop.LINE:
            return services.line(statement, self._running(step, is_begun=True))
        after = self._running(step + 1)
        instruction = self._program.codes[code].instructions[place]
        if matter == _Matter.CALL:
            return then(lambda: services.tell_call(instruction.operands[0]), after)
        if matter == _Matter.LEAVE:
            return then(services.tell_leave, after)
        match instruction.op:
            case Op.LINE:
                return services.line(place, after)
            case Op.ASK:
                return services.ask(instruction.operands[0], after)
            case Op.BUILTIN:
                return services.builtin(instruction.operands[0], after)
            case Op.PROCEED:
                return services.proceed(after)
            case Op.UNLINKED:
                text = self._program.texts[instruction.operands[0]]
                return raising(lambda: LinkError(text))
        return services.tell(instruction, after)


class _Frames(Frames):
    """Frames that the machine in C opens and closes."""

    def __init__(self, program: Program, core: _State) -> None:
        super().__init__(program, cast("State", core))
        self._core = core

    def begin(self, number: int) -> None:
        """Create the first frame."""
        self._core.begin(number)

    def open(self, number: int, serial: int, _after: Operation) -> None:
        """See `Frames.open`."""
        core, found = self._core, self.captures(number, serial)
        if not core.open_frame(number):
            raise fault("stack")
        core[core.fp : core.fp + len(found)] = found

    def close(self) -> None:
        """Drop the current frame."""
        self._core.close_frame()

    def first_cell(self, serial: int) -> int | None:
        """See `Frames.first_cell`."""
        return self._core.frame_of(serial)


class Machine(vm.Machine):
    """Runs a verified program in C, otherwise like `interp.bytecode.vm.executor.Machine`."""

    def _made_state(self, limits: Limits) -> State:
        sink = self._sink
        beside = cast("_State", self._together[0]._state) if self._together else None
        self._traced = sum(bit for kind, bit in _TRACED.items() if wanting(sink, kind) is not None)
        image, depths = self._verified.image, self._verified.depths
        return cast("State", _State(image, depths, self._traced, limits.depth, beside))

    def _made_ready(self, program: Program) -> ThreadedCode:
        state = cast("_State", self._state)
        return cast("ThreadedCode", _NativeCode(program, state, self._services))

    def _made_frames(self) -> Frames:
        return _Frames(self._program, self._core)

    @property
    def _core(self) -> _State:
        return cast("_State", self._state)

    def break_at(self, places: Breaks) -> bool:
        """Stop before statements in these lines; return whether the machine can do so."""
        if self._traced & _TRACED["line"]:
            return False
        steps = [
            (self._core.step(number, place), *self._guarded(number, places[where]))
            for number, code in enumerate(self._program.codes)
            for place, one in enumerate(code.instructions)
            if one.op is Op.LINE and (where := (code.file, one.operands[0])) in places
        ]
        return self._core.break_at(steps) == len(steps)

    def _guarded(self, number: int, guard: Guard | None) -> tuple[int, int, bool, Raw]:
        """Return a breakpoint's condition for C: relation, cell, whether in the frame, constant."""
        if guard is None or self._program.codes[number].kind is not CodeKind.ROUTINE:
            return _UNGUARDED
        found = Names(self._program, InFrame([], number, 0)).fixed(guard.name)
        relation, right = RELATIONS.index(guard.relation), guard.constant
        match right, found:
            case bool(), (type_, cell, is_of_frame) if type_ == BOOL and relation < _ORDER:
                return relation, cell, is_of_frame, right
            case str(), (Enumeration(constants=names), cell, is_of_frame) if relation < _ORDER:
                keys = [name.upper() for name in names]
                if right in keys:
                    return relation, cell, is_of_frame, keys.index(right)
            case int(), (type_, cell, is_of_frame) if type_ == INT:
                return relation, cell, is_of_frame, right
        return _UNGUARDED

    def _memory(self) -> object:
        return self._core.snapshot()
