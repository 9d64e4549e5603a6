"""The prompt of `krl debug`: commands from a terminal or a file."""

import cmd
import re
from collections.abc import Callable
from typing import Final, cast

import typer

from interp.controller.state.trace import TaskName
from interp.debugging.client import (
    Back,
    Breakpoint,
    Command,
    Go,
    Quit,
    Restart,
    Select,
    StepCommand,
    Stop,
    Watch,
    Way,
)
from interp.debugging.conditions import parsed
from interp.debugging.debugger import Debugger
from interp.debugging.value_text import value_text
from interp.port.requests import At
from interp.program.load import CheckedProgram
from interp.values.faults import RuntimeFailure
from krl.errors import say, shown

_BREAK = re.compile(
    r"(?:(?P<file>[^\s:]+):)?(?P<line>\d+)"
    r"(?:\s+if\s+(?P<condition>.+?))?(?:\s+hits\s+(?P<hits>[<>=%]*\s*\d+))?(?:\s+log\s+(?P<log>.+))?",
    re.IGNORECASE,
)
_SET = re.compile(r"(?P<name>[^=]+?)\s*=\s*(?P<value>[^=].*)")
_WAYS: Final = {"step": "into", "next": "over", "out": "out", "motion": "motion", "continue": "go"}
_SHORT: Final = {
    "s": "step",
    "n": "next",
    "o": "out",
    "m": "motion",
    "c": "continue",
    "b": "break",
    "p": "print",
    "l": "list",
    "w": "where",
    "q": "quit",
    "h": "help",
    "?": "help",
    "bs": "back step",
    "bn": "back next",
    "bo": "back out",
    "bm": "back motion",
    "bc": "back continue",
    "EOF": "quit",
}
_AROUND: Final = 4
_MOST_SHOWN: Final = 40


class _WrongCommand(Exception):
    """A command is unknown or impossible here; the message is shown."""


class Prompt(cmd.Cmd):
    """Reads commands where a program has stopped; a client of the debugger.

    Each ``do_`` method is a command with its docstring as help. A command that lets the program
    continue returns a command for the debugger. ``has_failed`` says that a command from a file was
    wrong. ``is_running`` is true while the program runs.
    """

    def __init__(self, program: CheckedProgram, *, is_terminal: bool) -> None:
        super().__init__()
        self.use_rawinput = is_terminal
        self.prompt = "(krl) " if is_terminal else ""
        self.has_failed = self.is_running = False
        self._is_terminal = is_terminal
        self._program = program
        self._displayed: list[str] = []
        self._task: TaskName = "robot"
        self._frame = 0
        self._last = ""
        self._way: Command = Quit()
        self._debugger: Debugger
        self._stop: Stop

    def stopped(self, debugger: Debugger, stop: Stop) -> Command:
        """Return the first command that lets the program continue."""
        self._debugger, self._stop, self.is_running = debugger, stop, False
        self._task, self._frame = stop.task, 0
        self._tell_stop()
        self._way = Quit()
        self.cmdloop()
        self.is_running = True
        return self._way

    # ----------------------------------------------------------------------- lines

    def onecmd(self, line: str) -> bool:
        """Execute a line; return whether the program continues.

        In a terminal an empty line repeats the last one.
        """
        line = line.strip() or self._last
        self._last = line if self._is_terminal else ""
        words = line.split()
        if not words or words[0].startswith(";"):
            return False
        name = _SHORT.get(words[0], words[0]).split()
        do: Callable[[str], Command | None] | None = getattr(self, f"do_{name[0].lower()}", None)
        try:
            if do is None:
                raise _WrongCommand(f"{words[0]} is not a command; help lists them")
            rest = line.strip()[len(words[0]) :].strip()
            way = do(" ".join([*name[1:], rest]).strip())
        except (_WrongCommand, RuntimeFailure) as error:
            self.has_failed = self.has_failed or not self._is_terminal
            self._say(str(error))
            return False
        if way is None:
            return False
        self._way = way
        return True

    @staticmethod
    def _say(text: str) -> None:
        say(text)

    def _tell_stop(self) -> None:
        stop = self._stop
        why: str = stop.reason
        if stop.watch is not None:
            change = f"{value_text(stop.before)} -> {value_text(stop.now)}"
            why += f" {stop.watch.text}: {change}"
        if stop.text:
            why += f": {stop.text}"
        self._say(why)
        if stop.reason == "ended":
            return
        self._say(self._place(stop.at, stop.task))
        self._say(self._moment())
        for text in self._displayed:
            self._say(f"{text} = {self._shown_value(text)}")

    def _place(self, at: At, task: str) -> str:
        whose = "submit " if task == "submit" else ""
        return f"{whose}{at.file}:{at.line}  {self._line(at.file, at.line).strip()}"

    def _moment(self) -> str:
        """Return the time and the position of the arm, which is behind the advance run."""
        arm = self._debugger.arm
        text = f"{arm.time / 1e6:g} s; "
        if arm.running is None:
            return text + "the arm stands"
        text += f"the arm moves, {arm.running.file}:{arm.running.line}"
        return text + (f", {arm.waiting - 1} more planned" if arm.waiting > 1 else "")

    def _line(self, file: str, line: int) -> str:
        unit = self._program.unit_of(file)
        return "" if unit is None else unit.source.line(line)

    def _shown_value(self, text: str) -> str:
        try:
            return value_text(self._debugger.look(text, self._task, self._frame))
        except RuntimeFailure as error:
            return f"({error})"

    # ----------------------------------------------------------------------- going

    def do_step(self, _rest: str) -> Command:
        """`step, s`: to the next statement of this program, into calls and interrupts."""
        return StepCommand("into", self._task)

    def do_next(self, _rest: str) -> Command:
        """`next, n`: to the next statement of this routine, over calls."""
        return StepCommand("over", self._task)

    def do_out(self, _rest: str) -> Command:
        """`out, o`: to the next statement of the caller."""
        return StepCommand("out", self._task)

    def do_motion(self, _rest: str) -> Command:
        """`motion, m`: until a motion has ended."""
        return StepCommand("motion", self._task)

    def do_continue(self, _rest: str) -> Command:
        """`continue, c`: to the next breakpoint, watch, fault, or the end."""
        return Go()

    def do_back(self, rest: str) -> Command:
        """`back [step|next|out|motion|continue]`, bs bn bo bm bc: the same back; default next."""
        way = _WAYS.get(_SHORT.get(rest, rest) or "next")
        if way is None:
            raise _WrongCommand(f"back: one of {', '.join(_WAYS)}")
        return Back("go", self._task) if way == "go" else Back(cast(Way, way), self._task)

    def do_goto(self, rest: str) -> Command:
        """`goto LINE`: continue at a line of this routine, without executing what lies between."""
        return Select(_number(rest, "goto"))

    def do_restart(self, _rest: str) -> Command:
        """`restart`: begin anew, without the changes that were made."""
        return Restart()

    def do_quit(self, _rest: str) -> Command:
        """`quit, q`: leave."""
        return Quit()

    # ----------------------------------------------------------------------- stopping

    def do_break(self, rest: str) -> None:
        """`break [FILE:]LINE [if CONDITION] [hits 3|>=3|%3] [log TEXT {X}]`, b: stop there."""
        if not rest:
            self._list_stops()
            return
        match = _BREAK.fullmatch(rest)
        if match is None:
            raise _WrongCommand("break [FILE:]LINE [if CONDITION] [hits N] [log TEXT]")
        file, line = match["file"] or self._at().file, int(match["line"])
        lines = self._debugger.breakpoints.lines(file)
        if line not in lines:
            later = next((one for one in lines if one > line), None)
            there = f"; the next is line {later}" if later else ""
            raise _WrongCommand(f"{file}:{line}: no statement begins here{there}")
        if match["condition"]:
            parsed(match["condition"])
        made = Breakpoint(file, line, match["condition"], match["hits"], match["log"])
        self._debugger.breakpoints.set([*self._debugger.breakpoints.all, made])
        self._list_stops()

    def do_watch(self, rest: str) -> None:
        """`watch EXPRESSION`: stop where a variable, signal or expression changes."""
        if not rest:
            self._list_stops()
            return
        self._debugger.watches.add(rest, self._task, self._frame)
        self._list_stops()

    def do_delete(self, rest: str) -> None:
        """`delete NUMBER|all`: forget a breakpoint or a watch."""
        stops = self._stops()
        if rest.lower() != "all":
            number = _number(rest, "delete")
            if not 1 <= number <= len(stops):
                raise _WrongCommand(f"there is no breakpoint {number}")
            stops = stops[number - 1 : number]
        for one in stops:
            if isinstance(one, Watch):
                self._debugger.watches.remove(one)
        left = [one for one in self._debugger.breakpoints.all if one not in stops]
        self._debugger.breakpoints.set(left)

    def do_faults(self, rest: str) -> None:
        """`faults on|off`: whether to stop at faults that the program does not handle."""
        if rest.lower() not in ("on", "off"):
            raise _WrongCommand("faults on, or faults off")
        self._debugger.stops_at_faults = rest.lower() == "on"

    def _stops(self) -> list[Breakpoint | Watch]:
        return [*self._debugger.breakpoints.all, *self._debugger.watches.all]

    def _list_stops(self) -> None:
        for number, one in enumerate(self._stops(), 1):
            if isinstance(one, Watch):
                self._say(f"{number} watch {one.text}")
                continue
            text = f"{number} break {one.file}:{one.line}"
            text += f" if {one.condition}" if one.condition else ""
            text += f" hits {one.hits}" if one.hits else ""
            self._say(text + (f" log {one.log}" if one.log else ""))

    # ----------------------------------------------------------------------- looking

    def do_print(self, rest: str) -> None:
        """`print EXPRESSION, p`: its value here."""
        self._say(value_text(self._debugger.look(rest, self._task, self._frame)))

    def do_display(self, rest: str) -> None:
        """`display EXPRESSION`: its value at each stop; without one, no longer any."""
        if not rest:
            self._displayed.clear()
            return
        parsed(rest)
        self._displayed.append(rest)
        self._say(f"{rest} = {self._shown_value(rest)}")

    def do_set(self, rest: str) -> None:
        """`set NAME = EXPRESSION`: give a variable, output or input a value: set $IN[3] = TRUE."""
        match = _SET.fullmatch(rest)
        if match is None:
            raise _WrongCommand("set NAME = EXPRESSION")
        self._debugger.assign(match["name"], match["value"], self._task, self._frame)

    def do_where(self, _rest: str) -> None:
        """`where, w`: what is open, the innermost first."""
        for number, frame in enumerate(self._debugger.frames(self._task)):
            mark = "*" if number == self._frame else " "
            self._say(f"{mark}{number} {frame.name} {self._place(frame.at, '')}")

    def do_frame(self, rest: str) -> None:
        """`frame NUMBER`: look at variables from there."""
        number = _number(rest, "frame")
        if number >= len(self._debugger.frames(self._task)):
            raise _WrongCommand(f"there is no frame {number}")
        self._frame = number
        self._say(self._place(self._at(), self._task))

    def do_task(self, rest: str) -> None:
        """`task robot|submit`: look at this program, and step it."""
        found = next((one for one in self._debugger.tasks if one == rest.lower()), None)
        if found is None:
            raise _WrongCommand(f"task: one of {', '.join(self._debugger.tasks)}")
        self._task, self._frame = found, 0
        self._say(self._place(self._at(), found))

    def do_variables(self, rest: str) -> None:
        """`variables [local|data|config|others|signals]`: names and values; default local."""
        names = self._debugger.names(self._task, self._frame)
        group = rest.lower() or "local"
        if group not in names.__slots__:
            raise _WrongCommand(f"variables: one of {', '.join(names.__slots__)}")
        found: tuple[str, ...] = getattr(names, group)
        for name in found[:_MOST_SHOWN]:
            self._say(f"{name} = {self._shown_value(name)}")
        if len(found) > _MOST_SHOWN:
            self._say(f"and {len(found) - _MOST_SHOWN} more")

    def do_arm(self, _rest: str) -> None:
        """`arm`: the time, the motion the arm is in, and where it is."""
        self._say(self._moment())
        for name in ("$AXIS_ACT", "$POS_ACT"):
            self._say(f"{name} = {self._shown_value(name)}")

    def do_list(self, rest: str) -> None:
        """`list [LINE], l`: the source around here."""
        at = self._at()
        middle = _number(rest, "list") if rest else at.line
        unit = self._program.unit_of(at.file)
        lines = [] if unit is None else unit.source.text.splitlines()
        stops = {one.line for one in self._debugger.breakpoints.all}
        for line in range(max(1, middle - _AROUND), min(len(lines), middle + _AROUND) + 1):
            mark = ">" if line == at.line else "*" if line in stops else " "
            typer.echo(shown(f"{line:5}{mark} {lines[line - 1].expandtabs()}".rstrip()))

    def do_help(self, rest: str) -> None:
        """`help, h`: this list."""
        names = [rest] if rest else [one[3:] for one in vars(Prompt) if one.startswith("do_")]
        for name in names:
            method = getattr(self, f"do_{_SHORT.get(name, name).split()[0]}", None)
            if method is None:
                raise _WrongCommand(f"{name} is not a command; help lists them")
            typer.echo((method.__doc__ or "").replace("`", ""))

    def _at(self) -> At:
        return self._debugger.frames(self._task)[self._frame].at


def _number(text: str, command: str) -> int:
    if not text.isascii() or not text.isdigit():
        raise _WrongCommand(f"{command}: a number is missing")
    return int(text[:9])
