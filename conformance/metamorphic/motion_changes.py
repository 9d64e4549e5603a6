"""Laws about motion and execution: frames, override, batches, executors, robots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random
from typing import Final

from conformance.evaluation.observation import Observation
from conformance.metamorphic.comparison import (
    Compare,
    at_most_twice,
    no_sooner,
    same_axes,
    same_geometry,
    same_outputs,
)
from conformance.metamorphic.law import Law
from conformance.metamorphic.subject import Program, Run
from conformance.metamorphic.tree_rewriting import (
    MADE,
    name,
    names_of,
    rewritten,
    routines,
    variable,
    with_routines,
)
from grammar.syntax import ast
from grammar.syntax.walk import walk

_KINEMATIC: Final = Run(robot="kinematic")
_SHIFT: Final = {"X": 24.0, "Y": -36.0, "Z": 12.0}
#: Names with which a program reads or changes the position of the arm or the base.
_KNOW_PLACES: Final = ("$POS_", "$IPO_MODE", "INVERSE", "FORWARD", "$ROBROOT", "BAS")
#: Names that can make the time of an event matter.
_KNOW_TIMES: Final = (
    "$TIMER",
    "$OV_PRO",
    "$ADVANCE",
    "$CYCFLAG",
    "$DATE",
    "$ROB_TIMER",
    "$DISTANCE",
    "$VEL_ACT",
    "$DIST_NEXT",
    "$POS_ACT",
    "$AXIS_ACT",
    "$MODE_OP",
)
_POINT: Final = frozenset("XYZ")


def _nodes(program: Program) -> list[ast.Node]:
    return [one for module in (program.modules or {}).values() for one in walk(module)]


def _mentions(program: Program, words: Sequence[str]) -> bool:
    names = [key for module in (program.modules or {}).values() for key in names_of(module)]
    return any(one.startswith(word) for one in names for word in words)


def _motions(program: Program) -> list[ast.Motion]:
    return [one for one in _nodes(program) if isinstance(one, ast.Motion)]


def _is_timeless(program: Program) -> bool:
    """Return whether a program moves, and only its own statements decide where."""
    if program.case.io or len(program.case.sources) > 2 or not _motions(program):
        return False
    bound = ast.InterruptDeclaration | ast.WaitFor | ast.SignalOn | ast.StopWhen | ast.Halt
    is_bound = any(isinstance(one, bound) for one in _nodes(program))
    return not is_bound and not _mentions(program, _KNOW_TIMES)


def _has_exact_stops(program: Program) -> bool:
    return _is_timeless(program) and not any(one.criteria for one in _motions(program))


def _goes_by_place(program: Program) -> bool:
    return _is_timeless(program) and all("C_VEL" not in one.criteria for one in _motions(program))


def _with_prelude(program: Program, *statements: ast.Statement) -> Program | None:
    """Return the program with statements added before its first statement."""
    modules = dict(program.modules or {})
    module = modules[program.case.main]
    if not routines(module):
        return None
    first, *others = routines(module)
    place = next(
        (n for n, one in enumerate(first.body) if not isinstance(one, ast.Definition)),
        len(first.body),
    )
    body = (*first.body[:place], *statements, *first.body[place:])
    modules[program.case.main] = with_routines(module, [replace(first, body=body), *others])
    return program.written(modules)


# ------------------------------------------------------------------------------------ frames


def _number(node: ast.Expression) -> float | None:
    match node:
        case ast.IntegerLiteral(value=value):
            return float(value)
        case ast.RealLiteral():
            return node.value
        case ast.Unary(operator="-", operand=ast.IntegerLiteral() | ast.RealLiteral() as operand):
            return -float(operand.value)
    return None


def _real(value: float) -> ast.Expression:
    literal = ast.RealLiteral(MADE, f"{abs(value):.4f}")
    return ast.Unary(MADE, "-", literal) if value < 0 else literal


def _components(point: ast.Expression | None) -> dict[str, float] | None:
    """Return the components of a target if it is an aggregate of numbers, else ``None``."""
    if not isinstance(point, ast.Aggregate):
        return None
    found = {}
    for one in point.components:
        number = _number(one.value)
        if number is None:
            if isinstance(one.value, ast.BitLiteral):
                continue
            return None
        found[one.name.key] = number
    return found


def _moved(point: ast.Expression, way: dict[str, float]) -> ast.Expression:
    assert isinstance(point, ast.Aggregate), "the caller looked"
    found = []
    for one in point.components:
        more = way.get(one.name.key)
        number = _number(one.value)
        found.append(
            one if more is None or number is None else replace(one, value=_real(number + more))
        )
    return replace(point, components=tuple(found))


def _shifted(program: Program, _random: Random) -> Program | None:
    """Shift $BASE, and shift all points by the opposite vector."""
    absolute = [one for one in _motions(program) if not one.kind.endswith("_REL")]
    points = [p for one in absolute for p in (one.target, one.auxiliary) if p is not None]
    written = [_components(point) for point in points]
    if any(one is None for one in written) or not any(_POINT & set(one or ()) for one in written):
        return None
    back = {key: -value for key, value in _SHIFT.items()}

    frame = ast.Aggregate(
        MADE,
        None,
        tuple(
            ast.Component(MADE, name(key), None, _real(value))
            for key, value in {**_SHIFT, "A": 0.0, "B": 0.0, "C": 0.0}.items()
        ),
    )
    sets = _sets_base(program)
    if sets is None:
        return None

    def change(node: ast.Node) -> ast.Node:
        if id(node) in sets and isinstance(node, ast.Assignment):
            return replace(node, value=frame)
        if not isinstance(node, ast.Motion) or node.kind.endswith("_REL"):
            return node
        auxiliary = None if node.auxiliary is None else _moved(node.auxiliary, back)
        return replace(node, target=_moved(node.target, back), auxiliary=auxiliary)

    changed = {path: rewritten(one, change) for path, one in (program.modules or {}).items()}
    shifted = program.written(changed)
    if sets:
        return shifted
    return _with_prelude(shifted, ast.Assignment(MADE, variable("$BASE"), frame))


def _sets_base(program: Program) -> frozenset[int] | None:
    """Return the assignments of zero to $BASE, by `id`; ``None`` if $BASE is used otherwise."""
    found = []
    mentions = 0
    for one in _nodes(program):
        mentions += isinstance(one, ast.Variable) and one.name.key == "$BASE"
        match one:
            case ast.Assignment(target=ast.Variable() as target, value=ast.Variable() as value):
                if target.name.key == "$BASE" and value.name.key == "$NULLFRAME":
                    found.append(id(one))
    return frozenset(found) if len(found) == mentions else None


def _knows_no_places(program: Program) -> bool:
    return bool(_motions(program)) and not _mentions(program, _KNOW_PLACES)


# ------------------------------------------------------------------------------------ speed


def _slower(program: Program, random: Random) -> Program | None:
    percent = ast.IntegerLiteral(MADE, random.choice((30, 50, 75)))
    return _with_prelude(program, ast.Assignment(MADE, variable("$OV_PRO"), percent))


def _halved_override(program: Program, _random: Random) -> Program | None:
    half = ast.IntegerLiteral(MADE, 50)
    return _with_prelude(program, ast.Assignment(MADE, variable("$OV_PRO"), half))


def _stopped(program: Program, _random: Random) -> Program | None:
    """Replace all blends by exact stops."""
    if _has_exact_stops(program):
        return None

    def change(node: ast.Node) -> ast.Node:
        return replace(node, criteria=()) if isinstance(node, ast.Motion) else node

    return program.rewritten(lambda _routine: change)


# ------------------------------------------------------------------------------------ lines


def _halved(program: Program, _random: Random) -> Program | None:
    """Replace each LIN between known points by two, with an exact stop in the middle."""

    def change(node: ast.Node) -> ast.Node:
        if not isinstance(node, ast.Routine):
            return node
        new: list[ast.Statement] = []
        for before, one in zip((None, *node.body), node.body, strict=False):
            middle = _middle(before, one)
            if middle is not None and isinstance(one, ast.Motion):
                new.append(replace(one, target=middle, values=()))
            new.append(one)
        return node if len(new) == len(node.body) else replace(node, body=tuple(new))

    return program.rewritten(lambda _routine: change)


def _middle(before: ast.Statement | None, one: ast.Statement) -> ast.Aggregate | None:
    """Return the midpoint of a LIN that only translates the tool; ``None`` if it is unknown."""
    if not isinstance(before, ast.Motion) or not isinstance(one, ast.Motion):
        return None
    if one.kind != "LIN" or one.criteria or before.criteria or before.kind.endswith("_REL"):
        return None
    start, end = _components(before.target), _components(one.target)
    if start is None or end is None or not set(start) >= _POINT or not set(end) >= _POINT:
        return None
    if any(start.get(key) != value for key, value in end.items() if key in "ABC"):
        return None
    if any(key[0] == "E" for key in end):
        return None
    return ast.Aggregate(
        MADE,
        None,
        tuple(
            ast.Component(MADE, name(key), None, _real((start[key] + end[key]) / 2))
            for key in "XYZ"
        ),
    )


# ------------------------------------------------------------------------------------ batches


def _is_for_batches(program: Program) -> bool:
    return _is_timeless(program) and not any(
        isinstance(one, ast.Continue) for one in _nodes(program)
    )


def _unless_blends_fail(compare: Compare) -> Compare:
    """Return a comparison that makes an exception for two kinds of programs.

    One are those in which a blend has failed: in a batch, all blends are known in time. The other
    are those in which a motion cannot be planned: then no motion of its batch is executed
    (`interp.robot.api.batch`).
    """

    def found(left: Observation, right: Observation) -> str:
        failed = left.ending == "fault" or any(
            one.fields.get("number") in (1123, 1442) for one in left.of_kind("message")
        )
        return "" if failed else compare(left, right)

    return found


LAWS: Final[Sequence[Law]] = (
    Law(
        "points and base shifted",
        "a base moved one way and all points the other way are the same path in the world",
        ("ARI-09",),
        same_axes,
        _shifted,
        _KINEMATIC,
        needs=_knows_no_places,
    ),
    Law(
        "override",
        "the override changes times, not where the arm goes, but for blends by speed",
        ("BLD-01", "MOT-09", "SPL-03"),
        same_geometry,
        _slower,
        _KINEMATIC,
        needs=_goes_by_place,
    ),
    Law(
        "half the override",
        "with half the override exact stops are no sooner, and motions take up to twice as long",
        ("MOT-09",),
        at_most_twice,
        _halved_override,
        _KINEMATIC,
        needs=_has_exact_stops,
    ),
    Law(
        "exact stops",
        "a program without its approximations takes no less time",
        ("BLD-12",),
        no_sooner,
        _stopped,
        _KINEMATIC,
        needs=_is_timeless,
    ),
    Law(
        "LIN in two halves",
        "a stop at the middle of a line leaves the line as it is",
        ("MOT-04",),
        same_geometry,
        _halved,
        _KINEMATIC,
        needs=_has_exact_stops,
    ),
    Law(
        "batches",
        "motions executed in batches go the same way and switch the same outputs, at other times",
        ("ADV-01", "BLD-09"),
        _unless_blends_fail(same_outputs),
        None,
        _KINEMATIC,
        Run(robot="kinematic", motion="batch"),
        needs=_is_for_batches,
    ),
)
