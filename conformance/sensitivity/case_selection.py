"""Which cases are tried on a seeded fault, and in which order: those that may notice it soonest."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice, zip_longest
from operator import itemgetter
from typing import TYPE_CHECKING, Final, TypeAlias

from conformance.sensitivity.line_reach import Reach
from conformance.sensitivity.mutated_code import modules, text_of, tree_of

if TYPE_CHECKING:
    from conformance.sensitivity.mutants import Mutant
    from conformance.sensitivity.planted_faults import Fault

_RULE: Final = re.compile(r"\b[A-Z]{3}-\d\d\b")


#: A fault that cases should notice: a drawn mutant, or one that is planted by hand.
SeededFault: TypeAlias = "Mutant | Fault"


@dataclass(frozen=True, slots=True)
class Candidates:
    """The cases to try on a mutant; ``reached`` and ``sure`` as in `Trial`."""

    tried: tuple[Reach, ...]
    reached: int
    sure: int


def candidates(
    fault: SeededFault, reaches: Sequence[Reach], most: int, *, is_search: bool
) -> Candidates:
    """Return at most ``most`` cases that may fail and run its lines, and a tenth as many others.

    If fewer may fail there are more of the others, as executors that differ fail any case. First
    come cases of each line around it, those of the rarest lines first; then a case of each rule
    that the code there cites; then one of each set of lines run in its module, because cases with
    the same set mostly notice the same; then an even sample of the rest. A change of a search is
    tried on all cases that run it, as it is equivalent only if it changes none of their runs.
    """
    uses = uses_of(fault)
    reaching = [one for one in reaches if any(one.has(*lines) for lines in uses.items())]
    hard = [one for one in reaching if one.case.may_fail]
    tried = reaching
    if not is_search:
        soft = [one for one in reaching if not one.case.may_fail]
        room = max(most - len(hard), most // 10, 1)
        tried = [*_chosen(fault, hard, most), *_chosen(fault, soft, room)]
    # the lines are large, and no longer needed
    return Candidates(tuple(replace(one, lines={}) for one in tried), len(reaching), len(hard))


def _chosen(fault: SeededFault, cases: Sequence[Reach], most: int) -> Iterator[Reach]:
    """Return at most ``most`` of the cases."""
    chosen: dict[str, Reach] = {}
    for way in (_of_rarest(fault, cases), _of_rules(fault, cases), _of_ways(fault, cases)):
        new = (one for one in way if one.case.name not in chosen)
        chosen.update((one.case.name, one) for one in islice(new, most // 4))
    yield from chosen.values()
    left = [one for one in cases if one.case.name not in chosen]
    room = most - len(chosen)
    if room:
        yield from left[:: -(-len(left) // room) or 1]


def _of_rarest(fault: SeededFault, cases: Sequence[Reach]) -> Iterator[Reach]:
    """Yield for each line around a fault the first case that runs it, the rarest lines first."""
    near = around(fault)
    running_it: dict[tuple[str, int], list[Reach]] = {}
    for one in cases:
        for module, lines in near.items():
            for line in lines.intersection(one.lines.get(module, ())):
                running_it.setdefault((module, line), []).append(one)
    found: set[str] = set()
    for _, those in sorted(running_it.items(), key=lambda item: (len(item[1]), item[0])):
        if those[0].case.name not in found:
            found.add(those[0].case.name)
            yield those[0]


def _of_rules(fault: SeededFault, cases: Sequence[Reach]) -> Iterator[Reach]:
    """Yield a case of each rule that the code around a fault cites, the rarest first, then more."""
    wanted = cited(fault)
    stating: dict[str, list[Reach]] = {}
    for one in cases:
        for rule in wanted.intersection(one.case.rules):
            stating.setdefault(rule, []).append(one)
    rows = (those for _, those in sorted(stating.items(), key=lambda row: (len(row[1]), row[0])))
    return (one for turn in zip_longest(*rows) for one in turn if one is not None)


def _of_ways(fault: SeededFault, cases: Sequence[Reach]) -> list[Reach]:
    """Return one case of each set of lines run in the module of a fault, then a second of each."""
    turns: Counter[frozenset[int]] = Counter()
    found = []
    for one in cases:
        way = one.lines.get(fault.module, frozenset())
        turns[way] += 1
        found.append((turns[way], one))
    return [one for _, one in sorted(found, key=itemgetter(0))]


# --------------------------------------------------------------- the code around a fault


def uses_of(fault: SeededFault) -> Mapping[str, frozenset[int]]:
    """Return the lines of which a case has to run one to notice a fault, by module.

    Those of its statement, or where a module-level name was changed those that use this name.
    """
    if not fault.is_module_level:
        first, last = fault.lines
        return {fault.module: frozenset(range(first, last + 1))}
    importing = f"from {fault.module} import"
    return {
        module: frozenset(
            one.lineno
            for function in ast.walk(tree_of(module))
            if isinstance(function, ast.FunctionDef | ast.Lambda)
            for one in ast.walk(function)
            if isinstance(one, ast.Name) and one.id == fault.function
        )
        for module in modules()
        if module == fault.module or importing in text_of(module)
    }


def around(fault: SeededFault) -> Mapping[str, frozenset[int]]:
    """Return the lines of a fault's function, and of the functions and classes that it names."""
    first, last = sorted(map(abs, fault.lines))
    words = {fault.function.rpartition(".")[2]}
    for node in ast.walk(tree_of(fault.module)):
        if isinstance(node, ast.Name | ast.Attribute) and first <= node.lineno <= last:
            words.add(node.id if isinstance(node, ast.Name) else node.attr)
    found: dict[str, set[int]] = {}
    for module, name, lines in _functions_of_modules():
        if name in words:
            found.setdefault(module, set()).update(lines)
    return {module: frozenset(lines) for module, lines in found.items()}


def cited(fault: SeededFault) -> frozenset[str]:
    """Return the rules that a fault's function cites or its statement names, and modules."""
    found = set()
    for module, lines in around(fault).items():
        rows = text_of(module).splitlines()
        text = [ast.get_docstring(tree_of(module)) or "", *(rows[number - 1] for number in lines)]
        found.update(_RULE.findall("\n".join(text)))
    return frozenset(found)


@cache
def _functions_of_modules() -> Sequence[tuple[str, str, range]]:
    """Module, name and lines of each function and class."""
    return [
        (module, node.name, range(node.lineno, (node.end_lineno or node.lineno) + 1))
        for module in modules()
        for node in ast.walk(tree_of(module))
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    ]
