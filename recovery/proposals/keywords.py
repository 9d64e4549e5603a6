"""The words of a grammar: which are reserved, which have a use, which are also names.

An edit that needs a new word reserves it, and adds it where the grammar lists its words.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from grammar.notation.edits import AddAlternative, AddToken, Edit
from grammar.notation.model import Element, Group, Literal, Reference, walk
from grammar.parser.recognizer import Recognizer
from recovery.tuning import WORD_LIST_PART


class Vocabulary:
    """The reserved words of one grammar, and the rules that are made of them."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.grammar = recognizer.grammar

    # ------------------------------------------------------------------------------- rules of words

    def is_set_of_words(self, rule: str) -> bool:
        """Whether each alternative of a rule is one token."""
        return all(
            len(a.elements) == 1
            and (
                isinstance(e := a.elements[0], Literal) or (isinstance(e, Reference) and e.is_token)
            )
            for a in self.grammar.by_name[rule].alternatives
        )

    @cached_property
    def kinds_of_words(self) -> dict[str, str]:
        """Reserved words that are a choice with others, names too perhaps, with the rule of it."""
        lexer = self.recognizer.lexer
        found: dict[str, str] = {}
        for rule in self.grammar.rules:
            if not rule.is_lexer and len(rule.alternatives) > 1 and self.is_set_of_words(rule.name):
                for word in self.words_of(rule.name):
                    if lexer.is_keyword(lexer.kind_of[word]):
                        found.setdefault(word, rule.name)
        return found

    def words_of(self, rule: str) -> frozenset[str]:
        """The tokens of a rule whose alternatives are one token, or one such rule, each.

        None where an alternative is anything else.
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
        """Whether an element is a reserved word, or a choice of such words."""
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
        """Rules that list reserved words, many of all there are."""
        lexer = self.recognizer.lexer
        all_words = sum(lexer.is_keyword(kind) for kind in lexer.kind_of.values())
        return tuple(
            rule.name
            for rule in self.grammar.rules
            if not rule.is_lexer
            and self.is_set_of_words(rule.name)
            and WORD_LIST_PART * len(rule.alternatives) > all_words
        )

    def is_written(self, word: str) -> bool:
        """Whether some rule has a use for a word; to be listed among all is none."""
        return word in self._written

    @cached_property
    def _written(self) -> frozenset[str]:
        return frozenset(
            e.name
            for rule in self.grammar.rules
            if not rule.is_lexer and rule.name not in self.word_lists
            for a in rule.alternatives
            for e in walk(a)
            if isinstance(e, Reference) and e.is_token
        )

    def reserve(self, keywords: Iterable[str]) -> tuple[Edit, ...]:
        """The edits that reserve words, and add them where all reserved words are listed."""
        edits: list[Edit] = []
        for word in sorted(set(keywords)):
            edits.append(AddToken(word))
            edits += [AddAlternative(rule, word) for rule in self.word_lists]
        return tuple(edits)

    @cached_property
    def names(self) -> str | None:
        """The rule of what is a name: a token, and keywords that are names in most places."""
        lexer = self.recognizer.lexer
        for rule in self.grammar.rules:
            if not rule.is_lexer and self.words_of(rule.name):
                single = [a.elements[0] for a in rule.alternatives]
                words = sum(map(self.is_keyword, single))
                token = sum(isinstance(e, Reference) and e.is_token for e in single) - words
                if token == 1 and words:
                    kinds = [lexer.kind_of[t] for t in self.words_of(rule.name)]
                    if sum(map(lexer.is_keyword, kinds)) == len(kinds) - 1:
                        return rule.name
        return None

    def still_names(self, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
        """The edits with the words they reserve left names; ``None`` where there is no such rule.

        Such words are in the list of names then, and not in that of all other reserved words.
        """
        if self.names is None:
            return None
        words = [edit.name for edit in edits if isinstance(edit, AddToken)]
        listed = set(self.reserve(words))
        tokens = tuple(edit for edit in edits if isinstance(edit, AddToken))
        entered = (AddAlternative(self.names, word) for word in words)
        return (*tokens, *entered, *(edit for edit in edits if edit not in listed))
