"""Mutants: which changes there are, that they are put in place and taken out, who notices them."""

import ast
import fnmatch
import re
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from conformance.evaluation.execution import Setup, observe
from conformance.sensitivity import bench_record, detection
from conformance.sensitivity.case_selection import candidates
from conformance.sensitivity.detection import (
    Detection,
    Fate,
    detect_faults,
    is_possible,
    kept_detections,
    reaches_of,
)
from conformance.sensitivity.equivalents import equivalent, search_reason, searches
from conformance.sensitivity.line_reach import Reach, is_alike, reach_of
from conformance.sensitivity.mutants import Mutant, all_mutants, drawn, named
from conformance.sensitivity.mutated_code import LEFT_OUT, modules, text_of
from conformance.sensitivity.mutation_operators import changes
from conformance.sensitivity.seeded_faults import around, uses_of
from conformance.suite.case import CASES, Case, read_case
from interp.controller.state import clock, declared_interrupts
from interp.tree import statements as tree_statements

_SETUP = Setup("tree", "kinematic")
needs_fork = pytest.mark.skipif(not is_possible(), reason="it takes a copy of a process")


def _made(body: str) -> set[tuple[str, str]]:
    tree = ast.parse(f"def f(a, b):\n    {body}\n")
    return {(one.operator, one.now) for one in changes(tree)}


def _changes(module: str) -> list[tuple[str, str, str]]:
    """Function, was and now of all changes of a module."""
    return [(one.function, one.was, one.now) for one in changes(ast.parse(text_of(module)))]


def _mutant(module: str, function: str, was: str, now: str) -> Mutant:
    """The mutant that is this change."""
    return named(f"{module}:{_changes(module).index((function, was, now))}")


def _case(name: str) -> Case:
    return read_case(CASES / f"{name}.src")


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("return a < b", {("comparison", "a <= b"), ("comparison", "a >= b")}),
        ("return a is b", {("comparison", "a is not b")}),
        ("return a and b", {("connective", "a or b")}),
        ("return not a", {("connective", "a")}),
        ("return a + b", {("arithmetic", "a - b")}),
        ("return a + 'text'", set()),
        ("return -a", {("arithmetic", "a")}),
        ("return True", {("constant", "False")}),
        ("return 7", {("constant", "8"), ("constant", "6")}),
        ("return 500.0", {("constant", "1000.0")}),
        ("return 1444", {("constant", "2888")}),
        ("raise a; a()", {("statement", "pass")}),
        ("return a if b else a", {("condition", "not b")}),
        ("return [c for c in a if c]", {("condition", "not c")}),
        ("a.b = b", {("statement", "pass")}),
        ("c = b", set()),
        ("raise a", {("statement", "pass")}),
        ("raise ProfileError(a)", set()),
        ("raise LinkError(a)", set()),
        ("if a < b: raise ValueError(a)", set()),
        ("assert a < 7", set()),
        ("return isinstance(a, int | str)", set()),
        ("return f'{a + 1}'", set()),
    ],
)
def test_changes_of_a_function(body: str, expected: set[tuple[str, str]]) -> None:
    """Each operator makes its changes, and leaves alone what decides nothing."""
    assert expected == _made(body)


def test_boundaries_of_reals_stay() -> None:
    """What a number that is not whole is compared with is equal to it by chance only."""
    found = changes(ast.parse("_NEAR = 0.001\ndef f(a):\n    return a < 2 * _NEAR, a < 1.0\n"))
    now = {one.now for one in found if one.operator == "comparison"}
    assert {"a >= 2 * _NEAR", "a <= 1.0", "a >= 1.0"} == now


def test_conditions_are_not_negated_twice() -> None:
    """Where the opposite of a comparison is a change already, its negation is none."""
    assert {("comparison", "a != b"), ("statement", "pass")} == _made("if a == b: a()")
    assert ("condition", "not a.b") in _made("while a.b: a()")


def test_a_lambda_is_run_at_another_time() -> None:
    """Its lines are negative, for changes as for what a case runs."""
    (change,) = changes(ast.parse("T = (\n    lambda a: not a,\n)\n"))
    assert (-2, -2) == change.lines
    mutant = _mutant(
        "interp.controller.requests.computed_variables",
        "connect_computed",
        "state.mode == 'T1'",
        "state.mode != 'T1'",
    )
    found = reach_of([_case("io/mode_signals"), _case("control/if_else")], _SETUP)
    lines = uses_of(mutant)[mutant.module]
    assert [True, False] == [one.has(mutant.module, lines) for one in found]


def test_the_same_seed_draws_the_same() -> None:
    """Seeds tell draws apart, and each mutant is found again by its name."""
    first = drawn(3, 2)
    assert first == drawn(3, 2)
    assert first != drawn(4, 2)
    assert first[0] == named(first[0].name)


def test_a_name_of_no_mutant() -> None:
    """Neither another module nor a number that is too high names a mutant."""
    for name in ("krl.cli:0", "interp.values.values:99999", "interp.values.values:x"):
        with pytest.raises(KeyError):
            named(name)


def test_a_mutant_is_there_only_while_it_is_in_place() -> None:
    """The clock has another next tick within the context, and the usual one behind it."""
    mutant = _mutant(
        "interp.controller.state.clock",
        "Clock.next_tick",
        "self.tick + self.cycle",
        "self.tick - self.cycle",
    )
    with mutant.plant():
        assert -12_000 == clock.Clock(12_000).next_tick
    assert 12_000 == clock.Clock(12_000).next_tick


def test_module_level_names_are_changed_wherever_they_are() -> None:
    """The modules that use the name have another value, for as long as the context lasts."""
    mutant = _mutant("interp.controller.state.declared_interrupts", "_RANGES", "40", "41")
    assert not declared_interrupts.is_usable(40)
    with mutant.plant():
        assert declared_interrupts.is_usable(40)
    assert not declared_interrupts.is_usable(40)
    uses = uses_of(mutant)["interp.controller.state.declared_interrupts"]
    text = Path(str(declared_interrupts.__file__)).read_text(encoding="utf-8").splitlines()
    assert all("_RANGES" in text[line - 1] for line in uses)


def test_modules_decide_semantics() -> None:
    """What only records or is only compared with is not changed."""
    assert "interp.values.operators" in modules()
    assert "interp.controller.state.trace" not in modules()
    module = "interp.tree.executor"
    names = set(all_mutants())
    functions = [one for one, _, _ in _changes(module)]
    left = {one for at, one in enumerate(functions) if f"{module}:{at}" not in names}
    of_debuggers = ("ask_at", "break_at", "frames", "look", "put", "select")
    assert {f"TreeExecutor.{one}" for one in of_debuggers} == left


def _functions(root: Path, path: Path) -> Iterator[str]:
    """Yield functions, classes and names of values of a file with their modules, and the module."""
    module = ".".join(path.with_suffix("").parts)
    yield module
    left: list[tuple[str, ast.AST]] = [
        (module, ast.parse((root / path).read_text(encoding="utf-8")))
    ]
    while left:
        around, node = left.pop()
        for one in ast.iter_child_nodes(node):
            if isinstance(one, ast.FunctionDef | ast.ClassDef):
                yield f"{around}.{one.name}"
                left.append((f"{around}.{one.name}", one))
            elif isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name):
                yield f"{around}.{one.target.id}"


def test_what_is_left_out_exists() -> None:
    """A function that has another name now is not left out by its old one."""
    root = Path(str(import_module("interp").__file__)).parents[1]
    files = (path.relative_to(root) for path in (root / "interp").rglob("*.py"))
    there = [name for path in files for name in _functions(root, path)]
    assert [] == [one for one in LEFT_OUT if not fnmatch.filter(there, one)]


def test_lines_that_a_case_runs() -> None:
    """A case runs the lines of what it uses, and no others."""
    (reach,) = reach_of([_case("control/if_else")], _SETUP)
    text = Path(str(tree_statements.__file__)).read_text(encoding="utf-8").splitlines()
    at = next(number for number, line in enumerate(text, 1) if "def _if(" in line)
    assert reach.has("interp.tree.statements", frozenset(range(at, at + 12)))
    assert not reach.has("interp.robot.path.spline", frozenset(range(1, 999)))


def test_cases_that_run_what_a_statement_names_come_first() -> None:
    """Of three cases that run a call only the last runs what the called function then does."""
    plan = "interp.robot.planning.planned_arm"
    mutant = _mutant(plan, "PlannedArm.plan", "check_numbers(motion)", "pass")
    called = "interp.robot.path.programmed_targets"
    rare = max(around(mutant)[called])
    lines = {plan: frozenset({mutant.line})}
    reaches = [Reach(_case(f"motion/{name}"), lines, 1) for name in ("acc_cp", "lin_speed")]
    last = _case("motion/lin_end_pose")
    reaches.append(Reach(last, {**lines, called: frozenset({rare})}, 1))
    assert last == candidates(mutant, reaches, 60, is_search=False).tried[0].case


def test_cases_that_state_what_the_code_cites_are_tried() -> None:
    """Of cases that run the same lines that of INT-15 is, which the class of the position cites."""
    unit = "interp.controller.interrupts.interrupt_unit"
    mutant = _mutant(unit, "InterruptUnit.watch", "self._positions.keep('INT')", "pass")
    names = ("motion/acc_cp", "motion/lin_speed", "motion/lin_end_pose", "motion/lin_smooth")
    cases = [_case(name) for name in (*names, "motion/lin_limits", "interrupt/positions_of_event")]
    reaches = [Reach(case, {unit: frozenset({mutant.line})}, 1) for case in cases]
    tried = candidates(mutant, reaches, 4, is_search=False).tried
    assert cases[-1] in [one.case for one in tried]


@needs_fork
@pytest.mark.parametrize(
    ("case", "function", "was", "now", "fate"),
    [
        ("data/int_division", "values.operators:_divided", "right == 0", "right != 0", "red"),
        ("data/round_negative", "values.values:single", "0", "-1", "equivalent"),
        (
            "io/anin_too_many",
            "controller.interrupts.cyclic_evaluation:CyclicEvaluation._switch",
            "number is None",
            "number is not None",
            "soft",
        ),
    ],
)
def test_what_becomes_of_a_mutant(case: str, function: str, was: str, now: str, fate: str) -> None:
    """The machine in C divides otherwise; an unsure rule is soft; one element is the last."""
    module, _, name = function.partition(":")
    mutant = _mutant(f"interp.{module}", name, was, now)
    (found,) = detect_faults([mutant], reach_of([_case(case)], _SETUP))
    assert (fate, 1, 1) == (found.fate, found.reached, found.runs)
    assert ("" if fate == "equivalent" else case) == found.case == found.changed


@needs_fork
@pytest.mark.parametrize(
    ("case", "module", "function", "was", "now", "by_profile"),
    [
        (
            "spline/circle_then_spl",
            "spline",
            "_is_corner",
            "before.is_exact and segment.is_exact",
            "before.is_exact or segment.is_exact",
            True,
        ),
        (
            "motion/circle_shape",
            "circle",
            "Circle.at",
            "np.cos(phi) * self.first + np.sin(phi) * self.second",
            "np.cos(phi) * self.first - np.sin(phi) * self.second",
            False,
        ),
    ],
)
def test_red_by_laws_of_the_simulator_only(
    case: str, module: str, function: str, was: str, now: str, by_profile: bool
) -> None:
    """An arm that stops where it need not has another profile; one off its points breaks a rule."""
    mutant = _mutant(f"interp.robot.path.{module}", function, was, now)
    (found,) = detect_faults([mutant], reach_of([_case(case)], _SETUP))
    assert ("red", by_profile) == (found.fate, found.by_profile)


def test_runs_that_differ_by_rounding_are_alike() -> None:
    """A billionth of a degree is rounding, a hundred-thousandth is not, nor is another event.

    A full turn is no difference of A, nor is a microsecond of an event.
    """
    seen = observe(_case("motion/acc_cp"), _SETUP)
    assert seen.path is not None
    alike = []
    for off in (1e-9, 1e-5):
        path = replace(seen.path, axes=seen.path.axes + off)
        alike.append(is_alike(seen, replace(seen, path=path)))
    for a in (360.0, 180.0):
        path = replace(seen.path, points=seen.path.points + a * np.eye(6)[3])
        alike.append(is_alike(seen, replace(seen, path=path)))
    for late in (1, 2):
        events = tuple(replace(event, time=(event.time or 0) + late) for event in seen.events)
        alike.append(is_alike(seen, replace(seen, events=events)))
    assert [True, False] * 3 == alike
    assert not is_alike(seen, replace(seen, events=seen.events[1:]))
    assert not is_alike(seen, replace(seen, path=None))


@needs_fork
def test_a_case_that_is_not_sure_does_not_end_the_detection() -> None:
    """Two dialogues at a time are our reading; that one is answered by its button is not."""
    names = ("message/answer_beside_message", "message/answer_of_dialogue")
    was, panel = "self._messages.answer(button)", "interp.controller.inputs.operator_panel"
    mutant = _mutant(panel, "OperatorPanel.answer", was, "pass")
    reaches = reach_of([_case(name) for name in names], _SETUP)
    found = [detect_faults([mutant], reaches[:count])[0] for count in (1, 2)]
    assert [("soft", names[0]), ("red", names[1])] == [(one.fate, one.case) for one in found]


@needs_fork
def test_a_case_that_takes_too_long_has_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    """So much computing is more than any case may take where it may take next to none."""
    monkeypatch.setattr(detection, "_SECONDS", 1e-6)
    mutant = _mutant("interp.values.operators", "_divided", "left / right", "left * right")
    (found,) = detect_faults([mutant], reach_of([_case("data/int_division")], _SETUP))
    assert ("red", "data/int_division") == (found.fate, found.case)
    assert "seconds of computing" in found.why


@needs_fork
def test_what_is_kept_is_not_tried_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that goes on takes over lines and detections, and has the same result."""
    mutants = [named("interp.controller.state.clock:0"), named("interp.controller.state.clock:1")]
    cases = [_case("control/if_else")]

    def tried() -> list[Detection[Mutant]]:
        with kept_detections(tmp_path) as store:
            return detect_faults(mutants, reaches_of(cases, store=store), store=store)

    first = tried()
    for name in ("conformance.sensitivity.line_reach._reach", f"{detection.__name__}._tried"):
        monkeypatch.setattr(name, None)
    assert first == tried()


@needs_fork
def test_a_mutant_whose_lines_no_case_runs_survives() -> None:
    """It is not tried on a case that cannot notice it."""
    mutant = _mutant("interp.values.operators", "_divided", "right == 0", "right != 0")
    (found,) = detect_faults([mutant], reach_of([_case("control/if_else")], _SETUP))
    assert ("survived", 0, 0) == (found.fate, found.reached, found.runs)


def test_known_equivalent_changes_exist() -> None:
    """Each entry is a change that can be drawn from its line, or a line from which one can."""
    lines = {module: text_of(module).splitlines() for module, *_ in equivalent()}
    there = {
        (module, one.function, lines[module][one.line - 1].strip(), one.was, one.now)
        for module in lines
        for one in changes(ast.parse(text_of(module)))
    }
    assert set() == set(equivalent()) - there - {one[:3] for one in there}
    assert [] == [
        (module, name)
        for module, name in searches()
        if all(name != function for function, _, _ in _changes(module))
    ]
    assert [] == [
        (module, line)
        for (module, _), row in searches().items()
        for line in row.get("deciding", ())
        if not re.search(rf"^ *{re.escape(line)}$", text_of(module), re.MULTILINE)
    ]


def test_no_change_of_a_line_can_be_noticed() -> None:
    """An entry for a whole line is the reason for each of its changes, and for no other line."""
    told = "self._notify((name, place), value)", "pass"
    fates = []
    for was, now in (("1", "2"), ("1", "0"), told):
        mutant = _mutant(
            "interp.controller.state.state", "ControllerState.signal_changed", was, now
        )
        fates.append(detection._if_equivalent(Detection(mutant, "survived")).fate)
    assert ["equivalent", "equivalent", "survived"] == fates


@pytest.mark.parametrize(
    ("reached", "runs", "changed", "fate"),
    [
        (1, 1, "", "equivalent"),
        (0, 0, "", "survived"),
        (2, 1, "", "survived"),
        (1, 1, "a/case", "survived"),
    ],
)
def test_a_search_may_go_another_way(reached: int, runs: int, changed: str, fate: Fate) -> None:
    """A change of one is equivalent where all cases that run it did, and saw nothing else."""
    mutant = _mutant("interp.robot.path.speed_profile", "bisected", "2.0", "3.0")
    one = Detection(mutant, "survived", reached=reached, runs=runs, changed=changed)
    assert fate == detection._if_equivalent(one).fate


def test_a_search_is_tried_on_all_cases() -> None:
    """A sample does not tell that nothing seen is another; what decides is no search."""
    module = "interp.robot.path.arc_length"
    cases = [_case(name) for name in ("motion/acc_cp", "motion/lin_speed", "motion/lin_end_pose")]
    counts = []
    for was, now in (("wanted - self.at(u)", "wanted + self.at(u)"), ("0.0", "1.0")):
        mutant = _mutant(module, "ArcLength.parameters", was, now)
        reaches = [Reach(case, {module: frozenset({mutant.line})}, 1) for case in cases]
        is_search = bool(search_reason(mutant))
        counts.append(len(candidates(mutant, reaches, 1, is_search=is_search).tried))
    assert [3, 1] == counts


def test_shares_are_of_what_could_be_noticed() -> None:
    """Equivalent and invalid mutants count neither as found nor as missed."""
    mutant = named("interp.values.values:0")
    fates: tuple[Fate, ...] = ("red", "red", "soft", "survived", "equivalent", "invalid")
    record = bench_record.mutants_record({7: [Detection(mutant, fate) for fate in fates]})
    assert (6, 2, 0.5) == (record["mutants"], record["red"], record["share"])
    assert [("values", 0.5)] == [(one["package"], one["share"]) for one in record["packages"]]
    assert [(7, 0.5)] == [
        (one["seed"], each["share"]) for one in record["seeds"] for each in one["packages"]
    ]
