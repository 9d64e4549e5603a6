"""Variables as trees whose nodes the protocol refers to by numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Final

from grammar.semantics.types import CHAR
from interp.controller.state.trace import TaskName
from interp.debugging.debugger import Debugger
from interp.debugging.value_text import value_text
from interp.values.faults import RuntimeFailure
from interp.values.values import ArrayValue, StructureValue, Value
from krl.debug_adapter.connection import Json

#: The variables in the scope ``System``.
_SYSTEM: Final = (
    *("$POS_ACT", "$AXIS_ACT", "$VEL_ACT", "$TOOL", "$BASE", "$IPO_MODE", "$OV_PRO", "$ADVANCE"),
    *("$MODE_OP", "$PRO_STATE1", "$STOPMESS", "$ROB_TIMER", "$ERR"),
)
_SCOPES: Final = {
    "local": "Locals",
    "data": "Data list",
    "config": "$config",
    "others": "Other global data",
    "signals": "Signals",
}
_LARGE: Final = 100


@dataclass(frozen=True, slots=True)
class _Node:
    """An expandable node: names of a frame, or the parts of the variable ``text``."""

    task: TaskName
    frame: int
    names: tuple[str, ...] = ()
    text: str = ""
    value: StructureValue | ArrayValue | None = None


class Variables:
    """The variables at a stop; their numbers are valid until the program continues."""

    def __init__(self, debugger: Debugger) -> None:
        self._debugger = debugger
        self._nodes: list[_Node] = []

    def scopes(self, task: TaskName, frame: int) -> list[Json]:
        """Return the groups of variables that are visible in a frame, without empty ones."""
        names = self._debugger.names(task, frame)
        groups = [(title, tuple(getattr(names, group))) for group, title in _SCOPES.items()]
        groups.append(("System", _SYSTEM))
        return [
            {
                "name": title,
                "variablesReference": self._kept(_Node(task, frame, found)),
                "namedVariables": len(found),
                "expensive": title != "Locals",
                **({"presentationHint": "locals"} if title == "Locals" else {}),
            }
            for title, found in groups
            if found
        ]

    def children(self, reference: int, start: int = 0, count: int = 0) -> list[Json]:
        """Return ``count`` variables or parts of a node from ``start`` on; 0 means all."""
        node = self._node(reference)
        end = start + count if count else None
        if isinstance(node.value, ArrayValue):
            sizes = node.value.sizes
            places = islice(product(*(range(1, size + 1) for size in sizes)), start, end)
            return [
                self._variable(node, f"[{','.join(map(str, place))}]", node.value.get(*place))
                for place in places
            ]
        if isinstance(node.value, StructureValue):
            members = zip(node.value.type.members, node.value.members, strict=True)
            return [
                self._variable(node, one.name, value) for one, value in islice(members, start, end)
            ]
        return [self._named(node, name) for name in node.names[start:end]]

    def assign(self, reference: int, name: str, value: str) -> Json:
        """Assign a value to a variable of a node; raises `RuntimeFailure`."""
        node = self._node(reference)
        text = _path(node, name)
        self._debugger.assign(text, value, node.task, node.frame)
        return self.shown(text, node.task, node.frame)

    def path(self, reference: int, name: str) -> tuple[str, TaskName, int]:
        """Return the expression for a variable of a node, with its task and frame."""
        node = self._node(reference)
        return _path(node, name), node.task, node.frame

    def shown(self, text: str, task: TaskName, frame: int) -> Json:
        """Return the value of an expression, expandable if it has parts."""
        return self._value(_Node(task, frame), text, self._debugger.look(text, task, frame))

    def _named(self, node: _Node, name: str) -> Json:
        try:
            value = self._debugger.look(name, node.task, node.frame)
        except RuntimeFailure as error:
            return {"name": name, "value": f"({error})", "variablesReference": 0}
        return self._variable(node, name, value)

    def _variable(self, node: _Node, name: str, value: Value | None) -> Json:
        text = _path(node, name)
        found = self._value(node, text, value)
        return {"name": name, "value": found.pop("result"), "evaluateName": text, **found}

    def _value(self, node: _Node, text: str, value: Value | None) -> Json:
        found: Json = {"result": value_text(value), "variablesReference": 0}
        if isinstance(value, StructureValue | ArrayValue):
            found["type"] = str(value.type)
            made = _Node(node.task, node.frame, text=text, value=value)
            found["variablesReference"] = self._kept(made)
        if isinstance(value, ArrayValue) and value.type.element != CHAR and len(value) > _LARGE:
            found["indexedVariables"] = len(value)
        return found

    def _kept(self, node: _Node) -> int:
        self._nodes.append(node)
        return len(self._nodes)

    def _node(self, reference: int) -> _Node:
        nodes: Sequence[_Node] = self._nodes
        if not 1 <= reference <= len(nodes):
            raise IndexError(f"there are no variables {reference}")
        return nodes[reference - 1]


def _path(node: _Node, name: str) -> str:
    """Return the expression for a part of a node."""
    if not node.text:
        return name
    return f"{node.text}{name}" if name.startswith("[") else f"{node.text}.{name}"
