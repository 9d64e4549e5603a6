"""Clusters: failures grouped by cause, ranked by the number of files they keep from parsing."""

from __future__ import annotations

import hashlib
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from grammar.parser.failures import FailureContext, FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause, NegativeCounter, Proposal, no_negatives
from recovery.clustering.causes import find_causes
from recovery.clustering.file_trial import FailingFile, FileTrial
from recovery.clustering.reason import AS_NAME, ReasonFinder
from recovery.clustering.regression import ParsedFiles
from recovery.clustering.title import TitleWriter
from recovery.proposals.edit_site import LinePattern
from recovery.survey.failing_line import FailingLine
from recovery.survey.signature import Signature, signature_of
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile
from recovery.survey.suspected_keywords import SuspectedKeywords
from support.parallel.progress import Progress, no_progress


@dataclass(frozen=True, slots=True)
class Member:
    """A failure with its file."""

    file: SurveyedFile
    failed: FailingLine


@dataclass(frozen=True, slots=True)
class Cluster:
    """Failures with one cause.

    ``title`` is a description for people. ``id`` is derived from ``signature``, so it is stable as
    long as the signature of the failing line is. ``unlocks`` is the number of files that would
    parse if only this cluster were repaired. ``line`` is the failing line that represents the
    cluster, and ``example`` a failure of that line. ``restores`` lists, for each of the
    ``proposals``, the files in which it repairs every line that fails by itself.
    """

    id: str
    signature: str
    title: str
    context: FailureContext
    line: LinePattern
    example: Member
    members: tuple[Member, ...]
    unlocks: int
    proposals: tuple[Proposal, ...]
    restores: tuple[tuple[SurveyedFile, ...], ...]

    @property
    def files(self) -> tuple[SurveyedFile, ...]:
        """Distinct files with a failure of this cluster, in the order of the survey."""
        return tuple({m.file.digest: m.file for m in self.members}.values())


@dataclass(frozen=True, slots=True)
class Clusters:
    """All clusters of a survey by rank, and the greedy order in which to repair them.

    ``order`` lists pairs of a cluster and the number of files that parse once it and all before it
    are repaired. ``cluster_of`` maps (digest, index of a failure) to the id of its cluster.
    ``contexts`` are those of the survey's forms.
    """

    ranked: tuple[Cluster, ...]
    order: tuple[tuple[Cluster, int], ...]
    cluster_of: dict[tuple[str, int], str]
    lines: tuple[LinePattern, ...]
    contexts: tuple[FailureContext, ...]


def text_on_disk(file: SurveyedFile) -> str:
    """Return the text of a file, read again; empty if it has changed since the survey."""
    return "\n".join(file.lines())


def cluster(
    found: Survey,
    *,
    count_negatives: NegativeCounter = no_negatives,
    text_of: Callable[[SurveyedFile], str] = text_on_disk,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> Clusters:
    """Return the failures of a survey grouped by cause.

    ``count_negatives`` counts the negatives that an edit accepts; ``text_of`` returns the text of a
    file; ``on_found`` and ``on_done`` report progress.
    """
    groups = _FailingLines(found)
    causes: Sequence[Cause] = ()
    if groups.lines:
        on_found(len(groups.by_signature))
        causes = find_causes(
            groups.recognizer,
            groups.lines,
            groups.weights,
            groups.by_signature,
            count_negatives,
            on_done,
            FileTrial(groups.recognizer, groups.failing(found, text_of)),
            ParsedFiles(
                ((f.size, partial(text_of, f)) for f in found.files if not f.failures),
                {word for line in groups.lines for _, word in line.keywords},
            ),
            groups.reasons,
        )
    cause_of = {n: c for c, cause in enumerate(causes) for n in cause.lines}
    return _assembled(found, groups, causes, cause_of)


class _FailingLines:
    """The distinct failing lines of a survey, and where each occurs."""

    def __init__(self, found: Survey) -> None:
        self.recognizer = Recognizer(found.grammar)
        finder = FailureFinder(self.recognizer)
        self.contexts = [self._context(finder, f.before, f.kinds[: f.index]) for f in found.forms]
        direct = [
            (file, index, failed)
            for file in found.failing
            for index, failed in enumerate(file.failures)
            if not failed.follows
        ]
        lexer = self.recognizer.lexer
        suspected = SuspectedKeywords(
            lexer, ((f.digest, x, found.forms[x.form]) for f, _, x in direct)
        )
        numbers: dict[LinePattern, int] = {}
        signatures: list[Signature] = []
        self.line_of: dict[tuple[str, int], int] = {}
        self.specimens: list[Member] = []  # the shortest occurrence of each line
        files: dict[int, dict[str, int]] = defaultdict(dict)
        for file, index, failed in direct:
            form = found.forms[failed.form]
            line = LinePattern(form, suspected.of_line(failed, form))
            number = numbers.setdefault(line, len(numbers))
            if number == len(signatures):
                context = self.contexts[failed.form]
                signatures.append(signature_of(lexer, form, line.keywords, context))
                self.specimens.append(Member(file, failed))
            elif len(failed.source) < len(self.specimens[number].failed.source):
                self.specimens[number] = Member(file, failed)
            self.line_of[file.digest, index] = number
            files[number][file.digest] = len(file.places)
        self.lines = tuple(numbers)
        self.signatures = signatures
        reasons = ReasonFinder(self.recognizer)
        self.reasons = [
            reasons.reason(line, signature, self.contexts[found_in.failed.form])
            for line, signature, found_in in zip(numbers, signatures, self.specimens, strict=True)
        ]
        self.weights = [sum(files[n].values()) for n in range(len(signatures))]
        by_signature: dict[Signature, list[int]] = defaultdict(list)
        for number, signature in enumerate(signatures):
            by_signature[signature].append(number)
        self.by_signature = sorted(
            by_signature.values(), key=lambda group: (-sum(self.weights[n] for n in group), group)
        )

    def failing(
        self, found: Survey, text_of: Callable[[SurveyedFile], str]
    ) -> Iterator[FailingFile]:
        """Yield the files with failing lines; their texts are read when needed."""
        for file in found.failing:
            lines = tuple(
                (failed.line, self.line_of[file.digest, index])
                for index, failed in enumerate(file.failures)
                if not failed.follows
            )
            if lines:
                yield FailingFile(file.digest, file.size, partial(text_of, file), lines)

    def _context(
        self, finder: FailureFinder, before: tuple[tuple[int, ...], ...], kinds: Sequence[int]
    ) -> FailureContext:
        return finder.context(self.recognizer.run(self.recognizer.restore(before), kinds)[0])


def _assembled(
    found: Survey, groups: _FailingLines, causes: Sequence[Cause], cause_of: dict[int, int]
) -> Clusters:
    members: dict[int, list[Member]] = defaultdict(list)
    needs: list[tuple[SurveyedFile, frozenset[int], frozenset[int]]] = []
    by_failure: dict[tuple[str, int], int] = {}
    for file in found.failing:
        direct: set[int] = set()
        last = None
        for index, failed in enumerate(file.failures):
            line = groups.line_of.get((file.digest, index))
            if line is not None:
                direct.add(line)
                last = cause_of[line]
            assert last is not None  # the first failure of a file follows from no other
            members[last].append(Member(file, failed))
            by_failure[file.digest, index] = last
        if direct:
            needs.append((file, frozenset(direct), frozenset(cause_of[n] for n in direct)))
    alone: Counter[int] = Counter()
    for file, _, wanted in needs:
        if len(wanted) == 1:
            alone[next(iter(wanted))] += len(file.places)
    heaviest = [_heaviest(cause, groups) for cause in causes]
    rules = [groups.signatures[n].rule for n in heaviest]
    signatures = _distinct([groups.signatures[n].text for n in heaviest], rules)
    writer = TitleWriter(groups.recognizer)
    titles = writer.distinguished(
        [_title(cause, n, groups, writer) for cause, n in zip(causes, heaviest, strict=True)],
        [groups.lines[n] for n in heaviest],
        rules,
    )
    clusters = [
        _cluster(
            cause,
            heaviest[number],
            signatures[number],
            titles[number],
            members[number],
            alone[number],
            groups,
            needs,
        )
        for number, cause in enumerate(causes)
    ]
    parsed = _places(found.files) - _places(found.failing)
    order = _greedy(parsed, [(f, wanted) for f, _, wanted in needs], clusters)
    ranked = sorted(clusters, key=lambda c: (-c.unlocks, -_places(c.files), -len(c.members), c.id))
    return Clusters(
        tuple(ranked),
        tuple(order),
        {key: clusters[number].id for key, number in by_failure.items()},
        groups.lines,
        tuple(groups.contexts),
    )


def _heaviest(cause: Cause, groups: _FailingLines) -> int:
    """Return the line that represents a cause: the heaviest one its best proposal repairs."""
    mended = cause.proposals[0].mended & set(cause.lines) if cause.proposals else ()
    return max(
        mended or cause.lines,
        key=lambda n: (groups.weights[n], -len(groups.lines[n].form.kinds), -n),
    )


def _title(cause: Cause, number: int, groups: _FailingLines, writer: TitleWriter) -> str:
    """Return the title for the line with this number, which represents a cause."""
    if groups.reasons[number] == AS_NAME:
        return writer.title_of_names(
            [groups.lines[n] for n in cause.lines if groups.reasons[n] == AS_NAME]
        )
    best = cause.proposals[0] if cause.proposals else None
    return writer.title(
        groups.lines[number],
        groups.contexts[groups.specimens[number].failed.form],
        groups.signatures[number].bracket,
        [groups.lines[n] for n in cause.lines],
        best if best and number in best.mended else None,
    )


def _cluster(
    cause: Cause,
    heaviest: int,
    signature: str,
    title: str,
    members: Sequence[Member],
    unlocks: int,
    groups: _FailingLines,
    needs: Sequence[tuple[SurveyedFile, frozenset[int], frozenset[int]]],
) -> Cluster:
    example = groups.specimens[heaviest]
    return Cluster(
        id=_identity(signature),
        signature=signature,
        title=title,
        context=groups.contexts[example.failed.form],
        line=groups.lines[heaviest],
        example=example,
        members=tuple(members),
        unlocks=unlocks,
        proposals=cause.proposals,
        restores=tuple(
            tuple(file for file, direct, _ in needs if direct <= proposal.mended)
            for proposal in cause.proposals
        ),
    )


def _places(files: Iterable[SurveyedFile]) -> int:
    return sum(len(file.places) for file in files)


def _identity(signature: str) -> str:
    return "c-" + hashlib.sha256(signature.encode()).hexdigest()[:8]


def _distinct(texts: Sequence[str], rules: Sequence[str]) -> list[str]:
    """Return the texts made unique, by the rule and then by a number."""
    plain = Counter(texts)
    out: list[str] = []
    for text, rule in zip(texts, rules, strict=True):
        named = text if plain[text] == 1 else f"{text} (in {rule})"
        same = sum(t == named or t.startswith(f"{named} #") for t in out)
        out.append(f"{named} #{same + 1}" if same else named)
    return out


def _greedy(
    parsed: int,
    needs: Sequence[tuple[SurveyedFile, frozenset[int]]],
    clusters: Sequence[Cluster],
) -> Iterator[tuple[Cluster, int]]:
    """Yield the clusters in a greedy order, with the number of files that parse after each.

    ``parsed`` files parse before the first. The next cluster is the one that makes most files parse
    or, on a tie, brings most files closest to it.
    """
    waiting: Counter[frozenset[int]] = Counter()
    for file, wanted in needs:
        waiting[wanted] += len(file.places)
    while waiting:
        gain: Counter[int] = Counter()
        near: dict[int, float] = defaultdict(float)
        for wanted, count in waiting.items():
            for number in wanted:
                near[number] += count / len(wanted) ** 2
                if len(wanted) == 1:
                    gain[number] += count
        best = max(near, key=lambda n: (gain[n], near[n], clusters[n].id))
        left: Counter[frozenset[int]] = Counter()
        for wanted, count in waiting.items():
            rest = wanted - {best}
            if rest:
                left[rest] += count
            else:
                parsed += count
        waiting = left
        yield clusters[best], parsed
