"""Generation of programs that are invalid KRL under any grammar.

A short program is composed of valid fragments and mutated in one place. It is kept if it then
breaks a fact of the language (`recovery.negatives.language_facts`); that fact proves it invalid and
is its reason. So the mutations need no proof of their own. Half of the programs get two tokens that
cannot be neighbours. In the other half a line, block, bracket or word is removed, doubled, moved or
replaced.
"""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from itertools import cycle, islice, zip_longest

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS
from recovery.brackets import BRACKETS
from recovery.negatives.fragments import fragment_pool
from recovery.negatives.language_facts import adjacent, violation
from recovery.negatives.negatives import Negative
from recovery.negatives.tokens import RESERVED, RESERVED_FIRST, SourceToken, line

#: Returns a mutated program, or nothing if the mutation does not apply.
_Mutation = Callable[[list[str], random.Random], list[str] | None]

# After this many failures in a row the generator stops: nothing new can be made of the fragments.
_PATIENCE = 2_000


def generate(programs: Sequence[str] = (), *, count: int, seed: int) -> Iterator[Negative]:
    """Yield ``count`` distinct programs of at most 15 lines that break a fact of KRL.

    They are made from fragments of ``programs``, texts of valid KRL, and of a few built-in ones.
    The same arguments give the same programs in the same order. Ends early if nothing new can be
    made.
    """
    chance = random.Random(seed)
    stock = fragment_pool(programs)
    neighbours = _Neighbours(chance)
    seen: set[tuple[tuple[str, ...], ...]] = set()
    failures = 0
    for way in cycle([w for mutation in _MUTATIONS for w in (neighbours, mutation)]):
        if len(seen) == count or failures == _PATIENCE:
            return
        failures += 1
        spoilt = way(stock.program(chance), chance)
        if spoilt is None:
            continue
        text = "\n".join(spoilt) + "\n"
        found = violation(text)
        tokens = tuple(tuple(token.word for token in line(each).tokens) for each in spoilt)
        if found and tokens not in seen:
            failures = 0
            seen.add(tokens)
            yield Negative(None, text, found.fact, "parse", line=found.line)


def evenly(negatives: Iterable[Negative], count: int) -> list[Negative]:
    """Return up to ``count`` of the negatives, taken from the different reasons in turn."""
    by_reason: dict[str, list[Negative]] = defaultdict(list)
    for negative in negatives:
        by_reason[negative.reason].append(negative)
    rows = zip_longest(*by_reason.values())
    return list(islice((n for row in rows for n in row if n), count))


# ------------------------------------------------------------------------------------ neighbours

#: Texts for kinds of tokens whose name is not their text.
_SPELLINGS = {
    "name": ("COUNT", "$VEL.CP", "PART_OK"),
    "number": ("7", "0.5", "1E3"),
    "string": ('"A"', '"READY"'),
    "bits": ("'B101'", "'HFF'"),
    "enum": ("#ON", "#T1"),
    "truth": ("TRUE", "FALSE"),
    "type": ("INT", "BOOL"),
}
_ANY = ("name", "number", "string", "truth", "type", "(", ")", "=", "==", "+", ",", "THEN", "NOT")


def _spell(kind: str, chance: random.Random) -> str:
    if kind == "any":
        kind = chance.choice(_ANY)
    return chance.choice(_SPELLINGS.get(kind, (kind,)))


class _Neighbours:
    """Puts tokens side by side that cannot be neighbours; all pairs of kinds in turn."""

    def __init__(self, chance: random.Random) -> None:
        pairs = sorted(adjacent())
        chance.shuffle(pairs)
        self._pairs = cycle(pairs)

    def __call__(self, program: list[str], chance: random.Random) -> list[str] | None:
        left, right = next(self._pairs)
        sites = [
            (number, token, token.kind == left)
            for number, token in _tokens(program)
            if token.kind in (left, right)
        ]
        if sites:
            number, token, is_left = chance.choice(sites)
        else:
            number, token = chance.choice(list(_tokens(program)))
            is_left = True
        text = program[number]
        before, after = text[: token.end], text[token.end :]
        if left == "start":
            before, after = "", text
        elif not sites:
            before = f"{before} {_spell(left, chance)}"
        elif not is_left:
            before, after = f"{text[: token.start]}{_spell(left, chance)}", text[token.start :]
            return _replaced(program, number, f"{before} {after}")
        if right == "end":
            return _replaced(program, number, before)
        return _replaced(program, number, f"{before} {_spell(right, chance)} {after.lstrip()}")


def _tokens(program: list[str]) -> Iterator[tuple[int, SourceToken]]:
    """Yield every token with the index of its line."""
    for number, text in enumerate(program):
        for token in line(text).tokens:
            yield number, token


def _replaced(program: list[str], number: int, *texts: str) -> list[str]:
    return [*program[:number], *(text.rstrip() for text in texts), *program[number + 1 :]]


# --------------------------------------------------------------------------- lines and blocks

_CLOSERS = tuple(CLOSERS)
_OPENERS = (
    "IF $IN[4] THEN",
    "FOR I = 1 TO 3",
    "WHILE $IN[5]",
    "REPEAT",
    "LOOP",
    "SWITCH I",
    "SPLINE",
    "DEF NEXT()",
    "DEFFCT INT NEXT()",
    "DEFDAT NEXT",
)
_STRAYS = (*_OPENERS, *_CLOSERS[:-1], "UNTIL $IN[6]", "ELSE", "CASE 9", "DEFAULT")
_STRUCTURE = frozenset({*BLOCKS, *CLOSERS, *BRANCHES})


def _structural(program: list[str], chance: random.Random) -> int:
    """Return the index of a random line that opens, divides or closes a block."""
    return chance.choice([i for i, text in enumerate(program) if line(text).lead in _STRUCTURE])


def _without_line(program: list[str], chance: random.Random) -> list[str] | None:
    return _replaced(program, _structural(program, chance))


def _doubled_line(program: list[str], chance: random.Random) -> list[str] | None:
    at = _structural(program, chance)
    return _replaced(program, at, program[at], program[at])


def _other_closer(program: list[str], chance: random.Random) -> list[str] | None:
    closers = [i for i, text in enumerate(program) if line(text).lead in _CLOSERS]
    return _replaced(program, chance.choice(closers), chance.choice(_CLOSERS))


def _moved_line(program: list[str], chance: random.Random) -> list[str] | None:
    rest = list(program)
    moved = rest.pop(_structural(program, chance))
    rest.insert(chance.randrange(len(rest) + 1), moved)
    return rest


def _crossed_lines(program: list[str], chance: random.Random) -> list[str] | None:
    """Return the program with two structural lines swapped."""
    one, other = _structural(program, chance), _structural(program, chance)
    crossed = list(program)
    crossed[one], crossed[other] = crossed[other], crossed[one]
    return crossed


def _stray_line(program: list[str], chance: random.Random) -> list[str] | None:
    at = chance.randrange(len(program) + 1)
    return [*program[:at], chance.choice(_STRAYS), *program[at:]]


def _line_behind_end(program: list[str], chance: random.Random) -> list[str] | None:
    return [*program, chance.choice(program[1:])]


def _other_module(program: list[str], _: random.Random) -> list[str] | None:
    """Return the program with its body in the other kind of module, routine or data list."""
    if line(program[-1]).lead == "ENDDAT":
        return ["DEF NEG()", *program[1:-1], "END"]
    return ["DEFDAT NEG", *program[1:-1], "ENDDAT"]


def _operand_as_parameter(program: list[str], chance: random.Random) -> list[str] | None:
    at = program[0].find("(")
    operand = chance.choice(("7", "TRUE", "A.B", "A + 1", "#ON", "{X 1}", "A, 7", "F(A)", "INT A"))
    return _replaced(program, 0, f"{program[0][:at]}({operand})") if at > 0 else None


def _joined_lines(program: list[str], chance: random.Random) -> list[str] | None:
    at = chance.randrange(len(program) - 1)
    joined = f"{program[at]} {program[at + 1].lstrip()}"
    return [*program[:at], joined, *program[at + 2 :]]


def _split_line(program: list[str], chance: random.Random) -> list[str] | None:
    number, token = chance.choice(list(_tokens(program)))
    text = program[number]
    return _replaced(program, number, text[: token.start], text[token.start :])


# --------------------------------------------------------------------------- tokens of a line

#: Words and signs that a line cannot do without.
_NEEDED = frozenset("IF THEN FOR TO SEC WHEN DO DECL INTERRUPT =".split())
_BRACKETS = (*BRACKETS, *BRACKETS.values())
_OPENER_OF = {closer: opener for opener, closer in BRACKETS.items()}
_SWAPPED = {"=": "==", "==": "=", **BRACKETS, **_OPENER_OF}
_SIGNS = (*"+ - * / = == <> < >= . , :".split(), *_BRACKETS)
_WORDS = sorted(
    RESERVED | RESERVED_FIRST | set("TRUE INT CHAR DO TO STEP WHEN WAIT LIN INTERRUPT".split())
)


def _site(
    program: list[str], chance: random.Random, wanted: Container[str] | None = None
) -> tuple[int, SourceToken] | None:
    """Return a random token with the index of its line; all ``wanted`` words are equally likely."""
    sites: dict[str, list[tuple[int, SourceToken]]] = {}
    for number, token in _tokens(program):
        if wanted is None or token.word in wanted:
            sites.setdefault("" if wanted is None else token.word, []).append((number, token))
    return chance.choice(sites[chance.choice(list(sites))]) if sites else None


def _changed(program: list[str], site: tuple[int, SourceToken], new: str) -> list[str]:
    number, token = site
    text = program[number]
    return _replaced(program, number, f"{text[: token.start]}{new}{text[token.end :]}")


def _exchanged(
    new: Callable[[str, random.Random], str], wanted: Container[str] | None = None
) -> _Mutation:
    """Return the mutation that puts a new text for one of the wanted words, or for any token."""

    def exchanged(program: list[str], chance: random.Random) -> list[str] | None:
        site = _site(program, chance, wanted)
        return site and _changed(program, site, new(site[1].text, chance))

    return exchanged


def _second_equals(program: list[str], chance: random.Random) -> list[str] | None:
    """Return the program with an additional equals sign, as in ``A = B = 1`` or ``STEP = 2``."""
    values = [(n, t) for n, t in _tokens(program) if t.kind in ("name", "number", "truth")]
    site = chance.choice(values) if values else None
    return site and _changed(program, site, f"{chance.choice(('', 'COUNT '))}= {site[1].text}")


def _tail(program: list[str], chance: random.Random) -> list[str] | None:
    """Return the program with a value or a statement added at the end of a line."""
    number = chance.randrange(len(program))
    tail = chance.choice(("COUNT", "7", "= 7", "== 7", "+ 7", ", 7", "COUNT = 7", "WORK()", "HALT"))
    return _replaced(program, number, f"{program[number]} {tail}")


def _word_as_name(program: list[str], chance: random.Random) -> list[str] | None:
    names = [(n, t) for n, t in _tokens(program) if t.kind == "name"]
    return _changed(program, chance.choice(names), chance.choice(_WORDS)) if names else None


def _swapped_tokens(program: list[str], chance: random.Random) -> list[str] | None:
    number = chance.randrange(len(program))
    text, tokens = program[number], line(program[number]).tokens
    if len(tokens) < 2:
        return None
    at = chance.randrange(len(tokens) - 1)
    one, other = tokens[at], tokens[at + 1]
    turned = f"{text[: one.start]}{other.text} {one.text} {text[other.end :]}"
    return _replaced(program, number, turned)


#: ``=`` for ``==``, a closing bracket for an opening one, or back.
_swapped_sign = _exchanged(lambda text, _: f" {_SWAPPED[text]} ", _SWAPPED)
# Mutations that reveal most about a grammar are more frequent.
_MUTATIONS: tuple[_Mutation, ...] = (
    *[_exchanged(lambda _text, _: "", _NEEDED)] * 8,
    *[_other_module] * 3,
    _operand_as_parameter,
    *[_joined_lines, _other_closer, _stray_line, _swapped_sign, _second_equals, _tail] * 2,
    _without_line,
    _doubled_line,
    _moved_line,
    _crossed_lines,
    _line_behind_end,
    _split_line,
    _exchanged(lambda _text, _: "", _BRACKETS),
    _exchanged(lambda _text, chance: chance.choice(_BRACKETS), _BRACKETS),
    _exchanged(lambda _text, _: ""),
    _exchanged(lambda text, _: f"{text} {text}"),
    _exchanged(lambda text, chance: f"{text} {chance.choice(_SIGNS)} "),
    _exchanged(lambda text, chance: f"{text} {chance.choice(_WORDS)} "),
    _word_as_name,
    _swapped_tokens,
)
