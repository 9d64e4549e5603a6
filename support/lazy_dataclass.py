"""Dataclasses whose generated code is compiled when the first instance is made.

`dataclasses.dataclass` compiles up to seven functions for each class, which was a third of the
start of a command: most of the classes that it loads it never makes. Here ``__init__`` is compiled
at its first call, and the other methods are closures that need no compiling. Nothing else differs,
but that ``__init__`` has no signature of its own before.
"""

import dataclasses
from collections.abc import Callable
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NoReturn

__all__ = ["dataclass"]

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls=None, /, *, frozen=False, eq=True, slots=False):
        """A class as a dataclass; other options are not needed so far."""
        if cls is None:
            return partial(dataclass, frozen=frozen, eq=eq, slots=slots)
        own = frozenset(vars(cls))
        made = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots)(cls)
        added = {"__init__": _init_of(made, frozen), "__repr__": _repr}
        if frozen:
            added |= {"__setattr__": _set, "__delattr__": _delete}
        if frozen and slots:
            added |= {"__getstate__": _state, "__setstate__": _restore}
        if eq:
            added |= _comparison(made, frozen)
        for name, method in added.items():
            if name not in own:
                setattr(made, name, method)
        return made


def _init_of(cls: Any, frozen: bool) -> Callable[..., None]:
    def initialise(self: Any, *values: Any, **named: Any) -> None:
        cls.__init__ = _compiled_init(cls, frozen)
        cls.__init__(self, *values, **named)

    return initialise


def _compiled_init(cls: Any, frozen: bool) -> Callable[..., None]:
    known: dict[str, Any] = {"set_": object.__setattr__, "MISSING": dataclasses.MISSING}
    fields = [one for one in dataclasses.fields(cls) if one.init]
    heads, lines = ["self_"], []
    for one in sorted(fields, key=lambda one: bool(one.kw_only)):
        name = value = head = one.name
        if one.default is not dataclasses.MISSING:
            known[f"{name}_default"] = one.default
            head = f"{name}={name}_default"
        elif one.default_factory is not dataclasses.MISSING:
            known[f"{name}_factory"] = one.default_factory
            head = f"{name}=MISSING"
            value = f"{name}_factory() if {name} is MISSING else {name}"
        heads += ["*", head] if one.kw_only and "*" not in heads else [head]
        lines.append(f"set_(self_, {name!r}, {value})" if frozen else f"self_.{name} = {value}")
    if hasattr(cls, "__post_init__"):
        lines.append("self_.__post_init__()")
    exec(f"def __init__({', '.join(heads)}):\n " + "\n ".join(lines or ["pass"]), known)
    init: Callable[..., None] = known["__init__"]
    return init


def _comparison(cls: Any, frozen: bool) -> dict[str, Callable[..., Any] | None]:
    names = [one.name for one in dataclasses.fields(cls) if one.compare]
    values: Callable[[Any], tuple[Any, ...]] = (
        attrgetter(*names)
        if len(names) > 1
        else lambda one: tuple(getattr(one, name) for name in names)
    )

    def equals(self: Any, other: object) -> object:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return values(self) == values(other)

    def hashed(self: Any) -> int:
        return hash(values(self))

    return {"__eq__": equals, "__hash__": hashed if frozen else None}


def _repr(self: Any) -> str:
    shown = (
        f"{one.name}={getattr(self, one.name)!r}" for one in dataclasses.fields(self) if one.repr
    )
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _state(self: Any) -> list[Any]:
    return [getattr(self, one.name) for one in dataclasses.fields(self)]


def _restore(self: Any, state: list[Any]) -> None:
    for one, value in zip(dataclasses.fields(self), state, strict=True):
        object.__setattr__(self, one.name, value)


def _set(_self: object, name: str, _value: object) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")


def _delete(_self: object, name: str) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
