"""Structure for a start that has none: rows that may stand in any order.

Such a start reads ``IF X THEN`` and ``ENDIF`` as rows as all others are, and any row behind any
other one. Which words open and close a block the files show (`recovery.proposals.blocks`). In what
order kinds of row stand in a file, and in each kind of block, is a chain (`recovery.forms.chain`).
Kinds that stand in either order somewhere are alternatives of one rule.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count, islice

from grammar.notation.edits import AddRule, Edit, RemoveRule, Replace
from grammar.notation.model import Reference, Rule
from grammar.parser.recognizer import Recognizer
from recovery.forms.chain import chain_of
from recovery.forms.rule_matcher import RuleMatcher
from recovery.forms.symbols import UNKNOWN, Token
from recovery.induction.block_edits import led_files
from recovery.induction.grammar_view import item_of
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.induction.steps import AcceptedStep
from recovery.proposals.blocks import BlockLines, SourceFile, find_blocks
from recovery.proposals.grammar_profile import GrammarProfile

#: The kind of row that no word begins, and the outside of all blocks.
_OTHER = ""


def with_blocks(recognizer: Recognizer, keywords: InferredKeywords) -> AcceptedStep | None:
    """Return a step that gives rows the structure of the files.

    ``None`` if the grammar has blocks, or no rows, or if no two words of rows are those of a block.
    """
    profile, lexer = GrammarProfile(recognizer), recognizer.lexer
    found = next(_rows(profile), None)
    if profile.blocks or found is None:
        return None
    _, rows, _ = found
    forms: dict[str, list[str]] = defaultdict(list)
    for alternative in rows.alternatives:
        first = alternative.elements[0]
        is_token = isinstance(first, Reference) and first.is_token and first.name != lexer.name
        kind = rows.source_of(first) if is_token else _OTHER
        forms[kind].append(" ".join(map(rows.source_of, alternative.elements)))

    matcher = RuleMatcher(recognizer)

    def kind_of(lead: str, tokens: Sequence[Token]) -> str:
        kinds = tuple(kind for kind, _ in tokens)
        # what no row reads may be of any kind
        return lead or (_OTHER if rows.name in matcher.rules_for(kinds) else UNKNOWN)

    files = [
        SourceFile(tuple((kind_of(*line), line[1]) for line in file.lines), file.origins)
        for file in led_files(keywords)
    ]
    values = {name for name, kind in lexer.kind_of.items() if lexer.has_value(kind)}
    words = {kind for file in files for kind, _ in file.lines if kind.isidentifier()}
    blocks = find_blocks(files, words - values, keywords.least)
    known = {b.opener: b for b in blocks if {b.opener, b.closer} <= forms.keys()}
    inside: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    for file in files:
        for opener, kinds in _levels([kind for kind, _ in file.lines], blocks):
            inside[opener].append(tuple(k for k in kinds if k in forms))
    if not known:
        return None
    pairs = ", ".join(f"{block.opener} to {block.closer}" for block in known.values())
    edits = _edits(profile, found, forms, known, inside)
    return AcceptedStep(f"rows are blocks: {pairs}", tuple(edits))


def _rows(profile: GrammarProfile) -> Iterator[tuple[Rule, Rule, str]]:
    """Yield the rule that has ``(x? NL)*``, the rule ``x``, and the one between if there is one."""
    by_name = profile.grammar.by_name
    for rule in profile.grammar.parser_rules:
        for element in rule.alternatives[0].elements if len(rule.alternatives) == 1 else ():
            item, often = item_of(element)
            between = item.name if isinstance(item, Reference) and not item.is_token else ""
            every = by_name[between].alternatives if between else getattr(item, "alternatives", ())
            if often in ("*", "+") and len(every) == 1 and len(every[0].elements) == 2:
                row, end = (item_of(e)[0] for e in every[0].elements)
                if isinstance(row, Reference) and not row.is_token and profile.ends_a_line(end):
                    yield rule, by_name[row.name], between


def _levels(
    kinds: Iterable[str], blocks: Sequence[BlockLines]
) -> Iterator[tuple[str, Sequence[str]]]:
    """Yield the kinds of row in each block of a file by its opener, and those outside of blocks.

    A block is a row of the kind of its opener. A file in which one is not closed shows nothing.
    """
    openers = {block.closer: block.opener for block in blocks}
    middles = {word for block in blocks for word in block.middles}
    open_: list[tuple[str, list[str]]] = [(_OTHER, [])]
    done: list[tuple[str, list[str]]] = []
    for kind in kinds:
        if kind in openers.values():
            open_.append((kind, []))
        elif kind in openers and openers[kind] == open_[-1][0]:
            done.append(open_.pop())
            open_[-1][1].append(done[-1][0])
        elif kind not in middles:
            open_[-1][1].append(kind)
    if len(open_) == 1:
        yield from (*done, *open_)


def _edits(
    profile: GrammarProfile,
    found: tuple[Rule, Rule, str],
    forms: Mapping[str, Sequence[str]],
    known: Mapping[str, BlockLines],
    inside: Mapping[str, Sequence[tuple[str, ...]]],
) -> Iterator[Edit]:
    """Yield edits after which rows of ``forms`` are in blocks, in the order ``inside`` them."""
    whole, rows, between = found
    chains = {opener: chain_of(inside[opener]) for opener in (*known, _OTHER)}
    classes: list[set[str]] = []
    for symbols in (set(factor.symbols) for chain in chains.values() for factor in chain):
        alike = [some for some in classes if some & symbols]
        classes = [some for some in classes if some not in alike]
        classes.append(symbols.union(*alike))
    number = {kind: n for n, kinds in enumerate(classes) for kind in kinds}
    order = {o: list(dict.fromkeys(number[f.symbols[0]] for f in c)) for o, c in chains.items()}
    # what no file has is where most blocks end
    ends = Counter(numbers[-1] for opener, numbers in order.items() if numbers and opener)
    (usual, _), *_ = ends.most_common(1) or [(len(classes) - 1, 0)]
    closing = {word for block in known.values() for word in (block.closer, *block.middles)}
    classes[usual] |= forms.keys() - closing - set[str]().union(*classes)
    known_names = profile.grammar.by_name.keys()
    fresh = (n for k in count(1) if {n := f"{rows.name}{k}", f"{n}Line"}.isdisjoint(known_names))
    names = [*islice(fresh, len(classes))]
    end = next(fresh)
    line_end = profile.recognizer.lexer.line_end

    def body(opener: str) -> str:
        return " ".join(f"{names[n]}Line*" for n in order[opener] or [usual])

    def choice(kind: str) -> str:
        return forms[kind][0] if len(forms[kind]) == 1 else f"({' | '.join(forms[kind])})"

    def written(kind: str) -> str:
        if kind not in known:
            return "\n    | ".join(forms[kind])
        block = known[kind]
        often = {word: often for word, often in block.often.items() if word in forms}
        middles = [f"({choice(w)} {end} {body(kind)}){o}" for w, o in often.items()]
        return " ".join((choice(kind), end, body(kind), *middles, choice(block.closer)))

    last = names[order[_OTHER][-1]] if order[_OTHER] else names[usual]
    elements = whole.alternatives[0].elements
    is_ended = whole.source_of(elements[-1]) == "EOF"
    # without rules of lines: the last line of a file may lack its end
    outer = " ".join(f"({names[n]} {end})*" for n in order[_OTHER] or [usual])
    text = f"{line_end}* {outer} {last}?"
    yield Replace(whole.name, (1, 1), text, len(elements) - is_ended)
    within = {usual}.union(*(order[opener] for opener in known))
    for place, (name, kinds) in reversed([*enumerate(zip(names, classes, strict=True))]):
        text = "\n    | ".join(written(kind) for kind in forms if kind in kinds)
        yield AddRule(rows.name, f"{name}\n    : {text}\n    ;")
        if place in within:
            yield AddRule(rows.name, f"{name}Line\n    : {name} {end}\n    ;")
    yield AddRule(rows.name, f"{end}\n    : {line_end}+\n    ;")
    yield from map(RemoveRule, filter(None, (between, rows.name)))
