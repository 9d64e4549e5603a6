"""Statements that only make a request, in one table for all executors.

Each part of the statement is evaluated in turn. The results are the fields of the request after
``at``.
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
    """A field of a statement node.

    An expression is converted to ``type``, INT or REAL. ``type`` is ``None`` for a plain word.
    """

    field: str
    type: Type | None = None


@dataclass(frozen=True, slots=True)
class StatementRequest:
    """The class of a request, and the parts of the statement that are its fields after ``at``."""

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
