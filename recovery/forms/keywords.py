"""The words of a grammar: which are reserved, which are used, which are also names.

An edit with a new word reserves it, and adds it to the grammar's lists of keywords.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from grammar.notation.edits import AddAlternative, AddToken, Edit
from grammar.notation.model import Element, Group, Literal, Reference, reached, referred
from grammar.parser.recognizer import Recognizer
from recovery.tuning import WORD_LIST_PART


class Vocabulary:
    """The keywords of one grammar, and the rules that consist of them."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.grammar = recognizer.grammar

    # ------------------------------------------------------------------------------- rules of words

    def is_set_of_words(self, rule: str) -> bool:
        """Return whether each alternative of a rule is one token."""
        return all(
            len(a.elements) == 1
            and (
                isinstance(e := a.elements[0], Literal) or (isinstance(e, Reference) and e.is_token)
            )
            for a in self.grammar.by_name[rule].alternatives
        )

    @cached_property
    def kinds_of_words(self) -> dict[str, str]:
        """For keywords that are a choice with others, the rule of that choice."""
        lexer = self.recognizer.lexer
        found: dict[str, str] = {}
        for rule in self.grammar.parser_rules:
            if len(rule.alternatives) > 1 and self.is_set_of_words(rule.name):
                for word in self.words_of(rule.name):
                    if lexer.is_keyword(lexer.kind_of[word]):
                        found.setdefault(word, rule.name)
        return found

    def words_of(self, rule: str) -> frozenset[str]:
        """Return the tokens of a rule that is a choice of tokens, or of other such rules.

        Returns none if an alternative is anything else.
        """
        found: set[str] = set()
        todo, seen = [rule], {rule}
        while todo:
            for alternative in self.grammar.by_name[todo.pop()].alternatives:
                element = alternative.elements[0] if len(alternative.elements) == 1 else None
                if isinstance(element, Reference) and not element.is_token:
                    todo += {element.name} - seen
                    seen.add(element.name)
                elif isinstance(element, Reference | Literal):
                    found.add(self.grammar.token_of(element))
                else:
                    return frozenset()
        return frozenset(found)

    def is_keyword(self, element: Element) -> bool:
        """Return whether an element is a keyword or a choice of keywords."""
        if isinstance(element, Group):
            return all(
                len(a.elements) == 1 and self.is_keyword(a.elements[0])
                for a in element.alternatives
            )
        lexer = self.recognizer.lexer
        return (
            isinstance(element, Reference)
            and element.is_token
            and lexer.is_keyword(lexer.kind_of[element.name])
        )

    # ------------------------------------------------------------------------------- uses of words

    @cached_property
    def word_lists(self) -> tuple[str, ...]:
        """Rules that list a large share of all keywords."""
        lexer = self.recognizer.lexer
        all_words = sum(lexer.is_keyword(kind) for kind in lexer.kind_of.values())
        return tuple(
            rule.name
            for rule in self.grammar.parser_rules
            if self.is_set_of_words(rule.name)
            and WORD_LIST_PART * len(rule.alternatives) > all_words
        )

    def is_written(self, word: str) -> bool:
        """Return whether a rule other than the lists of keywords uses a word.

        Rules that the rule of programs does not reach do not count.
        """
        return word in self._written

    @cached_property
    def _written(self) -> frozenset[str]:
        called = {
            rule.name: referred(rule)
            for rule in self.grammar.parser_rules
            if rule.name not in self.word_lists
        }
        return frozenset(reached(called, self.grammar.start)) - called.keys()

    def reserve(self, keywords: Iterable[str]) -> tuple[Edit, ...]:
        """Return the edits that reserve words and add them to the lists of keywords."""
        edits: list[Edit] = []
        for word in sorted(set(keywords)):
            edits.append(AddToken(word))
            edits += [AddAlternative(rule, word) for rule in self.word_lists]
        return tuple(edits)

    @cached_property
    def names(self) -> str | None:
        """The rule for names: the token of names, and keywords that are names in most places."""
        lexer = self.recognizer.lexer
        for rule in self.grammar.parser_rules:
            if self.words_of(rule.name):
                single = [a.elements[0] for a in rule.alternatives]
                words = sum(map(self.is_keyword, single))
                token = sum(isinstance(e, Reference) and e.is_token for e in single) - words
                if token == 1 and words:
                    kinds = [lexer.kind_of[t] for t in self.words_of(rule.name)]
                    if sum(map(lexer.is_keyword, kinds)) == len(kinds) - 1:
                        return rule.name
        return None

    def in_like_rules(self, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
        """Return the edits with the word that the last one adds in all rules like the one it is in.

        These are rules that have two words of that rule or more, except lists of all words. Returns
        ``None`` if there is no such rule, or no such word.
        """
        last = edits[-1]
        if not isinstance(last, AddAlternative) or AddToken(last.text) not in edits:
            return None
        written = {
            rule.name: {
                e.name
                for a in rule.alternatives
                for e in a.elements
                if len(a.elements) == 1 and isinstance(e, Reference) and e.is_token
            }
            for rule in self.grammar.parser_rules
            if rule.name not in self.word_lists
        }
        own = written.pop(last.rule, set())
        more = [AddAlternative(rule, last.text) for rule in written if len(own & written[rule]) > 1]
        return (*edits[:-1], *more, last) if more else None

    def still_names(self, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
        """Return the edits with their reserved words left names; ``None`` without a rule for names.

        Such words are added to the rule for names, and not to the lists of other keywords.
        """
        if self.names is None:
            return None
        words = [edit.name for edit in edits if isinstance(edit, AddToken)]
        listed = set(self.reserve(words))
        tokens = tuple(edit for edit in edits if isinstance(edit, AddToken))
        entered = (AddAlternative(self.names, word) for word in words)
        return (*tokens, *entered, *(edit for edit in edits if edit not in listed))
