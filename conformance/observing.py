"""How a case is observed: read, checked, or run on an executor with a robot.

What a program is run with is a `Setup`. Executors and robots that this machine does not have are
told as such (`missing`), never silently left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from typing import Any, Final

from conformance.case import Case
from conformance.observation import Event, Finding, Observation
from grammar.build import read_module
from grammar.check import stops
from grammar.check.context import Context
from grammar.check.framework import check_module
from grammar.check.unknowns import of_project
from grammar.diagnostics import Diagnostic, in_order
from grammar.link import File, Project, link
from grammar.predefined import System
from grammar.scopes import Module
from grammar.source import Source
from interp.events import Recorder, Sink
from interp.executor import Executor
from interp.faults import Fault, LinkError
from interp.program import CheckedProgram, Limits, load
from interp.rendering import to_json
from interp.requests import Crash, Fail
from interp.stub import StubWorld, run
from interp.tree import TreeExecutor, system_values

__all__ = ["EXECUTORS", "FRONT", "ROBOTS", "Setup", "missing", "observe"]

#: Who reads and checks cases: there is one front end.
FRONT: Final = "grammar"
EXECUTORS: Final = ("tree", "vm", "native")
ROBOTS: Final = ("none", "kinematic", "mujoco")


@dataclass(frozen=True, slots=True)
class Setup:
    """An executor and a robot, by name."""

    executor: str
    robot: str


def observe(case: Case, setup: Setup) -> Observation:
    """See what a case does. Never raises for what a program does."""
    match case.phase:
        case "parse":
            return _parsed(case)
        case "check":
            return _checked(case)
    return _run(case, setup)


def _parsed(case: Case) -> Observation:
    found = []
    for source in case.sources:
        read = read_module(source.text, source.path)
        if isinstance(read, list):
            found += [
                Finding(source.path, one.line, "error", "syntax", one.reason or "")
                for one in read
                if not one.follows
            ]
    return Observation(findings=tuple(found))


def _checked(case: Case) -> Observation:
    """All findings, those about the advance run included; a case is a whole project."""
    files, found = [], []
    for source in case.sources:
        read = read_module(source.text, source.path)
        if isinstance(read, list):
            found += [Finding(source.path, one.line, "error", "syntax") for one in read]
        else:
            files.append(File(source.path, read))
    sources = {source.path: source for source in case.sources}
    for project, module in link(files, is_complete=True).modules():
        found += map(_finding, _findings(project, module, sources[module.path]))
    return Observation(findings=tuple(found))


def _findings(project: Project, module: Module, source: Source) -> list[Diagnostic]:
    done = check_module(project, module, source)
    known = (dict(done.types), dict(done.enumerations), dict(done.values))
    context = Context(project, module, source, done.resolution, System.load(), *known)
    gaps = of_project(done.findings.references)
    return in_order([*done.findings.diagnostics, *stops.check(context), *gaps])


def _finding(found: Diagnostic) -> Finding:
    return Finding(found.path, found.region.line, found.severity, found.code, found.message)


# ------------------------------------------------------------------------------------ running


def missing(setup: Setup) -> str:
    """Why a setup cannot be used on this machine; empty where it can."""
    if setup.executor != "tree":
        return f"the executor {setup.executor} is not built here"
    if setup.robot != "none":
        return f"the robot {setup.robot} is not built here"
    return ""


def _run(case: Case, setup: Setup) -> Observation:
    try:
        program = load(case.sources, case.main)
        recorder = Recorder()
        executor = TreeExecutor(program, limits=Limits(100_000, 1000, 64), sink=recorder)
    except LinkError as error:
        return Observation(ending="fault", note=str(error))
    world = StubWorld(values=system_values(program))
    events: list[Event] = []
    reply: Any = None
    ending, note = "running", ""
    for _ in range(20_000):
        request = executor.advance(reply)
        events += map(_told, recorder.events)
        recorder.events.clear()
        at = request.at
        name = type(request).__name__
        if name in ("End", "Fail", "Crash"):
            ending = {"End": "end", "Fail": "fault", "Crash": "crash"}[name]
            if isinstance(request, Fail):
                error = request.fault
                slug = error.slug if isinstance(error, Fault) else "link"
                number = error.number if isinstance(error, Fault) else None
                fields = {"slug": slug, "number": number, "text": str(error)}
                events.append(Event(None, "robot", "fault", at.file, at.line, fields))
            if isinstance(request, Crash):
                note = request.reason
            break
        if name == "Write" and request.path[0] == "$OUT" and len(request.path) == 2:
            fields = {"number": request.path[1], "value": request.value}
            events.append(Event(None, "robot", "out", at.file, at.line, fields))
        reply = world.reply(request)
    return Observation(events=tuple(events), ending=ending, note=note, is_exact=False)


def _told(event: Any) -> Event:
    fields: dict[str, Any] = {}
    if event.kind == "assign":
        fields = {"path": list(event.path), "value": to_json(event.value)}
    elif event.kind in ("call", "return"):
        fields = {"name": event.name}
    elif event.kind == "branch":
        fields = {"way": event.way}
    return Event(None, "robot", event.kind, event.at.file, event.at.line, fields)
