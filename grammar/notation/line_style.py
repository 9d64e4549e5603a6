"""Rows of lines in grammars of another style, written as in this project.

``(x NL+)*`` becomes ``xLine*``, with rules for the line and for its end, and a rule that is nothing
but such a row is written where it is called. The same texts are read. But now there is a rule to
which a line or a block of lines can be added, and blocks show what their bodies are.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import count

from grammar.notation.model import (
    Alternative,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    characters_of,
    walk,
)
from grammar.notation.splices import Splice, spliced


def with_ends_of_lines(grammar: Grammar) -> str:
    """Return the text with a rule for the ``NL+`` with which lines in a row end."""
    changed: dict[str, list[Splice]] = defaultdict(list)
    token = next((_repeated(end) for *_, end in _rows(grammar) if _repeated(end)), "")
    if token:
        name, last = _fresh(grammar, "eol"), grammar.parser_rules[-1]
        for rule in grammar.parser_rules:
            ends = [e for e in walk(rule) if _repeated(e) == token]
            changed[rule.name] += ((*e.span, name) for e in ends)
        place = len(last.text)
        changed[last.name].append((place, place, f"\n\n{name}\n    : {token}+\n    ;"))
    return spliced(grammar, changed)


def with_rules_of_lines(grammar: Grammar) -> str:
    """Return the text with a rule for the lines of each row ``(x NL)*``, if there are none yet."""
    if any(_has_lines(grammar, rule) for rule in grammar.parser_rules):
        return grammar.text
    changed: dict[str, list[Splice]] = defaultdict(list)
    names: dict[str, str] = {}
    rows = [
        (r, row, line, " ".join(r.source_of(row.item)[1:-1].split()))
        for r, row, line, _ in _rows(grammar)
    ]
    for rule, row, line, text in rows:
        if text not in names:
            of = line or rule.name
            names[text] = _fresh(grammar, f"{of}Line", names.values())
            changed[of].append((0, 0, f"{names[text]}\n    : {text}\n    ;\n\n"))
        changed[rule.name].append((*row.span, f"{names[text]}{row.operator}"))
    lines = {line for _, _, line, _ in rows}  # rows call these by their names
    written_out = {
        rule.name: f"{names[text]}{row.operator}"
        for rule, row, _, text in rows
        if rule is not grammar.parser_rules[0]
        and rule.name not in lines
        and [a.elements for a in rule.alternatives] == [(row,)]
    }
    for rule in grammar.parser_rules:
        for element in walk(rule):
            if isinstance(element, Repeat) and isinstance(element.item, Reference):
                # one suffix more would mean something else
                written_out.pop(element.item.name, None)
    for rule in grammar.parser_rules:
        calls = [e for e in walk(rule) if isinstance(e, Reference) and e.name in written_out]
        changed[rule.name] += ((*e.span, written_out[e.name]) for e in calls)
    for name in written_out:
        ahead = (splice for splice in changed[name] if not splice[1])
        changed[name] = [*ahead, (0, len(grammar.by_name[name].text), "")]
    return spliced(grammar, changed)


def _rows(grammar: Grammar) -> Iterator[tuple[Rule, Repeat, str, Element]]:
    """Yield the rows ``(x NL)*`` of a rule ``x``, or of what is written out in it.

    Each with its rule, ``x`` if it is a rule, else an empty text, and the end of a line.
    """
    for rule in grammar.parser_rules:
        for element in walk(rule):
            match element:
                case Repeat(
                    item=Group(alternatives=(Alternative(elements=(first, *more, end)),)),
                    operator="*" | "+",
                ) if next((e for e in walk(element) if _is_end(grammar, e)), None) == end:
                    is_rule = isinstance(first, Reference) and not first.is_token and not more
                    if more or is_rule:
                        yield rule, element, rule.source_of(first) if is_rule else "", end


def _has_lines(grammar: Grammar, rule: Rule) -> bool:
    """Return whether all alternatives of a rule end with a line."""
    return all(len(a.elements) > 1 and _is_end(grammar, a.elements[-1]) for a in rule.alternatives)


def _is_end(grammar: Grammar, element: Element) -> bool:
    """Return whether an element is the token of line ends, once or more, or such a rule."""
    match element:
        case Reference(name=name, is_token=False):
            elements = [e for a in grammar.by_name[name].alternatives for e in a.elements]
            return len(elements) == 1 and _repeated(elements[0]) != ""
        case Reference(name=name) | Repeat(item=Reference(name=name, is_token=True), operator="+"):
            return name in grammar.by_name and _has_line_end(grammar.by_name[name])
    return False


def _has_line_end(rule: Rule) -> bool:
    """Return whether a token may have the end of a line in it."""
    texts = (e.text for e in walk(rule) if isinstance(e, Literal))
    ranges = (pair for e in walk(rule) for pair in characters_of(e) or ())
    return any("\n" in text for text in texts) or any(a <= ord("\n") <= b for a, b in ranges)


def _repeated(element: Element) -> str:
    """Return the token that comes once or more; empty for any other element."""
    match element:
        case Repeat(item=Reference(name=name, is_token=True), operator="+"):
            return name
    return ""


def _fresh(grammar: Grammar, wanted: str, taken: Iterable[str] = ()) -> str:
    """Return a name that no rule has."""
    every = {*grammar.by_name, *taken}
    return next(n for k in count(1) if (n := f"{wanted}{k if k > 1 else ''}") not in every)
