"""Control flow of a routine: EXIT, GOTO and labels, its end, unreachable statements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from grammar.check.analysis.context import Context, PlacedStatement, RoutineBody
from grammar.check.analysis.control_flow_graph import FlowNode, flow_graph
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.diagnostics.did_you_mean import did_you_mean, one_of
from grammar.diagnostics.typos import Series, Typos
from grammar.semantics.error_suppression import suppressions
from grammar.syntax import ast

# Guessing costs time for each label, and one who has so many wrong has something else in mind.
_MOST_GUESSES = 20
_LOOPS = frozenset({ast.For, ast.While, ast.Repeat, ast.Loop})


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about the control flow of all routines of a file."""
    labels = [_labels(routine) for routine in context.routines]
    homes: dict[str, list[str]] = {}
    for routine, own in zip(context.routines, labels, strict=True):
        for key in own:
            homes.setdefault(key, []).append(routine.node.name.text)
    for routine, own in zip(context.routines, labels, strict=True):
        yield from _exits(context, routine)
        yield from _label_twice(context, own)
        yield from _gotos(context, routine, own, homes)
        yield from _end(context, routine)
        yield from _never_reached(context, routine)
        yield from _not_suppressed(context, routine)


# ------------------------------------------------------------------------------------------- EXIT


def _exits(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    for placed in routine.statements:
        statement = placed.statement
        if type(statement) is ast.Exit and not any(
            type(one.statement) in _LOOPS for one in placed.around
        ):
            reason = ""
            if placed.inside is not None:
                block = "SWITCH" if isinstance(placed.inside.statement, ast.Switch) else "IF"
                reason = f"{block} is not a loop"
            yield context.finding(
                "exit-outside-loop",
                statement,
                "EXIT outside a loop",
                reason=reason,
            )


# ------------------------------------------------------------------------------- GOTO and labels

_Labels = dict[str, list[PlacedStatement]]


def _labels(routine: RoutineBody) -> _Labels:
    found: _Labels = {}
    for placed in routine.statements:
        if isinstance(placed.statement, ast.Label):
            found.setdefault(placed.statement.name.key, []).append(placed)
    return found


def _label_twice(context: Context, own: _Labels) -> Iterator[Diagnostic]:
    for first, *others in own.values():
        line = context.line(first.statement)
        for other in others:
            assert isinstance(other.statement, ast.Label)
            message = f"label {other.statement.name.text} stands on line {line} already"
            yield context.finding("label-twice", other.statement.name, message)


def _gotos(
    context: Context, routine: RoutineBody, own: _Labels, homes: Mapping[str, Sequence[str]]
) -> Iterator[Diagnostic]:
    """Yield jumps that lead nowhere or into a block; ``homes`` has the routines of each label."""
    guesses = _MOST_GUESSES
    slips = {} if context.is_cut(routine) else _slipped(context, routine, own, homes)
    for wanted, name in slips.items():
        message = f"no GOTO leads to {name.text}, and there is no label {wanted}"
        yield context.finding("unknown-label", name, message, fix=one_of([wanted]))
    for placed in routine.statements:
        goto = placed.statement
        if not isinstance(goto, ast.Goto):
            continue
        targets = own.get(goto.label.key)
        if targets is None and (context.is_cut(routine) or goto.label.key in slips):
            continue
        if targets is None:
            all_ = (one.statement for one in routine.statements)
            labels = (one.name.text for one in all_ if isinstance(one, ast.Label))
            guess = did_you_mean(goto.label.text, labels) if guesses > 0 else None
            guesses -= 1
            home = homes.get(goto.label.key, ("",))[0]
            yield context.finding(
                "unknown-label",
                goto.label,
                f"{routine.node.name.text} has no label {goto.label.text}",
                reason=f"it is in {home}, another routine" if home else "",
                fix=guess,
            )
            continue
        block = targets[0].inside
        if block is not None and not _holds(block.statement, goto):
            line = context.line(targets[0].statement)
            kind = _BLOCKS.get(type(block.statement), "a block")
            message = f"GOTO into {kind}, to {goto.label.text} on line {line}"
            yield context.finding("goto-into-block", goto, message)


def _slipped(
    context: Context, routine: RoutineBody, own: _Labels, homes: Mapping[str, Sequence[str]]
) -> dict[str, ast.Name]:
    """Return the unused labels by the key of the only missing label that is a slip away.

    A label that several routines have is not a slip.
    """
    if context.module.words:  # what cannot be read may lead there
        return {}
    all_ = (one.statement for one in routine.statements)
    wanted = Counter(one.label.key for one in all_ if isinstance(one, ast.Goto))
    alone = (key for key in own if key not in wanted and len(homes[key]) == 1)
    near = Typos(alone, series=Series.NONE)
    found: dict[str, ast.Name] = {}
    for key in wanted:
        meant = near.meant(key) if key not in own else ()
        if len(meant) == 1 and (wanted[key] > 1 or context.spelling.is_likelier(key, meant[0])):
            label = own[meant[0]][0].statement
            assert isinstance(label, ast.Label)
            found[key] = label.name
    return found


def _holds(block: ast.Node, node: ast.Node) -> bool:
    return block.span[0] <= node.span[0] and node.span[1] <= block.span[1]


_BLOCKS: dict[type[ast.Node], str] = {
    ast.If: "an IF",
    ast.Switch: "a SWITCH",
    ast.For: "a FOR loop",
    ast.While: "a WHILE loop",
    ast.Repeat: "a REPEAT loop",
    ast.Loop: "a LOOP",
}


# ----------------------------------------------------------------------------- the end of a routine


def _end(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    if routine.node.result is None or context.is_cut(routine):
        return
    ways = flow_graph(routine.node, lambda switch: _is_exhaustive(context, switch))
    if ways.end in ways.reached():
        name = routine.node.name
        executed = (one.statement for one in routine.statements)
        kinds = {type(one) for one in executed if not isinstance(one, ast.Definition)}
        # The controller accepts it, and files that it is delivered with have it. A function without
        # any statement only says what it is called with.
        if not kinds or ast.Return in kinds or "RETURN" in (context.module.words or ()):
            message = f"{name.text} can reach ENDFCT without RETURN, and has no result then"
            yield context.finding("return-missing", name, message)
        else:
            message = f"{name.text} has no RETURN, so it never has a result"
            yield context.finding("return-missing", name, message, severity="warning")


def _is_exhaustive(context: Context, switch: ast.Switch) -> bool:
    """Return whether a SWITCH without DEFAULT may cover all possible values."""
    values = [value for branch in switch.branches for value in branch.values]
    if not all(isinstance(value, ast.EnumConstant) for value in values):
        return False
    known = {context.enumerations.get(v) for v in values if isinstance(v, ast.EnumConstant)}
    named = {v.name.key for v in values if isinstance(v, ast.EnumConstant)}
    for enumeration in known:
        if enumeration is not None and not enumeration.is_open:
            return {constant.upper() for constant in enumeration.constants} <= named
    return True


#: Behind all other statements the next one comes, or one in a block of theirs.
_LEAVING = frozenset({ast.Goto, ast.Return, ast.Exit, *_LOOPS})


def _never_reached(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    if not any(type(placed.statement) in _LEAVING for placed in routine.statements):
        return
    reached = routine.reached
    for step, before, inside in routine.ways.steps:
        if step in reached or isinstance(step.statement, ast.Label | ast.Definition):
            continue
        if (inside is None or inside in reached) and (before is None or before in reached):
            yield _unreachable(context, step, before)


def _unreachable(context: Context, step: FlowNode, before: FlowNode | None) -> Diagnostic:
    assert step.statement is not None
    assert before is not None, "the first statement of a block that is reached is reached"
    assert before.statement is not None
    line = context.line(before.statement)
    message = f"this is never reached: the program does not continue after line {line}"
    return context.finding("unreachable", context.head(step.statement), message)


# --------------------------------------------------------------------------- ON_ERROR_PROCEED


def _not_suppressed(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    statements = (placed.statement for placed in routine.statements)
    for node, _, following, has_effect in suppressions(statements, context.line):
        if has_effect:
            continue
        reason = "nothing on the next line can fail"
        if following is not None:
            word = context.source.text[slice(*following.span)].split()[0].upper()
            reason = f"it does not apply to {word}"
        yield context.finding(
            "proceed-lost",
            node,
            "ON_ERROR_PROCEED has no effect",
            reason=reason,
        )
