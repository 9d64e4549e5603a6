"""Dataclasses whose generated methods are compiled at their first call.

`dataclasses.dataclass` compiles up to seven functions for each class, which was a third of the
start-up time of a command, although most of the loaded classes are never instantiated. The only
other difference is that ``__init__`` has no signature of its own before its first call. A class may
only inherit from classes made here, or from classes that are no dataclasses.
"""

import dataclasses
from collections.abc import Callable
from functools import cache, partial
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar, dataclass_transform

__all__ = ["dataclass", "node"]

_Class = TypeVar("_Class")

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls=None, /, *, frozen=False, eq=True, slots=False, **options):
        """A class as a dataclass, with ``order`` and ``repr`` too; only orders are no later."""
        if cls is None:
            return partial(dataclass, frozen=frozen, eq=eq, slots=slots, **options)
        own = frozenset(vars(cls))
        order = options.get("order", False)
        made = dataclasses.dataclass(init=False, repr=False, eq=order, order=order, slots=slots)(
            cls
        )
        init = _frozen_init if frozen else _init
        added = {"__init__": _late(made, "__init__", init)}
        if options.get("repr", True):
            added["__repr__"] = _repr
        if eq:
            added["__eq__"] = _late(made, "__eq__", _eq)
            added["__hash__"] = _late(made, "__hash__", _hash) if frozen else None
        if frozen:
            added |= {"__setattr__": _set, "__delattr__": _delete}
        if frozen and slots:
            added |= _state(made)
        for name, method in added.items():
            if name not in own:
                setattr(made, name, method)
        return made


@dataclass_transform(eq_default=False, frozen_default=True)
def node(kind: type[_Class]) -> type[_Class]:
    """Return a class whose instances compare by identity and are frozen for type checkers only.

    It is meant for objects that are created by the thousand, such as tree nodes: a dataclass that
    is frozen at run time takes three times as long to create.
    """
    return dataclass(slots=True, eq=False)(kind)


def _late(cls: Any, name: str, text_of: Callable[[Any], tuple[str, dict[str, Any]]]) -> Any:
    """Return a method that, at its first call, replaces itself by the compiled text."""

    def method(self: Any, *values: Any, **named: Any) -> Any:
        text, known = text_of(cls)
        exec(text, known)
        known[name].__qualname__ = f"{cls.__qualname__}.{name}"
        setattr(cls, name, known[name])
        return known[name](self, *values, **named)

    return method


def _frozen_init(cls: Any) -> tuple[str, dict[str, Any]]:
    return _init(cls, "set_(self_, {0!r}, {1})")


def _init(cls: Any, assignment: str = "self_.{0} = {1}") -> tuple[str, dict[str, Any]]:
    known: dict[str, Any] = {"set_": object.__setattr__, "MISSING": dataclasses.MISSING}
    heads, lines = ["self_"], []
    for one in sorted(dataclasses.fields(cls), key=lambda one: bool(one.kw_only)):
        name = value = head = one.name
        default = f"{name}_default"
        if one.default is not dataclasses.MISSING:
            known[default] = one.default
            head = f"{name}={default}"
        elif one.default_factory is not dataclasses.MISSING:
            known[default] = one.default_factory
            default += "()"
            head, value = f"{name}=MISSING", f"{default} if {name} is MISSING else {name}"
        elif not one.init:
            continue
        if one.init:
            heads += ["*", head] if one.kw_only and "*" not in heads else [head]
        else:
            value = default
        lines.append(assignment.format(name, value))
    if hasattr(cls, "__post_init__"):
        lines.append("self_.__post_init__()")
    return f"def __init__({', '.join(heads)}):\n " + "\n ".join(lines or ["pass"]), known


def _compared(cls: Any, name: str) -> str:
    return "".join(f"{name}.{one.name}, " for one in dataclasses.fields(cls) if one.compare)


def _hashed(cls: Any) -> str:
    fields = dataclasses.fields(cls)
    hashed = (one.name for one in fields if (one.compare if one.hash is None else one.hash))
    return "".join(f"self.{name}, " for name in hashed)


def _eq(cls: Any) -> tuple[str, dict[str, Any]]:
    mine, others = _compared(cls, "self"), _compared(cls, "other")
    is_same = "other.__class__ is self.__class__"
    value = f"({mine}) == ({others}) if {is_same} else NotImplemented"
    return f"def __eq__(self, other):\n return {value}", {}


def _hash(cls: Any) -> tuple[str, dict[str, Any]]:
    return f"def __hash__(self):\n return hash(({_hashed(cls)}))", {}


@cache
def _shown(cls: Any) -> tuple[str, ...]:
    return tuple(one.name for one in dataclasses.fields(cls) if one.repr)


@recursive_repr()
def _repr(self: Any) -> str:
    cls: Any = type(self)
    shown = (f"{name}={getattr(self, name)!r}" for name in _shown(cls))
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _state(cls: Any) -> dict[str, Callable[..., Any]]:
    names = [one.name for one in dataclasses.fields(cls)]

    def state(self: Any) -> list[Any]:
        return [getattr(self, name) for name in names]

    def restore(self: Any, values: list[Any]) -> None:
        for name, value in zip(names, values, strict=True):
            object.__setattr__(self, name, value)

    return {"__getstate__": state, "__setstate__": restore}


def _set(_self: object, name: str, _value: object) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")


def _delete(_self: object, name: str) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
