"""Forms: one text of a rule that reads all lines, or all contents of brackets, of one kind.

Commas become lists first. Then every symbol is named after the word or sign before it, so that the
operand after ``TO`` differs from the one after ``STEP``; words that only some lines have are
skipped for this. The result is a chain (`recovery.induction.chain`), in which each operand is
written as the narrowest rules that read all of its examples.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

from grammar.notation.g4 import read_rule
from grammar.notation.model import Alternative, Element, Group, Literal, Reference, Repeat, walk
from recovery.induction.chain import Factor, chain_of
from recovery.induction.symbols import BRACKETS, Operand, OperandRules, Symbol, SymbolReader
from recovery.tuning import (
    ITEMS_BEHIND_THE_FIRST,
    LONGEST_SIGNS_AHEAD,
    MANY_LISTS,
    MOST_SAMPLES,
    READ_TOGETHER_SHARE,
)

#: So many items are more than a short list has.
LONG_LIST = ITEMS_BEHIND_THE_FIRST + 2
_COMMA = "','"
_EQUALS = "'='"
#: A list of pieces with commas between: its text is this, ``inside`` is none.
_LIST = "…"


@dataclass(frozen=True, slots=True)
class _Key:
    """The identity of a symbol of a form in different lines: its text and what it follows."""

    text: str
    after: str
    number: int


#: A line: its symbols with what makes them the same in two lines.
_Keyed = Sequence[tuple[_Key, Symbol]]


class FormWriter:
    """Writes forms for one grammar; ``operands`` of the corpus define which rules are narrow."""

    def __init__(self, reader: SymbolReader, operands: Iterable[tuple[int, ...]]) -> None:
        self.reader = reader
        self.rules = rules = reader.rules
        self._reads: dict[str, int] = Counter(
            rule for kinds in operands for rule in rules.matcher.rules_for(kinds)
        )

    def form(self, given: Iterable[Sequence[Symbol]]) -> str | None:
        """Return the text of a rule that reads all lines; ``None`` if an operand has no rule."""
        lines = [tuple(line) for line in given]
        some = [line for line in lines if line]
        if len(some) < len(lines):
            text = self.form(some) if some else ""
            return text and f"({text})?"
        lines = self._opened(lines)
        items = self._items(lines)
        if items is not None:
            lines, item = items
            if item is None:
                return None
        else:
            item = ""
        return self._chained(self._types_first(_keyed(lines)), item)

    def _types_first(self, keyed: Sequence[_Keyed]) -> list[_Keyed]:
        """Return the lines with operands that stand alone as the first of two, if some are types.

        ``INT :IN`` beside ``INT A :IN`` lacks the name, and not the type.
        """
        firsts = {key.after for line in keyed for key, _ in line if key.number and not key.text}
        alone = [
            {
                place
                for place, (key, symbol) in enumerate(line)
                if symbol.is_operand and key.after in firsts and not key.number
                if all(o.text or o.after != key.after or o == key for o, _ in line)
            }
            for line in keyed
        ]
        typed = {
            line[place][0].after
            for line, places in zip(keyed, alone, strict=True)
            for place in places
            if self._is_type(line[place][1])
        }
        return [
            [
                (replace(key, number=1), s) if n in places and key.after in typed else (key, s)
                for n, (key, s) in enumerate(line)
            ]
            for line, places in zip(keyed, alone, strict=True)
        ]

    def _is_type(self, symbol: Symbol) -> bool:
        """Return whether an operand is a reserved word for a type, or the rule of types."""
        operand, rules = symbol.operand or Operand(), self.rules
        is_word = len(operand.kinds) == 1 and rules.lexer.is_keyword(operand.kinds[0])
        return operand.rule in rules.word_choices or (
            is_word and operand.kinds[0] in rules.type_kinds
        )

    def _chained(self, keyed: Sequence[_Keyed], item: str) -> str | None:
        """Return the chain of the lines as text; ``item`` is the text of a list."""
        factors = chain_of([[key for key, _ in line] for line in keyed])
        met: dict[_Key, list[Symbol]] = defaultdict(list)
        for line in keyed:
            for key, symbol in line:
                met[key].append(symbol)
        texts: list[str] = []
        for place, factor in enumerate(factors):
            text = self._factor(factor, met, item)
            if text is None:
                return None
            found = self._ended_by_words(factor, met, keyed, item)
            if found and text == f"({found[0]} | {found[1]})" and any(found[2]):
                rest = self._chained(found[2], item)
                ahead = _joined(factors[:place], texts, keyed)
                return rest and f"{ahead} ({found[0]} {rest} | {found[1]})".strip()
            texts.append(text)
        return _joined(factors, texts, keyed)

    def _ended_by_words(
        self,
        factor: Factor[_Key],
        met: Mapping[_Key, Sequence[Symbol]],
        keyed: Sequence[_Keyed],
        item: str,
    ) -> tuple[str | None, str, list[_Keyed]] | None:
        """Return a factor whose place some lines end with a reserved word.

        The result has the text of the factor in the other lines, the words, and the rests of the
        other lines. It is ``None`` if a line continues after such a word, which is then an ordinary
        operand.
        """
        if len(factor.symbols) > 1 or met[factor.symbols[0]][0].operand is None:
            return None
        words, others, rests = set[str](), list[Symbol](), list[_Keyed]()
        for line in keyed:
            place = next((n for n, (key, _) in enumerate(line) if key in factor.symbols), None)
            if place is None:
                return None
            symbol, rest = line[place][1], line[place + 1 :]
            kinds = symbol.operand.kinds if symbol.operand else ()
            if len(kinds) == 1 and self.rules.lexer.is_keyword(kinds[0]):
                if rest:
                    return None
                words.add(self.rules.lexer.names[kinds[0]])
            else:
                others.append(symbol)
                rests.append(rest)
        if not (words and others):
            return None
        text = self._factor(factor, {factor.symbols[0]: others}, item)
        return text, " | ".join(sorted(words)), rests

    def _opened(self, lines: Sequence[tuple[Symbol, ...]]) -> list[tuple[Symbol, ...]]:
        """Return the lines with calls taken apart if other lines have brackets that are not calls.

        ``DEFFCT INT F(X)`` occurs beside ``DEFFCT INT F(X:IN)``. A name is separated from its index
        if others have an index after a type: ``EXT F(NAMED[]:IN, INT[]:IN)``.
        """
        signs = {
            right.text
            for line in lines
            for left, right in pairwise(line)
            if left.is_operand and right.inside is not None
        } | {f"'{sign}'" for line in lines for s in line for sign in self._bracketed_words(s)}
        indices = {
            right.text
            for line in lines
            for left, right in pairwise(line)
            if left.is_operand and right.text in self.rules.following.values()
        }
        return [tuple(p for s in line for p in self._parts(s, signs, indices)) for line in lines]

    def _bracketed_words(self, symbol: Symbol) -> Iterator[str]:
        """Return the bracket at the end of an operand if it contains a word that is no operand."""
        kinds = symbol.operand.kinds if symbol.operand else ()
        for start, kind in enumerate(kinds):
            if not self.rules.words_in_brackets(kind).isdisjoint(kinds[start + 1 :]):
                yield self.rules.lexer.display[kind]

    def _parts(self, symbol: Symbol, signs: set[str], indices: set[str]) -> tuple[Symbol, ...]:
        kinds = symbol.operand.kinds if symbol.operand else ()
        display = self.rules.lexer.display
        index = self.rules.following.get(kinds[1], "") if len(kinds) > 1 else ""
        if index in indices and index in self.rules.matcher.rules_for(kinds[1:]):
            return Symbol("", Operand(kinds[:1])), Symbol(index)
        for start in range(1, len(kinds)):
            if f"'{display[kinds[start]]}'" in signs:
                tokens = [(kind, None) for kind in kinds]
                if self.reader.closer(tokens, start) == len(kinds) - 1:
                    inside = self.reader.symbols(tokens[start + 1 : -1], atoms=True)
                    return (
                        Symbol("", Operand(kinds[:start])),
                        Symbol(f"'{display[kinds[start]]}'", None, inside),
                    )
        return (symbol,)

    # ------------------------------------------------------------------------------------ lists

    def _items(
        self, lines: Sequence[tuple[Symbol, ...]]
    ) -> tuple[list[tuple[Symbol, ...]], str | None] | None:
        """Return the lines with lists as one symbol, and the text of a list, or ``None``."""
        cut = [split_at_commas(line) for line in lines]
        behind = [piece for pieces in cut for piece in pieces[1:]]
        if not behind:
            return None
        shapes = {tuple(s.text for s in piece) for piece in behind}
        longest = max(map(len, shapes))
        out = []
        ahead: list[tuple[Symbol, ...]] = []
        for pieces in cut:
            first = pieces[0]
            size = _suffix(first, shapes, longest)
            if not size and len(pieces) == 1:  # no list, rather than one of nothing
                out.append(first)
                continue
            ahead.append(first[len(first) - size :])
            out.append((*first[: len(first) - size], Symbol(_LIST)))
        if not longest:  # commas alone
            return out, "','*"
        item = self.form([piece for piece in (*behind, *ahead) if piece])
        if item is None:
            return out, None
        single = item
        if any(not piece for piece in (*behind, *ahead)):
            single = item if " " not in item else f"({item})"
            if single[-1] in "?*":
                return out, None
            single += "?"
        return out, f"{self._first_item(ahead, behind) or single} (',' {single})*"

    def _first_item(
        self, ahead: Sequence[tuple[Symbol, ...]], behind: Sequence[tuple[Symbol, ...]]
    ) -> str | None:
        """Return the form of a first item, if many lists begin with what only some continue."""
        shapes = {tuple(s.text for s in piece) for piece in ahead}
        others = {tuple(s.text for s in piece) for piece in behind}
        if len(ahead) < MANY_LISTS or () in others or not shapes < others:
            return None
        return self.form([p for p in (*ahead, *behind) if tuple(s.text for s in p) in shapes])

    # ---------------------------------------------------------------------------------- factors

    def _factor(
        self, factor: Factor[_Key], met: Mapping[_Key, Sequence[Symbol]], item: str
    ) -> str | None:
        words, operands = [], []
        for key in factor.symbols:
            some = met[key][0]
            if key.text == _LIST:
                words.append(item)
            elif some.inside is not None:
                inside = self.form([s.inside or () for s in met[key]])
                if inside is None:
                    return None
                within = f"{inside} " if inside else ""
                words.append(f"{key.text} {within}'{BRACKETS[key.text.strip(chr(39))]}'")
            elif some.operand is not None:
                operands += [s.operand for s in met[key] if s.operand]
            else:
                words.append(key.text)
        if operands:
            rules = self.cover(operands)
            if rules is None:
                return None
            words += rules
        words = [word for word in dict.fromkeys(words) if not self._is_covered(word, words)]
        text = " | ".join(words)
        is_one = len(words) == 1 and " " not in text
        if factor.often:
            return f"{text if is_one else f'({text})'}{factor.often}"
        return text if len(words) == 1 else f"({text})"

    def _is_covered(self, rule: str, others: Collection[str]) -> bool:
        """Return whether a rule is a choice of words that the other rules read."""
        known = self.rules.grammar.by_name.get(rule)
        every = [a.elements for a in known.alternatives] if known and not known.is_lexer else [()]
        words = {e[0].name for e in every if len(e) == 1 and isinstance(e[0], Reference)}
        kinds = self.rules.lexer.kind_of
        if len(words) < len(every) or not words <= kinds.keys():
            return False
        read = (self.rules.matcher.rules_for((kinds[word],)) for word in words)
        return bool(frozenset[str](others).difference({rule}).intersection(*read))

    def cover(self, operands: Sequence[Operand]) -> list[str] | None:
        """Return the narrowest rules or tokens that together read the operands, or ``None``."""
        names = self.rules.lexer.names
        kinds = {o.kinds for o in operands if o.kinds}
        needed = {o.rule for o in operands if o.rule}
        single = {k[0] for k in kinds if len(k) == 1}
        if not needed and len(single) == len(kinds) == 1:
            (kind,) = single
            if kind == self.rules.lexer.name_kind:
                return [self._name()]
        indexed = self._indexed(kinds, needed)
        if indexed:
            return [indexed]
        if len(kinds) == 1 and not needed and self._has_operator(*kinds):
            return [" ".join(map(self._token, *kinds))]
        # a single reserved word beside names, or several that are no values, say nothing of values
        reserved = {k for k in single if self.rules.lexer.is_keyword(k)}
        is_plain = len(reserved) == 1 or not any(map(self.reader.is_value, reserved))
        is_some = 0 < len(reserved) < len(kinds) and reserved.isdisjoint(self.rules.type_kinds)
        if is_some and is_plain:
            beside = {k for k in kinds if k[0] not in reserved}
            is_name = not needed and beside == {(self.rules.lexer.name_kind,)}
            others = self._name() if is_name else self._indexed(beside, needed)
            if others:
                return [others, *sorted(names[k] for k in reserved)]
        usual = self.rules.usual
        reads = {
            rule: {k for k in kinds if rule in self.rules.matcher.rules_for(k)}
            | {n for n in needed if self.rules.includes(rule, n)}
            for rule in usual
        }
        left: set[object] = {*kinds, *needed}
        whole = [rule for rule in usual if reads[rule] >= left]
        if whole:
            single_rule = min(whole, key=self._breadth)
            return self._of_values(self._narrower(single_rule, reads, left) or [single_rule])
        found: list[str] = []
        while left:
            best = max(usual, key=lambda r: (len(reads[r] & left), [-n for n in self._breadth(r)]))
            if not reads[best] & left:
                tokens = {names[k[0]] for k in left if isinstance(k, tuple) and len(k) == 1}
                return [*found, *sorted(tokens)] if len(tokens) == len(left) else None
            left -= reads[best]
            found.append(best)
        return self._of_values(found)

    def _of_values(self, found: list[str]) -> list[str]:
        """Return the rules with variables for bare names: names among values are variables."""
        if len(found) > 1 and self._name() in found and self.variable:
            return [self.variable if rule == self._name() else rule for rule in found]
        return found

    @cached_property
    def variable(self) -> str | None:
        """Return the narrowest rule of names with what may follow them, and of no other value."""
        rules, lexer = self.rules, self.rules.lexer
        others = [(k,) for k in lexer.kind_of.values() if k != rules.lexer.name_kind]
        values = [kinds for kinds in others if rules.matcher.is_operand(kinds[0])]
        examples = [(rules.lexer.name_kind,), *(o.kinds for o in rules.followed.values())]
        having = frozenset(rules.usual).intersection(*map(rules.matcher.rules_for, examples))
        fitting = having.difference({self._name()}, *map(rules.matcher.rules_for, values))
        return min(fitting, key=self._breadth, default=None) if rules.followed else None

    def _indexed(self, kinds: set[tuple[int, ...]], needed: set[str]) -> str | None:
        """Return a name with optional brackets; ``None`` if operands are anything else."""
        matcher, name = self.rules.matcher, self._name()
        behind: set[str | None] = set()
        for first, *rest in kinds:
            if first != self.rules.lexer.name_kind and name not in matcher.rules_for((first,)):
                return None
            if rest:
                rule = self.rules.following.get(rest[0])
                behind.add(rule if rule in matcher.rules_for(tuple(rest)) else None)
        if needed - {name} or len(behind) != 1 or None in behind:
            return None
        return f"{name} {behind.pop()}?"

    def _narrower(
        self, wide: str, reads: Mapping[str, set[tuple[int, ...] | str]], wanted: set[object]
    ) -> list[str] | None:
        """Two rules instead of a wide one, where they read much less, or no names and it does."""
        usual = [r for r in self.rules.usual if reads[r] and r not in self.rules.including(wide)]
        pairs = [
            (self._reads[one] + self._reads[other], usual.index(one), usual.index(other))
            for one in usual
            for other in usual
            if one < other and reads[one] | reads[other] >= wanted
        ]
        if not pairs:
            return None
        count, first, second = min(pairs)
        found = [usual[first], usual[second]]
        named = self.rules.matcher.rules_for((self.rules.lexer.name_kind,))
        is_constant = wide in named and named.isdisjoint(found)
        return found if is_constant or count <= READ_TOGETHER_SHARE * self._reads[wide] else None

    def _breadth(self, rule: str) -> tuple[int, ...]:
        """Return what a rule reads: operands of the corpus first, then the size of other rules."""
        usual = self.rules.usual
        inner = sum(self.rules.includes(rule, other) for other in usual)
        return self._reads[rule], inner, -self.rules.uses[rule], usual.index(rule)

    def _has_operator(self, kinds: Sequence[int]) -> bool:
        """Return whether an operand consists of several names with signs between them."""
        tokens = [(kind, None) for kind in kinds]
        is_of_names = set(kinds[::2]) == {self.rules.lexer.name_kind}
        return is_of_names and len(self.reader.symbols(tokens, atoms=True)) > 1

    def _token(self, kind: int) -> str:
        return self._name() if kind == self.rules.lexer.name_kind else self.reader.text(kind)

    def _name(self) -> str:
        """Return the text for a name."""
        return self.rules.names or self.rules.lexer.name


def is_loose(form: str, lines: Sequence[Sequence[Symbol]]) -> bool:
    """Return whether a form allows fewer operands than any of its lines, with shortest lists.

    Parts that exclude each other can then all be left out.
    """
    words = frozenset[str]().union(*map(texts_of, lines))
    return _fewest(read_rule(f"form : {form} ;").alternatives, words) < min(map(_operands, lines))


def texts_of(line: Sequence[Symbol]) -> frozenset[str]:
    """Return the texts of a line's symbols, including those in brackets."""
    inner = (texts_of(symbol.inside) for symbol in line if symbol.inside)
    return frozenset(symbol.text for symbol in line).union(*inner)


def _operands(line: Sequence[Symbol]) -> int:
    """Return the operands of a line up to its first comma, including those in brackets."""
    first = split_at_commas(line)[0]
    return sum(s.is_operand if s.inside is None else _operands(s.inside) for s in first)


def _fewest(alternatives: Iterable[Alternative], words: Set[str]) -> int:
    """Return the operands of the alternative with the fewest; ``words`` are no operands."""
    return min(sum(_fewest_of(e, words) for e in a.elements) for a in alternatives)


def _fewest_of(element: Element, words: Set[str]) -> int:
    match element:
        case Repeat(item=item, operator=operator):
            return _fewest_of(item, words) if operator == "+" else 0
        case Group(alternatives=alternatives):
            return _fewest(alternatives, words)
        case Reference(name=name):
            return int(name not in words)
        case _:
            return 0


def split_at_commas(line: Sequence[Symbol]) -> list[tuple[Symbol, ...]]:
    """Return the pieces of a line between its commas, at least one."""
    pieces: list[list[Symbol]] = [[]]
    for symbol in line:
        if symbol.text == _COMMA:
            pieces.append([])
        else:
            pieces[-1].append(symbol)
    return [tuple(piece) for piece in pieces]


def _suffix(first: Sequence[Symbol], shapes: set[tuple[str, ...]], longest: int) -> int:
    """Return how many symbols at the end of a list's first piece belong to the list."""
    texts = {text for shape in shapes for text in shape}
    heads = [s.text for s in first]
    if _sketch(heads) in set(map(_sketch, shapes)):
        return len(first)
    if len(first) <= longest and texts.issuperset(s.text for s in first):
        return len(first)
    for size in range(min(longest, len(first)), 0, -1):
        if tuple(s.text for s in first[len(first) - size :]) in shapes:
            # what one operand of a list is set to belongs to it
            if size == 1 and [s.text for s in first[-3:-1]] == ["", _EQUALS]:
                return 3
            return size
    # one that is set to nothing where the others are is an item too
    are_set = all(shape[:2] == ("", _EQUALS) for shape in shapes)
    return int(are_set and len(first) > 1 and first[-1].is_operand and _EQUALS not in heads)


def _sketch(texts: Iterable[str]) -> tuple[str, ...]:
    """Return a shape in which all words are equal, without what only follows operands."""
    return tuple("word" if text.isupper() else text for text in texts if not text.islower())


def _keyed(lines: Sequence[Sequence[Symbol]]) -> list[_Keyed]:
    """Return the symbols of lines with their identities."""
    shapes = {tuple(s.text for s in line) for line in lines}
    # two operands behind a word: other lines may have another word between, and end otherwise
    declared = {s[i : i + 3] for s in shapes for i in range(len(s)) if s[i : i + 3][1:] == ("", "")}
    passing = {
        text
        for shape in shapes
        for place, text in enumerate(shape)
        if text
        and text[0] not in "'"
        and text != _LIST
        and (
            (*shape[:place], *shape[place + 1 :]) in shapes
            or (place and (shape[place - 1], *shape[place + 1 : place + 3]) in declared)
        )
    }
    out: list[_Keyed] = []
    for line in lines:
        after = ""
        counts: Counter[str] = Counter()
        keyed = []
        for place, symbol in enumerate(line):
            text = symbol.text
            if symbol.is_operand:
                # of operands side by side the last one is what is always there
                number = 0
                for behind in line[place + 1 :]:
                    if behind.text in passing:
                        continue
                    if not behind.is_operand:
                        break
                    number += 1
                key = _Key("", after, number)
            elif text in passing or text == _LIST:
                key = _Key(text, "", 0)
            elif text.startswith("'"):
                key = _Key(text, after, 0)
                after = f"{after} {text}"[-LONGEST_SIGNS_AHEAD:]
            else:
                counts[text] += 1
                key = _Key(text, "", counts[text])
                after = f"{text}{counts[text]}"
            keyed.append((key, symbol))
        out.append(keyed)
    return out


def _joined(factors: Sequence[Factor[_Key]], texts: Sequence[str], keyed: Sequence[_Keyed]) -> str:
    """Return the text of consecutive factors, grouping those that occur together.

    Factors that exclude each other become a choice.
    """
    having = [{key for key, _ in line} for line in keyed]
    present = [tuple(not keys.isdisjoint(f.symbols) for keys in having) for f in factors]
    groups: list[tuple[list[str], tuple[bool, ...], bool]] = []
    for factor, text, where in zip(factors, texts, present, strict=True):
        optional = factor.often in ("?", "*")
        bare = text[:-1] if factor.often == "?" else text
        if _is_group(bare) and "|" not in bare:  # a row of symbols goes into a longer one as it is
            bare = bare[1:-1]
        if factor.often == "*" and groups and groups[-1][2] and groups[-1][1] == where:
            groups[-1][0].append(f"{text[:-1]}+")
        elif optional and groups and groups[-1][2] and groups[-1][1] == where:
            groups[-1][0].append(bare)
        else:
            groups.append(([bare if optional else text], where, optional))
    out: list[str] = []
    place = 0
    while place < len(groups):
        parts, where, optional = groups[place]
        if not optional:
            out += parts
            place += 1
            continue
        choice = [parts]
        taken = list(where)
        place += 1
        while place < len(groups) and groups[place][2]:
            following = groups[place][1]
            if any(a and b for a, b in zip(taken, following, strict=True)):
                break
            choice.append(groups[place][0])
            taken = [a or b for a, b in zip(taken, following, strict=True)]
            place += 1
        text = " | ".join(" ".join(part) for part in choice)
        if all(taken) and len(choice) > 1:
            out.append(f"({text})")
        elif len(choice) == 1 and len(parts) == 1 and text[-1] == "*":
            out.append(text)
        else:
            is_one = len(choice) == 1 and len(parts) == 1 and (" " not in text or _is_group(text))
            out.append(f"{text if is_one else f'({text})'}?")
    return " ".join(out)


def _is_group(text: str) -> bool:
    """Return whether a text is one group in parentheses."""
    if not (text.startswith("(") and text.endswith(")")):
        return False
    depth = 0
    for left, right in pairwise(text.replace("'('", "   ").replace("')'", "   ") + " "):
        depth += (left == "(") - (left == ")")
        if not depth and right != " ":
            return False
        if not depth:
            return right == " " and text.rstrip().endswith(")")
    return True


def samples_of(rules: OperandRules, sequence: Sequence[Element]) -> list[tuple[Symbol, ...]]:
    """Yield what elements of a rule read, as symbols, with and without each optional part."""
    return [_grouped(rules, line) for line in _sequences(rules, sequence)]


def _with_index(rules: OperandRules, symbols: Sequence[Symbol]) -> tuple[Symbol, ...]:
    """Return the symbols with a name and its brackets as one operand, as they are read."""
    out: list[Symbol] = []
    names = {Operand((rules.lexer.name_kind,)), Operand((), rules.names or "")}
    samples = rules.followed
    for symbol in symbols:
        rule = symbol.operand.rule if symbol.operand else symbol.text
        if out and out[-1].operand in names and rule in samples:
            out[-1] = Symbol("", samples[rule])
        else:
            out.append(Symbol(rule) if rule in rules.following.values() else symbol)
    return tuple(out)


def _grouped(
    rules: OperandRules, symbols: Sequence[Symbol], *, is_line: bool = True
) -> tuple[Symbol, ...]:
    """Return the symbols with the contents of brackets as one symbol; types as they are read."""
    out: list[Symbol] = []
    at = 0
    kind_of = rules.lexer.kind_of
    while at < len(symbols):
        text = symbols[at].text
        closing = f"'{BRACKETS.get(text.strip(chr(39)), '')}'"
        close = next((i for i in range(at, len(symbols)) if symbols[i].text == closing), None)
        if text and close is not None:
            inside = _grouped(rules, symbols[at + 1 : close], is_line=False)
            out.append(Symbol(text, None, inside))
            at = close
        elif text in rules.type_words and (at or not is_line):
            out.append(Symbol("", Operand((kind_of[text],))))
        else:
            out.append(symbols[at])
        at += 1
    return _with_index(rules, out)


def _sequences(
    rules: OperandRules, sequence: Sequence[Element], within: frozenset[str] = frozenset()
) -> list[tuple[Symbol, ...]]:
    """Yield the samples of elements; the rules in ``within`` are not expanded again."""
    lines: list[tuple[Symbol, ...]] = [()]
    for element in sequence:
        lines = [(*line, *more) for line in lines for more in _samples(rules, element, within)]
        # an odd step takes both of what comes in pairs
        lines = lines[:: len(lines) // MOST_SAMPLES | 1]
    return lines


def _samples(
    rules: OperandRules, element: Element, within: frozenset[str]
) -> list[tuple[Symbol, ...]]:
    match element:
        case Group(alternatives=alternatives):
            return [s for a in alternatives for s in _sequences(rules, a.elements, within)]
        case Repeat(item=item, operator=operator):
            once = _samples(rules, item, within)
            # more often than a short list, so that it stays one of any length
            more = [s * LONG_LIST for s in once] if operator != "?" else []
            return [*(() if operator == "+" else [()]), *once, *more]
        case Reference(name=name) if name in rules.following.values():
            return [(Symbol("", Operand((), name)),)]
        case Reference(name=name) if not name[0].isupper():
            alternatives = rules.grammar.by_name[name].alternatives
            is_level = name in rules.reaches[name] and name in rules.ladder
            if name in within or is_level or name in rules.bracketed.values():
                return [(Symbol("", Operand((), name)),)]
            inner = [e for a in alternatives for e in walk(a)]
            if rules.is_part(name) or any(isinstance(e, Literal) and e.text == "," for e in inner):
                return [
                    s for a in alternatives for s in _sequences(rules, a.elements, within | {name})
                ]
            return [(Symbol("", Operand((), name)),)]
        case Reference() | Literal():
            token = rules.grammar.token_of(element)
            lexer = rules.recognizer.lexer
            kind = lexer.kind_of[token]
            if rules.matcher.is_operand(kind):
                return [(Symbol("", Operand((kind,))),)]
            shown = lexer.display[kind]
            return [(Symbol(token if lexer.is_keyword(kind) else f"'{shown}'"),)]
    return []
