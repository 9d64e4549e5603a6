"""Evaluation of a construct: its effect, its cost, and reasons to refuse it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.derivation import Deriver, Steps
from grammar.parser.recognizer import Recognizer
from grammar.parser.shortest_paths import Paths
from recovery.ledger.baseline import GrammarMeasurement
from recovery.ledger.construct import ACCEPTED, REJECTED, Construct, Effect
from recovery.ledger.evidence import (
    RestoredLine,
    broken_files,
    place,
    restored_files,
    restored_lines,
    with_counts,
)
from recovery.ledger.ledger import broken_examples, is_wording, missing_parts
from recovery.ledger.metrics import metrics
from recovery.negatives.negatives import Negative
from recovery.survey.failing_line import FailingLine
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile

# How many repaired lines are examined for ambiguity, shortest first, and their longest (tokens).
_LINES_READ = 60
_LONGEST_READ = 200
_NAMED = 3


@dataclass(frozen=True, slots=True)
class Evaluation:
    """A construct with its measured evidence and effect, and the objections to it.

    ``refusals`` has a line for each objection; without any, the construct can be accepted.
    ``is_counted`` says whether there was a corpus in which to count the evidence; otherwise the
    counts are the old ones.
    """

    construct: Construct
    refusals: tuple[str, ...]
    is_counted: bool

    @property
    def kept(self) -> Construct:
        """The construct with its new evidence and the state this gives; without an effect."""
        construct = self.construct
        if construct.state in (ACCEPTED, REJECTED):
            return construct
        return replace(construct, state=construct.earned_state, effect=None)


def evaluate(
    construct: Construct, before: GrammarMeasurement, after: GrammarMeasurement
) -> Evaluation:
    """Return the evaluation by the measurements of the grammars without and with a construct."""
    lines: list[RestoredLine] = []
    evidence = construct.evidence
    if before.evidence is not None and after.evidence is not None:
        lines = restored_lines(before.evidence, after.evidence)
        evidence = with_counts(evidence, lines)
    if before.own is not None and after.own is not None:
        lines = lines + restored_lines(before.own, after.own)
    effect = _effect(construct, before, after, _ambiguities(construct, before, after, lines))
    measured = replace(construct, evidence=evidence, effect=effect)
    return Evaluation(
        measured, tuple(_refusals(measured, before, after)), before.evidence is not None
    )


# ----------------------------------------------------------------------------------- refusals


def _refusals(
    construct: Construct, before: GrammarMeasurement, after: GrammarMeasurement
) -> Iterator[str]:
    if construct.state == REJECTED:
        yield "the ledger rejects it; its summary says why"
    yield from losses(before, after)
    yield from broken_examples(construct, after.recognizer)
    if is_wording(before.grammar, after.grammar):
        return
    if construct.evidence.objection:
        yield construct.evidence.objection
    yield from missing_parts(construct)
    for number, text in enumerate(construct.accept, 1):
        known = _reading(before.recognizer, text)
        if known is not None and known == _reading(after.recognizer, text):
            yield f"examples.accept: number {number} is read the same way without the construct"


#: Each token's name with the rules that begin and end before it.
_Reading = tuple[tuple[Steps, str], ...]


def _reading(recognizer: Recognizer, text: str) -> _Reading | None:
    """Return how a program is read, or ``None`` if the text is no program.

    Another keyword or other rules make another reading; the order of alternatives does not.
    """
    kinds = recognizer.kinds(text)
    if recognizer.run(recognizer.start, kinds)[1] is not None:
        return None
    deriver = Deriver(recognizer.grammar, recognizer.lexer)
    found = deriver.derive(kinds)
    if found is None:
        return None
    actions = (deriver.actions[number] for number in chain.from_iterable(found.lines))
    return tuple((action.steps, recognizer.lexer.names[action.kind]) for action in actions)


def losses(before: GrammarMeasurement, after: GrammarMeasurement) -> Iterator[str]:
    """Yield what the first grammar did rightly and the second does not, one line each."""
    for survey, other in ((before.evidence, after.evidence), (before.own, after.own)):
        if survey is not None and other is not None:
            yield from _breaks(broken_files(survey, other))
    yield from _newly_accepted(after.accepted_negatives - before.accepted_negatives)


def _breaks(found: Sequence[tuple[SurveyedFile, FailingLine]]) -> Iterator[str]:
    for file, failed in found[:_NAMED]:
        yield f"no longer parses: {place(*file.places[0])}:{failed.line}, at {failed.token!r}"
    if len(found) > _NAMED:
        yield f"no longer parse: {len(found) - _NAMED} more files"


def _newly_accepted(negatives: Iterable[Negative]) -> Iterator[str]:
    written = sorted((n for n in negatives if n.path), key=lambda n: str(n.path))
    made = sorted((n for n in negatives if not n.path), key=lambda n: (len(n.text), n.text))
    for negative in written:
        assert negative.path is not None
        yield f"accepts a negative: {negative.path.as_posix()}: {negative.reason}"
    for fact in sorted({n.reason for n in made}):
        breaking = [n for n in made if n.reason == fact]
        more = f" (and {len(breaking) - 1} more)" if len(breaking) > 1 else ""
        shortest = breaking[0].text.rstrip("\n").replace("\n", " ⏎ ")
        yield f"accepts what breaks a fact{more}: {fact}: {shortest}"


# ------------------------------------------------------------------------------------- effect


def _effect(
    construct: Construct, before: GrammarMeasurement, after: GrammarMeasurement, ambiguities: int
) -> Effect:
    old = construct.effect or Effect()
    if before.evidence is not None and after.evidence is not None:
        old = replace(
            old,
            files=_places(after.evidence.files),
            parsed=_places(_parsed(after.evidence)),
            bytes=_bytes(after.evidence.files),
            parsed_bytes=_bytes(_parsed(after.evidence)),
            restores=_places(restored_files(before.evidence, after.evidence)),
        )
    own = after.own
    return replace(
        old,
        own_files=0 if own is None else _places(own.files),
        own_parsed=0 if own is None else _places(_parsed(own)),
        negatives=len(after.accepted_negatives - before.accepted_negatives),
        ambiguities=ambiguities,
        metrics=dict(metrics(after.grammar)),
    )


def _parsed(survey: Survey) -> list[SurveyedFile]:
    return [file for file in survey.files if not file.failures]


def _places(files: Iterable[SurveyedFile]) -> int:
    return sum(len(file.places) for file in files)


def _bytes(files: Iterable[SurveyedFile]) -> int:
    return sum(file.size * len(file.places) for file in files)


# -------------------------------------------------------------------------------- ambiguities


def _ambiguities(
    construct: Construct,
    before: GrammarMeasurement,
    after: GrammarMeasurement,
    lines: Sequence[RestoredLine],
) -> int:
    """Return how many accept examples and newly readable lines have two readings."""
    wider = after.recognizer
    programs = map(wider.kinds, construct.accept)
    count = sum(is_ambiguous(wider, wider.start, kinds) for kinds in programs)
    paths = Paths(before.recognizer.network)
    names, kind_of = before.recognizer.lexer.names, wider.lexer.kind_of
    distinct = {line.form: line.failed.source for line in lines}
    for form in sorted(distinct, key=lambda form: len(form.kinds))[:_LINES_READ]:
        if len(form.kinds) > _LONGEST_READ:
            break
        way = [names[kind] for kind in min(map(paths.prefix, form.before), key=len)]
        if not kind_of.keys() >= set(way):  # the edits removed the path to this line
            continue
        start, failed = wider.run(wider.start, [kind_of[name] for name in way])
        if failed is None:
            kinds = [*wider.kinds(distinct[form])[:-1], wider.line_kind]
            count += is_ambiguous(wider, start, kinds)
    return count
