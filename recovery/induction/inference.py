"""Edits inferred from all failing lines of a kind at once: operators, brackets, statements, blocks.

Each source looks at the lines from another side and writes edits that hold for many of them. None
is believed: `recovery.induction.rounds` tries them all and takes those that prove themselves.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from grammar.notation.addresses import Address, sequences
from grammar.notation.edits import AddAlternative, AddRule, AddToken, Edit, Insert, Replace, Widen
from grammar.notation.model import Element, Group, Literal, Reference, Repeat, walk
from grammar.parser.failures import FailureContext
from grammar.parser.recognizer import Recognizer, State
from recovery.induction.blocks import BlockLines
from recovery.induction.forms import FormWriter, samples_of, split_at_commas
from recovery.induction.symbols import (
    BRACKETS,
    Operand,
    OperandRules,
    Symbol,
    SymbolReader,
    Token,
    bracket_pairs,
    operands_of,
)
from recovery.proposals.edit_site import LinePattern, places_of
from recovery.proposals.grammar_profile import GrammarProfile

__all__ = ["Inference", "Inferred"]

_WORD = re.compile(r"\b[A-Z_][A-Z0-9_]*\b")
# Alternatives from which on a rule of words is the list of all of them.
_LONG_LIST = 8
# The part of the kinds of line of one word that another has too, for one form to read both.
_ALIKE = 0.5
# What a rule counts that an edit no longer calls, in symbols.
_LOST = 12
# Elements in a row that may be missing together.
_LONGEST_RUN = 3
# What a level counts by which operators bind weaker than they need, in symbols.
_LEVEL = 12
#: Signs that may stand ahead of an operand.
_PREFIXES = frozenset({"+", "-", "NOT"})


@dataclass(frozen=True, slots=True)
class Inferred:
    """Edits, why they were written, and the lines they were written for.

    Those that are ``is_strict`` read so much that they may accept nothing which must be rejected.
    ``breadth`` is how much more they read than others for the same lines, in symbols of a rule.
    """

    title: str
    edits: tuple[Edit, ...]
    lines: tuple[int, ...]
    is_strict: bool = False
    is_block: bool = False
    breadth: int = 0


class Inference:
    """Infers edits of one grammar from its failing lines."""

    def __init__(
        self,
        recognizer: Recognizer,
        lines: Sequence[LinePattern],
        contexts: Sequence[FailureContext],
        origins: Sequence[Collection[str]],
        blocks: Sequence[BlockLines] = (),
        prefixes: frozenset[str] = frozenset(),
        least: int = 1,
    ) -> None:
        """``contexts[n]`` is what the grammar was doing where line ``n`` fails.

        ``origins[n]`` are those that have the line; each pair of neighbours in a form has to be in
        lines of ``least`` of them.

        ``blocks`` are those of the corpus that the grammar does not have, ``prefixes`` words that
        may be missing at the head of a line.
        """
        self.recognizer = recognizer
        self.grammar = recognizer.grammar
        self.lexer = recognizer.lexer
        self.lines = lines
        self.contexts = contexts
        self._origins = origins
        self._least = least
        self._blocks = blocks
        self._prefixes = prefixes
        self.rules = OperandRules(recognizer)
        self.reader = SymbolReader(self.rules)
        self.profile = GrammarProfile(recognizer)
        self.tokens = [tuple(line.words()) for line in lines]
        self.symbols = [
            () if line.is_enormous else self.reader.symbols(tokens)
            for line, tokens in zip(lines, self.tokens, strict=True)
        ]
        self.symbols = [self._listed(symbols) for symbols in self.symbols]
        self._operator_lines: set[int] = set()
        self._operators: set[str] = {f"'{sign}'" for sign in _PREFIXES}
        self.writer = FormWriter(self.reader, operands_of(self.symbols))

    def _listed(self, symbols: tuple[Symbol, ...]) -> tuple[Symbol, ...]:
        """The symbols with reserved words as operands where they are items of a list of names."""
        name = Symbol("", Operand((self.lexer.name_kind,)))
        ends = [i for i, symbol in enumerate(symbols) if symbol.text == "','"] + [len(symbols)]
        items = {right - 1 for left, right in pairwise(ends) if right == left + 2}
        if len(items) < len(ends) - 1 or not any(symbols[i] == name for i in items):
            return symbols
        # the first item stands behind the name of what the list belongs to
        first = ends[0] - 1
        items |= {first} if first > 0 and symbols[first - 1] == name else set()
        # a word that the grammar does not reserve yet is one of the names
        kinds = {
            i: self.lexer.kind_of.get(symbols[i].text, self.lexer.name_kind)
            for i in items
            if _WORD.fullmatch(symbols[i].text)
        }
        return tuple(
            Symbol("", Operand((kinds[i],))) if i in kinds else symbol
            for i, symbol in enumerate(symbols)
        )

    def inner(self) -> Iterator[Inferred]:
        """What is missing within operands: operators, what stands in brackets."""
        yield from self.operators()
        yield from self.words_as_names()
        yield from self.operand_forms()
        yield from self.bracket_contents()

    def outer(self) -> Iterator[Inferred]:
        """What is missing of whole lines and blocks of lines."""
        yield from self.blocks()
        yield from self.line_rules()
        yield from self.statements()

    # ---------------------------------------------------------------------------- words of edits

    def reserving(self, *texts: str) -> tuple[Edit, ...]:
        """The edits that reserve the words in texts of rules that the grammar lacks."""
        found = {w for text in texts for w in _WORD.findall(re.sub(r"'[^']*'", " ", text))}
        words = sorted(w for w in found if w not in self.grammar.by_name)
        lists = [
            rule
            for rule in self.profile.vocabulary.word_lists
            if len(self.grammar.by_name[rule].alternatives) >= _LONG_LIST
        ]
        entered = (AddAlternative(rule, word) for word in words for rule in lists)
        return (*map(AddToken, words), *entered)

    # ---------------------------------------------------------------------------------- operators

    def operators(self) -> Iterator[Inferred]:
        """Words and signs between two operands or ahead of one, at each level there is."""
        infix: dict[str, list[int]] = defaultdict(list)
        prefix: dict[str, list[int]] = defaultdict(list)
        for number, line in enumerate(self.lines):
            if not line.is_enormous and 0 < line.form.index < len(self.tokens[number]) - 1:
                self._note_operator(number, infix, prefix)
        self._operator_lines = {n for ns in (*infix.values(), *prefix.values()) for n in ns}
        self._operators |= infix.keys() | prefix.keys()
        for text, members in infix.items():
            heads = {self._text(self.tokens[n][0]) for n in members}
            if text[0] != "'" and len(heads) == 1 and None not in heads:
                continue  # a word of one statement, as STEP is
            for edits, level in self._as_infix(text):
                breadth = _LEVEL * (len(self.rules.ladder) - level)
                title = f"{text} between operands"
                yield Inferred(title, edits, tuple(members), breadth=breadth)
        for text, members in prefix.items():
            for rule in self.rules.ladder:
                for alternative in self.grammar.by_name[rule].alternatives:
                    if len(alternative.elements) == 2 and _calls(alternative.elements[1], rule):
                        edits = (*self.reserving(text), AddAlternative(rule, f"{text} {rule}"))
                        yield Inferred(f"{text} ahead of an operand", edits, tuple(members))

    def _note_operator(
        self, number: int, infix: dict[str, list[int]], prefix: dict[str, list[int]]
    ) -> None:
        """Enter a line under the operator at which it seems to fail, if there is one."""
        tokens, index = self.tokens[number], self.lines[number].form.index
        ahead = self._text(tokens[index - 1])
        is_sign = ahead is not None and self._shown(tokens[index - 1]) in _PREFIXES
        if is_sign and self._begins_operand(tokens, index):
            prefix[str(ahead)].append(number)  # the sign of a number, as it seemed
        text = self._text(tokens[index])
        if not text or text == "','" or text.strip("'") in (*BRACKETS, *BRACKETS.values()):
            return
        if self._begins_operand(tokens, index + 1):
            if self._ends_operand(tokens, index):
                infix[text].append(number)
            elif self.lexer.name_kind in self._expected(number):
                prefix[text].append(number)

    def _as_infix(self, text: str) -> Iterator[tuple[tuple[Edit, ...], int]]:
        """The edits for each level of operators, and the place of that level on the ladder."""
        words = self.reserving(text)
        is_word = text[0] != "'"
        for level, rule in enumerate(self.rules.ladder):
            for number, alternative in enumerate(self.grammar.by_name[rule].alternatives, 1):
                for place, element in enumerate(alternative.elements, 1):
                    if isinstance(element, Repeat) and isinstance(element.item, Group):
                        inner = element.item.alternatives[0].elements
                        if len(inner) == 2 and self._is_operator(inner[0], is_word=is_word):
                            yield (*words, Widen(rule, (number, place, 1, 1), text)), level
        if not is_word and self.rules.ladder:
            # a sign of its own kind binds tighter than all others
            for level, rule in enumerate(self.rules.ladder, 1):
                for number, alternative in enumerate(self.grammar.by_name[rule].alternatives, 1):
                    single = alternative.elements
                    if len(single) != 1 or not isinstance(single[0], Reference):
                        continue
                    lower = single[0].name
                    if (
                        lower in self.rules.ladder
                        and len(self.grammar.by_name[rule].alternatives) > 1
                        and len(self.grammar.by_name[lower].alternatives) > 2
                    ):
                        new = self._fresh(f"{lower}Chain")
                        rule_text = f"{new}\n    : {lower} ({text} {lower})*\n    ;"
                        yield (AddRule(rule, rule_text), Replace(rule, (number, 1), new)), level
                        return

    def _is_operator(self, element: Element, *, is_word: bool) -> bool:
        some = element.alternatives[0].elements if isinstance(element, Group) else (element,)
        first = some[0] if some else None  # an alternative may be empty
        if isinstance(first, Literal):
            return not is_word and first.text != ","
        return isinstance(first, Reference) and is_word and first.is_token

    def words_as_names(self) -> Iterator[Inferred]:
        """Reserved words where a name is expected."""
        found: dict[str, list[int]] = defaultdict(list)
        name = self.lexer.name_kind
        for number, line in enumerate(self.lines):
            kind = line.form.kinds[line.form.index] if not line.is_enormous else 0
            if kind > 0 and self.lexer.is_keyword(kind) and name in self._expected(number):
                tokens, index = self.tokens[number], line.form.index
                # between signs, as a name is: an operand beside it would make it a word
                is_between = not self._ends_operand(tokens, index) and not (
                    self._begins_operand(tokens, index + 1) if index + 1 < len(tokens) else False
                )
                if index and is_between:
                    found[self.lexer.names[kind]].append(number)
        for word, members in found.items():
            if self.rules.names:
                edits = (AddAlternative(self.rules.names, word),)
                yield Inferred(f"{word} as a name", edits, tuple(members), is_strict=True)

    def operand_forms(self) -> Iterator[Inferred]:
        """What stands in brackets of its own where an operand can be."""
        found: dict[str, list[int]] = defaultdict(list)
        name = self.lexer.name_kind
        for number, line in enumerate(self.lines):
            tokens, index = self.tokens[number], line.form.index
            if line.is_enormous or index >= len(tokens):
                continue
            rule = self.rules.bracketed.get((self._text(tokens[index]) or "").strip("'"))
            if rule and rule not in self.rules.ladder and name in self._expected(number):
                found[rule].append(number)
        gathering = max(
            self.rules.ladder, key=lambda r: len(self.grammar.by_name[r].alternatives), default=None
        )
        levels = [r for r in self.rules.ladder if self.profile.has_choice(r)]
        for rule, members in found.items():
            for level in levels:
                if level != rule:
                    edits = (AddAlternative(level, rule),)
                    breadth = 0 if level == gathering else _LEVEL
                    yield Inferred(f"{rule} as an operand", edits, tuple(members), breadth=breadth)

    # ----------------------------------------------------------------------------------- brackets

    def bracket_contents(self) -> Iterator[Inferred]:
        """What stands between the brackets of a rule, from all contents that it does not read."""
        found: dict[tuple[str, str], dict[tuple[Symbol, ...], list[int]]] = defaultdict(
            lambda: defaultdict(list)
        )
        for number, line in enumerate(self.lines):
            if line.is_enormous:
                continue
            for sign, inside in _groups(self.symbols[number]):
                rule = self.rules.bracketed.get(sign)
                if rule and not any(s.text in self._operators for s in inside):
                    found[rule, sign][self._known_groups(inside)].append(number)
            tokens, index = self.tokens[number], line.form.index
            opened = self._opened(tokens, index)
            if opened is None or number in self._operator_lines:
                continue
            sign = self._shown(tokens[opened])
            close = self.reader.closer(tokens, opened)
            rule = self._writing(number, sign)
            if close is not None and rule is not None and rule not in self.rules.bracketed.values():
                inside = self.reader.symbols(tokens[opened + 1 : close])
                if not any(sign in self.rules.bracketed for sign, _ in _groups(inside)):
                    found[rule, sign][inside].append(number)
        for (rule, sign), contents in found.items():
            members = tuple(dict.fromkeys(n for numbers in contents.values() for n in numbers))
            title = f"between {sign} and {BRACKETS[sign]} of {rule}"
            for edits, lost in self._between(rule, sign, contents):
                yield Inferred(title, edits, members, breadth=lost)

    def _between(
        self, rule: str, sign: str, contents: dict[tuple[Symbol, ...], list[int]]
    ) -> Iterator[tuple[tuple[Edit, ...], int]]:
        """Edits for contents of brackets, with their breadth: parts left out, then new forms."""
        source_of = self.grammar.by_name[rule].source_of
        for number, alternative in enumerate(self.grammar.by_name[rule].alternatives, 1):
            for opening, start, end in bracket_pairs(alternative):
                if opening != sign:
                    continue
                old = alternative.elements[start + 1 : end]
                for first, count in _runs(len(old)):
                    text = _optional(" ".join(map(source_of, old[first : first + count])))
                    yield (Replace(rule, (number, start + 2 + first), text, count),), 0
                yield from self._of_items(old, contents)
                for text in self._forms(contents, samples_of(self.rules, old)):
                    at, count = (number, start + 2), len(old)
                    edit = Replace(rule, at, text, count) if count else Insert(rule, at, text)
                    yield (*self.reserving(text), edit), self._lost(old, text)

    def _of_items(
        self, old: Sequence[Element], contents: dict[tuple[Symbol, ...], list[int]]
    ) -> Iterator[tuple[tuple[Edit, ...], int]]:
        """Edits of the rule that reads the items of a list and nothing else."""
        called = {e.name for o in old for e in walk(o) if isinstance(e, Reference)}
        for name in sorted(called & self.rules.reaches.keys()):
            first, *others = self.grammar.by_name[name].alternatives
            if others or not self.rules.is_part(name):
                continue
            items: dict[tuple[Symbol, ...], list[int]] = defaultdict(list)
            for inside, numbers in contents.items():
                for item in split_at_commas(inside)[1:]:  # ahead of the first one there may be more
                    items[item] += numbers
            for text in self._forms(items, samples_of(self.rules, first.elements)) if items else ():
                edit = Replace(name, (1, 1), text, len(first.elements))
                yield (*self.reserving(text), edit), self._lost(first.elements, text)

    def _lost(self, old: Sequence[Element], text: str) -> int:
        """What a text costs for the rules that the old elements call and it does not."""
        written = set(re.findall(r"\w+", text))
        called = {
            e.name for o in old for e in walk(o) if isinstance(e, Reference) and not e.is_token
        }
        return _LOST * sum(
            not any(self.rules.includes(other, name) for other in written)
            for name in called & self.rules.reaches.keys()
        )

    def _known_groups(self, symbols: Sequence[Symbol]) -> tuple[Symbol, ...]:
        """The symbols with groups, where a rule is such a group, as operands of that rule."""
        out = []
        for symbol in symbols:
            rule = self.rules.bracketed.get(symbol.text.strip("'"))
            if symbol.inside is not None and rule:
                # what only follows operands, as an index, is written as its rule
                follows = rule in self.rules.recursive and rule not in self.rules.ladder
                out.append(Symbol(rule) if follows else Symbol("", Operand((), rule)))
            else:
                out.append(symbol)
        return tuple(out)

    def _opened(self, tokens: Sequence[Token], index: int) -> int | None:
        """The place of the innermost bracket that is open at a token."""
        depth = 0
        for place in range(min(index, len(tokens)) - 1, -1, -1):
            shown = self._shown(tokens[place])
            if shown in BRACKETS.values():
                depth += 1
            elif shown in BRACKETS:
                if not depth:
                    return place
                depth -= 1
        return None

    def _writing(self, number: int, sign: str) -> str | None:
        """The innermost rule at work that writes the bracket."""
        for rule in reversed(self.contexts[number].rules):
            for alternative in self.grammar.by_name[rule].alternatives:
                if any(opening == sign for opening, _, _ in bracket_pairs(alternative)):
                    return rule
        return None

    # -------------------------------------------------------------------------------------- blocks

    def blocks(self) -> Iterator[Inferred]:
        """Blocks of several lines where their first line may stand."""
        for block in self._blocks:
            members = self._opening(block)
            for host in self._hosts_of_block(block):
                for body in self._bodies(host):
                    text = self._block_text(block, body)
                    if text:
                        ending = f" {self.profile.line_end}" if self.profile.closing(host) else ""
                        edits = (*self.reserving(text), AddAlternative(host, text + ending))
                        title = f"{block.opener} to {block.closer} as {host}"
                        yield Inferred(title, edits, members, is_block=True)

    def _opening(self, block: BlockLines) -> tuple[int, ...]:
        """The lines that open a block."""
        return tuple(
            n
            for n, symbols in enumerate(self.symbols)
            if symbols and block.opener in [s.text for s in symbols[:2]]
        )

    def _hosts_of_block(self, block: BlockLines) -> dict[str, None]:
        """The rules of which a block may be an alternative."""
        return dict.fromkeys(host for n in self._opening(block) for host in self._block_hosts(n))

    def _block_hosts(self, number: int) -> list[str]:
        entered = self._entered(number)
        found = sorted(entered & self.profile.of_lines or entered & self.profile.blocks)
        # where some rules have blocks among their lines the others have none
        return [host for host in found if self._has_blocks(host)] or found

    def _has_blocks(self, rule: str) -> bool:
        blocks = self.profile.blocks
        return rule in blocks or not blocks.isdisjoint(self.profile.near(rule))

    def _bodies(self, host: str) -> list[str]:
        """What may be between the lines of a block: what is so in the blocks that a rule has."""
        texts = [" ".join(body) for body in self.profile.bodies] or [
            f"{rule}*" for rule in sorted(self.profile.loops & self.profile.of_lines)
        ]
        written = " ".join(self.grammar.by_name[host].text.split())
        return [t for t in texts if t in written] or texts[:1]

    def _block_text(self, block: BlockLines, body: str) -> str | None:
        end = self.profile.line_end
        header, closer = self._line_form(block.headers), self._line_form(block.closers)
        if not header or not closer:
            return None
        parts = [header, end, *([body] if block.has_body else [])]
        for word, often in block.often.items():
            middle = self._line_form(block.middles[word])
            if not middle:
                return None
            text = f"{middle} {end} {body}"
            parts.append(f"({text}){often}" if often else text)
        return " ".join((*parts, closer))

    def _line_form(self, lines: Mapping[tuple[Token, ...], Collection[str]]) -> str | None:
        shapes: dict[tuple[Symbol, ...], set[str]] = defaultdict(set)
        for tokens, origins in lines.items():
            shapes[self._known_groups(self.reader.symbols(tokens))].update(origins)
        return self.writer.form([shape for shape in self._supported(shapes) if shape])

    # ---------------------------------------------------------------------------------- statements

    def line_rules(self) -> Iterator[Inferred]:
        """A kind of line where another one is expected."""
        found: dict[tuple[str, str], list[int]] = defaultdict(list)
        kinds_of = sorted(self.profile.of_lines)
        for number, line in enumerate(self.lines):
            if line.is_enormous or line.keywords:
                continue
            read = self.rules.matcher.rules_for(line.form.kinds)
            # what ends with the line stands for what ends with it too: a second end is a blank line
            for host in filter(self.profile.closing, self._hosts(number)):
                for other in kinds_of:
                    if other in read and other != host:
                        found[host, other].append(number)
        for (host, other), members in found.items():
            edits = (AddAlternative(host, other),)
            fresh = {other, *self.rules.reaches[other]} - {host, *self.rules.reaches[host]}
            known = self.grammar.by_name
            breadth = sum(len(known[name].alternatives) for name in fresh if name in known)
            yield Inferred(f"{other} as {host}", edits, tuple(members), breadth=breadth)

    def statements(self) -> Iterator[Inferred]:
        """Forms of lines by their first word, or first sign where they begin with a name."""
        groups: dict[tuple[tuple[str, ...], str], list[int]] = defaultdict(list)
        # where no rule has blocks, or lines in a row that could be within one, each line is its own
        kept_for_blocks = frozenset[str]().union(
            *(
                block.words
                for block in self._blocks
                if any(map(self._bodies, self._hosts_of_block(block)))
            )
        )
        self.symbols = [self._known_groups(symbols) for symbols in self.symbols]
        for number, line in enumerate(self.lines):
            symbols = self.symbols[number]
            if line.is_enormous or not symbols or self._opened_in_group(number):
                continue
            beside = [a.is_operand and b.is_operand for a, b in pairwise(symbols)]
            if symbols[0].is_operand and (any(beside) or len(symbols) == 1):
                continue  # no line is a value, or two without a word that says what they are
            head = self._head(symbols)
            if kept_for_blocks.isdisjoint(s.text for s in symbols[:2]):
                groups[self._hosts(number), head].append(number)
        families = list(_families(groups))
        for (hosts, head), members in families:
            yield from self._statement(hosts, head, members)
        yield from self._of_many_words(families)

    def _of_many_words(
        self, families: Sequence[tuple[tuple[tuple[str, ...], str], list[int]]]
    ) -> Iterator[Inferred]:
        """One form for lines that begin with different words and go on alike."""
        gathered: dict[tuple[str, ...], list[tuple[str, list[int], set[tuple[str, ...]]]]]
        gathered = defaultdict(list)
        for (hosts, head), members in families:
            if _WORD.fullmatch(head) and head not in self._leading:
                tails = {
                    tuple(map(self._sort, self.symbols[n][1:]))
                    for n in members
                    if self.symbols[n][0].text == head
                }
                gathered[hosts].append((head, members, tails))
        for hosts, heads in gathered.items():
            # around each word those that have most kinds of tail in common with it
            for head, _, tails in heads:
                alike = [
                    h for h in heads if len(h[2] & tails) >= _ALIKE * min(len(h[2]), len(tails))
                ]
                if len(alike) < 3:
                    continue
                every = tuple(n for _, ns, _ in alike for n in ns)
                shapes = dict.fromkeys(
                    self.symbols[n][1:] for n in members if self.symbols[n][0].text in _of(alike)
                )
                tail = self.writer.form(list(shapes))
                for host in hosts if tail else ():
                    ending = f" {self.profile.line_end}" if self.profile.closing(host) else ""
                    text = f"({' | '.join(sorted(_of(alike)))}) {tail}{ending}"
                    edits = (*self.reserving(text), AddAlternative(host, text))
                    yield Inferred(
                        f"{head} and {len(alike) - 1} words as {host}", edits, every, is_strict=True
                    )

    def _opened_in_group(self, number: int) -> bool:
        """Whether a line fails within brackets that a rule of the grammar writes."""
        index = self.lines[number].form.index
        opened = self._opened(self.tokens[number], index) if index else None
        if opened is None:
            return False
        return self._writing(number, self._shown(self.tokens[number][opened])) is not None

    def _head(self, symbols: Sequence[Symbol]) -> str:
        """What says which kind of line it is: its first word, behind one that may be missing."""
        texts = [symbol.text for symbol in symbols[:3]]
        if symbols[0].is_operand:
            return " ".join(["_", *texts[1:2]])
        if len(texts) > 1 and texts[0] in self._prefixes and _WORD.fullmatch(texts[1]):
            texts = texts[1:]
        # where several alternatives begin alike the second word tells them apart
        if self._leading.get(texts[0], 0) > 1 and len(texts) > 1 and _WORD.fullmatch(texts[1]):
            return " ".join(texts[:2])
        return texts[0]

    @cached_property
    def _leading(self) -> dict[str, int]:
        """The words that alternatives begin with, lists of words left out, and of how many."""
        found: dict[str, int] = defaultdict(int)
        for _, _, first in self._alternatives():
            for word in _words(first[0]):
                found[word] += 1
        return found

    def _alternatives(self) -> Iterator[tuple[str, int, tuple[Element, ...]]]:
        """Alternatives that may be a line: rule, number, and the elements of the first line."""
        end = self.profile.line_end
        for rule in self.grammar.rules:
            if rule.is_lexer or rule.name in self.rules.recursive:
                continue
            if self.profile.vocabulary.is_set_of_words(rule.name) and len(rule.alternatives) > 1:
                continue
            for number, alternative in enumerate(rule.alternatives, 1):
                elements = alternative.elements
                ends = [i for i, e in enumerate(elements) if rule.source_of(e) == end]
                first = elements[: ends[0]] if ends else elements
                if len(first) > 1 or (first and len(rule.alternatives) == 1):
                    yield rule.name, number, first

    @cached_property
    def _all_lines(self) -> list[tuple[str, Address, tuple[Element, ...]]]:
        """Alternatives that may be a line, then the lines within blocks, with their places."""
        outer = ((rule, (number, 1), first) for rule, number, first in self._alternatives())
        return [*outer, *self._inner_lines()]

    def _inner_lines(self) -> Iterator[tuple[str, Address, tuple[Element, ...]]]:
        """The lines within blocks and at their end: rule, place of the first element, elements."""
        end = self.profile.line_end
        for rule in self.grammar.rules:
            for address, sequence in () if rule.is_lexer else sequences(rule):
                elements = sequence.elements
                ends = [i for i, e in enumerate(elements) if rule.source_of(e) == end]
                starts = [0] * (len(address) > 1) + [i + 1 for i in ends]
                for begin in starts if ends else ():
                    start = begin
                    stop = next((i for i in ends if i >= start), len(elements))
                    while start < stop and not self._is_within_line(elements[start]):
                        start += 1  # the lines of a body come first
                    if start < stop:
                        yield rule.name, (*address, start + 1), elements[start:stop]

    def _is_within_line(self, element: Element) -> bool:
        called = {e.name for e in walk(element) if isinstance(e, Reference) and not e.is_token}
        return called <= self.rules.within_lines

    def _hosts(self, number: int) -> tuple[str, ...]:
        """Rules that a line could be where it begins, those that end with a line end last."""
        before = self.lines[number].form.before
        if before not in self._hosts_of:
            entered = self._entered(number)
            lines = sorted(entered & self.profile.of_lines)
            self._hosts_of[before] = tuple(sorted(entered & self._whole_lines) + lines)
        return self._hosts_of[before]

    def _entered(self, number: int) -> frozenset[str]:
        """Rules that may begin where a line does."""
        recognizer, network = self.recognizer, self.recognizer.network
        sites = recognizer.sites(recognizer.restore(self.lines[number].form.before))
        return frozenset(
            network.rule[entry] for site in sites for entry, _ in network.calls[site[0]]
        )

    @cached_property
    def _hosts_of(self) -> dict[object, tuple[str, ...]]:
        return {}

    @cached_property
    def _whole_lines(self) -> frozenset[str]:
        """Rules that gather alternatives and are somewhere all of a line but its end."""
        ends = {*self.profile.line_ends, self.lexer.line_end}
        found: set[str] = set()
        for rule in self.grammar.rules:
            for _, sequence in () if rule.is_lexer else sequences(rule):
                called = [
                    inner.name if isinstance(inner, Reference) else ""
                    for e in sequence.elements
                    for inner in [e.item if isinstance(e, Repeat) else e]
                ]
                found.update(
                    name
                    for before, name, behind in zip(["", *called], called, called[1:], strict=False)
                    if behind in ends and (not before or before in ends)
                )
        return frozenset(filter(self.profile.is_hub, found & self.rules.reaches.keys()))

    def _sort(self, symbol: Symbol) -> str:
        """A symbol by its text, an operand by the bracket it ends with."""
        kinds = symbol.operand.kinds if symbol.operand else ()
        shown = self._shown((kinds[-1], None)) if kinds else ""
        return symbol.text or (shown if shown in BRACKETS.values() else "_")

    def _finer_sort(self, symbol: Symbol) -> str:
        """The sort of a symbol; operands by their rule, and by whether they begin with a name."""
        if symbol.operand is None or symbol.operand.rule:
            return symbol.text or (symbol.operand.rule if symbol.operand else "")
        first = symbol.operand.kinds[0]
        is_name = first == self.lexer.name_kind or self.rules.matcher.may_be_a_name(first)
        return "name" if is_name else self._sort(symbol)

    def _statement(
        self, hosts: Sequence[str], head: str, members: Sequence[int]
    ) -> Iterator[Inferred]:
        shapes: dict[tuple[Symbol, ...], list[int]] = defaultdict(list)
        for number in members:
            shapes[self.symbols[number]].append(number)
        grown = list(self._grown(head, shapes, members))
        if grown:
            yield from grown
            return
        title = head.replace("_ ", "name ").strip()
        for text in self._forms(shapes):
            for host in hosts:
                ending = f" {self.profile.line_end}" if self.profile.closing(host) else ""
                added = AddAlternative(host, f"{text}{ending}")
                edits = (*self.reserving(text), added)
                yield Inferred(f"{title} … as {host}", edits, tuple(members))

    def _grown(
        self, head: str, shapes: dict[tuple[Symbol, ...], list[int]], members: Sequence[int]
    ) -> Iterator[Inferred]:
        """An alternative that begins with the same words, so that it reads these lines too."""
        words = head.split()
        for rule, place, first in self._all_lines:
            inside = [e for e in first if not (isinstance(e, Repeat) and e.operator == "?")]
            leads = [_words(e) for e in inside[:2]]
            if not inside or words[0] not in leads[0]:
                continue
            if len(words) > 1 and (len(leads) < 2 or words[1] not in leads[1]):
                continue
            title = f"{head} … in {rule}"
            for at, tails in self._tails(rule, place, len(first), members).items():
                # what a comma begins would be taken for a list; some only do so go on with one
                begun = {tail[0].text for tail in tails}
                comma = "','" if "','" in begun else ""
                rests = {tail[1:]: ns for tail, ns in tails.items()} if comma else tails
                for text in self._forms(rests) if not comma or len(begun) == 1 else ():
                    edits = (
                        *self.reserving(text),
                        Insert(rule, at, _optional(f"{comma} {text}".strip())),
                    )
                    yield Inferred(title, edits, tuple(members))
            for text in self._forms(shapes, samples_of(self.rules, first)):
                edits = (*self.reserving(text), Replace(rule, place, text, len(first)))
                yield Inferred(title, edits, tuple(members), breadth=self._lost(first, text))

    def _tails(
        self, rule: str, place: Address, count: int, members: Sequence[int]
    ) -> dict[Address, dict[tuple[Symbol, ...], list[int]]]:
        """What lines go on with where elements of a rule may be all of a line, by the place."""
        *outer, first = place
        places = {(*outer, first + n) for n in range(1, count + 1)}
        found: dict[Address, dict[tuple[Symbol, ...], list[int]]] = {}
        for number in members:
            if self.lexer.line_kind in self._expected(number):
                tokens = self.tokens[number][self.lines[number].form.index :]
                tail = self._known_groups(self.reader.symbols(tokens))
                for at in sorted(places & self._places(number, rule)) if tail else ():
                    found.setdefault(at, defaultdict(list))[tail].append(number)
        return found

    def _places(self, number: int, rule: str) -> set[Address]:
        """Where in a rule the grammar stands when a line fails."""
        recognizer = self.recognizer
        sites = recognizer.sites(self._state(number))
        within = (site for site in sites if recognizer.network.rule[site[0]] == rule)
        return {place for site in within for place in places_of(recognizer, site)}

    def _forms(
        self, shapes: dict[tuple[Symbol, ...], list[int]], old: Sequence[tuple[Symbol, ...]] = ()
    ) -> Iterator[str]:
        """Forms of ``old`` shapes and these: all, those that recur, those whose words recur.

        One odd line must not spoil the form, nor one origin.
        """
        having = {
            shape: set[str]().union(*(self._origins[n] for n in numbers))
            for shape, numbers in shapes.items()
        }
        shapes = {shape: shapes[shape] for shape in self._supported(having, old)}
        lines = Counter(text for shape in shapes for text in {symbol.text for symbol in shape})
        choices = [
            [shape for shape, numbers in shapes.items() if len(numbers) >= least]
            for least in (1, 2, 4)
        ]
        choices += [
            [shape for shape in shapes if all(lines[symbol.text] >= least for symbol in shape)]
            for least in (2, 4)
        ]
        texts = [self.writer.form([*old, *chosen]) for chosen in choices if chosen]
        yield from dict.fromkeys(text for text in texts if text)

    def _supported(
        self,
        shapes: Mapping[tuple[Symbol, ...], Collection[str]],
        old: Sequence[tuple[Symbol, ...]] = (),
    ) -> list[tuple[Symbol, ...]]:
        """Those in which all neighbours are such in enough origins, or in an ``old`` shape.

        ``shapes`` come with the origins that have them.
        """
        pairs = {shape: frozenset(self._pairs(shape)) for shape in shapes}
        known = {pair for shape in old for pair in self._pairs(shape)}
        having: dict[tuple[str, ...], set[str]] = defaultdict(set)
        for shape, origins in shapes.items():
            for pair in pairs[shape]:
                having[pair].update(origins)
        enough = known | {pair for pair, found in having.items() if len(found) >= self._least}
        return [shape for shape in shapes if pairs[shape] <= enough]

    def _pairs(self, symbols: Sequence[Symbol], group: str = "") -> Iterator[tuple[str, ...]]:
        """What stands beside what, in groups in brackets too; operands by their sort."""
        for left, right in pairwise(["", *map(self._finer_sort, symbols), ""]):
            yield group, left, right
        for symbol in symbols:
            if symbol.inside is not None:
                yield from self._pairs(symbol.inside, f"{group}{symbol.text}")

    # ------------------------------------------------------------------------------------- helpers

    def _shown(self, token: Token) -> str:
        return self.lexer.display[token[0]] if token[0] > 0 else ""

    def _text(self, token: Token) -> str | None:
        """What an edit writes for a word or a sign; ``None`` for what is neither."""
        kind, word = token
        if word:
            return word
        if kind <= 0 or kind == self.lexer.line_kind:
            return None
        shown = self.lexer.display[kind]
        if self.lexer.is_keyword(kind):
            return self.lexer.names[kind]
        return f"'{shown}'" if shown != self.lexer.names[kind] else None

    def _ends_operand(self, tokens: Sequence[Token], at: int) -> bool:
        kind, word = tokens[at - 1]
        return not word and (
            (kind > 0 and self.rules.matcher.is_operand(kind))
            or self._shown(tokens[at - 1]) in BRACKETS.values()
        )

    def _begins_operand(self, tokens: Sequence[Token], at: int) -> bool:
        kind, word = tokens[at]
        if word or kind <= 0:
            return False
        shown = self._shown(tokens[at])
        return (
            (self.rules.matcher.is_operand(kind) and kind != self.lexer.line_kind)
            or shown in BRACKETS
            or self.rules.widest in self.rules.matcher.rules_for((kind,))
            or shown in _PREFIXES
        )

    def _state(self, number: int) -> State:
        """Where the grammar stands when a line fails."""
        form = self.lines[number].form
        before = self.recognizer.restore(form.before)
        return self.recognizer.run(before, form.kinds[: form.index])[0]

    def _expected(self, number: int) -> frozenset[int]:
        return self.recognizer.expected(self._state(number))

    def _fresh(self, wanted: str) -> str:
        name, count = wanted, 2
        while name in self.grammar.by_name:
            name, count = f"{wanted}{count}", count + 1
        return name


def _groups(symbols: Sequence[Symbol]) -> Iterator[tuple[str, tuple[Symbol, ...]]]:
    """Groups in brackets at any depth that no rule has read: the opening sign and the inside."""
    for symbol in symbols:
        if symbol.inside is not None:
            yield symbol.text.strip("'"), symbol.inside
            yield from _groups(symbol.inside)


def _families(
    groups: dict[tuple[tuple[str, ...], str], list[int]],
) -> Iterator[tuple[tuple[tuple[str, ...], str], list[int]]]:
    """The groups, those of the same head in one whose lines may be the same rules."""
    done: list[tuple[set[str], str, list[int]]] = []
    for (hosts, head), members in groups.items():
        same = next((d for d in done if d[1] == head and d[0] & set(hosts)), None)
        if same is None:
            done.append((set(hosts), head, list(members)))
        else:
            same[0].intersection_update(hosts)
            same[2].extend(members)
    order = {host: place for hosts, _ in groups for place, host in enumerate(hosts)}
    for left, head, gathered in done:
        yield (tuple(sorted(left, key=lambda h: (order[h], h))), head), gathered


def _of(heads: Sequence[tuple[str, list[int], set[tuple[str, ...]]]]) -> list[str]:
    return [head for head, _, _ in heads]


def _optional(text: str) -> str:
    """A text that may be missing; what may be already stays as it is."""
    if not re.fullmatch(r"\S+", text):
        return f"({text})?"
    if text[-1] == "+":
        return f"{text[:-1]}*"
    return text if text[-1] in "?*" else f"{text}?"


def _runs(count: int) -> Iterator[tuple[int, int]]:
    """Runs of so many elements, but not all of them: the first one and how many."""
    for length in range(1, min(_LONGEST_RUN, count - 1) + 1):
        yield from ((start, length) for start in range(count - length + 1))


def _calls(element: object, rule: str) -> bool:
    return isinstance(element, Reference) and element.name == rule


def _words(element: object) -> frozenset[str]:
    """The words that an element is: one, or a choice of them."""
    match element:
        case Reference(name=name) if name.isupper():
            return frozenset({name})
        case Group(alternatives=alternatives):
            return frozenset(
                w for a in alternatives if len(a.elements) == 1 for w in _words(a.elements[0])
            )
        case Repeat(item=item):
            return _words(item)
        case _:
            return frozenset()
