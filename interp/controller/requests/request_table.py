"""The dispatch table of requests: which handler answers which type of request."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from interp.controller.state.tasks import Answer, Task
from interp.port.requests import Request
from interp.values.faults import Fault

_Request = TypeVar("_Request", bound=Request)


class RequestTable:
    """Handlers of requests, by the type of the request."""

    def __init__(self) -> None:
        self._handlers: dict[type[object], Callable[[Task, Any], Answer]] = {}

    def add(self, kind: type[_Request], handler: Callable[[Task, _Request], Answer]) -> None:
        """Register the handler of a type of requests; it may raise `Fault`."""
        self._handlers[kind] = handler

    def answer(self, task: Task, request: Request) -> Answer:
        """Return the answer of the handler; a `Fault` that it raises is returned as the answer."""
        try:
            return self._handlers[type(request)](task, request)
        except Fault as error:
            return error
