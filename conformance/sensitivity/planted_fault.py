"""A planted fault: its description, where it should be noticed, and how it is planted.

Faults are planted into the running process: an attribute of a class or module is replaced for as
long as a case runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Any

#: Plants a fault for as long as the context lasts.
Plant = Callable[[], AbstractContextManager[None]]
#: Makes what is planted from what was there: the function as its class has it, or a value.
Make = Callable[[Any], Any]


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault that can be planted.

    ``suites`` are those that have to find it, all of them where it is empty. ``robot`` is the one
    cases run on.
    """

    group: str
    words: str
    suites: tuple[str, ...]
    plant: Plant
    robot: str = "kinematic"


def group_of(name: str, rows: Iterable[tuple[str, tuple[str, ...], Plant]]) -> tuple[Fault, ...]:
    """The faults of a group: words, suites, plant of each."""
    return tuple(Fault(name, words, suites, plant) for words, suites, plant in rows)


def group_in(
    name: str, suites: tuple[str, ...], rows: Iterable[tuple[str, Plant]]
) -> tuple[Fault, ...]:
    """The faults of a group that the same suites have to find: words, plant of each."""
    return tuple(Fault(name, words, suites, plant) for words, plant in rows)


def on(owner: Any, name: str, make: Make) -> Plant:
    """Replace an attribute of a class or module; it has to be one of its own."""
    before = vars(owner)[name]

    @contextmanager
    def planted() -> Iterator[None]:
        setattr(owner, name, make(before))
        try:
            yield
        finally:
            setattr(owner, name, before)

    return planted


def constant(owner: Any, name: str, value: Any) -> Plant:
    """Give an attribute another value."""
    return on(owner, name, lambda _before: value)


def several(*plants: Plant) -> Plant:
    """Plant all of them: one fault that shows in several places."""

    @contextmanager
    def planted() -> Iterator[None]:
        if not plants:
            yield
            return
        with plants[0](), several(*plants[1:])():
            yield

    return planted
