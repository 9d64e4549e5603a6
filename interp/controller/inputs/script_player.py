"""The player of input scripts: it performs each step at its time, or when its cause happens.

It also knows whether the script may still press a button, for which a HALT waits.
"""

from __future__ import annotations

from collections import defaultdict
from functools import partial

from grammar.semantics.types import Enumeration
from interp.controller.inputs.channels import Channels
from interp.controller.inputs.input_script import (
    Answer,
    Assign,
    AtTime,
    Cause,
    DialogueShown,
    EnumWord,
    Literal,
    MessageShown,
    Press,
    ProgramHalted,
    Script,
    ScriptError,
    ScriptStep,
    Send,
    TextReceived,
    VariableChanged,
)
from interp.controller.inputs.operator_panel import OperatorPanel
from interp.controller.state.state import ControllerState
from interp.port.requests import Path, Value
from interp.values.faults import Fault, LinkError
from interp.values.values import constant, single


class ScriptPlayer:
    """Plays one script.

    Before anything is played, all steps are checked: an unknown variable, an index out of range and
    an impossible value raise `ScriptError`.
    """

    def __init__(
        self, script: Script, state: ControllerState, panel: OperatorPanel, channels: Channels
    ) -> None:
        self._state = state
        self._variables = state.variables
        self._panel = panel
        self._channels = channels
        self._steps: dict[Cause, list[ScriptStep]] = defaultdict(list)
        self._watched: dict[str, list[tuple[VariableChanged, Value]]] = defaultdict(list)
        self._held: dict[VariableChanged, bool] = {}
        self._pending: list[ScriptStep] = []
        #: Whether the script may do anything.
        self.has_steps = bool(script.steps)
        for step in script.steps:
            self._check(step)
            if isinstance(step.cause, AtTime):
                self._schedule(step.cause.time + step.delay, step)
            else:
                self._steps[step.cause].append(step)
        for cause in self._steps:
            if isinstance(cause, VariableChanged):
                wanted = self._typed(cause.path, cause.value)
                self._watched[str(cause.path[0])].append((cause, wanted))
                self._held[cause] = self._variables.read(cause.path) == wanted

    # ------------------------------------------------------------------------- what happens

    def changed(self, path: Path, _value: Value) -> None:
        """Note that a variable, or an element of one, was assigned."""
        for cause, wanted in self._watched.get(str(path[0]), ()):
            holds = self._variables.read(cause.path) == wanted
            before, self._held[cause] = self._held[cause], holds
            if holds and not before:
                self._happened(cause)

    def halted(self) -> None:
        """Note that the program executes HALT."""
        self._happened(ProgramHalted())

    def shown(self, number: int, kind: str) -> None:
        """Note that a message or a dialogue has appeared."""
        self._happened(MessageShown(number))
        self._happened(MessageShown(None))
        if kind == "dialogue":
            self._happened(DialogueShown())

    def received(self, channel: str, text: str) -> None:
        """Note that a program has sent a text to the peer of a channel."""
        self._happened(TextReceived(channel, text))
        self._happened(TextReceived(channel, None))

    def _happened(self, cause: Cause) -> None:
        for step in self._steps.get(cause, ()):
            self._schedule(self._state.clock.now + step.delay, step)

    def _schedule(self, time: int, step: ScriptStep) -> None:
        self._pending.append(step)
        self._state.actions.add(time, partial(self._perform, step))

    def awaits(self, button: str) -> bool:
        """Return whether a step that presses a button is pending or may still be caused.

        The program has halted when this is asked, so a step that another HALT would cause does not
        count.
        """
        may_come = [
            step
            for cause, steps in self._steps.items()
            if not isinstance(cause, ProgramHalted)
            for step in steps
        ]
        return any(
            isinstance(action, Press) and action.button == button
            for step in (*self._pending, *may_come)
            for action in step.actions
        )

    # ------------------------------------------------------------------------- what is done

    def _perform(self, step: ScriptStep) -> None:
        self._pending.remove(step)
        for action in step.actions:
            match action:
                case Assign(path, value):
                    try:
                        self._state.assign(path, self._typed(path, value))
                    except Fault as fault:
                        raise ScriptError(f"{step.at}: {fault}") from None
                case Press(button, number):
                    self._panel.press(button, number)
                case Answer(button):
                    self._panel.answer(button)
                case Send(channel, text):
                    self._channels.receive(channel, text)

    def _check(self, step: ScriptStep) -> None:
        pairs = [(one.path, one.value) for one in step.actions if isinstance(one, Assign)]
        if isinstance(step.cause, VariableChanged):
            pairs.append((step.cause.path, step.cause.value))
        for path, value in pairs:
            name = str(path[0])
            if self._variables.entry(name) is None:
                raise ScriptError(f"{step.at}: there is no system variable {name}")
            try:
                self._variables.read(path)
                self._typed(path, value)
            except (Fault, LinkError) as error:
                raise ScriptError(f"{step.at}: {error}") from None

    def _typed(self, path: Path, value: Literal) -> Value:
        """Return a literal as a value of the type that the variable has."""
        if isinstance(value, EnumWord):
            type_ = self._variables.part_type(path)
            if not isinstance(type_, Enumeration):
                raise LinkError(f"#{value.name} is given to what is no enumeration")
            return constant(type_, value.name)
        if isinstance(value, float) or (
            isinstance(value, int)
            and not isinstance(value, bool)
            and isinstance(self._variables.read(path), float)
        ):
            return single(float(value))
        before = self._variables.read(path)
        if isinstance(before, bool) != isinstance(value, bool):
            raise LinkError(f"{value!r} is not a value for {path[0]}")
        return value
