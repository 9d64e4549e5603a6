"""Rounds: read the corpus, infer edits from what fails, take those that prove themselves, repeat.

Several edits are taken in a round. Each is first tried on the lines it was inferred from; then the
most useful are looked at one by one. Refused are those that rest on too little, that accept a
program which must stay rejected, and that lose lines which could be read.
"""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, get_args

from grammar.notation.addresses import sequences
from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    Replace,
    Widen,
    apply,
)
from grammar.notation.model import Element, Grammar, GrammarError, Reference, Repeat
from grammar.notation.wellformed import problem
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.lexer import SKIPPED
from grammar.parser.recognizer import Recognizer, State
from recovery.clustering.edit_trial import EditTrial, changed_rules, edited
from recovery.induction.blocks import BlockLines, SourceFile, find_blocks
from recovery.induction.corpus_lines import CorpusFile, CorpusLines
from recovery.induction.folding import Folding, size
from recovery.induction.inference import Inference, Inferred
from recovery.induction.literals import split_literals
from recovery.induction.symbols import OperandRules, SymbolReader, operands_of
from recovery.induction.would_be_keywords import LEAST_FILES_ALONE, WouldBeKeywords
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.negatives.tokens import RESERVED
from recovery.negatives.tokens import lines as tokens_of
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.keywords import Vocabulary
from recovery.survey.failing_line import source_lines

__all__ = ["Evidence", "Induction", "Reading", "Refused", "Round", "Taken"]

# What is left of a gain for each symbol that is written and each step in width of its rule.
_BREADTH_FACTOR = 0.997
# Symbols for which a part counts more that may come any number of times.
_UNBOUNDED = 3
# What a line counts that is read further and still fails.
_ADVANCED = 0.25
# The least share of what an edit does that no edit before it in the round has done.
_FRESH = 0.5
# Files with lines that an edit mends, for one program more that it accepts and should not.
_GAIN_PER_NEGATIVE = 75
# The least share of lines with a word ahead that others begin without it, by so many tokens.
_PREFIX_SHARE = 0.6
_PREFIX_TOKENS = 5
# Lines that use a word as a name, from which on it stays one.
_NAMED_LINES = 3
# Files of a single origin that an edit of an operand's rule needs, as operands are everywhere.
_OPERAND_FILES = 5
# Different lines of a single file that an edit with a new word needs, and places without one.
_LINES_OF_ONE_FILE = 3
_PLACES_IN_ONE_FILE = 2
# Files on which a block is tried, the shortest that open one.
_BLOCK_FILES = 12

#: What a round looks for: what is missing within lines, whole lines and blocks, what is alike.
_Step = Literal["inner", "outer", "fold"]
_STEPS: tuple[_Step, ...] = get_args(_Step)
# The files, the shortest, on which it is tried whether an alternative is needed.
_FOLD_FILES = 40

#: Edits whose place another edit of the same rule may move.
_Placed = Insert | Widen | MakeOptional | Replace


@dataclass(frozen=True, slots=True)
class Evidence:
    """What speaks for edits: files and origins with lines that they mend, and up to ten places."""

    files: int
    origins: int
    lines: int
    seen: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Taken:
    """A step of the growth: edits, why, and on what evidence."""

    title: str
    edits: tuple[Edit, ...]
    evidence: Evidence


@dataclass(frozen=True, slots=True)
class Refused:
    """Edits that were tried and not taken, with the reason."""

    title: str
    edits: tuple[Edit, ...]
    gain: float
    reason: str


@dataclass(frozen=True, slots=True)
class Reading:
    """How files read under a grammar: which parse, and which of their lines fail."""

    parsed: int
    files: int
    failing: int


@dataclass(frozen=True, slots=True)
class Round:
    """One round: how the files read before it, what it took and what it refused."""

    shown: Reading
    held: Reading
    taken: tuple[Taken, ...]
    refused: tuple[Refused, ...]


@dataclass(slots=True)
class _Line:
    """A distinct failing line: where it occurs."""

    files: set[int] = field(default_factory=set)
    origins: set[str] = field(default_factory=set)
    seen: list[str] = field(default_factory=list)
    texts: set[tuple[str, ...]] = field(default_factory=set)
    state: State | None = None


class Induction:
    """Grows a grammar from the files it is shown; others are held out and only read."""

    def __init__(
        self,
        grammar: Grammar,
        shown: Sequence[CorpusFile],
        held: Sequence[CorpusFile],
        negatives: NegativeSet,
        *,
        origins: int = 2,
        struck: Collection[tuple[Edit, ...]] = (),
    ) -> None:
        """``origins`` have to show an edit, while any does; ``struck`` edits are not taken."""
        self.struck = frozenset(struck)
        self.grammar = grammar
        self.shown = shown
        self.held = held
        self.negatives = negatives
        self.least_origins = min(origins, len({o for f in shown for o in f.origins}))
        self.is_finished = False
        self._read: tuple[str, FailureFinder, list[list[Failure]]] | None = None
        self._corpus: CorpusLines | None = None
        self._keywords: WouldBeKeywords | None = None
        self._names: str | None = None
        self._prefixes: frozenset[str] = frozenset()
        self._tried: set[Edit] = set()

    def rounds(self, most: int = 60) -> Iterator[Round]:
        """Up to ``most`` rounds; ``is_finished`` once nothing more is worth taking."""
        # what recurs in one origin only comes later, and last what recurs in one file only
        trusts = dict.fromkeys([(self.least_origins, LEAST_FILES_ALONE), (1, LEAST_FILES_ALONE)])
        stages = [(step, least) for least in (*trusts, (1, 1)) for step in _STEPS]
        place = 0
        for _ in range(most):
            step, least = stages[place]
            done = self._round(step, *least)
            yield done
            place = stages.index((_STEPS[0], least)) if done.taken else place + 1
            if place == len(stages):
                self.is_finished = True
                return

    # ------------------------------------------------------------------------------------ a round

    def _round(self, step: _Step, origins: int, files: int) -> Round:
        finder, failures = self._failures_under(self.grammar)
        shown = _reading(failures)
        held = _reading([finder.find(file.text) for file in self.held])
        if step == "fold":
            taken, refused = self._folded(finder.recognizer, failures)
        else:
            taken, refused = self._inferred(finder, failures, origins, files, inner=step == "inner")
        self.grammar = apply(self.grammar, _joined(taken))
        return Round(shown, held, tuple(taken), tuple(refused))

    def _inferred(
        self,
        finder: FailureFinder,
        failures: Sequence[Sequence[Failure]],
        origins: int,
        files: int,
        *,
        inner: bool,
    ) -> tuple[list[Taken], list[Refused]]:
        """What is taken and what refused, of what is inferred from the lines that fail."""
        recognizer = finder.recognizer
        if self._corpus is None:
            self._corpus = CorpusLines(self.shown, recognizer.lexer)
        corpus = self._corpus
        known_for = self._keywords and (self._keywords.lexer.names, self._keywords.least)
        if self._keywords is None or known_for != (recognizer.lexer.names, origins):
            types = OperandRules(recognizer).type_words
            read = self._names_read(failures)
            self._keywords = WouldBeKeywords(corpus, recognizer.lexer, read, types, origins)
        keywords = self._keywords
        if inner:
            whole = self._with_literals(failures, recognizer)
            if whole is not None:
                return [whole], []
        table = self._table(failures, keywords)
        lines = list(table)
        known = list(table.values())
        contexts = [finder.context(line.state) for line in known if line.state is not None]
        self._names = OperandRules(recognizer).names
        self._prefixes = prefixes = _prefixes(corpus, keywords, recognizer)
        blocks = [] if inner else self._blocks(corpus, keywords, recognizer, prefixes)
        having = [line.origins for line in known]
        inference = Inference(recognizer, lines, contexts, having, blocks, prefixes, origins)
        trial = EditTrial(recognizer, lines)
        rejected = self.negatives.rejected_by(recognizer)
        scored: list[tuple[float, Inferred, frozenset[int]]] = []
        for written in inference.inner() if inner else inference.outer():
            found = replace(written, edits=self._softened(written.edits, keywords))
            if self._names is None and any(
                isinstance(e, AddAlternative) and e.rule == "name" for e in found.edits
            ):
                return [self._with_names()], []
            if found.edits in self.struck:
                continue
            if found.is_block:
                gain = self._block_gain(found, recognizer, failures, known)
                mended = frozenset(found.lines)
            else:
                gain, mended = _line_gain(trial, found, known)
            if gain:
                breadth = found.breadth + sum(map(_size, found.edits))
                callers = inference.profile.callers
                rules = [r for r in changed_rules(found.edits) if r in callers]
                breadth += sum(map(inference.profile.width, rules))
                scored.append((gain * _BREADTH_FACTOR**breadth, found, mended))
        scored.sort(key=lambda s: (-s[0], str(s[1].edits)))
        taken, refused = self._chosen(scored, known, rejected, recognizer, (origins, files))
        taken, lost = self._kept(taken, failures)
        _, after = self._failures_under(apply(self.grammar, _joined(taken)))
        if taken and _standing(after) <= _standing(failures):  # two forms may undo each other
            lost += [Refused(s.title, s.edits, 0.0, "mends nothing in the files") for s in taken]
            taken = []
        return taken, [*lost, *refused]

    def _failures_under(self, grammar: Grammar) -> tuple[FailureFinder, list[list[Failure]]]:
        """The failures of all files shown; those of the grammar that was read last are kept."""
        if self._read is None or self._read[0] != grammar.sha256:
            finder = FailureFinder(Recognizer(grammar))
            found = [finder.find(file.text) for file in self.shown]
            self._read = (grammar.sha256, finder, found)
        return self._read[1:]

    def _names_read(self, failures: Sequence[Sequence[Failure]]) -> dict[str, set[str]]:
        """Words in lines that can be read, with the origins of these."""
        read: dict[str, set[str]] = defaultdict(set)
        for file, of_file in zip(self.shown, failures, strict=True):
            failing = {failure.line for failure in of_file}
            for number, line in enumerate(source_lines(file.text), 1):
                if number not in failing:
                    read[line] |= file.origins
        lexer = Recognizer(self.grammar).lexer
        name = lexer.kind_of.get("NAME")
        found: Counter[str] = Counter()
        origins: dict[str, set[str]] = defaultdict(set)
        for line, having in read.items():
            words = [word for word in lexer.lexemes(line) if lexer.kinds[word] != SKIPPED]
            # what only ever begins a line may be a word that looks like a call there
            for upper in {w.upper() for w in words[1:] if lexer.kinds[w] == name}:
                found[upper] += 1
                origins[upper] |= having
        return {word: origins[word] for word, count in found.items() if count >= _NAMED_LINES}

    def _table(
        self, failures: Sequence[Sequence[Failure]], keywords: WouldBeKeywords
    ) -> dict[LinePattern, _Line]:
        """The distinct failing lines of the files shown."""
        found: dict[LinePattern, _Line] = {}
        for place, of_file in enumerate(failures):
            for failure in of_file:
                if failure.follows:
                    continue
                lexemes = tuple(
                    lexeme.upper() for lexeme in failure.lexemes if lexeme.strip("\r\n")
                )
                pattern = LinePattern(failure.form, keywords.in_line(lexemes) if lexemes else ())
                line = found.setdefault(pattern, _Line())
                line.texts.add(lexemes)
                line.state = line.state or failure.state
                line.files.add(place)
                line.origins |= self.shown[place].origins
                if len(line.seen) < 3:
                    line.seen.append(f"{self.shown[place].path}:{failure.line}")
        return found

    def _blocks(
        self,
        corpus: CorpusLines,
        keywords: WouldBeKeywords,
        recognizer: Recognizer,
        prefixes: frozenset[str],
    ) -> list[BlockLines]:
        lexer = recognizer.lexer
        name = lexer.kind_of.get("NAME")
        tokens = []
        leads = []
        for line in corpus.lines:
            meant = dict(keywords.in_line(line))
            lead = line[1] if len(line) > 1 and line[0] in prefixes else line[0]
            at = 1 if lead is not line[0] else 0
            leads.append(
                lead if lexer.kinds[lead] != name or at in meant or lead in keywords.words else ""
            )
            if lead in keywords.words and at not in meant and lexer.kinds[lead] == name:
                meant[at] = lead
            tokens.append(tuple((lexer.kinds[word], meant.get(i)) for i, word in enumerate(line)))
        files = [
            SourceFile(tuple((leads[n], tokens[n]) for n in numbers), file.origins)
            for file, numbers in zip(self.shown, corpus.of_file, strict=True)
        ]
        vocabulary = Vocabulary(recognizer)
        free = {w for w in leads if w.isidentifier() and not vocabulary.is_written(w)}
        return find_blocks(files, free)

    def _block_gain(
        self,
        found: Inferred,
        recognizer: Recognizer,
        failures: Sequence[Sequence[Failure]],
        known: Sequence[_Line],
    ) -> float:
        """Failing lines fewer with a block, in some files that open one, as if in all of them."""
        wider = edited(recognizer, found.edits)
        places = sorted(
            {p for n in found.lines for p in known[n].files}, key=lambda p: len(self.shown[p].text)
        )
        if wider is None or not places:
            return 0.0
        finder = FailureFinder(wider)
        some = places[:_BLOCK_FILES]
        opener = found.title.split()[0]
        fewer = openers = left = 0
        for place in some:
            after = finder.find(self.shown[place].text)
            fewer += len(failures[place]) - len(after)
            openers += _led_by(opener, failures[place])
            left += _led_by(opener, after)
        # a block that may stand in some places only leaves openers behind
        read = 1 - left / openers if openers else 0.0
        return max(0.0, read * fewer * len(places) / len(some))

    # ------------------------------------------------------------------------------------- choosing

    def _chosen(
        self,
        scored: Sequence[tuple[float, Inferred, frozenset[int]]],
        known: Sequence[_Line],
        rejected: NegativeSet,
        recognizer: Recognizer,
        least: tuple[int, int],
    ) -> tuple[list[Taken], list[Refused]]:
        """The edits that fit together and each deserve it."""
        grammar = self.grammar
        operands = OperandRules(recognizer).recursive
        taken: list[Taken] = []
        refused: list[Refused] = []
        done: set[int] = set()
        changed: set[str] = set()
        reserved: set[Edit] = set()
        for gain, found, lines in scored:
            fresh = sum(len(known[n].files) for n in lines - done)
            if fresh < _FRESH * sum(len(known[n].files) for n in lines):
                continue
            origins = frozenset[str]().union(*(known[n].origins for n in lines))
            fixed = {e.rule for e in found.edits if isinstance(e, _Placed)}
            edits = tuple(e for e in found.edits if e not in reserved)
            files = {p for n in lines for p in known[n].files}
            is_wide = len(origins) == 1 and not fixed.isdisjoint(operands)
            enough = _OPERAND_FILES if is_wide else least[1]
            reason = ""
            if len(origins) < least[0] or len(files) < enough:
                reason = "only one origin shows it"
            elif len(files) < LEAST_FILES_ALONE and not _is_repeated(
                edits, [known[n] for n in lines]
            ):
                reason = "too few lines of one file show it"
            elif fixed & changed:
                continue  # its place has changed in this round: the next one will try it again
            else:
                reason = self._objection(
                    grammar,
                    edits,
                    found.edits,
                    recognizer,
                    rejected,
                    gain,
                    is_strict=found.is_strict,
                )
            if reason:
                refused.append(Refused(found.title, found.edits, gain, reason))
                continue
            grammar = apply(grammar, edits)
            done |= lines
            changed |= changed_rules(found.edits)
            reserved |= {e for e in edits if isinstance(e, AddToken | AddAlternative)}
            count = sum(len(known[n].files) for n in lines)
            seen = tuple(dict.fromkeys(s for n in sorted(lines) for s in known[n].seen))[:10]
            taken.append(
                Taken(found.title, found.edits, Evidence(len(files), len(origins), count, seen))
            )
        return taken, refused

    def _objection(
        self,
        grammar: Grammar,
        edits: Sequence[Edit],
        alone: Sequence[Edit],
        recognizer: Recognizer,
        rejected: NegativeSet,
        gain: float,
        *,
        is_strict: bool,
    ) -> str:
        """Why edits are not to be taken; empty where nothing speaks against them."""
        try:
            after = apply(grammar, edits)
        except GrammarError as error:
            return str(error)
        if after.rules == grammar.rules:
            return "changes nothing"
        if wrong := problem(after):
            return f"the grammar would be ill formed: line {wrong}"
        wider = edited(recognizer, alone)
        if wider is None:
            return "does not fit the grammar"
        accepted = [n for n in rejected.accepted(wider) if _is_read_anew(recognizer, wider, n)]
        if len(accepted) > (0 if is_strict else gain / _GAIN_PER_NEGATIVE):
            return f"accepts {len(accepted)} programs that must be rejected: {accepted[0].reason}"
        return ""

    def _kept(
        self, taken: Sequence[Taken], failures: Sequence[Sequence[Failure]]
    ) -> tuple[list[Taken], list[Refused]]:
        """The steps without those under which a file fails earlier than it did."""
        _, after = self._failures_under(apply(self.grammar, _joined(taken)))
        worse = [p for p, found in enumerate(after) if _first(found) < _first(failures[p])]
        if not worse:
            return list(taken), []
        kept: list[Taken] = []
        lost: list[Refused] = []
        for step in taken:
            version, reason = step, ""
            for _ in range(2):
                try:
                    grammar = apply(self.grammar, _joined([*kept, version]))
                except GrammarError as error:
                    reason = str(error)
                    break
                finder = FailureFinder(Recognizer(grammar))
                read = {p: finder.find(self.shown[p].text) for p in worse}
                lost_in = [p for p, f in read.items() if _first(f) < _first(failures[p])]
                if not lost_in or self._is_outvoted(lost_in, step.evidence):
                    reason = ""
                    break
                reason = "loses lines that can be read"
                version = self._with_names_kept(step, [read[p][0] for p in lost_in])
            if reason:
                lost.append(Refused(step.title, step.edits, 0.0, reason))
            else:
                kept.append(version)
        return kept, lost

    def _is_outvoted(self, places: Sequence[int], evidence: Evidence) -> bool:
        """Whether files are of one origin, and an edit is shown by more origins and files."""
        origins = frozenset[str]().union(*(self.shown[p].origins for p in places))
        return len(origins) == 1 < evidence.origins and 2 * len(places) < evidence.files

    def _with_names_kept(self, step: Taken, failures: Sequence[Failure]) -> Taken:
        """The step with the words that it reserves left names too where lines fail for them."""
        used = {lexeme.upper() for failure in failures for lexeme in failure.lexemes}
        words = [e.name for e in step.edits if isinstance(e, AddToken) and e.name in used]
        more = tuple(AddAlternative(self._names, word) for word in words if self._names)
        edits = (*step.edits, *(edit for edit in more if edit not in step.edits))
        return replace(step, edits=edits)

    # ------------------------------------------------------------------------------------- folding

    def _folded(
        self, recognizer: Recognizer, failures: Sequence[Sequence[Failure]]
    ) -> tuple[list[Taken], list[Refused]]:
        """Folds after which the grammar is shorter, accepts no more negatives and reads no less."""
        rejected = self.negatives.rejected_by(recognizer)
        reader, kinds = SymbolReader(OperandRules(recognizer)), recognizer.lexer.kinds
        lines = CorpusLines(self.shown, recognizer.lexer).lines
        operands = operands_of(reader.symbols([(kinds[w], None) for w in line]) for line in lines)
        grammar = self.grammar
        good = [p for p, found in enumerate(failures) if not found]
        some = sorted(good, key=lambda p: len(self.shown[p].text))[:_FOLD_FILES]
        taken: list[Taken] = []
        refused: dict[str, Refused] = {}
        found = Folding(recognizer, operands, self._prefixes).candidates()
        while fold := next(found, None):
            if fold.title in refused or fold.edits in self.struck:
                continue
            reason = self._objection(
                grammar, fold.edits, fold.edits, recognizer, rejected, 0.0, is_strict=True
            )
            if not reason:
                shorter = apply(grammar, fold.edits)
                narrower = Recognizer(shorter)
                if size(shorter) >= size(grammar) + fold.breadth:
                    reason = "the grammar would not be shorter"
                elif not all(narrower.accepts(self.shown[p].text) for p in some):
                    reason = "loses lines that can be read"
            if reason:
                refused[fold.title] = Refused(fold.title, fold.edits, 0.0, reason)
                continue
            taken.append(Taken(fold.title, fold.edits, Evidence(0, 0, 0, ())))
            grammar, recognizer = shorter, narrower
            found = Folding(recognizer, operands, self._prefixes).candidates()
        taken, lost = self._kept(taken, failures)
        return taken, [*lost, *refused.values()]

    # ------------------------------------------------------------------------------------- literals

    def _with_literals(
        self, failures: Sequence[Sequence[Failure]], recognizer: Recognizer
    ) -> Taken | None:
        """A step that gives literals a form that the lexer cuts apart; ``None`` without any."""
        lines: list[tuple[str, frozenset[str]]] = []
        places: set[int] = set()
        for place, of_file in enumerate(failures):
            source = source_lines(self.shown[place].text) if of_file else []
            for failure in of_file:
                if failure.line <= len(source):
                    lines.append((source[failure.line - 1], self.shown[place].origins))
                    places.add(place)
        found = split_literals(lines, recognizer.lexer)
        if found is None or found[0] in self._tried or len(found[1]) < self.least_origins:
            return None
        edit, origins, seen = found
        self._tried.add(edit)
        step = Taken(
            f"{seen[0]} is one literal",
            (edit,),
            Evidence(len(places), len(origins), len(lines), seen),
        )
        kept, _ = self._kept([step], failures)
        if not kept:
            return None
        self._corpus = self._keywords = None
        return step

    # ---------------------------------------------------------------------------------------- names

    def _softened(self, edits: Sequence[Edit], keywords: WouldBeKeywords) -> tuple[Edit, ...]:
        """The edits with the words they reserve left names where files use them so."""
        words = [e.name for e in edits if isinstance(e, AddToken) and e.name in keywords.soft]
        names = self._names or "name"
        more = tuple(AddAlternative(names, word) for word in words)
        return (
            *(e for e in edits if isinstance(e, AddToken)),
            *more,
            *(e for e in edits if not isinstance(e, AddToken)),
        )

    def _with_names(self) -> Taken:
        """A step that gives names a rule of their own, for words that are also names."""
        edits: list[Edit] = []
        last = ""
        for rule in self.grammar.rules:
            if rule.is_lexer:
                continue
            last = rule.name
            for address, sequence in sequences(rule):
                for place, element in enumerate(sequence.elements, 1):
                    if _is_name(element):
                        edits.append(Replace(rule.name, (*address, place), "name"))
                    elif isinstance(element, Repeat) and _is_name(element.item):
                        text = f"name{element.operator}"
                        edits.append(Replace(rule.name, (*address, place), text))
        return Taken(
            "names are a rule of their own",
            (AddRule(last, "name\n    : NAME\n    ;"), *edits),
            Evidence(0, 0, 0, ()),
        )


def _prefixes(
    corpus: CorpusLines, keywords: WouldBeKeywords, recognizer: Recognizer
) -> frozenset[str]:
    """Words that may be missing at the head of a line: most lines go on as others begin."""
    lexer = recognizer.lexer
    name = lexer.kind_of.get("NAME")

    def begun(words: Sequence[str]) -> tuple[object, ...]:
        kinds = (lexer.kinds[word] for word in words[:_PREFIX_TOKENS])
        return tuple(
            w if k == name and w in keywords.words else k
            for w, k in zip(words, kinds, strict=False)
        )

    beginnings = {begun(line) for line in corpus.lines}
    whole: Counter[str] = Counter()
    rest: Counter[str] = Counter()
    for line in corpus.lines:
        if line[0] in keywords.words or lexer.is_keyword(lexer.kinds[line[0]]):
            whole[line[0]] += 1
            rest[line[0]] += len(line) > 2 and begun(line[1:]) in beginnings
    return frozenset(w for w, count in whole.items() if rest[w] > _PREFIX_SHARE * count)


def _first(failures: Sequence[Failure]) -> float:
    """The first line that fails: those before it are read for certain, others in places guessed."""
    return failures[0].line if failures else math.inf


def _standing(failures: Sequence[Sequence[Failure]]) -> tuple[int, int]:
    """How far files are read, more is better: those that parse, then lines that fail, negated."""
    return sum(not found for found in failures), -sum(map(len, failures))


def _is_name(element: Element) -> bool:
    return isinstance(element, Reference) and element.name == "NAME"


def _is_repeated(edits: Sequence[Edit], lines: Sequence[_Line]) -> bool:
    """Whether lines of a single file show edits often enough to be no slip."""
    if any(isinstance(edit, AddToken) for edit in edits):
        return len({text for line in lines for text in line.texts}) >= _LINES_OF_ONE_FILE
    return sum(len(line.seen) for line in lines) >= _PLACES_IN_ONE_FILE


def _size(edit: Edit) -> int:
    """How many symbols an edit writes; what may come any number of times counts thrice more."""
    text = getattr(edit, "text", "")
    return len(text.split()) + _UNBOUNDED * len(re.findall(r"[)\w][*+]", text))


def _led_by(word: str, failures: Sequence[Failure]) -> int:
    return sum(word in [lexeme.upper() for lexeme in f.lexemes[:2]] for f in failures)


def _line_gain(
    trial: EditTrial, found: Inferred, known: Sequence[_Line]
) -> tuple[float, frozenset[int]]:
    """What edits do for the lines they were inferred from, in files, and for which."""
    result = trial.result(found.edits, found.lines)
    mended = sum(len(known[n].files) for n in result.mended)
    advanced = sum(len(known[n].files) for n in result.advanced)
    return mended + _ADVANCED * advanced, result.mended | result.advanced


def _is_read_anew(recognizer: Recognizer, wider: Recognizer, negative: Negative) -> bool:
    """Whether a negative was rejected at the line that is wrong, all words of which are known.

    One that was rejected at another line has told nothing about the wrong one so far; nor has one
    that misuses a word which both grammars take for a name.
    """
    if negative.line is None:
        return True
    wrong = tokens_of(negative.text)[negative.line - 1]
    if not RESERVED.intersection(wrong.kinds) <= wider.lexer.kind_of.keys():
        return False
    kinds = recognizer.kinds(negative.text)
    _, failed = recognizer.run(recognizer.start, kinds)
    return failed is None or kinds[:failed].count(recognizer.line_kind) + 1 == negative.line


def _joined(steps: Sequence[Taken]) -> list[Edit]:
    """The edits of all steps; what two of them reserve or add alike comes once."""
    found: list[Edit] = []
    for edit in (edit for step in steps for edit in step.edits):
        if not (isinstance(edit, AddToken | AddAlternative) and edit in found):
            found.append(edit)
    return found


def _reading(failures: Sequence[Sequence[object]]) -> Reading:
    return Reading(sum(not found for found in failures), len(failures), sum(map(len, failures)))
