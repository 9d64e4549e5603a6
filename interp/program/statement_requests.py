"""Statements that only make a request: which one, and what it holds.

Both executors execute these statements by this table: each part is evaluated in turn, and is a
field of the request behind ``at``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from grammar.semantics.types import INT, REAL, Type
from grammar.syntax import ast
from interp.port import requests
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Part:
    """A field of a node; an expression has the INT or REAL that it is converted to, a word none."""

    field: str
    type: Type | None = None


@dataclass(frozen=True, slots=True)
class StatementRequest:
    """The class of a request, and the parts of the node that are its fields behind ``at``."""

    request: type[requests.Request]
    parts: tuple[Part, ...] = ()


STATEMENT_REQUESTS: Mapping[type[Any], StatementRequest] = {
    ast.Brake: StatementRequest(requests.BrakeArm, (Part("mode"),)),
    ast.Confirm: StatementRequest(requests.Confirm, (Part("number", INT),)),
    ast.Continue: StatementRequest(requests.Continue),
    ast.Halt: StatementRequest(requests.Halt),
    ast.Resume: StatementRequest(requests.Resume),
    ast.WaitSeconds: StatementRequest(requests.Wait, (Part("duration", REAL),)),
}
