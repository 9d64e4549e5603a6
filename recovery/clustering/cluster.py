"""Clusters: failures grouped by cause, ranked by the number of files they keep from parsing."""

from __future__ import annotations

import hashlib
from array import array
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from grammar.parser.failures import FailureContext
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.causes import find_causes
from recovery.clustering.distinct_lines import DistinctLines, Member
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.mending_order import FileNeed, mending_order
from recovery.clustering.negative_score import NegativeCounter, no_negatives
from recovery.clustering.reason import AS_NAME
from recovery.clustering.regression import ParsedFiles
from recovery.clustering.title import TitleWriter
from recovery.clustering.unknown_characters import with_tokens
from recovery.proposals.edit_site import LinePattern
from recovery.survey.failing_line import FailingLine
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile
from recovery.tuning import MOST_EXAMPLES
from support.parallel.progress import Progress, no_progress


@dataclass(frozen=True, slots=True)
class Cluster:
    """Failures with one cause.

    ``title`` is a description for people. ``id`` is derived from ``signature``, so it is stable as
    long as the signature of the failing line is. ``unlocks`` is the number of files that would
    parse if only this cluster were repaired. ``line`` is the failing line that represents the
    cluster, and ``example`` a failure of that line; ``others`` are further ones in different files.
    It has ``failures``, of which so many are ``following``, in the ``files``, each with the line of
    its first. ``restores`` lists, for each of the ``proposals``, the files in which it repairs
    every line that fails by itself.
    """

    id: str
    signature: str
    title: str
    context: FailureContext
    line: LinePattern
    example: Member
    others: Sequence[Member]
    failures: int
    following: int
    files: Sequence[tuple[SurveyedFile, int]]
    unlocks: int
    proposals: tuple[Proposal, ...]
    restores: tuple[tuple[SurveyedFile, ...], ...]

    @property
    def places(self) -> int:
        """The number of files with a failure of this cluster, copies included."""
        return sum(len(file.places) for file, _ in self.files)


@dataclass(frozen=True, slots=True)
class Clusters:
    """All clusters of a survey by rank, and the mending order: the greedy one.

    ``order`` lists pairs of a cluster and the number of files that parse once it and all before it
    are repaired. ``numbers`` has the index in ``ranked`` of the cluster of each failure of a file,
    by its digest. ``contexts`` are those of the survey's forms.
    """

    ranked: tuple[Cluster, ...]
    order: tuple[tuple[Cluster, int], ...]
    numbers: Mapping[str, Sequence[int]]
    lines: tuple[LinePattern, ...]
    contexts: tuple[FailureContext, ...]

    def cluster_of(self, file: SurveyedFile, index: int) -> str:
        """Return the id of the cluster to which a failure of a file belongs."""
        return self.ranked[self.numbers[file.digest][index]].id


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
    groups = DistinctLines(found)
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

        def place_of(number: int) -> tuple[FailingLine, str]:
            member = groups.specimens[number]
            return member.failed, text_of(member.file)

        causes = with_tokens(groups.recognizer, causes, groups.lines, place_of, count_negatives)
    cause_of = {n: c for c, cause in enumerate(causes) for n in cause.lines}
    return _assembled(found, groups, causes, cause_of)


def _assembled(
    found: Survey, groups: DistinctLines, causes: Sequence[Cause], cause_of: dict[int, int]
) -> Clusters:
    heaviest = [_heaviest(cause, groups) for cause in causes]
    failures = [_Failures(groups.specimens[number]) for number in heaviest]
    needs: list[FileNeed] = []
    shared: dict[frozenset[int], frozenset[int]] = {}
    for file in found.failing:
        lines = groups.lines_of[file.digest]
        causes_of = _with_followers(lines, cause_of)
        for number, failed in zip(causes_of, file.failures, strict=True):
            failures[number].add(file, failed)
        wanted = frozenset(causes_of)
        needs.append(FileNeed(file, lines, shared.setdefault(wanted, wanted)))
    clusters = list(_clusters(groups, causes, heaviest, failures, needs))
    parsed = _places(found.files) - _places(found.failing)
    order = mending_order(parsed, needs, [entry.id for entry in clusters])
    by_rank = sorted(
        range(len(clusters)),
        key=lambda n: (
            -clusters[n].unlocks,
            -clusters[n].places,
            -clusters[n].failures,
            clusters[n].id,
        ),
    )
    rank_of = {number: rank for rank, number in enumerate(by_rank)}
    ranks = {line: rank_of[number] for line, number in cause_of.items()}
    return Clusters(
        tuple(clusters[number] for number in by_rank),
        tuple((clusters[number], count) for number, count in order),
        {digest: _with_followers(lines, ranks) for digest, lines in groups.lines_of.items()},
        groups.lines,
        tuple(groups.contexts),
    )


def _clusters(
    groups: DistinctLines,
    causes: Sequence[Cause],
    heaviest: Sequence[int],
    failures: Sequence[_Failures],
    needs: Sequence[FileNeed],
) -> Iterator[Cluster]:
    """Yield the cluster of each cause; its ``heaviest`` line represents it."""
    alone: Counter[frozenset[int]] = Counter()
    for need in needs:
        alone[need.causes] += len(need.file.places)
    rules = [groups.signatures[n].rule for n in heaviest]
    signatures = _distinct([groups.signatures[n].text for n in heaviest], rules)
    writer = TitleWriter(groups.recognizer)
    titles = writer.distinguished(
        [_title(cause, n, groups, writer) for cause, n in zip(causes, heaviest, strict=True)],
        [groups.lines[n] for n in heaviest],
        rules,
    )
    for number, (cause, line) in enumerate(zip(causes, heaviest, strict=True)):
        mended = [proposal.mended | {DistinctLines.FOLLOWS} for proposal in cause.proposals]
        yield Cluster(
            id="c-" + hashlib.sha256(signatures[number].encode()).hexdigest()[:8],
            signature=signatures[number],
            title=titles[number],
            context=groups.contexts[groups.specimens[line].failed.form],
            line=groups.lines[line],
            example=groups.specimens[line],
            others=failures[number].others,
            failures=failures[number].count,
            following=failures[number].following,
            files=failures[number].files,
            unlocks=alone[frozenset([number])],
            proposals=cause.proposals,
            restores=tuple(
                tuple(need.file for need in needs if lines.issuperset(need.lines))
                for lines in mended
            ),
        )


class _Failures:
    """The failures of one cause, as they are met file by file."""

    def __init__(self, example: Member) -> None:
        self._example = example
        self.count = self.following = 0
        self.files: list[tuple[SurveyedFile, int]] = []
        self.others: list[Member] = []

    def add(self, file: SurveyedFile, failed: FailingLine) -> None:
        """Add a failure; its file is that of the last one or a new one."""
        self.count += 1
        self.following += failed.follows
        if not self.files or self.files[-1][0] is not file:
            self.files.append((file, failed.line))
        self._offer(Member(file, failed))

    def _offer(self, member: Member) -> None:
        """Keep a failure among the shortest in different files, direct ones first."""
        last = self.others[-1] if self.others else None
        if member == self._example:
            return
        if len(self.others) == MOST_EXAMPLES and last and _length(member) >= _length(last):
            return
        same = next((one for one in self.others if one.file is member.file), None)
        if same is not None:
            if _length(member) >= _length(same):
                return
            self.others.remove(same)
        self.others.append(member)
        self.others.sort(key=_length)
        del self.others[MOST_EXAMPLES:]


def _length(member: Member) -> tuple[bool, int]:
    return member.failed.follows, len(member.failed.source)


def _with_followers(lines: Sequence[int], of_line: Mapping[int, int]) -> array[int]:
    """Return the number of each line's cause; what follows has that of the line before it."""
    numbers = array("l")
    for line in lines:  # the first failure of a file follows from no other
        numbers.append(numbers[-1] if line == DistinctLines.FOLLOWS else of_line[line])
    return numbers


def _heaviest(cause: Cause, groups: DistinctLines) -> int:
    """Return the line that represents a cause: the heaviest one its best proposal repairs."""
    mended = cause.proposals[0].mended & set(cause.lines) if cause.proposals else ()
    return max(
        mended or cause.lines,
        key=lambda n: (groups.weights[n], -len(groups.lines[n].form.kinds), -n),
    )


def _title(cause: Cause, number: int, groups: DistinctLines, writer: TitleWriter) -> str:
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


def _places(files: Iterable[SurveyedFile]) -> int:
    return sum(len(file.places) for file in files)


def _distinct(texts: Sequence[str], rules: Sequence[str]) -> list[str]:
    """Return the texts made unique, by the rule and then by a number."""
    plain = Counter(texts)
    out: list[str] = []
    for text, rule in zip(texts, rules, strict=True):
        named = text if plain[text] == 1 else f"{text} (in {rule})"
        same = sum(t == named or t.startswith(f"{named} #") for t in out)
        out.append(f"{named} #{same + 1}" if same else named)
    return out
