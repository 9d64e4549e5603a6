"""A law: a change of a program, or of its run, that must not be observable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from conformance.metamorphic.comparison import Compare
from conformance.metamorphic.subject import Program, Run

#: Returns a changed program, optionally with its own comparison; ``None`` if the law does not
#: apply to the program.
Change = Callable[[Program, Random], "Program | tuple[Program, Compare] | None"]


@dataclass(frozen=True, slots=True)
class Law:
    """A law.

    ``states`` is the law in words, ``rules`` the rules of KRL on which it rests. ``change`` returns
    the changed program; without it the program stays the same and is run as ``other`` says. With
    ``is_of_text``, the change is one of the source text and not of syntax trees. ``usual`` says how
    both programs are run, and ``needs`` to which programs the law applies.
    """

    name: str
    states: str
    rules: tuple[str, ...]
    compare: Compare
    change: Change | None = None
    usual: Run = Run()  # noqa: RUF009 - frozen
    other: Run | None = None
    is_of_text: bool = False
    needs: Callable[[Program], bool] = lambda _program: True


@dataclass(frozen=True, slots=True)
class Attempt:
    """The result of a law on a program; ``difference`` is empty if the law held."""

    law: str
    program: str
    difference: str
    changed: tuple[tuple[str, str], ...] = ()


def run_law(law: Law, program: Program, seed: int = 0) -> Attempt | None:
    """Try a law on a program; return ``None`` if it does not apply."""
    if program.modules is None or not law.needs(program):
        return None
    before = program if law.is_of_text or law.change is None else program.plain
    after, compare = before, law.compare
    if law.change is not None:
        if program.knows_lines:
            return None
        found = law.change(before, Random(f"{seed}/{law.name}/{program.name}"))
        if found is None:
            return None
        after, compare = found if isinstance(found, tuple) else (found, law.compare)
    left = before.run(law.usual)
    if left.ending == "crash":
        return None
    difference = compare(left, after.run(law.other or law.usual))
    texts = tuple((one.path, one.text) for one in after.case.sources) if difference else ()
    return Attempt(law.name, program.name, difference, texts)
