"""How well the survey repairs damaged grammars (`recovery.bench.damaged_grammars`)."""

from __future__ import annotations

import hashlib
import random
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from grammar.notation.addresses import Address
from grammar.notation.edits import (
    AddAlternative,
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    RemoveElement,
    Widen,
)
from grammar.notation.model import Grammar, referred
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from recovery.bench.damaged_grammars import DamagedGrammar
from recovery.clustering.cluster import Clusters, cluster
from recovery.clustering.edit_merging import combined_edits
from recovery.clustering.edit_trial import edited
from recovery.clustering.negative_score import negative_counter
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.reproducer.reduce import Reducer
from recovery.survey.result_cache import key_of
from recovery.survey.survey import survey_texts
from support.files.discovery import source_files
from support.files.result_store import ResultStore
from support.parallel.processes import process_pool
from support.parallel.progress import Progress, no_progress

_CLUSTERS_LOOKED_AT = 5
_PROPOSALS_LOOKED_AT = 5
# Failing texts by which the proposals of a cluster are compared: those that are left out are read
# in the end.
_TEXTS_COMPARED = 60


@dataclass(frozen=True, slots=True)
class Assessment:
    """How the tool did on one damaged grammar; see `assess` for what each field means."""

    damaged: DamagedGrammar
    detected: bool
    rule_rank: int | None
    item_rank: int | None
    repair_rank: int | None
    clusters: int
    false_accepts: int
    reproducer_tokens: tuple[int, ...]
    seconds: float


@dataclass(frozen=True)
class BenchMaterial:
    """What damaged grammars are assessed on.

    ``shown`` are programs (path, text) the tool sees, ``held_out`` texts it does not; all are read
    by ``grammar``. ``negatives`` are programs that no grammar may accept.
    """

    grammar: Grammar
    shown: tuple[tuple[str, str], ...]
    held_out: tuple[str, ...]
    negatives: tuple[Negative, ...]

    @cached_property
    def rejected(self) -> NegativeSet:
        """The negatives that the grammar rejects."""
        return NegativeSet(self.negatives).rejected_by(Recognizer(self.grammar))


def assess(damaged: DamagedGrammar, material: BenchMaterial) -> Assessment:
    """Survey the programs shown under the damaged grammar and see how the tool does.

    - detected: some program that the grammar reads fails, or the lost keyword is suspected
      (`recovery.survey.unreserved_keywords`) where it is read as a name.
    - rule_rank, item_rank: the first of the proposals of all clusters, taken in the order of the
      page, whose edit is in the right rule, or at the right place.
    - repair_rank: the first after which all of the programs can be read again, shown or held out.
      Where several parts are missing no one proposal does that: it is 1 if the best proposals of
      all clusters do so together; else the clusters are gone through in the order of the page, of
      each the proposal is taken (the first of equals among five) after which most of the failing
      texts can be read, of a cluster none whose lines can be read already, and the rank is that
      of the deepest proposal taken: so far down one has to look in each cluster.
    - false_accepts: negatives the best proposal accepts that the grammar rejects.
    - seconds: of processor time, for the survey and the search.
    """
    began = time.process_time()
    found = survey_texts(material.shown, damaged.grammar)
    failing = [f for f in found.files if f.failures]
    if not failing:
        noticed = any(one.word in damaged.keywords for one in found.unreserved)
        seconds = time.process_time() - began
        return Assessment(damaged, noticed, None, None, None, int(noticed), 0, (), seconds)
    texts_of = dict(material.shown)
    clusters = cluster(
        found,
        count_negatives=negative_counter(damaged.grammar, material.negatives),
        text_of=lambda file: texts_of[file.digest],
    )
    seconds = time.process_time() - began
    base = Recognizer(damaged.grammar)
    ordered = list(_proposals(clusters))
    reducer = Reducer(base)
    tokens = []
    for entry in clusters.ranked[:_CLUSTERS_LOOKED_AT]:
        reproducer = reducer.reduce(entry.line, entry.example.failed.words)
        if reproducer is not None:
            tokens.append(reproducer.beyond)
    texts = [*texts_of.values(), *material.held_out]
    best = edited(base, ordered[0]) if ordered else None
    return Assessment(
        damaged,
        True,
        _rank(ordered, lambda edits: _names(edits, damaged, material.grammar)),
        _rank(ordered, lambda edits: _same_place(edits, damaged)),
        _rank(ordered, lambda edits: _repairs(base, edits, texts))
        if damaged.parts == 1
        else _repaired_together(base, clusters, texts),
        len(clusters.ranked),
        0 if best is None else len(material.rejected.accepted(best)),
        tuple(tokens),
        seconds,
    )


def _proposals(clusters: Clusters) -> Iterator[tuple[Edit, ...]]:
    """Yield proposals in the order of the page."""
    for entry in clusters.ranked[:_CLUSTERS_LOOKED_AT]:
        for proposal in entry.proposals:
            yield proposal.edits


def _rank(
    ordered: Sequence[tuple[Edit, ...]], good: Callable[[Sequence[Edit]], bool]
) -> int | None:
    return next((i for i, edits in enumerate(ordered[:5], 1) if good(edits)), None)


def _names(edits: Sequence[Edit], damaged: DamagedGrammar, whole: Grammar) -> bool:
    """Return whether an edit is in a rule that lost something, or calls a rule that is lost."""
    rules = {getattr(e, "rule", "") for e in damaged.edits} | damaged.rules
    callers = {r.name for r in whole.parser_rules if not damaged.rules.isdisjoint(referred(r))}
    place = getattr(edits[-1], "rule", "")
    return place in rules or (damaged.kind in ("rule", "keyword") and place in callers)


def _same_place(edits: Sequence[Edit], damaged: DamagedGrammar) -> bool:
    """Return whether an edit is in the rule and at the place where something was removed.

    A removed alternative is replaced by an alternative of that rule, a removed part between the
    elements on both sides of it.
    """
    edit = edits[-1]
    for removed in damaged.edits:
        if isinstance(removed, RemoveAlternative):
            if isinstance(edit, AddAlternative | Widen | Insert | MakeOptional) and (
                edit.rule == removed.rule
            ):
                return True
        elif (
            isinstance(removed, RemoveElement)
            and isinstance(edit, Insert | Widen)
            and edit.rule == removed.rule
            and _adjacent(edit.at, removed.at)
        ):
            return True
    return False


def _adjacent(here: Address, there: Address) -> bool:
    """Return whether two places are in the same sequence with at most one element between them."""
    depth = len(there) - 1
    return (
        len(here) > depth and here[:depth] == there[:depth] and abs(here[depth] - there[depth]) <= 1
    )


def _repaired_together(base: Recognizer, clusters: Clusters, texts: Sequence[str]) -> int | None:
    """Return how far down one has to look in each cluster; see `assess`."""
    best = [entry.proposals[0].edits for entry in clusters.ranked if entry.proposals]
    if _reads_all(_with_all(base, best), texts):
        return 1
    chosen: list[tuple[Edit, ...]] = []
    deepest = 0
    wider = base
    failing = _telling([text for text in texts if not base.accepts(text)])
    for entry in clusters.ranked:
        failing = [text for text in failing if not wider.accepts(text)]
        if not failing:
            break
        options = []
        for depth, proposal in enumerate(entry.proposals[:_PROPOSALS_LOOKED_AT]):
            made = _with_all(base, [*chosen, proposal.edits])
            options.append((sum(map(made.accepts, failing)), -depth, made))
        if not options or not (most := max(options, key=lambda option: option[:2]))[0]:
            continue  # nothing that is still to be read is read by any of them
        wider = most[2]
        chosen.append(entry.proposals[-most[1]].edits)
        deepest = max(deepest, 1 - most[1])
    return deepest if deepest and _reads_all(wider, texts) else None


def _telling(texts: Sequence[str]) -> list[str]:
    """Return texts to tell edits apart by: the short ones, which have few causes each to fail."""
    return sorted(set(texts), key=lambda text: (len(text), text))[:_TEXTS_COMPARED]


def _with_all(base: Recognizer, several: Sequence[Sequence[Edit]]) -> Recognizer:
    """Return a recogniser with the edits of all, except those that conflict with earlier ones."""
    found, edits = base, tuple[Edit, ...]()
    for some in several:
        more = combined_edits(edits, some)
        wider = edited(base, more)
        if wider is not None:
            found, edits = wider, more
    return found


def _reads_all(recognizer: Recognizer, texts: Sequence[str]) -> bool:
    return all(map(recognizer.accepts, texts))


def _repairs(base: Recognizer, edits: Sequence[Edit], texts: Sequence[str]) -> bool:
    """Return whether every program can be read again."""
    wider = edited(base, edits)
    return wider is not None and _reads_all(wider, texts)


def covering(grammar: Grammar) -> list[str]:
    """Return the shortest programs through every alternative and optional part of all rules."""
    recognizer = Recognizer(grammar)
    sentences, speller = Sentences(grammar), Speller(grammar)
    texts = {
        speller.text(sentence)
        for rule in sentences.reachable
        for sentence in sentences.through(rule)
    }
    return sorted(text for text in texts if recognizer.accepts(text))


def material_for(
    grammar: Grammar, roots: Sequence[Path], negatives: Sequence[Negative], seed: int
) -> BenchMaterial:
    """Return programs below ``roots``, half of them shown to the tool and half held out.

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


def assess_all(
    material: BenchMaterial,
    chosen: Sequence[DamagedGrammar],
    *,
    jobs: int = 1,
    cache: Path | None = None,
    on_done: Progress = no_progress,
) -> dict[str, Any]:
    """Assess damaged grammars in ``jobs`` processes and gather the figures; see `assess`.

    Each assessment is kept in the folder ``cache``, so that a bench continues where it ended.
    """
    found: dict[int, Assessment] = {}
    with ResultStore(cache, f"damaged grammars {key_of(material.grammar)}") as store:
        given = _digest(material.shown, material.held_out, [n.text for n in material.negatives])
        keys = [_digest(given, damaged.edits) for damaged in chosen]
        for number, (damaged, key) in enumerate(zip(chosen, keys, strict=True)):
            kept = store.get_record(key)
            if kept is not None:
                tokens = tuple(kept.pop("reproducer_tokens"))
                found[number] = Assessment(damaged, reproducer_tokens=tokens, **kept)
        on_done(len(found))
        left = [number for number in range(len(chosen)) if number not in found]
        for number, assessment in zip(left, _assessed(material, chosen, left, jobs), strict=True):
            found[number] = assessment
            record = {f.name: getattr(assessment, f.name) for f in fields(assessment)}
            store.put([(keys[number], {n: v for n, v in record.items() if n != "damaged"})])
            on_done(1)
    assessments = [found[number] for number in range(len(chosen))]
    count = len(NegativeSet(material.negatives))
    return {
        **figures(assessments, count),
        "by_kind": {
            kind: figures([v for v in assessments if v.damaged.kind == kind], count)
            for kind in sorted({v.damaged.kind for v in assessments})
        },
        "assessments": [_ranks(v, material.grammar) for v in assessments],
    }


def _assessed(
    material: BenchMaterial, chosen: Sequence[DamagedGrammar], numbers: Sequence[int], jobs: int
) -> Iterator[Assessment]:
    grammars = [chosen[number] for number in numbers]
    if jobs == 1:
        yield from (assess(damaged, material) for damaged in grammars)
    elif grammars:
        with process_pool(jobs, _prepare, material) as pool:
            yield from pool.map(_assess, grammars)


def _digest(*given: object) -> str:
    return hashlib.sha256(repr(given).encode()).hexdigest()


_materials: list[BenchMaterial] = []  # of a worker process


def _prepare(material: BenchMaterial) -> None:
    _materials.append(material)


def _assess(damaged: DamagedGrammar) -> Assessment:
    return assess(damaged, _materials[0])


def _ranks(assessment: Assessment, whole: Grammar) -> dict[str, Any]:
    return {
        "mutant": assessment.damaged.title(whole),
        "detected": assessment.detected,
        "rule_rank": assessment.rule_rank,
        "item_rank": assessment.item_rank,
        "repair_rank": assessment.repair_rank,
        "clusters": assessment.clusters,
    }


def figures(assessments: Sequence[Assessment], negative_count: int) -> dict[str, Any]:
    """Return the figures of a set of assessments; ``None`` for what nothing tells."""
    seen = [v for v in assessments if v.detected]
    tokens = [t for v in seen for t in v.reproducer_tokens]
    ranks = {
        "rule": [v.rule_rank for v in assessments],
        "item": [v.item_rank for v in assessments],
        "repair": [v.repair_rank for v in assessments],
    }
    return {
        "mutants": len(assessments),
        "detected": _mean([v.detected for v in assessments], 4),
        **{
            f"{name}_top{n}": _mean([rank is not None and rank <= n for rank in found], 4)
            for name, found in ranks.items()
            for n in (1, 5)
        },
        "clusters_per_cause": _mean([v.clusters / v.damaged.parts for v in seen], 3),
        "false_accept": _mean([v.false_accepts / max(1, negative_count) for v in seen], 5),
        "reproducer_median_tokens": statistics.median(tokens) if tokens else None,
        "seconds_per_mutant": _mean([v.seconds for v in assessments], 3),
    }


def _mean(values: Sequence[float], digits: int) -> float | None:
    return round(statistics.fmean(values), digits) if values else None
