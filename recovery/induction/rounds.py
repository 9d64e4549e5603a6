"""Rounds of an induction: read the corpus, infer edits from failures, keep those that hold, repeat.

A round accepts several edits. Each is first tried on the lines from which it was inferred; then the
most useful ones are examined one by one. Edits are refused if they have too little evidence, accept
a program that must be rejected, or lose lines that could be read.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Sequence, Set
from dataclasses import replace
from functools import cached_property
from itertools import chain, pairwise
from typing import Literal, get_args

from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    Replace,
    Widen,
    apply,
)
from grammar.notation.model import Grammar, GrammarError
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import EditTrial, changed_rules, edited
from recovery.forms.operand_rules import OperandRules
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import operands_of
from recovery.induction.block_edits import BlockEdits, blocks_of
from recovery.induction.bracket_edits import BracketEdits
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.failing_lines import FailingLines
from recovery.induction.folding import folds_of, size
from recovery.induction.folds_of_operands import closed_choices
from recovery.induction.grammar_view import GrammarView
from recovery.induction.inferred_keywords import InferredKeywords, names_read
from recovery.induction.language import CorpusFile, Language
from recovery.induction.line_edits import LineEdits
from recovery.induction.line_hosts import LineHosts
from recovery.induction.line_symbols import LineSymbols
from recovery.induction.list_lengths import bounded_lists
from recovery.induction.literals import spaced_literals, split_literals
from recovery.induction.names_rule import NAMES, softened, with_names, with_operands
from recovery.induction.objections import EditReview
from recovery.induction.open_classes import OPENINGS, rare_words
from recovery.induction.operand_edits import OperandEdits
from recovery.induction.row_structure import with_blocks
from recovery.induction.shown_files import Failures, ShownFiles, reading
from recovery.induction.steps import (
    AcceptedStep,
    InferredStep,
    Reading,
    RefusedStep,
    Round,
    described,
    grown,
)
from recovery.induction.supported_forms import SupportedForms
from recovery.ledger.construct import Evidence
from recovery.negatives.negatives import NegativeSet
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.unknown_tokens import unknown_tokens
from recovery.survey.failing_line import source_lines
from recovery.tuning import (
    ACCEPTED_SHARE,
    ADVANCED_WORTH,
    BLOCK_FILES,
    DAMAGED_SHARE,
    DRAWN_NEGATIVES,
    DRAWN_SEED,
    FEW_FILES,
    FOLD_FILES,
    LEAST_FILES_ALONE,
    MANY_FILES,
    OPERAND_FILES,
    PLACES_SHOWN,
    SEVERAL,
    SEVERAL_FILES,
    SEVERAL_ORIGINS,
    SYMBOL_FACTOR,
    UNBOUNDED_SYMBOLS,
)

#: What a round looks for: what is missing within lines, whole lines and blocks, what is alike, and
#: once at the end what may be new elsewhere.
_Step = Literal["inner", "outer", "fold", "open"]
*_STEPS, _END = get_args(_Step)

#: Origins and files that have to show an edit: with no file a single line is enough. That is so for
#: as long as more files fail than can be damaged.
_LINE = (1, 0)

#: Why edits are refused that may have more evidence later, or need less.
_RARE = _ONE_ORIGIN, _FEW_LINES = "only one origin shows it", "too few lines of one file show it"

#: Edits whose place another edit of the same rule may move.
_Placed = Insert | Widen | MakeOptional | Replace
#: What edits are worth, the edits, and the lines that they read further.
_Scored = tuple[float, InferredStep, frozenset[int]]


class Induction:
    """Grows a grammar from the shown files; held-out files are only read."""

    def __init__(
        self,
        grammar: Grammar,
        shown: Sequence[CorpusFile],
        held: Sequence[CorpusFile],
        negatives: NegativeSet,
        *,
        language: Language | None = None,
        struck: Collection[tuple[Edit, ...]] = (),
        start: Grammar | None = None,
    ) -> None:
        """``struck`` edits are not taken; ``language`` is that of the ``negatives``.

        ``start`` is the grammar before the first round, if ``grammar`` is one that has grown.
        """
        self.struck = frozenset(struck)
        self.grammar = grammar
        self._start = start or grammar
        self.shown = ShownFiles(shown)
        self.held = held
        self.negatives = negatives
        self._language = language or Language()
        self.least_origins = min(SEVERAL_ORIGINS, len({o for f in shown for o in f.origins}))
        self.is_finished = False
        self._corpus: CorpusLines | None = None
        self._keywords: InferredKeywords | None = None
        self._names: str | None = None
        self._tried: set[Edit] = set()
        self._lossy: set[tuple[Edit, ...]] = set()  # folds that lose lines of some file
        self._review: EditReview | None = None
        self._held_read = Reading(0, 0, 0)
        self._had = {grammar.sha256}
        self._explained: set[LinePattern] = set()  # lines that known forms may grow to read
        self._waiting: set[LinePattern] = set()  # lines that wait for more evidence on operands

    def rounds(self, most: int = 80) -> Iterator[Round]:
        """Yield up to ``most`` rounds; ``is_finished`` once nothing more is worth taking."""
        # what recurs in one origin only comes later, then what recurs in one file only, last a line
        trusts = dict.fromkeys([(self.least_origins, LEAST_FILES_ALONE), (1, LEAST_FILES_ALONE)])
        stages = [(step, least) for least in (*trusts, (1, 1), _LINE) for step in _STEPS]
        stages.append((_END, _LINE))
        place = 0
        for _ in range(most):
            step, least = stages[place]
            done = self._round(step, least)
            yield done
            again = place if step == _END else stages.index((_STEPS[0], least))
            place = again if done.taken else place + 1
            if place == len(stages):
                self.is_finished = True
                return

    def _round(self, step: _Step, least: tuple[int, int]) -> Round:
        finder, failures = self.shown.failures(self.grammar)
        recognizer = finder.recognizer
        if self._review is None or self._review.recognizer is not recognizer:
            self._held_read = reading([finder.find(file.text) for file in self.held])
            rejected = self.negatives.rejected_by(recognizer)
            found = zip(self.shown.files, failures, strict=True)
            good = (file.text for file, failed in found if not failed)
            texts = _varied(recognizer, sorted(good, key=len))
            self._review = EditReview(recognizer, rejected, self._language.reserved_in, texts)
        review = self._review
        if step == "fold":
            taken, refused = self._folded(review, is_last=least == _LINE)
        elif step == "open":
            taken, refused = self._opened(review, failures)
        elif least == _LINE and sum(map(bool, failures)) <= DAMAGED_SHARE * len(failures):
            taken, refused = [], []  # so few files may be damaged
        else:
            taken, refused = self._inferred(review, finder, failures, least, inner=step == "inner")
        grammar = grown(self.grammar, taken)
        if taken and grammar.sha256 in self._had:  # folds may undo each other
            refused += [RefusedStep(s.title, s.edits, 0.0, "has been so before") for s in taken]
            taken, grammar = [], self.grammar
        self.grammar = grammar
        self._had.add(grammar.sha256)
        return Round(reading(failures), self._held_read, tuple(taken), tuple(refused))

    # ----------------------------------------------------------------------------------- inference

    def _inferred(
        self,
        review: EditReview,
        finder: FailureFinder,
        failures: Failures,
        least: tuple[int, int],
        *,
        inner: bool,
    ) -> tuple[list[AcceptedStep], list[RefusedStep]]:
        """Return accepted and refused edits among those inferred from the failing lines."""
        recognizer = review.recognizer
        keywords = self._words(recognizer, failures, least)
        if inner and (whole := self._restated(failures, recognizer, keywords, least)):
            return [whole], []
        table = FailingLines(self.shown.files, failures, keywords)
        known = table.occurrences
        contexts = [finder.context(line.state) for line in known]
        self._names = OperandRules(recognizer).names
        at = LineSymbols(recognizer, table.patterns, contexts)
        forms = SupportedForms(at, [line.origins for line in known], least[0])
        if inner:
            operands = OperandEdits(at, forms)
            found_edits = chain(operands.edits(), BracketEdits(at, forms, operands).edits())
        else:
            hosts = LineHosts(at)
            blocks = BlockEdits(at, forms, hosts, blocks_of(keywords, recognizer))
            lines = LineEdits(at, forms, hosts, keywords, blocks.words)
            found_edits = chain(blocks.edits(), lines.edits())
        trial = EditTrial(recognizer, table.patterns)
        # a rule of that name may be something else
        names = self._names or (None if NAMES in self.grammar.by_name else NAMES)
        scored: list[_Scored] = []
        for written in found_edits:
            edits = softened(written.edits, keywords.soft, names)
            found = replace(written, edits=edits)
            if not self._names and any(getattr(e, "rule", "") == names for e in edits):
                return [with_names(self.grammar, recognizer.lexer.name)], []
            if edits in self.struck:
                continue
            if found.is_block:
                gain = self._block_gain(found, recognizer, failures, table)
                mended = frozenset(found.lines)
            else:
                gain, mended = _line_gain(trial, found, table)
            if gain and not {table.patterns[n] for n in mended} <= self._waiting:
                callers = at.profile.callers
                rules = [r for r in changed_rules(edits) if r in callers]
                breadth = found.breadth + sum(map(_size, edits))
                breadth += sum(map(at.profile.width, rules))
                scored.append((gain * SYMBOL_FACTOR**breadth, found, mended))
        scored.sort(key=lambda s: (-s[0], str(s[1].edits)))
        explained = {
            table.patterns[n]
            for _, found, lines in scored
            if not any(isinstance(edit, AddAlternative) for edit in found.edits)
            for n in lines
        }
        explained |= self._explained  # of the round before, under the same grammar
        self._explained = explained if inner else set()
        taken, refused = self._chosen(scored, table, review, least, explained)
        self._waiting = set(_waiting(scored, refused, trial, table)) if inner else set()
        types = list(at.rules.type_rules)
        taken, lost = self.shown.kept(self.grammar, taken, self._names, types)
        if taken and not self.shown.gains(self.grammar, taken):  # two forms may undo each other
            lost += [
                RefusedStep(s.title, s.edits, 0.0, "mends nothing in the files") for s in taken
            ]
            taken = []
        return taken, [*lost, *refused]

    def _words(
        self, recognizer: Recognizer, failures: Failures, least: tuple[int, int]
    ) -> InferredKeywords:
        """Return the keywords of the files; computed again for another lexer."""
        lexer = recognizer.lexer
        if self._corpus is None:
            self._corpus = CorpusLines(self.shown.files, lexer)
        known = self._keywords
        if known is None or (known.lexer.names, known.least) != (lexer.names, least):
            types = OperandRules(recognizer).type_words
            read = names_read(self.shown.files, failures, lexer)
            known = self._keywords = InferredKeywords(self._corpus, lexer, read, types, *least)
        return known

    def _block_gain(
        self, found: InferredStep, recognizer: Recognizer, failures: Failures, table: FailingLines
    ) -> float:
        """Failing lines fewer with a block, in some files that open one, as if in all of them."""
        files = self.shown.files
        wider = edited(recognizer, found.edits)
        places = sorted(
            {p for n in found.lines for p in table.occurrences[n].files},
            key=lambda p: len(files[p].text),
        )
        if wider is None or not places:
            return 0.0
        finder = FailureFinder(wider)
        some = places[:BLOCK_FILES]
        opener = found.title.split()[0]
        fewer = openers = left = 0
        for place in some:
            after = finder.find(files[place].text)
            fewer += len(failures[place]) - len(after)
            openers += _led_by(opener, failures[place])
            left += _led_by(opener, after)
        # a block that may stand in some places only leaves openers behind
        read = 1 - left / openers if openers else 0.0
        return max(0.0, read * fewer * len(places) / len(some))

    def _chosen(
        self,
        scored: Sequence[_Scored],
        table: FailingLines,
        review: EditReview,
        least: tuple[int, int],
        explained: Set[LinePattern],
    ) -> tuple[list[AcceptedStep], list[RefusedStep]]:
        """Return the edits that are compatible and each have enough evidence."""
        grammar = self.grammar
        operands = OperandRules(review.recognizer).recursive
        taken: list[AcceptedStep] = []
        refused: list[RefusedStep] = []
        done: set[int] = set()
        changed: set[str] = set()
        reserved: set[Edit] = set()
        for gain, found, lines in scored:
            if 2 * table.weight(lines - done) < table.weight(lines):
                continue  # most of it has been done in this round
            evidence = table.evidence(lines)
            fixed = {e.rule for e in found.edits if isinstance(e, _Placed)}
            edits = tuple(e for e in found.edits if e not in reserved)
            is_new = _has_token(found.edits)
            is_inner = not changed_rules(found.edits).isdisjoint(operands)
            is_wide = evidence.origins == 1 and is_inner and not is_new and not found.is_known
            # a slip in operands spoils all lines: they need more files, at the end different lines
            is_rare = evidence.files < (OPERAND_FILES if is_wide else LEAST_FILES_ALONE)
            is_odd = table.distinct(lines) < SEVERAL
            if evidence.origins < least[0] or (is_rare and least[1] > 1):
                reason = _ONE_ORIGIN
            elif is_rare and least == _LINE and table.are_misnamed(lines, review.recognizer):
                reason = "a reserved word stands for a name"
            elif (
                is_rare
                and least != _LINE
                and not found.is_known
                and (
                    (is_wide and is_odd)
                    or not table.is_repeated(lines, edits, review.recognizer, explained)
                )
            ):
                reason = _FEW_LINES
            elif least != _LINE and not is_new and table.have_one_word(lines):
                reason = "a word that all lines have behind a name may be a keyword"
            elif fixed & changed:
                continue  # its place has changed in this round: the next one will try it again
            else:
                scale = max(1, MANY_FILES / max(FEW_FILES, len(self.shown.files)))
                worth = 0.0 if found.is_strict else gain * scale
                # a slip hardly comes in several different lines, or reads as another kind of line
                is_slip = is_rare and not found.is_known and (is_wide or is_odd)
                most = evidence.lines if is_slip else math.inf
                reason = review.objection(grammar, edits, found.edits, worth, most)
            if reason:
                refused.append(RefusedStep(found.title, found.edits, gain, reason))
                continue
            grammar = apply(grammar, edits)
            done |= lines
            changed |= changed_rules(found.edits)
            reserved |= {e for e in edits if isinstance(e, AddToken | AddAlternative)}
            taken.append(AcceptedStep(found.title, found.edits, evidence))
        return taken, refused

    # ------------------------------------------------------------------------------------- folding

    def _folded(
        self, review: EditReview, *, is_last: bool
    ) -> tuple[list[AcceptedStep], list[RefusedStep]]:
        """Folds after which the grammar is shorter, accepts no more negatives and reads no less.

        Where none is left at the end choices are closed.
        """
        before = review
        recognizer = review.recognizer
        operands = _operands(recognizer, CorpusLines(self.shown.files, recognizer.lexer))
        taken: list[AcceptedStep] = []
        refused: dict[str, RefusedStep] = {}
        had = {recognizer.grammar.sha256}
        tried: set[tuple[str, ...]] = set()  # without numbers of alternatives, which a fold changes
        found = folds_of(GrammarView(recognizer, operands))
        while fold := next(found, None):
            if fold.title in refused or fold.edits in self.struck | self._lossy:
                continue
            if not self._may_restate(review.recognizer.grammar, fold.edits):
                continue  # what no line needs otherwise is right as it is
            words = described(review.recognizer.grammar, fold.edits)
            if words in tried:
                continue
            tried.add(words)
            narrower = _narrower(review, fold, had)
            if isinstance(narrower, str):
                refused[fold.title] = RefusedStep(fold.title, fold.edits, 0.0, narrower)
                continue
            taken.append(AcceptedStep(fold.title, fold.edits))
            had.add(narrower.grammar.sha256)
            review = replace(review, recognizer=narrower)
            found = folds_of(GrammarView(narrower, operands))
        kept, lost = self.shown.kept(self.grammar, taken, self._names)
        if lost:
            # folds behind it are written for what it leaves: they are sought anew without it
            self._lossy.add(lost[0].edits)
            taken = kept[: [step.edits for step in taken].index(lost[0].edits)]
            if not taken:
                return self._folded(before, is_last=is_last)
        if is_last and not taken:
            closed = closed_choices(GrammarView(recognizer, operands))
            bounds = [AcceptedStep(c.title, c.edits) for c in closed if c.edits not in self.struck]
            taken, lost = self.shown.kept(self.grammar, bounds, self._names)
        return taken, [*lost, *refused.values()]

    def _opened(
        self, review: EditReview, failures: Failures
    ) -> tuple[list[AcceptedStep], list[RefusedStep]]:
        """Return openings that accept hardly any negative and lose no line, and others.

        Where none is left lists are bounded, for which all has to be read that will be.
        """
        grammar, lexer = self.grammar, review.recognizer.lexer
        corpus = CorpusLines(self.shown.files, lexer)
        operands = _operands(review.recognizer, corpus)
        taken: list[AcceptedStep] = []
        refused: list[RefusedStep] = []
        rare = rare_words(lexer, corpus)
        is_open = len(rare) >= SEVERAL
        # what others are judged by is drawn evenly from all reasons, of which some are common
        drawn = self._language.negatives(DRAWN_NEGATIVES, DRAWN_SEED) if is_open else ()
        negatives = NegativeSet(drawn)
        most = max(ACCEPTED_SHARE * len(negatives), len(negatives.accepted(review.recognizer)))
        for kind in OPENINGS if is_open else ():
            for found in kind(GrammarView(Recognizer(grammar), operands), rare):
                wider = apply(grammar, found.edits)
                if found.edits in self.struck:
                    continue
                widest = Recognizer(wider)
                count = len(negatives.accepted(widest))
                if accepted := review.newly_accepted(widest):
                    reason = f"accepts a program that must be rejected: {accepted[0].reason}"
                elif count > most:
                    reason = f"{count} programs that must be rejected would be accepted"
                else:
                    reason = ""
                if reason:
                    refused.append(RefusedStep(found.title, found.edits, 0.0, reason))
                else:
                    taken.append(AcceptedStep(found.title, found.edits))
                    grammar = wider
        if not taken:
            read = zip(self.shown.files, failures, strict=True)
            texts = (file.text for file, wrong in read if not wrong)
            bounds = bounded_lists(review.recognizer, self._start, texts)
            taken = [AcceptedStep(b.title, b.edits) for b in bounds if b.edits not in self.struck]
        kept, lost = self.shown.kept(self.grammar, taken, self._names)
        return kept, [*lost, *refused]

    def _may_restate(self, grammar: Grammar, edits: Sequence[Edit]) -> bool:
        """Return whether edits join alternatives only where lines fail or steps have changed some.

        Edits that join none hold by analogy wherever they are.
        """
        if not any(isinstance(edit, RemoveAlternative) for edit in edits):
            return True
        start, now = self._start.by_name, grammar.by_name
        changed = changed_rules(edits) - self._failing_rules
        return all(n not in start or start[n].text != now[n].text for n in changed)

    @cached_property
    def _failing_rules(self) -> frozenset[str]:
        """The rules of the start in which lines fail that they have begun to read."""
        finder, failures = self.shown.failures(self._start)
        recognizer, network = finder.recognizer, finder.recognizer.network
        found = (failure.state for of_file in failures for failure in of_file)
        states = {(state.core, state.tail): state for state in found}
        begun = (p for state in states.values() for p, _ in recognizer.sites(state))
        entries = frozenset(network.entry.values())
        return frozenset(network.rule[position] for position in begun if position not in entries)

    # --------------------------------------------------------------------------------------- tokens

    def _restated(
        self,
        failures: Failures,
        recognizer: Recognizer,
        keywords: InferredKeywords,
        least: tuple[int, int],
    ) -> AcceptedStep | None:
        """Return a step for what has to be there before lines are looked at; ``None`` without any.

        These are tokens, a rule of operands, and blocks.
        """
        if step := self._with_tokens(failures, recognizer, least):
            return step
        if any(failures) and OperandRules(recognizer).widest is None:
            return with_operands(self.grammar, recognizer.lexer)
        return with_blocks(recognizer, keywords) if any(failures) else None

    def _with_tokens(
        self, failures: Failures, recognizer: Recognizer, least: tuple[int, int]
    ) -> AcceptedStep | None:
        """Return a step for what the lexer splits or has no token for; ``None`` without any.

        A sign is first a token, and then what rules may read. It needs as many files as a word. A
        text in quotes is a value as others are.
        """
        lines: list[tuple[str, int]] = []
        for place, (file, of_file) in enumerate(zip(self.shown.files, failures, strict=True)):
            source = source_lines(file.text) if of_file else []
            failing = (f.line for f in of_file if f.line <= len(source))
            lines += ((source[line - 1], place) for line in failing)
        split = split_literals(lines, recognizer.lexer)
        if split and split[0] not in self._tried:
            edit, places, seen = split
            step = self._token_step(f"{seen[0]} is one literal", (edit,), places, seen, least)
            if step and self.shown.gains(self.grammar, [step]):
                self._tried.add(edit)  # else lines may still fail ahead of it: it is tried again
                return step
        enough = least[0], min(SEVERAL_FILES, len(self.shown.files))
        between, known = OperandRules(recognizer).signs_between, self.grammar.by_name
        for unknown in unknown_tokens(lines, recognizer.lexer, known, between):
            added: tuple[Edit, ...] = (AddRule(self.grammar.rules[-1].name, unknown.rule),)
            if spaced := spaced_literals(self.grammar, unknown.seen) if unknown.is_value else ():
                added = spaced
            elif unknown.is_value and (values := OperandRules(recognizer).values):
                added += (AddAlternative(values, unknown.name),)
            title = f"{unknown.seen[0]} is a token"
            step = self._token_step(title, added, unknown.files, unknown.seen, enough)
            if step:
                return step
        return None

    def _token_step(
        self,
        title: str,
        edits: tuple[Edit, ...],
        places: Collection[int],
        seen: tuple[str, ...],
        least: tuple[int, int],
    ) -> AcceptedStep | None:
        """Return a step with the edits of a token if it has evidence and loses no lines."""
        origins = frozenset[str]().union(*(self.shown.files[place].origins for place in places))
        if len(origins) < least[0] or len(places) < least[1] or edits in self.struck:
            return None
        lines = max(len(places), len(seen))  # each file has one, and each text is one
        evidence = Evidence(len(places), len(origins), lines, seen=seen[:PLACES_SHOWN])
        kept, _ = self.shown.kept(self.grammar, [AcceptedStep(title, edits, evidence)], None)
        if not kept:
            return None
        self._corpus = self._keywords = None
        return kept[0]


def _narrower(review: EditReview, fold: InferredStep, had: Set[str]) -> Recognizer | str:
    """Return the recogniser of the grammar after a fold, or why the fold must not be taken.

    ``had`` are the digests of earlier grammars. What takes least time is examined first, because
    most folds are refused.
    """
    grammar = review.recognizer.grammar
    try:
        shorter = grown(grammar, [fold])
    except GrammarError as error:
        return str(error)
    if size(shorter) >= size(grammar) + fold.breadth:
        return "the grammar would not be shorter"
    if shorter.sha256 in had:
        return "has been so before"
    if reason := review.objection(grammar, fold.edits, fold.edits):
        return reason
    narrower = Recognizer(shorter)
    if not all(map(narrower.accepts, review.texts)):
        return "loses lines that can be read"
    return narrower


def _varied(recognizer: Recognizer, texts: Iterable[str]) -> list[str]:
    """Return a few of the texts: each has two neighbours that none before it has."""
    found: list[str] = []
    known: set[tuple[int, int]] = set()
    for text in texts:
        if len(found) == FOLD_FILES:
            break
        pairs = set(pairwise(recognizer.kinds(text)))
        if not pairs <= known:
            found.append(text)
            known |= pairs
    return found


def _operands(recognizer: Recognizer, corpus: CorpusLines) -> list[tuple[int, ...]]:
    """Return the distinct operands of a corpus, as kinds of token."""
    reader, kinds = SymbolReader(OperandRules(recognizer)), recognizer.lexer.kinds
    lines = (reader.symbols([(kinds[word], None) for word in line]) for line in corpus.lines)
    return operands_of(lines)


def _size(edit: Edit) -> int:
    """Return the number of symbols that an edit writes; an unbounded part counts four times."""
    text = getattr(edit, "text", "")
    return len(text.split()) + UNBOUNDED_SYMBOLS * len(re.findall(r"[)\w][*+]", text))


def _waiting(
    scored: Sequence[_Scored],
    refused: Sequence[RefusedStep],
    trial: EditTrial,
    table: FailingLines,
) -> Iterator[LinePattern]:
    """Yield the lines that edits without a new word would mend if they had more evidence."""
    rare = {step.edits for step in refused if step.reason in _RARE}
    for _, step, _ in scored:
        if step.edits in rare and not _has_token(step.edits):
            yield from (table.patterns[n] for n in trial.result(step.edits, step.lines).mended)


def _has_token(edits: Sequence[Edit]) -> bool:
    return any(isinstance(edit, AddToken) for edit in edits)


def _led_by(word: str, failures: Sequence[Failure]) -> int:
    return sum(word in [lexeme.upper() for lexeme in f.lexemes[:2]] for f in failures)


def _line_gain(
    trial: EditTrial, found: InferredStep, table: FailingLines
) -> tuple[float, frozenset[int]]:
    """Return the gain of edits on the lines from which they were inferred, and these lines."""
    result = trial.result(found.edits, found.lines)
    if found.is_strict:  # a line that fails further on says little for what reads so much
        return table.weight(result.mended), result.mended
    gain = table.weight(result.mended) + ADVANCED_WORTH * table.weight(result.advanced)
    return gain, result.mended | result.advanced
