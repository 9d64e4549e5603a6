"""Names in a corpus that are keywords missing from the grammar, decided over all lines.

A name is meant as a keyword where no name is possible: at the beginning of a line before an
operand, or alone on a line; or beside an operand without a sign between. The last case only says
that one of the two is a keyword. Keywords and names are distinguished by their context: in one
context a language has few keywords, but any number of names. So only contexts with few different
words count, and nearly all uses of a word must be in such contexts, in several origins.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from grammar.parser.failures import Failure
from grammar.parser.lexer import SKIPPED, Lexer
from recovery.induction.corpus_lines import CorpusLines
from recovery.language import CorpusFile
from recovery.survey.failing_line import source_lines
from recovery.tuning import (
    FEW_WORDS,
    FEWER_WORDS,
    LEAST_FILES_ALONE,
    LINES_OF_ONE_FILE,
    NAME_SHARE,
    NAMED_LINES,
    OUTVOTING_ORIGINS,
    PREFIX_SHARE,
    PREFIX_TOKENS,
    WOULD_BE_FILES,
    WOULD_BE_FILES_ALONE,
    WOULD_BE_ORIGINS,
    WOULD_BE_SHARE,
)

# Signs behind a name that is called, indexed or has members.
_BEHIND_NAMES = frozenset("([.")

# Signs with which an operand may begin.
_OPENING = frozenset("(+-")

#: The head of the line, what is ahead, what is behind.
_Surroundings = tuple[str, str, str]
_OPERAND = "an operand"
_END = "end"
_TYPE = "a type"
# Where a name is nothing but a name.
_PLAIN: _Surroundings = ("", "", "")
# Where it may be either.
_OPEN: _Surroundings = ("", "", "(")
# No name begins a line with an operand behind it.
_HEAD: _Surroundings = ("", "", _OPERAND)


@dataclass(frozen=True, slots=True)
class _Use:
    place: int
    word: str
    surroundings: _Surroundings
    is_beside: bool


def names_read(
    files: Sequence[CorpusFile], failures: Sequence[Sequence[Failure]], lexer: Lexer
) -> dict[str, set[str]]:
    """Words that are names in lines that can be read, with the origins of these."""
    read: dict[str, set[str]] = defaultdict(set)
    for file, of_file in zip(files, failures, strict=True):
        failing = {failure.line for failure in of_file}
        for number, line in enumerate(source_lines(file.text), 1):
            if number not in failing:
                read[line] |= file.origins
    found: Counter[str] = Counter()
    origins: dict[str, set[str]] = defaultdict(set)
    for line, having in read.items():
        words = [word for word in lexer.lexemes(line) if lexer.kinds[word] != SKIPPED]
        # what only ever begins a line may be a word that looks like a call there
        for upper in {w.upper() for w in words[1:] if lexer.kinds[w] == lexer.name_kind}:
            found[upper] += 1
            origins[upper] |= having
    return {word: origins[word] for word, count in found.items() if count >= NAMED_LINES}


class WouldBeKeywords:
    """The words that the lines of a corpus use as keywords, under one lexer."""

    def __init__(
        self,
        corpus: CorpusLines,
        lexer: Lexer,
        read: Mapping[str, Collection[str]],
        types: Collection[str],
        least: int = WOULD_BE_ORIGINS,
        least_files: int = LEAST_FILES_ALONE,
    ) -> None:
        """``read`` are names in lines that the grammar reads, with the origins that use them so.

        ``types`` are reserved words that stand where the names of types may. ``least`` is
        how many origins a form needs; where it is 1, two files of one origin show a word too.
        With ``least_files`` of 1 a word between operands of an expression needs no second one.
        """
        self.corpus = corpus
        self.lexer = lexer
        self.least = least, least_files
        alone = WOULD_BE_FILES_ALONE if least > 1 else LEAST_FILES_ALONE
        self._types = frozenset(types)
        self._name = lexer.name_kind
        self._values = frozenset(
            kind
            for kind, shown in enumerate(lexer.display)
            if kind and shown == lexer.names[kind] and not lexer.is_keyword(kind)
        ) - {lexer.line_kind}
        fillers: dict[_Surroundings, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
        files: Counter[tuple[_Surroundings, str]] = Counter()
        uses: Counter[str] = Counter()
        operators: Counter[str] = Counter()
        beside: set[_Surroundings] = set()
        followed: Counter[str] = Counter()
        for number, line in enumerate(corpus.lines):
            for use in self._uses(line):
                fillers[use.surroundings][use.word] |= corpus.origins[number]
                if use.surroundings == _OPEN:
                    continue
                files[use.surroundings, use.word] += corpus.counts[number]
                uses[use.word] += corpus.counts[number]
                if _is_of_types(use.surroundings) and self._is_beside(line, use.place + 1):
                    followed[use.word] += corpus.counts[number]
                if use.surroundings[1:] == (_OPERAND, _OPERAND) and _in_expression(line, use.place):
                    operators[use.word] += corpus.counts[number]
                if use.is_beside:
                    beside.add(use.surroundings)
        self._closed: set[_Surroundings] = set()
        meant: Counter[str] = Counter()
        heads: Counter[str] = Counter()
        places: dict[str, set[str]] = defaultdict(set)
        for surroundings, words in fillers.items():
            is_head = surroundings == _HEAD or (
                surroundings[2] == _TYPE and len(words) <= FEWER_WORDS
            )
            if surroundings in (_PLAIN, _OPEN):
                continue
            if is_head or len(words) <= (FEW_WORDS if surroundings in beside else FEWER_WORDS):
                self._closed.add(surroundings)
                for word in words:
                    meant[word] += files[surroundings, word]
                    heads[word] += files[surroundings, word] * is_head
                    places[word] |= words[word]
        typing = self._of_types() if least == 1 else frozenset()
        self.words = frozenset(
            word
            for word, count in meant.items()
            if word not in typing
            if (len(places[word]) >= WOULD_BE_ORIGINS and count >= WOULD_BE_FILES)
            or count >= alone
            or (least_files == 1 and operators[word] == uses[word])
            if heads[word] >= WOULD_BE_FILES or count >= WOULD_BE_SHARE * uses[word]
        )
        typed = {
            word
            for surroundings, words in fillers.items()
            if _is_of_types(surroundings) and surroundings[1] in lexer.kind_of
            for word, origins in words.items()
            # what a type declares ends there, or a sign goes on
            if len(origins) >= WOULD_BE_ORIGINS and 2 * followed[word] <= files[surroundings, word]
        }
        ahead = {w for s in self._closed if s[2] == _TYPE for w in fillers[s]}
        #: Those that are used as names besides.
        self.soft = frozenset(
            word
            for word in self.words
            if word in typed - ahead
            or (
                (files[_PLAIN, word] > NAME_SHARE * uses[word] or word in read)
                # one origin that uses it as a name does not outvote several that do not, nor one
                # line those that the word begins
                and (
                    len(fillers[_PLAIN][word].union(read.get(word, ()))) > 1
                    or not (
                        len(places[word]) >= OUTVOTING_ORIGINS
                        or heads[word] >= LINES_OF_ONE_FILE > 1 >= files[_PLAIN, word]
                    )
                )
            )
        )

    def _of_types(self) -> frozenset[str]:
        """Return names of types: between a word and a last operand, where others have a type.

        They begin no line and do not precede two operands. The names after them are returned, too.
        """
        typed: set[tuple[str, str]] = set()
        found: dict[tuple[str, str], set[str]] = defaultdict(set)
        others: set[str] = set()
        for line in self.corpus.lines:
            kinds = [self.lexer.kinds[lexeme] for lexeme in line]
            is_value = [kind in self._values for kind in kinds]
            others.update(line[:1] if is_value[1:2] == [True] else ())
            for place in range(1, len(line) - 1):
                if is_value[place + 1] and line[place] in self._types:
                    typed.add((line[0], line[place - 1]))
                elif is_value[place + 1] and kinds[place] == self._name:
                    if self._is_beside(line, place + 1):
                        others.add(line[place])
                    else:
                        found[line[0], line[place - 1]].add(line[place])
        names = frozenset[str]().union(*(found[around] for around in typed)) - others
        declared = {b for line in self.corpus.lines for a, b in pairwise(line) if a in names}
        return names | (declared - others)

    def prefixes(self) -> frozenset[str]:
        """Words that may be missing at the head of a line: most lines go on as others begin.

        Other words follow them, of which there are several: a type ahead of names is no such word.
        """
        lines, kinds = self.corpus.lines, self.lexer.kinds

        def begun(line: Sequence[str]) -> tuple[object, ...]:
            words = line[:PREFIX_TOKENS]
            return tuple(
                w if kinds[w] == self._name and w in self.words else kinds[w] for w in words
            )

        beginnings = {begun(line) for line in lines}
        whole: Counter[str] = Counter()
        rest: Counter[str] = Counter()
        behind: dict[str, set[str]] = defaultdict(set)
        for line in lines:
            if self._is_word(line[0]):
                whole[line[0]] += 1
                rest[line[0]] += len(line) > 2 and begun(line[1:]) in beginnings
                behind[line[0]].update(filter(self._is_word, line[1:2]))
        return frozenset(
            word
            for word, count in whole.items()
            if rest[word] > PREFIX_SHARE * count and len(behind[word]) > 1
        )

    def _is_word(self, lexeme: str) -> bool:
        """Return whether the grammar reserves a word, or the corpus uses it as a keyword."""
        return lexeme in self.words or self.lexer.is_keyword(self.lexer.kinds[lexeme])

    def in_line(self, line: Sequence[str]) -> tuple[tuple[int, str], ...]:
        """Yield the places of a line where a keyword is meant, with the words."""
        return tuple(
            (use.place, use.word)
            for use in self._uses(line)
            if use.word in self.words
            and (
                use.word not in self.soft
                or (use.surroundings in self._closed and not _is_of_types(use.surroundings))
                or use.surroundings == _OPEN
            )
        )

    def _uses(self, line: Sequence[str]) -> Iterator[_Use]:
        """Yield the names of a line; those in braces are skipped, as values are beside them."""
        kinds = [self.lexer.kinds[lexeme] for lexeme in line]
        depth = 0
        is_headed = self.lexer.is_keyword(kinds[0]) or (
            len(kinds) > 1 and (kinds[1] in self._values or self.lexer.is_keyword(kinds[1]))
        )
        for place, (word, kind) in enumerate(zip(line, kinds, strict=True)):
            depth += (word == "{") - (word == "}")
            if kind != self._name or depth or word.startswith("$"):
                continue
            behind = self._class(line, kinds, place + 1, ("{",))
            if not place:
                if len(kinds) > 1 and self.lexer.is_keyword(kinds[1]):
                    behind = _OPERAND
                if behind in (_OPERAND, _END):
                    yield _Use(place, word, ("", "", behind), True)
                elif behind in _OPENING:  # a call, or a word with an operand behind it
                    yield _Use(place, word, _OPEN, False)
                elif behind not in _BEHIND_NAMES and self._is_headed_oddly(line, kinds):
                    yield _Use(place, word, ("", "", behind), False)
                else:
                    yield _Use(place, word, _PLAIN, False)
                continue
            ahead = self._class(line, kinds, place - 1, (")", "]", "}"))
            surroundings = (line[0], ahead, behind)
            if _OPERAND in (ahead, behind):
                yield _Use(place, word, surroundings, True)
            elif (
                is_headed
                and behind not in _BEHIND_NAMES
                and not (place == 1 and behind == "=")
                and (
                    (place == 1 and len(kinds) > 2 and self.lexer.is_keyword(kinds[2]))
                    or ahead == ":"
                    or self.lexer.is_keyword(kinds[place - 1])
                )
            ):
                yield _Use(place, word, surroundings, False)
            else:
                yield _Use(place, word, _PLAIN, False)

    def _is_headed_oddly(self, line: Sequence[str], kinds: Sequence[int]) -> bool:
        """Return whether two operands are adjacent, so that a word of the line is a keyword."""
        values = [kind in self._values for kind in kinds[1:]]
        return "{" not in line and any(a and b for a, b in pairwise(values))

    def _is_beside(self, line: Sequence[str], place: int) -> bool:
        """Return whether another operand or a type follows the operand at an index."""
        found = [self.lexer.kinds[lexeme] for lexeme in line[place : place + 2]]
        return len(found) > 1 and (found[1] in self._values or line[place + 1] in self._types)

    def _class(
        self, line: Sequence[str], kinds: Sequence[int], place: int, signs: Sequence[str]
    ) -> str:
        if place >= len(line):
            return _END
        if line[place] in signs or kinds[place] in self._values:
            # the first word of a line says what may come behind it, whether it is known or not
            return _OPERAND if place else line[0]
        return _TYPE if line[place] in self._types else line[place]


def _is_of_types(surroundings: _Surroundings) -> bool:
    """Return whether a context is a word and an operand with the name of a type between."""
    _, ahead, behind = surroundings
    return behind == _OPERAND and ahead not in ("", _OPERAND) and ahead.isidentifier()


def _in_expression(line: Sequence[str], place: int) -> bool:
    """Return whether a place is after an equals sign or in brackets, where no type is possible."""
    ahead = line[:place]
    return "=" in ahead or ahead.count("(") > ahead.count(")")
