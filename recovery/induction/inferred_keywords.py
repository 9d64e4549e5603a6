"""Names in a corpus that are keywords missing from the grammar, decided over all lines.

A name is meant as a keyword where no name is possible: at the beginning of a line before an
operand, or alone on a line; or beside an operand without a sign between. The last case only says
that one of the two is a keyword. Keywords and names are distinguished by their context: in one
context a language has few keywords, but any number of names. So only contexts with few different
words count, and nearly all uses of a word must be in such contexts, in several origins.

A word that is reserved by mistake makes programs unreadable in which it is a name. So this asks
more than `recovery.survey.suspected_keywords`, which serves a survey: lines that can be read count
too, and origins vote. On failing lines alone contexts with few words say little.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

from grammar.parser.failures import Failure
from grammar.parser.lexer import SKIPPED, Lexer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.language import CorpusFile
from recovery.induction.spelt_blocks import spelt_blocks
from recovery.survey.failing_line import source_lines
from recovery.survey.suspected_keywords import names_of_line
from recovery.tuning import (
    FEW_WORDS,
    FEWER_WORDS,
    INFERRED_FILES_ALONE,
    INFERRED_SHARE,
    LEAST_FILES_ALONE,
    NAME_SHARE,
    PREFIX_SHARE,
    PREFIX_TOKENS,
    SEVERAL,
    SEVERAL_FILES,
    SEVERAL_ORIGINS,
)

# Signs behind a name that is called, indexed or has members.
_BEHIND_NAMES = frozenset("([.")

# Signs with which an operand may begin.
_OPENING = frozenset("(+-")

_OPERAND = "an operand"
_END = "end"
_TYPE = "a type"


class _Context(NamedTuple):
    """What surrounds a name: the first token of the line, and the tokens ahead and behind.

    All operands are equal, and all types.
    """

    head: str
    ahead: str
    behind: str

    @property
    def is_of_types(self) -> bool:
        """Whether it is a word and an operand with the name of a type between."""
        is_word = self.ahead not in ("", _OPERAND) and self.ahead.isidentifier()
        return is_word and self.behind == _OPERAND

    @property
    def most_words(self) -> int:
        """The number of different words up to which they are keywords."""
        no_name = _OPERAND in (self.ahead, self.behind) or self == ("", "", _END)
        return FEW_WORDS if no_name else FEWER_WORDS


# Where a name is nothing but a name.
_PLAIN = _Context("", "", "")
# Where it may be either.
_OPEN = _Context("", "", "(")
# No name begins a line with an operand behind it.
_HEAD = _Context("", "", _OPERAND)


@dataclass(slots=True)
class _Uses:
    """Uses of a word in some contexts: the origins, and the files of each different line.

    ``operators`` are the files with the word between operands of an expression, ``followed`` those
    with the word ahead of two operands, as a type of two names would be; ``beside`` those with each
    other name right beside it.
    """

    origins: set[str] = field(default_factory=set)
    files: int = 0
    operators: int = 0
    followed: int = 0
    beside: Counter[str] = field(default_factory=Counter)


def names_read(
    files: Sequence[CorpusFile], failures: Sequence[Sequence[Failure]], lexer: Lexer
) -> dict[str, set[str]]:
    """Return words that are names in lines that can be read, with the origins of these."""
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
    return {word: origins[word] for word, count in found.items() if count >= SEVERAL}


class InferredKeywords:
    """The words that the lines of a corpus use as keywords, under one lexer.

    ``words`` are all of them, ``soft`` those that are used as names besides.
    """

    def __init__(
        self,
        corpus: CorpusLines,
        lexer: Lexer,
        read: Mapping[str, Collection[str]],
        types: Collection[str],
        least: int = SEVERAL_ORIGINS,
        least_files: int = LEAST_FILES_ALONE,
    ) -> None:
        """``read`` are names in lines that the grammar reads, with the origins that use them so.

        ``types`` are reserved words that stand where the names of types may. ``least`` is
        how many origins a form needs; where it is 1, two files of one origin show a word too.
        With ``least_files`` of 1 a word between operands of an expression needs no second one, and
        with 0 no word does.
        """
        self.corpus = corpus
        self.lexer = lexer
        self.least = least, least_files
        self._types = frozenset(types)
        self._values = frozenset(filter(lexer.has_value, range(1, len(lexer.names)))) - {
            lexer.line_kind
        }
        contexts = self._contexts()
        # where words are keywords however often they are names elsewhere
        heads = {
            context
            for context, words in contexts.items()
            if context == _HEAD or (context.behind == _TYPE and len(words) <= FEWER_WORDS)
        }
        # names of one origin are not those of another one
        few = {
            context
            for context, words in contexts.items()
            if sum(len(u.origins) == 1 for u in words.values()) <= context.most_words
        }
        self._closed = (heads | few) - {_PLAIN}
        every, closed = _total(contexts.values()), _total(contexts[c] for c in self._closed)
        closed = _total(
            contexts[c] if c in heads else _without_names(contexts[c], closed) for c in self._closed
        )
        head = _total(contexts[c] for c in heads)
        alone = INFERRED_FILES_ALONE if least > 1 else min(LEAST_FILES_ALONE, least_files + 1)
        type_names = self._type_names() if least == 1 else frozenset()
        self.spelt = spelt_blocks(corpus, lexer)
        self.words = frozenset(word for pair in self.spelt for word in pair).union(
            word
            for word, uses in closed.items()
            if word not in type_names
            if (len(uses.origins) >= SEVERAL_ORIGINS and uses.files >= SEVERAL_FILES)
            or uses.files >= alone
            or (least_files <= 1 and every[word].operators == every[word].files)
            if head[word].files >= SEVERAL_FILES or uses.files >= INFERRED_SHARE * every[word].files
        )
        # what a word behind a reserved one declares, as types do, ends there, or a sign goes on
        declaring = {
            word
            for context, words in contexts.items()
            if context.is_of_types and context.ahead in lexer.kind_of
            for word, uses in words.items()
            if len(uses.origins) >= SEVERAL_ORIGINS and 2 * every[word].followed <= uses.files
        }
        declaring -= {word for c in self._closed if c.behind == _TYPE for word in contexts[c]}

        def is_name_too(word: str) -> bool:
            plain = contexts[_PLAIN][word]
            if plain.files <= NAME_SHARE * every[word].files and word not in read:
                return False
            # one origin that uses it as a name does not outvote several that do not, nor one line
            # those that the word begins
            is_outvoted = len(closed[word].origins) >= SEVERAL or (
                head[word].files >= SEVERAL and plain.files <= 1
            )
            return len(plain.origins.union(read.get(word, ()))) > 1 or not is_outvoted

        self.soft = frozenset(w for w in self.words if w in declaring or is_name_too(w))

    def _contexts(self) -> dict[_Context, dict[str, _Uses]]:
        """Return the words of the corpus by context, without those that may be called."""
        found: dict[_Context, dict[str, _Uses]] = defaultdict(lambda: defaultdict(_Uses))
        corpus = self.corpus
        # at the end what is alone on several lines of one file is a word too
        often = Counter(n for numbers in corpus.of_file if self.least[1] <= 1 for n in numbers)
        every = zip(corpus.lines, corpus.counts, corpus.origins, strict=True)
        for number, (line, files, origins) in enumerate(every):
            count = often[number] if len(line) == 1 and often[number] >= SEVERAL else files
            for place, word, context in self._uses(line):
                if context == _OPEN:
                    continue
                uses = found[context][word]
                uses.origins |= origins
                uses.files += count
                for other in line[max(place - 1, 0) : place] + line[place + 1 : place + 2]:
                    uses.beside[other] += count
                if context.is_of_types and self._is_beside(line, place + 1):
                    uses.followed += count
                if context[1:] == (_OPERAND, _OPERAND) and _in_expression(line, place):
                    uses.operators += count
        return found

    def _type_names(self) -> frozenset[str]:
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
                elif is_value[place + 1] and kinds[place] == self.lexer.name_kind:
                    if self._is_beside(line, place + 1):
                        others.add(line[place])
                    else:
                        found[line[0], line[place - 1]].add(line[place])
        heads = {head for head, _ in typed}  # of few lines none may have a type right there
        is_like = (heads if self.least[1] == 0 else set()).__contains__
        names = frozenset[str]().union(
            *(found[at] for at in found if at in typed or is_like(at[0]))
        )
        names -= others
        declared = {b for line in self.corpus.lines for a, b in pairwise(line) if a in names}
        return names | (declared - others)

    @cached_property
    def prefixes(self) -> frozenset[str]:
        """Words that may be missing at the head of a line: most lines go on as others begin.

        Other words follow them, of which there are several: a type ahead of names is no such word.
        """
        lines, kinds = self.corpus.lines, self.lexer.kinds

        def begun(line: Sequence[str]) -> tuple[object, ...]:
            return tuple(w if w in self.words else kinds[w] for w in line[:PREFIX_TOKENS])

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
        """Return the places of a line where a keyword is meant, with the words."""
        return tuple(
            (place, word)
            for place, word, context in self._uses(line)
            if word in self.words
            and (
                word not in self.soft
                or (context in self._closed and not context.is_of_types)
                or context == _OPEN
            )
        )

    def _uses(self, line: Sequence[str]) -> Iterator[tuple[int, str, _Context]]:
        """Yield the names of a line: index, word and context."""
        kinds = [self.lexer.kinds[lexeme] for lexeme in line]
        is_headed = self.lexer.is_keyword(kinds[0]) or (
            len(kinds) > 1 and (kinds[1] in self._values or self.lexer.is_keyword(kinds[1]))
        )
        for place, word in names_of_line(line, kinds, self.lexer):
            behind = self._class(line, kinds, place + 1, ("{",))
            if not place:
                yield 0, word, self._context_of_first(line, kinds, behind)
                continue
            ahead = self._class(line, kinds, place - 1, (")", "]", "}"))
            is_odd = _OPERAND in (ahead, behind) or (
                is_headed
                and behind not in _BEHIND_NAMES
                and not (place == 1 and behind == "=")
                and (
                    (place == 1 and len(kinds) > 2 and self.lexer.is_keyword(kinds[2]))
                    or ahead == ":"
                    or self.lexer.is_keyword(kinds[place - 1])
                )
            )
            # of two names ahead of a bracket either may be the keyword: `WAIT FOR (`, `POS P[`
            is_either = place == 1 and kinds[0] == self.lexer.name_kind and behind in _BEHIND_NAMES
            other = _OPEN if is_either else _PLAIN
            yield place, word, _Context(line[0], ahead, behind) if is_odd else other

    def _context_of_first(self, line: Sequence[str], kinds: Sequence[int], behind: str) -> _Context:
        """Return the context of a name that begins a line."""
        if len(kinds) > 1 and self.lexer.is_keyword(kinds[1]):
            return _HEAD
        if behind in _OPENING:  # a call, or a word with an operand behind it
            return _OPEN
        is_odd = behind not in _BEHIND_NAMES and self._is_headed_oddly(line, kinds)
        return _Context("", "", behind) if is_odd or behind in (_OPERAND, _END) else _PLAIN

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


def _without_names(words: Mapping[str, _Uses], every: Mapping[str, _Uses]) -> dict[str, _Uses]:
    """Return the words of a context without names: several beside the same word that has more uses.

    Of two words side by side one is a keyword. It is the one that explains more lines.
    """
    names: dict[str, set[str]] = defaultdict(set)
    for word, uses in words.items():
        for other, count in uses.beside.items() if len(uses.origins) == 1 else ():
            if count == uses.files < every.get(other, uses).files and other not in words:
                names[other].add(word)
    known = frozenset[str]().union(*(some for some in names.values() if len(some) >= SEVERAL))
    return {word: uses for word, uses in words.items() if word not in known}


def _total(contexts: Iterable[Mapping[str, _Uses]]) -> defaultdict[str, _Uses]:
    """Return the uses of each word in some contexts together."""
    found: defaultdict[str, _Uses] = defaultdict(_Uses)
    for words in contexts:
        for word, uses in words.items():
            total = found[word]
            total.origins |= uses.origins
            total.files += uses.files
            total.operators += uses.operators
            total.followed += uses.followed
    return found


def _in_expression(line: Sequence[str], place: int) -> bool:
    """Return whether a place is after an equals sign or in brackets, where no type is possible."""
    ahead = line[:place]
    return "=" in ahead or ahead.count("(") > ahead.count(")")
