"""The execution of cases: each is parsed, checked, or run on an executor with a robot.

A `Setup` names executor and robot. A setup that this machine does not support is reported by
`missing`, and never left out silently.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.util import find_spec
from typing import Final, Literal

from conformance.evaluation.observation import Event, Finding, Observation
from conformance.suite.case import Case
from grammar.check.analysis.context import Context
from grammar.check.flow import advance_stops
from grammar.check.names.project_names import of_project
from grammar.check.project.framework import check_module
from grammar.diagnostics.diagnostic import Diagnostic, in_order
from grammar.diagnostics.syntax_errors.findings import syntax_findings
from grammar.semantics.link import File, Project, link
from grammar.semantics.predefined import System
from grammar.semantics.scopes import Module
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from interp import session
from interp.controller.inputs.input_script import Script, ScriptError
from interp.controller.state.profile import Profile
from interp.controller.state.trace import TraceEvent
from interp.executors import Prepared, is_available
from interp.port.events import Sink
from interp.port.executor import Executor
from interp.program.load import CheckedProgram, Limits, load
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.models import default_machine
from interp.robot.simulation.factory import ROBOTS, RobotName
from interp.robot.simulation.robot import Robot
from interp.values.faults import LinkError

#: The name of the front end that parses and checks cases; there is only one.
FRONT: Final = "grammar"
#: The values of ``;@ profile:``: a controller, and ``-bco`` if the program begins with a block
#: coincidence run.
PROFILES: Final = ("kss8", "kss8-bco", "kss5", "kss5-bco")
MakeExecutor = Callable[[CheckedProgram, str | None, Limits, Sink | None], Executor]
MakeRobot = Callable[[MachineData, int], Robot]

#: The largest number of statements that a case may execute.
_STATEMENTS: Final = 1_000_000
#: The endings of a run that expectations call otherwise.
_ENDINGS: Final[Mapping[str, str]] = {"time": "running"}


@dataclass(frozen=True, slots=True)
class Setup:
    """An executor and a robot, by name; ``motion`` is the strategy of motion planning."""

    executor: str
    robot: str
    motion: Literal["lookahead", "batch"] = "lookahead"


def observe(case: Case, setup: Setup) -> Observation:
    """Return the observation of a case. Never raises because of what a program does."""
    return _run(case, setup) if case.phase == "run" else _front_end(case)


def observe_with(
    case: Case, executor: MakeExecutor | None = None, robot: MakeRobot | None = None
) -> Observation:
    """Return the observation of a case that runs, on the given executor, robot, or both."""
    return _run(case, Setup("tree", "none" if robot is None else "mujoco"), executor, robot)


def _front_end(case: Case) -> Observation:
    """Return the findings of a case that is parsed, or of all checks; it is a whole project."""
    files: list[File] = []
    found: list[Diagnostic] = []
    for source in case.sources:
        read = read_module(source.text, source.path)
        if isinstance(read, list):
            found += syntax_findings(read, source)
        else:
            files.append(File(source.path, read))
    sources = {source.path: source for source in case.sources}
    for project, module in link(files, is_complete=True).modules() if case.phase == "check" else ():
        found += _findings(project, module, sources[module.path])
    return Observation(findings=tuple(map(_finding, found)))


def _findings(project: Project, module: Module, source: Source) -> list[Diagnostic]:
    """Return those about the advance run too."""
    done = check_module(project, module, source)
    known = (dict(done.types), dict(done.enumerations), dict(done.values))
    context = Context(project, module, source, done.resolution, System.load(), *known)
    open_ = (one for one in done.findings.references if not one.finding)
    gaps = of_project(open_, context.spelling)
    return in_order([*done.findings.diagnostics, *advance_stops.check(context), *gaps])


def _finding(found: Diagnostic) -> Finding:
    return Finding(found.path, found.region.line, found.severity, found.code, found.message)


# ------------------------------------------------------------------------------------ running


def missing(setup: Setup) -> str:
    """Return why a setup cannot be used on this machine; "" if it can."""
    if not is_available(setup.executor):
        return f"there is no executor {setup.executor} on this machine"
    if setup.robot == "mujoco" and find_spec("mujoco") is None:
        return "MuJoCo is not installed"
    return ""


class _ThirdParty(Prepared):
    """A program for the executor of a third party."""

    def __init__(self, program: CheckedProgram, make: MakeExecutor) -> None:
        super().__init__(program)
        self._make = make

    # `name` is required by the signature of the base class
    def executor(self, name: str, limits: Limits, sink: Sink | None = None) -> Executor:  # noqa: ARG002
        """Return the executor of the third party, whatever the name."""
        return self._make(self.program, self.routine, limits, sink)


def _run(
    case: Case, setup: Setup, executor: MakeExecutor | None = None, robot: MakeRobot | None = None
) -> Observation:
    """Run a case; a program that cannot begin is observed as a fault without a line."""
    program = prepared(case)
    if isinstance(program, LinkError):
        return _link_fault(program)
    if executor is not None:
        program = _ThirdParty(program.program, executor)
    profile = _profile(case.profile)
    wanted = session.RunSetup(
        executor=setup.executor,
        robot=_robot(setup.robot),
        profile=profile,
        script=Script.read("\n".join(case.io), case.name),
        submit=_submit(case),
        machine=_machine(case),
        make_robot=robot,
        motion=setup.motion,
        is_full=True,
        until=round(case.seconds * 1e6),
        limits=Limits(statements=_STATEMENTS, functions=_STATEMENTS, per_slice=profile.statements),
    )
    try:
        return observed(session.run_program(program, wanted), wanted)
    except LinkError as error:
        return _link_fault(error)
    except ScriptError as error:
        return Observation(ending="crash", note=f"the script of inputs: {error}")


def _robot(name: str) -> RobotName:
    return next(one for one in ROBOTS if one == name)


def _machine(case: Case) -> MachineData | None:
    """Return the arm of the profile; ``None`` if the case has its own machine data."""
    has_own = any(one.path.lower() == "$machine.dat" for one in case.sources)
    return None if has_own else default_machine()


def _profile(name: str) -> Profile:
    """Return a profile by name; with ``-bco`` it begins with a block coincidence run [ADV-14]."""
    base, _, variant = name.partition("-")
    return replace(Profile.load(base), runs_coincidence=variant == "bco")


@lru_cache(maxsize=16)
def prepared(case: Case) -> Prepared | LinkError:
    """Return a case that is checked and compiled once for all executors and robots."""
    try:
        return Prepared(load(case.sources, case.main, strict=False))
    except LinkError as error:
        return error


def _link_fault(error: LinkError) -> Observation:
    fields = {"slug": "link", "number": None, "text": str(error)}
    return Observation(events=(Event(0, "robot", "fault", "", 0, fields),), ending="fault")


def _submit(case: Case) -> str | None:
    """Return the name of the submit program, the first companion file that ends in .sub."""
    names = [one.path for one in case.sources[1:] if one.path.lower().endswith(".sub")]
    return names[0][: -len(".sub")] if names else None


def observed(done: session.RunResult, wanted: session.RunSetup) -> Observation:
    """Return the observation of a run, for the evaluation of expectations."""
    outcome = done.outcome
    return Observation(
        events=tuple(
            Event(one.time, one.task, one.kind, *_place(one), one.fields) for one in done.events
        ),
        ending=_ENDINGS.get(outcome.ending, outcome.ending),
        note="" if outcome.error is None else str(outcome.error),
        path=done.path,
        cycle=wanted.profile.cycle,
        robot=wanted.robot,
        machine=done.machine,
    )


def _place(event: TraceEvent) -> tuple[str, int]:
    return ("", 0) if event.at is None else (event.at.file, event.at.line)
