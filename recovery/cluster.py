"""Clusters: failures grouped by cause, ranked by what they hold back."""

from __future__ import annotations

import hashlib
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from grammar.failures import Context, FailureFinder, Form
from grammar.recognizer import Recognizer
from recovery.shapes import Shape, Shaper
from recovery.survey import Failed, Survey, SurveyedFile

__all__ = ["Cluster", "Clusters", "Member", "cluster"]


@dataclass(frozen=True, slots=True)
class Member:
    """A failure and the file it is in."""

    file: SurveyedFile
    failed: Failed


@dataclass(frozen=True, slots=True)
class Cluster:
    """Failures with one cause. ``unlocks``: files that would parse if only it were mended."""

    id: str
    title: str
    shape: Shape
    context: Context
    members: tuple[Member, ...]
    unlocks: int

    @property
    def example(self) -> Member:
        """The failure to show: direct, and on the shortest line."""
        return min(self.members, key=lambda m: (m.failed.follows, len(m.failed.source)))

    @property
    def files(self) -> tuple[SurveyedFile, ...]:
        """Distinct contents with a failure of this cluster, in the order of the survey."""
        return tuple({m.file.digest: m.file for m in self.members}.values())


@dataclass(frozen=True, slots=True)
class Clusters:
    """All clusters of a survey, what holds back most first, and the greedy order of mending.

    ``order`` lists (cluster, files that parse once it and all before it are mended).
    """

    ranked: tuple[Cluster, ...]
    order: tuple[tuple[Cluster, int], ...]
    cluster_of: dict[tuple[str, int], str]  # (digest, index of the failure) to the cluster's id


def cluster(found: Survey) -> Clusters:
    """Group the failures of a survey."""
    recognizer = Recognizer(found.grammar)
    finder = FailureFinder(recognizer)
    contexts = [_context(recognizer, finder, form) for form in found.forms]
    shaper = Shaper(
        recognizer.lexer,
        (
            (failed, found.forms[failed.form], contexts[failed.form])
            for file in found.files
            for failed in file.failures
            if not failed.follows
        ),
    )
    groups: dict[Shape, list[Member]] = defaultdict(list)
    shapes: dict[tuple[str, int], Shape] = {}
    example_context: dict[Shape, Context] = {}
    for file in found.files:
        for index, failed in enumerate(file.failures):
            context = contexts[failed.form]
            shape = shaper.shape(failed, found.forms[failed.form], context)
            groups[shape].append(Member(file, failed))
            shapes[file.digest, index] = shape
            example_context.setdefault(shape, context)
    alone = _unlocked_alone(found.files, shapes)
    names = _titles(groups)
    ranked = [
        Cluster(
            id=_identity(shape),
            title=names[shape],
            shape=shape,
            context=example_context[shape],
            members=tuple(members),
            unlocks=alone[shape],
        )
        for shape, members in groups.items()
    ]
    ranked.sort(key=lambda c: (-c.unlocks, -_places(c.files), -len(c.members), c.id))
    by_shape = {c.shape: c for c in ranked}
    return Clusters(
        tuple(ranked),
        tuple(_greedy(found.files, shapes, by_shape)),
        {key: by_shape[shape].id for key, shape in shapes.items()},
    )


def _context(recognizer: Recognizer, finder: FailureFinder, form: Form) -> Context:
    state, _ = recognizer.run(recognizer.restore(form.before), form.kinds[: form.index])
    return finder.context(state)


def _places(files: Iterable[SurveyedFile]) -> int:
    return sum(len(file.places) for file in files)


def _identity(shape: Shape) -> str:
    text = "\0".join((shape.rule, shape.lead, shape.bracket, shape.offender))
    return "c-" + hashlib.sha256(text.encode()).hexdigest()[:8]


def _titles(shapes: Iterable[Shape]) -> dict[Shape, str]:
    """Titles; where two shapes share one, the rule tells them apart."""
    shapes = list(shapes)
    counts = Counter(shape.title for shape in shapes)
    return {
        s: s.title if counts[s.title] == 1 else f"{s.title} (in {s.rule})" for s in shapes
    }


def _causes(
    file: SurveyedFile, shapes: dict[tuple[str, int], Shape]
) -> frozenset[Shape]:
    """Shapes that keep a file from parsing; what only follows goes away with its cause."""
    direct = {
        shapes[file.digest, i] for i, failed in enumerate(file.failures) if not failed.follows
    }
    return frozenset(direct or (shapes[file.digest, i] for i in range(len(file.failures))))


def _unlocked_alone(
    files: Sequence[SurveyedFile], shapes: dict[tuple[str, int], Shape]
) -> Counter[Shape]:
    alone: Counter[Shape] = Counter()
    for file in files:
        causes = _causes(file, shapes)
        if len(causes) == 1:
            alone[next(iter(causes))] += len(file.places)
    return alone


def _greedy(
    files: Sequence[SurveyedFile],
    shapes: dict[tuple[str, int], Shape],
    by_shape: dict[Shape, Cluster],
) -> Iterable[tuple[Cluster, int]]:
    """Mend next what lets most files parse, or brings most of them nearest to it."""
    parsed = sum(len(f.places) for f in files if not f.failures)
    waiting = Counter[frozenset[Shape]]()
    for file in files:
        if file.failures:
            waiting[_causes(file, shapes)] += len(file.places)
    while waiting:
        gain: Counter[Shape] = Counter()
        near: dict[Shape, float] = defaultdict(float)
        for causes, count in waiting.items():
            for shape in causes:
                near[shape] += count / len(causes) ** 2
                if len(causes) == 1:
                    gain[shape] += count
        best = max(near, key=lambda s: (gain[s], near[s], by_shape[s].id))
        left: Counter[frozenset[Shape]] = Counter()
        for causes, count in waiting.items():
            rest = causes - {best}
            if rest:
                left[rest] += count
            else:
                parsed += count
        waiting = left
        yield by_shape[best], parsed
