"""Specimens of the mutation bench: programs that the whole grammar reads, and mutants of it."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.bench.assessment import BenchMaterial, covering
from recovery.bench.mutation import Mutant, combined, mutants
from recovery.bench.resampling import readable
from recovery.negatives.negatives import Negative
from support.files.decode import decode
from support.files.discovery import Skipped, discover, read


def material_for(
    grammar: Grammar, roots: Sequence[Path], negatives: Sequence[Negative], seed: int
) -> BenchMaterial:
    """Programs below ``roots``, half of them shown to the tool and half held out.

    Where the grammar cannot read a line, a line of the corpus that it can read in that place takes
    its stead (`recovery.bench.resampling.readable`): the grammar of the day need not be finished.
    Shown are also the shortest programs through every part of the grammar, so that every part is
    used. Raises `support.files.discovery.IngestError`.
    """
    texts = []
    for found in discover(roots):
        data = found if isinstance(found, Skipped) else read(found)
        source = None if isinstance(data, Skipped) else decode(data)
        if source is not None and not isinstance(source, str):
            texts.append(source.text)
    programs = list(readable(texts, Recognizer(grammar)))
    random.Random(seed).shuffle(programs)
    shown = [*programs[::2], *covering(grammar)]
    return BenchMaterial(
        grammar,
        tuple((f"program {number}", text) for number, text in enumerate(shown, 1)),
        tuple(programs[1::2]),
        tuple(negatives),
    )


def choose_mutants(grammar: Grammar, singles: int, multiple: int, seed: int) -> list[Mutant]:
    """All single mutants, or ``singles`` of them drawn, and ``multiple`` with several parts out."""
    every = list(mutants(grammar))
    drawn = every
    if singles and singles < len(every):
        drawn = random.Random(seed).sample(every, singles)
    return drawn + combined(every, grammar, multiple, seed)
