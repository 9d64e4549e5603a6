"""Addresses of alternatives and elements in a rule, stable enough to be stored in a file.

An address is a tuple of numbers from 1. They name in turn an alternative and an element of it.
``(2, 3)`` is the third element of the second alternative. If that element is a group, with or
without a suffix, ``(2, 3, 1, 4)`` is the fourth element of the group's first alternative. The
number of the last element plus one stands for the end of the sequence.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.notation.model import Alternative, Element, GrammarError, Group, Repeat, Rule

Address = tuple[int, ...]


def spelled(at: Address) -> str:
    """Return an address as people write it: ``1.2`` for ``(1, 2)``."""
    return ".".join(map(str, at))


def _group_of(element: Element) -> Group | None:
    if isinstance(element, Repeat):
        element = element.item
    return element if isinstance(element, Group) else None


def sequence_at(rule: Rule, address: Address) -> Alternative:
    """Return the alternative at an address, whose length is odd.

    Raises `GrammarError` if the rule has no such alternative.
    """
    alternatives: tuple[Alternative, ...] = rule.alternatives
    for place, number in enumerate(address):
        if place % 2 == 0:
            if not 1 <= number <= len(alternatives):
                break
            sequence = alternatives[number - 1]
        else:
            inside = sequence.elements[number - 1 : number] if number > 0 else ()
            group = _group_of(inside[0]) if inside else None
            if group is None:
                break
            alternatives = group.alternatives
    else:
        if len(address) % 2:
            return sequence
    raise GrammarError(f"rule {rule.name} has no place {spelled(address) or 'without a number'}")


def element_at(rule: Rule, address: Address) -> Element:
    """Return the element at an address; raises `GrammarError` if there is none."""
    elements = sequence_at(rule, address[:-1]).elements
    if not 1 <= address[-1] <= len(elements):
        raise GrammarError(f"rule {rule.name} has no place {spelled(address)}")
    return elements[address[-1] - 1]


def sequences(rule: Rule) -> Iterator[tuple[Address, Alternative]]:
    """Yield every alternative of a rule and of the groups in it, with its address."""

    def within(
        alternatives: tuple[Alternative, ...], address: Address
    ) -> Iterator[tuple[Address, Alternative]]:
        for number, alternative in enumerate(alternatives, 1):
            here = (*address, number)
            yield here, alternative
            for place, element in enumerate(alternative.elements, 1):
                group = _group_of(element)
                if group is not None:
                    yield from within(group.alternatives, (*here, place))

    yield from within(rule.alternatives, ())
