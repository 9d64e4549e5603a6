"""Input scripts: what the world around the controller does, line by line (docs/io-scripts.md).

::

    t=0.5 IN[1]=TRUE, ANIN[2]=0.4
    on OUT[3]=TRUE after 0.2 IN[7]=TRUE
    on HALT after 1 press START
    on channel SER_1 gets "ping" channel SER_1 sends "pong"
    fulfil waits after 1
    stop at 10

`Script.read` parses such a text, and `script_player` plays it. Conformance cases use the same
language after ``;@ io:``.
"""

from __future__ import annotations

import re
from typing import Final, NoReturn

from interp.controller.state.clock import microseconds
from interp.port.requests import Path
from interp.values.faults import RuntimeFailure
from support.lazy_dataclass import dataclass


class ScriptError(RuntimeFailure):
    """A script is invalid; the text is one line that names the place."""


@dataclass(frozen=True, slots=True)
class EnumWord:
    """``#NAME``, a constant of the enumeration that the variable has as its type."""

    name: str


#: A value as written in a script.
Literal = bool | int | float | str | EnumWord

# ------------------------------------------------------------------------------------- causes


@dataclass(frozen=True, slots=True)
class AtTime:
    """``t=0.5``: a time, stored in µs."""

    time: int


@dataclass(frozen=True, slots=True)
class VariableChanged:
    """``on OUT[3]=TRUE``: a variable changes to this value."""

    path: Path
    value: Literal


@dataclass(frozen=True, slots=True)
class ProgramHalted:
    """``on HALT``: the program executes HALT."""


@dataclass(frozen=True, slots=True)
class MessageShown:
    """``on message 1442``: a message appears; any message if there is no number."""

    number: int | None


@dataclass(frozen=True, slots=True)
class DialogueShown:
    """``on dialogue``: a dialogue appears."""


@dataclass(frozen=True, slots=True)
class TextReceived:
    """``on channel SER_1 gets "ping"``: the program sends a text; any text if none is given."""

    channel: str
    text: str | None


Cause = AtTime | VariableChanged | ProgramHalted | MessageShown | DialogueShown | TextReceived

# ------------------------------------------------------------------------------------- actions


@dataclass(frozen=True, slots=True)
class Assign:
    """``IN[1]=TRUE``: assign a value to a system variable."""

    path: Path
    value: Literal


@dataclass(frozen=True, slots=True)
class Press:
    """``press START``, ``press STOP`` or ``press CONFIRM``; CONFIRM may name the message."""

    button: str
    number: int | None = None


@dataclass(frozen=True, slots=True)
class Answer:
    """``answer 2``: answer the oldest dialogue with a button, counted from 1."""

    button: int


@dataclass(frozen=True, slots=True)
class Send:
    """``channel SER_1 sends "pong"``: the peer sends a text."""

    channel: str
    text: str


Action = Assign | Press | Answer | Send


@dataclass(frozen=True, slots=True)
class ScriptStep:
    """One line: its cause, the delay in µs, and its actions; ``at`` names the line in errors."""

    at: str
    cause: Cause
    delay: int
    actions: tuple[Action, ...]


@dataclass(frozen=True, slots=True)
class Script:
    """The steps of a script in their order.

    ``stop`` is the time in µs at which the run stops, if the script says one. ``fulfils`` is the
    delay in µs after which inputs change during a WAIT FOR; ``None`` if they do not
    (`interp.controller.inputs.automatic_inputs`).
    """

    steps: tuple[ScriptStep, ...] = ()
    stop: int | None = None
    fulfils: int | None = None

    @staticmethod
    def read(text: str, name: str = "script") -> Script:
        """Parse a script; raise `ScriptError` with places that begin with ``name``."""
        steps: list[ScriptStep] = []
        stop: int | None = None
        fulfils: int | None = None
        for number, line in enumerate(text.splitlines(), start=1):
            reader = _Line(f"{name}:{number}", line)
            if reader.is_done:
                continue
            if reader.take("STOP"):
                reader.need("AT")
                stop = reader.time()
                reader.finish()
            elif reader.take("FULFIL"):
                reader.need("WAITS")
                fulfils = reader.time() if reader.take("AFTER") else 0
                reader.finish()
            else:
                steps.append(reader.step())
        return Script(tuple(steps), stop, fulfils)


_TOKEN: Final = re.compile(
    r"""\s*(?:
        (?P<comment>[;\#](?![A-Za-z_$]).*|;.*)
      | (?P<text>"[^"]*")
      | (?P<number>[+-]?(?:\d+\.(?!\.)\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?)
      | (?P<word>\#?\$?[A-Za-z_][\w$]*)
      | (?P<mark>\.\.|[=\[\],.:])
    )""",
    re.VERBOSE,
)
_BUTTONS: Final = ("START", "STOP", "CONFIRM")
_MOST_SECONDS: Final = 1e9


class _Line:
    """Parses one line from left to right."""

    def __init__(self, at: str, line: str) -> None:
        self._at = at
        self._tokens: list[tuple[str, str]] = []
        self._place = 0
        place = 0
        while line[place:].strip():
            match = _TOKEN.match(line, place)
            if match is None:
                self.fail(f"{line[place:].strip()[:1]!r} is not expected here")
            kind = str(match.lastgroup)
            if kind == "comment":
                break
            self._tokens.append((kind, match[kind]))
            place = match.end()

    def fail(self, why: str) -> NoReturn:
        """Raise a `ScriptError` at this line."""
        raise ScriptError(f"{self._at}: {why}")

    @property
    def is_done(self) -> bool:
        """Whether all tokens have been read."""
        return self._place == len(self._tokens)

    def take(self, text: str) -> bool:
        """Read a word or mark if it is next; return whether it was."""
        if self.is_done or self._tokens[self._place][0] == "text":
            return False
        if self._tokens[self._place][1].upper() != text:
            return False
        self._place += 1
        return True

    def need(self, text: str) -> None:
        """Read a word or mark that must be next."""
        if not self.take(text):
            self.fail(f"{text!r} is missing{self._before()}")

    def _before(self) -> str:
        return " at the end" if self.is_done else f" before {self._tokens[self._place][1]!r}"

    def _next(self, kind: str, what: str) -> str:
        if self.is_done or self._tokens[self._place][0] != kind:
            self.fail(f"{what} is missing{self._before()}")
        self._place += 1
        return self._tokens[self._place - 1][1]

    def finish(self) -> None:
        """Fail unless all tokens of the line have been read."""
        if not self.is_done:
            self.fail(f"{self._tokens[self._place][1]!r} is not expected here")

    # --------------------------------------------------------------------------- the parts

    def step(self) -> ScriptStep:
        """Parse a whole line that is a step."""
        cause = self._cause()
        delay = self.time() if self.take("AFTER") else 0
        actions = [self._action()]
        while self.take(","):
            actions.append(self._action())
        self.finish()
        return ScriptStep(self._at, cause, delay, tuple(actions))

    def time(self) -> int:
        """Parse a time in seconds, and return it in µs."""
        seconds = float(self._next("number", "a time in seconds"))
        if not 0 <= seconds <= _MOST_SECONDS:
            self.fail(f"{seconds:g} is not a time in seconds")
        return microseconds(seconds)

    def _count(self, what: str) -> int:
        text = self._next("number", what)
        if not text.isdigit():
            self.fail(f"{text!r} is not {what}")
        return int(text)

    def _cause(self) -> Cause:
        if self.take("T"):
            self.need("=")
            return AtTime(self.time())
        if not self.take("ON"):
            self.fail("a line begins with t=SECONDS, with on, with fulfil waits, or with stop at")
        if self.take("HALT"):
            return ProgramHalted()
        if self.take("DIALOGUE"):
            return DialogueShown()
        if self.take("MESSAGE"):
            is_any = self.is_done or self._tokens[self._place][0] != "number"
            return MessageShown(None if is_any else self._count("the number of a message"))
        if self.take("CHANNEL"):
            channel = self._channel()
            self.need("GETS")
            is_any = self.is_done or self._tokens[self._place][0] != "text"
            return TextReceived(channel, None if is_any else self._next("text", "a text")[1:-1])
        path = self._path()
        self.need("=")
        return VariableChanged(path, self._literal())

    def _action(self) -> Action:
        if self.take("PRESS"):
            button = self._next("word", "a button").upper()
            if button not in _BUTTONS:
                self.fail(f"there is no button {button}; there are {', '.join(_BUTTONS)}")
            has_number = (
                button == "CONFIRM"
                and not self.is_done
                and self._tokens[self._place][0] == "number"
            )
            return Press(button, self._count("the number of a message") if has_number else None)
        if self.take("ANSWER"):
            return Answer(self._count("the number of a button"))
        if self.take("CHANNEL"):
            channel = self._channel()
            self.need("SENDS")
            return Send(channel, self._next("text", "a text in quotation marks")[1:-1])
        path = self._path()
        self.need("=")
        return Assign(path, self._literal())

    def _channel(self) -> str:
        self.take(":")
        return self._next("word", "the name of a channel").upper()

    def _path(self) -> Path:
        """Parse ``IN[1]``, ``$IN[1..8]`` or ``ERR.NUMBER``; the dollar sign is optional."""
        name = self._next("word", "a variable").upper()
        steps: list[str | int] = [name if name.startswith("$") else f"${name}"]
        while True:
            if self.take("["):
                steps.append(self._count("an index"))
                if self.take(".."):
                    steps += ["TO", self._count("an index")]
                while self.take(","):
                    steps.append(self._count("an index"))
                self.need("]")
            elif self.take("."):
                steps.append(self._next("word", "a component").upper())
            else:
                return tuple(steps)

    def _literal(self) -> Literal:
        if self.is_done:
            self.fail("a value is missing at the end")
        kind, text = self._tokens[self._place]
        self._place += 1
        if kind == "number":
            return int(text) if text.lstrip("+-").isdigit() else float(text)
        if kind == "text":
            return text[1:-1]
        if text.startswith("#"):
            return EnumWord(text[1:].upper())
        if text.upper() not in ("TRUE", "FALSE"):
            self.fail(f"{text!r} is not a value")
        return text.upper() == "TRUE"
