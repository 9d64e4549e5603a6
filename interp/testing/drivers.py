"""Programs with drivers: added routines that set variables and call the routine under test.

Drivers, and the bodies of stand-ins, are appended to the text of files. The body of a routine that
is replaced by a stand-in becomes a single call of the stand-in, padded with empty lines. So every
line of the program keeps its number. The added text is KRL: it is typed, checked and executed like
the program itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Final

from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from interp.program.load import CheckedProgram, Routine
from interp.standins.uses import FOLDER

#: The variable of a driver for the result of the function that it calls.
RESULT: Final = "KRL_RESULT"
#: The routine in which variables can be inspected after a run; it waits at its first line.
VALUES: Final = "KRL_VALUES"
_DATA: Final = "KRL_TESTDATA"
_LINE_END: Final = re.compile(r"\r\n|\r|\n")


class DriverError(ValueError):
    """A statement, a call or a stand-in is invalid; the text is one line with the reason."""


@dataclass(frozen=True, slots=True)
class Driver:
    """A routine ``name`` with statements in KRL, followed by a call: ``PICK(2)`` or ``PICK``."""

    name: str
    statements: tuple[str, ...]
    call: str


def with_drivers(
    program: CheckedProgram,
    drivers: Sequence[Driver],
    stand_ins: Mapping[str, Sequence[Sequence[str]]],
) -> list[Source]:
    """Return the files of a program with drivers, which see everything that its main file sees.

    ``stand_ins`` has statements by the name of the routine that they replace: for its first call,
    its second and so on; the last ones also serve all later calls. They may use the routine's
    parameters. A routine that no file has, but that already has a stand-in, becomes a file. Raises
    `DriverError`.
    """
    texts = {
        unit.module.path: unit.source.text
        for unit in program.units.values()
        if unit.module.folder != FOLDER
    }
    main = program.main.module.path
    folder = PurePosixPath(main).parent
    counters: list[str] = []
    edits: list[tuple[str, int, int, str, str]] = []
    for name, bodies in stand_ins.items():
        found = [one for one in program.routines.values() if one.node.name.key == name.upper()]
        if not found:
            raise DriverError(f"no routine is called {name!r}, so no stand-in can replace it")
        for routine in found:
            path = routine.unit.module.path
            if path not in texts:
                path = str(folder / f"{name}.src")
                texts[path] = routine.unit.source.text
            counter = f"KRL_CALLS_{len(counters) + 1}" if len(bodies) > 1 else ""
            counters += [f"DECL GLOBAL INT {counter}=0"] if counter else [""]
            own = f"KRL_STANDIN_{len(counters)}"
            edits.append(
                (path, *_replaced_body(routine, own), _stand_in(routine, own, bodies, counter))
            )
    for path, start, end, body, stand_in in sorted(edits, key=lambda edit: -edit[1]):
        texts[path] = texts[path][:start] + body + texts[path][end:] + stand_in
    if any(counters):
        lines = [f"DEFDAT {_DATA} PUBLIC", *filter(None, counters), "ENDDAT", ""]
        texts[str(folder / f"{_DATA}.dat")] = "\n".join(lines)
    texts[main] += "".join(_driver(program, one) for one in drivers)
    texts[main] += _routine(f"DEF {VALUES}()", ["WAIT SEC 0"])
    return [Source(text, path) for path, text in texts.items()]


def _routine(head: str, lines: Sequence[str], end: str = "END") -> str:
    return "\n".join(["", head, *lines, end, ""])


def _driver(program: CheckedProgram, driver: Driver) -> str:
    for statements in driver.statements:
        _read(statements)
    call = driver.call if "(" in driver.call else f"{driver.call}()"
    node, *more = _read(call)
    if more or not isinstance(node, ast.CallStatement):
        raise DriverError(f"{driver.call!r} is no call of a routine")
    name = node.call.name
    routine = _seen(program, name.key)
    if routine is None:
        raise DriverError(f"no routine is called {name.text!r}")
    lines = list(driver.statements)
    if routine.node.result is not None:
        lines.insert(0, f"DECL {_text(routine, routine.node.result)} {RESULT}")
        call = f"{RESULT} = {call}"
    return _routine(f"DEF {driver.name}()", [*lines, call])


def _seen(program: CheckedProgram, key: str) -> Routine | None:
    """Return the routine to which a name refers in the main file, ``None`` if there is none."""
    for routine in program.routines_of(program.main):
        if routine.node.name.key == key:
            return routine
    others = (one for one in program.routines.values() if one.node.name.key == key)
    return next((one for one in others if _is_seen(program, one)), None)


def _is_seen(program: CheckedProgram, routine: Routine) -> bool:
    return routine.node.is_global or program.routines_of(routine.unit)[0] is routine


def _read(text: str) -> Sequence[ast.Statement]:
    """Parse a text that must contain at least one statement, and only statements."""
    read = read_module(f"DEF X()\n{text}\nEND\n")
    if isinstance(read, ast.Module) and isinstance(read.content, ast.Program):
        (routine, *more) = read.content.routines
        if not more and routine.body:
            return routine.body
    raise DriverError(f"{text!r} is no statement of KRL")


def _text(routine: Routine, node: ast.Node) -> str:
    return routine.unit.source.text[slice(*node.span)]


def _replaced_body(routine: Routine, own: str) -> tuple[int, int, str]:
    """Return the span of the statements of a routine, and the call that replaces them.

    The replacement has as many lines, so that all following lines keep their numbers.
    """
    node, text = routine.node, routine.unit.source.text
    definitions = [one for one in node.body if isinstance(one, ast.Definition)]
    last = definitions[-1].span[1] if definitions else _head_end(routine)
    following = _LINE_END.search(text, last)
    start = node.span[1] if following is None else following.end()
    end = max(text.rfind("\n", 0, node.span[1]), text.rfind("\r", 0, node.span[1])) + 1
    line_ends = _LINE_END.findall(text[start:end])
    if not line_ends:
        raise DriverError(f"{routine.name} is empty, so no stand-in can replace it")
    arguments = [one.name.text + "[]" * (one.indices is not None) for one in node.parameters]
    call = f"{own}({', '.join(arguments)})"
    call = call if node.result is None else f"RETURN ({call})"
    return start, end, call + "".join(line_ends)


def _head_end(routine: Routine) -> int:
    """Return the end of the head of a routine, after its parameters."""
    text, start = routine.unit.source.text, routine.node.name.span[1]
    return text.index(")", start) + 1


def _stand_in(routine: Routine, own: str, bodies: Sequence[Sequence[str]], counter: str) -> str:
    """Return a routine with the parameters and declarations of another one, and new statements."""
    for statements in (one for body in bodies for one in body):
        _read(statements)
    node, text = routine.node, routine.unit.source.text
    parameters = text[node.name.span[1] : _head_end(routine)]
    kind = "DEF" if node.result is None else f"DEFFCT {_text(routine, node.result)}"
    declared = [_text(routine, one) for one in node.body if isinstance(one, ast.Definition)]
    return _routine(
        f"{kind} {own}{parameters}",
        [*declared, *_by_call(bodies, counter)],
        "END" if node.result is None else "ENDFCT",
    )


def _by_call(bodies: Sequence[Sequence[str]], counter: str) -> Iterator[str]:
    """Yield the statements for each call in turn; the last ones also serve all later calls."""
    if not counter:
        yield from bodies[0]
        return
    yield f"{counter} = {counter} + 1"
    yield f"SWITCH {counter}"
    for number, body in enumerate(bodies[:-1], start=1):
        yield f"CASE {number}"
        yield from body
    yield "DEFAULT"
    yield from bodies[-1]
    yield "ENDSWITCH"
