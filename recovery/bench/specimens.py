"""Specimens of the mutation bench: programs that the whole grammar reads, and mutants of it."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.bench.assessment import BenchMaterial, covering
from recovery.bench.mutation import Mutant, combined, mutants
from recovery.negatives.negatives import Negative
from support.files.discovery import source_files


def material_for(
    grammar: Grammar, roots: Sequence[Path], negatives: Sequence[Negative], seed: int
) -> BenchMaterial:
    """Programs below ``roots``, half of them shown to the tool and half held out.

    Programs that the grammar does not read are left out. The shortest programs through every part
    of the grammar are shown too, so that every part is used. Raises
    `support.files.discovery.IngestError`.
    """
    recognizer = Recognizer(grammar)
    programs = [file.text for file in source_files(roots) if recognizer.accepts(file.text)]
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
