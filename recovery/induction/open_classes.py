"""Places that are open to words and texts which no shown file has.

How many words a further origin has that none of these has is estimated by the words that only one
of these has (Good and Turing). To the lexer such a word is a name. So where a rule chooses between
words, and where a word begins a statement, a name may be. That is asked at the end: before it, it
would hide what the files show.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Set

from grammar.notation.edits import AddAlternative, Replace
from grammar.notation.model import Group, Reference, walk
from grammar.parser.lexer import Lexer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.grammar_view import GrammarView, item_of
from recovery.induction.literals import blanks_between_quotes, has_blank, is_quoted
from recovery.induction.steps import InferredStep
from recovery.tuning import SEVERAL


def rare_words(lexer: Lexer, lines: CorpusLines) -> frozenset[str]:
    """Return the reserved words that are each of a single origin, where there are others."""
    having: dict[str, set[str]] = defaultdict(set)
    for line, origins in zip(lines.lines, lines.origins, strict=True):
        for word in set(line):
            having[lexer.names[lexer.kinds[word]]] |= origins
    several = len(frozenset[str]().union(*lines.origins)) > 1
    words = [name for name in having if several and lexer.is_keyword(lexer.kind_of[name])]
    return frozenset(name for name in words if len(having[name]) == 1)


def open_choices(view: GrammarView, rare: Set[str]) -> Iterator[InferredStep]:
    """Yield any word beside each choice of words of lines with a rare one.

    A word between operands says more.
    """
    found: dict[frozenset[str], list[Replace]] = defaultdict(list)
    for rule, at, element, _ in view.elements():
        group, often = item_of(element)
        words = view.words(group) if isinstance(group, Group) else frozenset()
        if len(words) > 1 and words <= view.reserved and words & rare:
            text = f"({' | '.join(sorted(words))} | {_name(view)}){often}"
            found[words].append(Replace(rule.name, at, text))
    for words, edits in found.items():
        yield InferredStep(f"any word beside {', '.join(sorted(words))}", tuple(edits), ())


def open_statements(view: GrammarView, _rare: Set[str]) -> Iterator[InferredStep]:
    """Yield any word ahead of a variable, with all that follows operands behind a first word."""
    variable = view.writer.cover.variable
    reading = view.rules.including(variable) if variable else frozenset[str]()
    heads: dict[str, set[str]] = defaultdict(set)
    tails: dict[str, None] = {}
    for rule, _, (word, operand, *tail) in view.lines():
        words = view.words(word)
        is_headed = words and words <= view.reserved and rule.name not in view.rules.recursive
        if is_headed and isinstance(operand, Reference) and operand.name in reading:
            heads[rule.name] |= words
            tails[view.source(rule.name, tail)] = None
    if sum(map(len, heads.values())) < SEVERAL:
        return
    host = view.grammar.by_name[max(heads, key=lambda name: len(heads[name]))]
    more = " | ".join(filter(None, tails))
    text = f"{_name(view)} {variable}" + (more and f" ({more})" + "?" * ("" in tails))
    if text not in map(host.source_of, host.alternatives):
        title = f"any word ahead of a variable as {host.name}"
        yield InferredStep(title, (AddAlternative(host.name, text),), ())


def open_words(view: GrammarView, _rare: Set[str]) -> Iterator[InferredStep]:
    """Yield any word alone on a line, where several words are."""
    alone: dict[str, set[str]] = defaultdict(set)
    is_list = view.profile.vocabulary.is_set_of_words
    for rule in (r for r in view.grammar.parser_rules if not is_list(r.name)):
        single = (a.elements[0] for a in rule.alternatives if len(a.elements) == 1)
        for words in map(view.words, single):
            alone[rule.name] |= words if words <= view.reserved else frozenset()
    name = max(alone, key=lambda rule: len(alone[rule]), default="")
    host = view.grammar.by_name.get(name)
    if host is None or len(alone[name]) < SEVERAL or name in view.rules.recursive:
        return
    if _name(view) not in map(host.source_of, host.alternatives):
        yield InferredStep(f"any word as {name}", (AddAlternative(name, _name(view)),), ())


def blanks_in_quotes(view: GrammarView, _rare: Set[str]) -> Iterator[InferredStep]:
    """Yield blanks in texts between quotes, where those between other quotes have some."""
    tokens = [a for r in view.grammar.rules if r.is_lexer for a in r.alternatives if is_quoted(a)]
    if any(has_blank(inner) for a in tokens for e in a.elements for inner in walk(e)):
        for edit in blanks_between_quotes(view.grammar):
            title = f"blanks in {edit.rule} {edit.at[0]}"
            yield InferredStep(title, (edit,), ())


#: The kinds of opening, in the order in which they are made.
OPENINGS: tuple[Callable[[GrammarView, Set[str]], Iterator[InferredStep]], ...] = (
    blanks_in_quotes,
    open_choices,
    open_statements,
    open_words,
)


def _name(view: GrammarView) -> str:
    """Return what a rule writes for a new word, which is a name to the lexer."""
    return view.rules.names or view.lexer.name
