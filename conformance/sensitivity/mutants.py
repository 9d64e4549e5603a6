"""Mutants: one random change each in code that determines semantics.

A mutant is activated in the running process: the code of existing functions is exchanged, and the
value of a module-level assignment is computed again. Caches of interpreters are cleared. Nothing is
written to a file.
"""

from __future__ import annotations

import ast
import gc
import inspect
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache, partial
from importlib import import_module
from itertools import islice
from pathlib import Path
from pkgutil import walk_packages
from random import Random
from types import CodeType, FunctionType, ModuleType
from typing import Any, Final, Protocol

from conformance.sensitivity.mutation_operators import Change, Operator, changes

#: What decides semantics, by the name under which it is reported: modules, and which of them or of
#: their functions are left out. Left out is what no program of KRL can observe: how a run is
#: fed, recorded and shown, what another caller than a controller uses, and what only one of the
#: robots needs.
PACKAGES: Final[Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]]] = {
    # left out: how values are written in traces, equality, which tests alone ask for, which random
    # numbers there are, what is skipped where parts of a program are stood in for, what only the
    # compiler, the verifier or a machine asks, and what runs while modules are loaded
    "values": (
        ("interp.values.*",),
        (
            "interp.values.json_form",
            "interp.values.builtins.Randomness.*",
            "interp.values.builtins.PredefinedFunction.is_out",
            "interp.values.builtins._builtin",
            "interp.values.faults.*.is_of_statement",
            "interp.values.operators.kind_of",
            "interp.values.operators._code",
            "interp.values.operators._letter",
            "*.__eq__",
        ),
    ),
    # left out: what a debugger asks of a program that stands, the way to a statement that it
    # selects, and rounds counted at once where no statement is recorded (a case records all)
    "tree": (
        ("interp.tree.*",),
        (
            "interp.tree.designators.Designators.look",
            *(
                f"interp.tree.executor.TreeExecutor.{name}"
                for name in ("ask_at", "break_at", "frames", "look", "put", "select")
            ),
            "interp.tree.run.ProgramState.again",
            "interp.tree.statements.Statements._is_entered",
            "interp.tree.statements.Statements._place_on_way",
        ),
    ),
    # left out: the cell around the controller, how a run is recorded, what lets time pass at once
    # where no statement is recorded (a case records all), what is looked up of one that has come to
    # its end or stands, loads, which only torques depend on, and what is skipped, or
    # gives a zero, where parts of a program are stood in for
    "controller": (
        ("interp.controller.*",),
        (
            "interp.controller.inputs.automatic_inputs",
            "interp.controller.controller._listed",
            *(
                f"interp.controller.controller.Controller.{name}"
                for name in ("arm", "assign", "is_pausing", "levels", "look", "unfulfilled")
            ),
            "interp.controller.inputs.input_script",
            "interp.controller.requests.motion_requests.MotionRequests._replaces",
            "interp.controller.requests.motion_requests.MotionRequests._skip",
            "interp.controller.motion.motions._load",
            *(
                f"interp.controller.requests.predefined_routines.PredefinedRoutines.{name}"
                for name in ("_no", "_receive_mailbox", "_sync", "_system_state", "_unsupported")
            ),
            "interp.controller.state.profile",
            "interp.controller.inputs.script_player",
            "interp.controller.state.state.ControllerState.skip",
            "interp.controller.state.trace",
            "interp.controller.state.variables.Variables.part_type",
            "interp.controller.quiet_time",
            "interp.controller.scheduler.Scheduler._free_slices",
            "interp.controller.state.variables.Variables._is_untyped_part",
        ),
    ),
    # left out: files of machine data, what checks them, and torques; motions written in Python and
    # what only they ask of the core, which also checks what it is given, forgets links of what
    # is past; and planning in batches, which is there to be compared with, and what it takes back
    "robot": (
        (
            "interp.robot.path.*",
            "interp.robot.planning.*",
            "interp.robot.api.*",
            "interp.robot.kinematics.*",
            "interp.robot.arm",
        ),
        (
            "interp.robot.api.batch",
            "interp.robot.api.commands.Transaction.check",
            "interp.robot.api.motions",
            *(
                f"interp.robot.api.control_core.ControlCore.{name}"
                for name in (
                    *("link", "run_out", "apply", "_act", "_end_path", "_first_deadlocked"),
                    *("_check", "_check_link", "_settle", "_cancel_deadlocked", "_drop_behind"),
                    *("_drop_start_link", "_act_when_due"),
                )
            ),
            "interp.robot.kinematics.*._check_*",
            "interp.robot.kinematics.data_list",
            "interp.robot.kinematics.dynamics_data",
            "interp.robot.kinematics.machine_data",
            "interp.robot.planning.deferred_arm.DeferredArm.rewind",
            "interp.robot.planning.limits.AxisLimits.carrying",
            "interp.robot.planning.limits.*.within",
            "interp.robot.planning.torque_limits",
            "interp.robot.planning.planned_arm.PlannedArm.mark",
            "interp.robot.planning.planned_arm.PlannedArm.rewind",
            "interp.robot.planning.timeline.Timeline.restore",
        ),
    ),
    # the machine in Python, on which no case runs: `krl bench fuzz` tries its mutants on programs;
    # left out: what a debugger asks
    "machine": (
        ("interp.bytecode.vm.*",),
        tuple(
            f"interp.bytecode.vm.executor.Machine.{name}"
            for name in ("ask_at", "begun", "companion", "data", "frames", "look", "put", "select")
        ),
    ),
}
#: Of these those that cases run.
OF_CASES: Final = tuple(name for name in PACKAGES if name != "machine")
_ROOT: Final = "interp"
_RULE: Final = re.compile(r"\b[A-Z]{3}-\d\d\b")


class InvalidMutant(ValueError):
    """A change that cannot be activated, because the function would need other names."""


class SeededFault(Protocol):
    """A fault that cases should notice: a drawn `Mutant`, or one that is planted by hand.

    ``lines`` are the first and last line of its function or statement. ``is_module_level`` is set
    for a change of the value of a name of ``module``, which is then ``function``.
    """

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def module(self) -> str: ...  # noqa: D102
    @property
    def function(self) -> str: ...  # noqa: D102
    @property
    def lines(self) -> tuple[int, int]: ...  # noqa: D102
    @property
    def is_module_level(self) -> bool: ...  # noqa: D102
    def plant(self) -> AbstractContextManager[object]: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class Mutant:
    """A change of a module; ``number`` is its index among all changes of this module.

    ``lines`` are those of its statement: a case that executes none of them cannot notice it.
    ``source`` is its first line.
    """

    package: str
    module: str
    number: int
    operator: Operator
    function: str
    line: int
    lines: tuple[int, int]
    was: str
    now: str
    source: str
    is_module_level: bool

    @property
    def name(self) -> str:
        """Its identity: module and number."""
        return f"{self.module}:{self.number}"

    @property
    def change(self) -> tuple[str, ...]:
        """A description that does not change when lines of the module move."""
        return self.module, self.function, self.source, self.was, self.now

    @property
    def file(self) -> str:
        """The path of its module in the repository."""
        return self.module.replace(".", "/") + ".py"

    @contextmanager
    def plant(self) -> Iterator[None]:
        """Have the mutant in the running process while the context lasts.

        Raises `InvalidMutant` if this is not possible.
        """
        module = import_module(self.module)
        tree = tree_of(self.module)
        change = _change(tree, self.number)
        change.make()
        undo = _reassigned(module, change) if change.assignment else recoded(module, tree)
        _forget()
        try:
            yield
        finally:
            for one in undo:
                one()
            _forget()


def all_mutants(packages: Iterable[str] = OF_CASES) -> Iterator[str]:
    """Return the names of all mutants of some of `PACKAGES`, one package after another."""
    left_out = [one for _, some in PACKAGES.values() for one in some]
    for module in (name for package in packages for name in _modules(package)):
        for number, function in enumerate(_changed(module)):
            if not any(fnmatchcase(f"{module}.{function}", each) for each in left_out):
                yield f"{module}:{number}"


def drawn(seed: int, count: int, packages: Iterable[str] = OF_CASES) -> tuple[Mutant, ...]:
    """Return ``count`` random mutants of some packages, in the order of `all_mutants`."""
    every = tuple(all_mutants(packages))
    chosen = Random(f"mutants {seed}").sample(range(len(every)), min(count, len(every)))
    return tuple(named(every[at]) for at in sorted(chosen))


def named(name: str) -> Mutant:
    """Return the mutant of a name, ``interp.values.values:12``; raises `KeyError` if unknown.

    Its module may be one from which none is drawn.
    """
    module, _, number = name.partition(":")
    is_known = module in _every_module() and number.isdigit()
    if not is_known or int(number) >= len(_changed(module)):
        raise KeyError(name)
    tree = tree_of(module)
    one = _change(tree, int(number))
    package = next((each for each in PACKAGES if module in _modules(each)), "")
    source = _text(module).splitlines()[one.line - 1].strip()
    return Mutant(
        package,
        module,
        int(number),
        one.operator,
        one.function,
        one.line,
        one.lines,
        one.was,
        one.now,
        source,
        one.assignment is not None,
    )


def of_line(file: str, line: int) -> list[Mutant]:
    """Return the mutants that begin on a line of a file, ``interp/values/values.py``."""
    module = file.removesuffix(".py").replace("/", ".")
    if module not in _every_module():
        return []
    found = enumerate(changes(tree_of(module)))
    return [named(f"{module}:{number}") for number, one in found if one.line == line]


@cache
def modules() -> tuple[str, ...]:
    """Return the names of all modules from which mutants are drawn."""
    return tuple(name for package in PACKAGES for name in _modules(package))


def uses_of(fault: SeededFault) -> Mapping[str, frozenset[int]]:
    """Return the lines of which a case has to run one to notice a fault, by module.

    Those of its statement, or where a module-level name was changed those that use this name.
    """
    if not fault.is_module_level:
        first, last = fault.lines
        return {fault.module: frozenset(range(first, last + 1))}
    importing = f"from {fault.module} import"
    return {
        module: frozenset(
            one.lineno
            for function in ast.walk(tree_of(module))
            if isinstance(function, ast.FunctionDef | ast.Lambda)
            for one in ast.walk(function)
            if isinstance(one, ast.Name) and one.id == fault.function
        )
        for module in modules()
        if module == fault.module or importing in _text(module)
    }


def around(fault: SeededFault) -> Mapping[str, frozenset[int]]:
    """Return the lines of a fault's function, and of the functions and classes that it names."""
    first, last = sorted(map(abs, fault.lines))
    words = {fault.function.rpartition(".")[2]}
    for node in ast.walk(tree_of(fault.module)):
        if isinstance(node, ast.Name | ast.Attribute) and first <= node.lineno <= last:
            words.add(node.id if isinstance(node, ast.Name) else node.attr)
    found: dict[str, set[int]] = {}
    for module, name, lines in _functions_of_modules():
        if name in words:
            found.setdefault(module, set()).update(lines)
    return {module: frozenset(lines) for module, lines in found.items()}


def cited(fault: SeededFault) -> frozenset[str]:
    """Return the rules that a fault's function cites or its statement names, and modules."""
    found = set()
    for module, lines in around(fault).items():
        rows = _text(module).splitlines()
        text = [ast.get_docstring(tree_of(module)) or "", *(rows[number - 1] for number in lines)]
        found.update(_RULE.findall("\n".join(text)))
    return frozenset(found)


@cache
def _functions_of_modules() -> Sequence[tuple[str, str, range]]:
    """Module, name and lines of each function and class."""
    return [
        (module, node.name, range(node.lineno, (node.end_lineno or node.lineno) + 1))
        for module in modules()
        for node in ast.walk(tree_of(module))
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    ]


@cache
def _modules(package: str) -> list[str]:
    wanted, left_out = PACKAGES[package]
    return [
        name
        for name in _every_module()
        if any(fnmatchcase(name, one) for one in wanted) and name not in left_out
    ]


@cache
def _every_module() -> tuple[str, ...]:
    root = import_module(_ROOT)
    found = walk_packages(root.__path__, f"{_ROOT}.")
    return tuple(sorted(one.name for one in found if not one.ispkg))


@cache
def _text(module: str) -> str:
    return Path(str(import_module(module).__file__)).read_text(encoding="utf-8")


def tree_of(module: str) -> ast.Module:
    """Return a new syntax tree of a module, which may be changed."""
    return ast.parse(_text(module))


@cache
def _changed(module: str) -> tuple[str, ...]:
    """Return the function that each mutant of a module changes, by number."""
    return tuple(one.function for one in changes(tree_of(module)))


def _change(tree: ast.Module, number: int) -> Change:
    return next(islice(changes(tree), number, None))


# ------------------------------------------------------------------------------ put in place


def _reassigned(module: ModuleType, change: Change) -> list[Callable[[], None]]:
    """Compute a module-level name again, for all modules that have it."""
    value = change.assignment.value if change.assignment else None
    assert value is not None, "it is a change of a value"
    code = compile(ast.Expression(value), str(module.__file__), "eval")
    name = change.function
    before = vars(module)[name]
    try:
        new = eval(code, vars(module))
    except Exception as error:
        raise InvalidMutant(f"{type(error).__name__}: {error}") from error
    undo: list[Callable[[], None]] = []
    for one in [one for key, one in sys.modules.items() if key.partition(".")[0] == _ROOT]:
        if vars(one).get(name) is before:
            setattr(one, name, new)
            undo.append(partial(setattr, one, name, before))
    return undo


def recoded(module: ModuleType, tree: ast.Module) -> Sequence[Callable[[], None]]:
    """Exchange the code of the functions that a tree has otherwise; returns what undoes it.

    Functions, comprehensions and lambdas are to begin where they did. Raises `InvalidMutant` where
    none is another, or one has other variables of the functions around it.
    """
    path = str(module.__file__)
    original = compile(_text(module.__name__), path, "exec", dont_inherit=True)
    mutated = compile(tree, path, "exec", dont_inherit=True)
    found = [
        (function, new)
        for old, new in _different(original, mutated)
        for function in _functions().get(_key(old), ())
    ]
    if not found:
        raise InvalidMutant("it compiles to the same code")
    if any(one.__code__.co_freevars != new.co_freevars for one, new in found):
        raise InvalidMutant("it has other variables of the functions around it")
    undo = [partial(setattr, one, "__code__", one.__code__) for one, _ in found]
    for one, new in found:
        one.__code__ = new
    return undo


def _different(old: CodeType, new: CodeType) -> Iterator[tuple[CodeType, CodeType]]:
    """Pairs of code of the same function, from the outside in, that are not the same."""
    left = [one for one in new.co_consts if isinstance(one, CodeType)]
    for one in (one for one in old.co_consts if isinstance(one, CodeType)):
        name = one.co_qualname, one.co_firstlineno
        other = next(
            (each for each in left if (each.co_qualname, each.co_firstlineno) == name), None
        )
        if other is None:
            continue
        left.remove(other)
        if one != other:
            yield one, other
            yield from _different(one, other)


def _key(code: CodeType) -> tuple[Any, ...]:
    """Which function it is of; lambdas of a line are distinguished by their columns."""
    columns = tuple(column for _, _, column, _ in code.co_positions())
    return code.co_filename, code.co_qualname, code.co_firstlineno, columns


def load() -> None:
    """Import all modules and find their functions and caches; `Mutant.plant` is quick then."""
    _functions()
    _caches()


@cache
def _functions() -> Mapping[tuple[Any, ...], Sequence[FunctionType]]:
    """Return the existing functions by file and place, once all modules are loaded."""
    for name in modules():
        import_module(name)
    found: dict[tuple[Any, ...], list[FunctionType]] = {}
    for one in _objects():
        if inspect.isfunction(one) and str(one.__module__).partition(".")[0] == _ROOT:
            found.setdefault(_key(one.__code__), []).append(one)
    return found


def _forget() -> None:
    """Empty the caches of interpreters and of the evaluation of cases."""
    for one in _caches():
        one.cache_clear()


def _objects() -> list[Any]:
    gc.unfreeze()  # what is set aside is not listed
    return gc.get_objects()


@cache
def _caches() -> Sequence[Any]:
    wrapper = type(_text)
    return [
        one
        for one in _objects()
        if type(one) is wrapper
        and str(one.__module__).startswith((f"{_ROOT}.", "conformance.evaluation."))
    ]
