"""Statements and items of spline blocks that only make a request, in one table for all executors.

Each part of the statement is evaluated in turn. The results are the fields of the request after
``at``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from grammar.semantics.types import INT, REAL, Type
from grammar.syntax import ast
from interp.port import requests
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Fixed:
    """A value that is the same for all statements of a kind."""

    value: str | bool | None


@dataclass(frozen=True, slots=True)
class Part:
    """A field of a statement node, and what becomes of it.

    An expression is converted to INT or REAL, or is a ``text``; one that is omitted is ``None``. A
    ``condition`` or an ``action`` is passed as a handle. An action that is an ``output`` is passed
    as its path and value, any other as ``None``. The ``signal`` is what `signal_name` returns.
    """

    field: str
    kind: Type | Literal["text", "condition", "action", "output", "signal"]


@dataclass(frozen=True, slots=True)
class StatementRequest:
    """The class of a request, and the fields after ``at``; a name is a field of the statement."""

    request: type[requests.Request | requests.SplineItem]
    parts: tuple[str | Part | Fixed, ...] = ()


_NOTHING = Fixed(None)
STATEMENT_REQUESTS: Mapping[type[Any], StatementRequest] = {
    ast.Brake: StatementRequest(requests.BrakeArm, ("mode",)),
    ast.Confirm: StatementRequest(requests.Confirm, (Part("number", INT),)),
    ast.Continue: StatementRequest(requests.Continue),
    ast.EmilyMotion: StatementRequest(
        requests.MoveEmily, (Part("device", "text"), Part("action", "text"), Part("number", REAL))
    ),
    ast.Halt: StatementRequest(requests.Halt),
    ast.InterruptDeclaration: StatementRequest(
        requests.DeclareInterrupt,
        (
            Part("number", INT),
            "is_global",
            Part("condition", "condition"),
            Part("action", "action"),
        ),
    ),
    ast.InterruptSwitch: StatementRequest(
        requests.SwitchInterrupt, ("action", Part("number", INT))
    ),
    ast.OnErrorProceed: StatementRequest(requests.EmptyError),
    ast.Resume: StatementRequest(requests.Resume),
    ast.SignalOff: StatementRequest(
        requests.SwitchSignal,
        ("keyword", Fixed(False), Part("variable", "signal"), *[_NOTHING] * 4),
    ),
    ast.SignalOn: StatementRequest(
        requests.SwitchSignal,
        (
            *("keyword", Fixed(True), Part("assignment", "signal"), Part("assignment", "action")),
            *(Part("delay", REAL), Part("minimum", REAL), Part("maximum", REAL)),
        ),
    ),
    ast.Trigger: StatementRequest(
        requests.SetTrigger,
        (
            *("place_kind", Part("place", REAL), "on_start", Part("delay", REAL)),
            *(Part("action", "action"), Part("action", "output"), Part("priority", INT)),
        ),
    ),
    ast.WaitSeconds: StatementRequest(requests.Wait, (Part("duration", REAL),)),
    # items of spline blocks
    ast.ConstantVelocity: StatementRequest(
        requests.SplineRange, (Fixed("CONST_VEL"), "edge", Part("place", REAL), "on_start")
    ),
    ast.StopWhen: StatementRequest(
        requests.SplineStop, (Part("place", REAL), "on_start", Part("condition", "condition"))
    ),
    ast.TimeBlock: StatementRequest(
        requests.SplineRange, (Fixed("TIME_BLOCK"), "edge", Part("value", REAL), Fixed(False))
    ),
}
