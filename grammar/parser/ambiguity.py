"""Ambiguity: does a text have two parse trees?

The recogniser follows all readings at once and keeps no record of how it reached a configuration.
Here the predecessors are kept, as in a graph-structured stack. If a configuration that leads to the
end has two of them, the text before it has two readings. Alternatives of one rule with the same
tokens count as one reading, because the rule's deterministic automaton merges them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import Recognizer, State

_MOST_NODES = 200_000

_Node = tuple[int, Configuration, bool]  # tokens read, configuration, whether a token was just read


def is_ambiguous(recognizer: Recognizer, state: State, kinds: Sequence[int]) -> bool:
    """Return whether the tokens, read from ``state``, have two readings with the same end.

    Returns ``False`` if the tokens cannot be read.
    """
    network = recognizer.network
    before: dict[_Node, set[_Node]] = defaultdict(set)
    # the tail is shared below each stack: copying it would cost the nesting depth for each line
    layer: set[_Node] = {
        (0, (position, state.tail.pushed(reversed(stack.positions()))), True)
        for position, stack in state.core.kernel
    }
    for index, kind in enumerate(kinds):
        reached: set[_Node] = set()
        seen = set(layer)
        todo = list(layer)
        while todo:
            node = todo.pop()
            _, (position, stack), _ = node
            following: list[_Node] = [
                (index, (entry, stack.push(back)), False) for entry, back in network.calls[position]
            ]
            if network.final[position] and stack.rest is not None:
                following.append((index, (stack.position, stack.rest), False))
            for other in following:
                before[other].add(node)
                if other not in seen:
                    seen.add(other)
                    todo.append(other)
            target = network.shifts[position].get(kind)
            if target is not None:
                shifted = (index + 1, (target, stack), True)
                before[shifted].add(node)
                reached.add(shifted)
        layer = reached
        if len(before) > _MOST_NODES:
            return True  # an unambiguous text never has so many nodes
    alive = set(layer)
    todo = list(layer)
    while todo:
        ways = before[todo.pop()]
        if len(ways) > 1:
            return True
        for node in ways - alive:
            alive.add(node)
            todo.append(node)
    return False
