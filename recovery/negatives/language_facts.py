"""Facts about KRL that hold for every program, whatever the current grammar is.

A grammar says what it accepts today. These few facts say what KRL never has: tokens that cannot be
neighbours (``adjacent.tsv``), brackets and blocks that do not match, lines without the word that
identifies them. They claim far less than a grammar does, so they hold for the programs of every
dialect, and a text that breaks one is invalid for a reason that can be named.

Sources: the rules of control flow, declarations, interrupts and triggers (CTL, TYP, SCO, INT, TRG),
and our own and the public corpus, whose valid files break none of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import pairwise

from grammar.blocks import BLOCKS, CLOSERS, OUTERMOST
from grammar.motion_kinds import MOTIONS, PLAIN_MOTIONS
from recovery.brackets import BRACKETS, CLOSING, closer_of
from recovery.negatives.tokens import RESERVED, SourceLine, lines
from support.files.tables import read_table


@dataclass(frozen=True, slots=True)
class Violation:
    """A broken fact, and the line, from 1, at which that is detected."""

    line: int
    fact: str


def violation(text: str) -> Violation | None:
    """Return the first fact that a text breaks; ``None`` does not mean that it is valid."""
    program = lines(text)
    for number, line in enumerate(program, 1):
        fact = _broken(line)
        if fact:
            return Violation(number, fact)
    return _blocks(program)


@lru_cache(maxsize=1 << 15)
def _broken(line: SourceLine) -> str | None:
    """Return the fact that a line breaks by itself, or ``None``."""
    if not line.tokens:
        return None
    return _strings(line) or _brackets(line) or _neighbours(line) or _shape(line)


# ------------------------------------------------------------------------- tokens of a line


@cache
def adjacent() -> Mapping[tuple[str, str], str]:
    """Return the pairs of token kinds that are never neighbours, with the reason.

    Kinds are those of `recovery.negatives.tokens.SourceToken`; ``start`` and ``end`` are the ends
    of a line, ``any`` is every kind.
    """
    found: dict[tuple[str, str], str] = {}
    for left, right, reason in read_table("recovery.negatives", "adjacent.tsv")[1:]:
        found |= {(a, b): reason for a in left.split() for b in right.split()}
    return found


def _neighbours(line: SourceLine) -> str | None:
    table = adjacent()
    for left, right in pairwise(("start", *line.kinds, "end")):
        reason = table.get((left, right)) or (right != "end" and table.get((left, "any")))
        if reason:
            return reason
    return None


def _strings(line: SourceLine) -> str | None:
    is_open = any(token.text == '"' for token in line.tokens)
    return "a string is closed on its line" if is_open else None


def _brackets(line: SourceLine) -> str | None:
    expected: list[str] = []
    for kind in line.kinds:
        if kind in BRACKETS:
            expected.append(BRACKETS[kind])
        elif kind in CLOSING and (not expected or expected.pop() != kind):
            return "a closing bracket belongs to an opening one of its form on the same line"
    return "a bracket is closed on its line" if expected else None


# ----------------------------------------------------------------------------- expressions

_RELATIONS = frozenset("== <> < > <= >= => =<".split())
_OPERATORS = _RELATIONS | frozenset("+ - * / : . , AND OR EXOR B_AND B_OR B_EXOR".split())
_PREFIXES = frozenset({"NOT", "B_NOT"})
_NO_OPERANDS = (RESERVED | {"type"}) - _OPERATORS - _PREFIXES
_OPERAND_ENDS = frozenset("name number string bits enum truth ) ] }".split())


def _operands(kinds: Sequence[str]) -> str | None:
    """Return the fact that expressions between commas break; braces are skipped."""
    braces = 0
    before = ""
    for kind in kinds:
        if kind in ("{", "}"):
            braces += 1 if kind == "{" else -1
        elif not braces:
            if kind == "other":  # not a token of KRL, so no fact applies
                return None
            if kind == "=":
                return "an expression has no equals sign"
            if before in _OPERAND_ENDS and not _can_follow(before, kind):
                return "two operands have an operator between them"
            if kind in _NO_OPERANDS:
                return "a reserved word is no operand"
        before = kind
    return None


def _can_follow(operand: str, kind: str) -> bool:
    if kind in ("(", "["):  # arguments and indices
        return operand in ("name", "]") or (operand, kind) == (")", "[")
    return kind in _OPERATORS or kind in CLOSING


# ---------------------------------------------------------------------------- forms of lines


def _words(line: SourceLine) -> list[str]:
    return [token.word for token in line.tokens]


def _if(line: SourceLine) -> str | None:
    if line.kinds[-1] != "THEN":
        return "THEN ends the line of IF"
    return _operands(line.kinds[1:-1])


def _for(line: SourceLine) -> str | None:
    words, kinds = _words(line), line.kinds
    if "=" not in kinds:
        return "an equals sign gives the counter of FOR its start"
    equals = kinds.index("=")
    if "TO" not in words[equals:]:
        return "FOR has TO"
    to = words.index("TO", equals)
    # STEP may be a name, but not after an operand
    steps = [i for i in range(to + 2, len(kinds)) if words[i] == "STEP"]
    step = next((i for i in steps if kinds[i - 1] in _OPERAND_ENDS), len(kinds))
    parts = (kinds[1:equals], kinds[equals + 1 : to], kinds[to + 1 : step], kinds[step + 1 :])
    return next(filter(None, map(_operands, parts)), None)


def _expressions(line: SourceLine) -> str | None:
    return _operands(line.kinds[1:])


def _wait(line: SourceLine) -> str | None:
    if _words(line)[1:2] not in (["FOR"], ["SEC"]):
        return "FOR or SEC follows WAIT"
    return _operands(line.kinds[2:]) if len(line.tokens) > 2 else "WAIT waits for something"


def _interrupt(line: SourceLine) -> str | None:
    words = _words(line)
    action = words[words.index("INTERRUPT") + 1 :][:1]
    if action in (["ON"], ["OFF"], ["ENABLE"], ["DISABLE"]):
        return "an equals sign has no place behind INTERRUPT ON" if "=" in words else None
    if action != ["DECL"]:
        return "INTERRUPT is followed by DECL, ON, OFF, ENABLE or DISABLE"
    if "WHEN" not in words or "DO" not in words[words.index("WHEN") :]:
        return "INTERRUPT DECL has WHEN and then DO"
    return None


def _trigger(line: SourceLine) -> str | None:
    words = _words(line)
    if words[1:2] != ["WHEN"]:
        return "WHEN follows TRIGGER"
    return None if "DO" in words else "TRIGGER has DO"


def _routine(line: SourceLine) -> str | None:
    if "(" not in line.kinds or line.kinds[-1] != ")":
        return "the head of a routine ends with its parentheses"
    depth = 0
    parameters = []  # without the content of their indices
    for kind in line.kinds[line.kinds.index("(") + 1 : -1]:
        depth -= kind == "]"
        if not depth and kind != "]":
            parameters.append(kind)
        depth += kind == "["
    wrong = not _PARAMETERS.fullmatch(" ".join(parameters))
    return "a parameter is a name with its size and mode" if wrong else None


_PARAMETERS = re.compile(r"(?:name(?: \[)?(?: : name)?(?: , (?!$)|$))*")


def _goto(line: SourceLine) -> str | None:
    return None if line.kinds[1:] == ("name",) else "GOTO names one label"


def _motion(line: SourceLine) -> str | None:
    if line.lead not in PLAIN_MOTIONS and line.kinds[1:2] in (("=",), ("[",), (".",)):
        return _assignment_or_call(line)  # a name before there were splines
    is_bare = "=" in line.kinds and "WITH" not in _words(line)
    return "a motion gives values only behind WITH" if is_bare else None


_FORMS: Mapping[str, Callable[[SourceLine], str | None]] = {
    "IF": _if,
    "FOR": _for,
    "WHILE": _expressions,
    "UNTIL": _expressions,
    "SWITCH": _expressions,
    "CASE": _expressions,
    "RETURN": _expressions,
    "WAIT": _wait,
    "INTERRUPT": _interrupt,
    "TRIGGER": _trigger,
    "DEF": _routine,
    "DEFFCT": _routine,
    "GOTO": _goto,
} | dict.fromkeys(MOTIONS, _motion)


def _shape(line: SourceLine) -> str | None:
    """Return the fact that a line breaks by its form."""
    if "THEN" in line.kinds and line.lead != "IF":
        return "THEN ends the line of IF"
    form = _FORMS.get(line.lead)
    if form:
        return form(line)
    return _assignment_or_call(line) if line.kinds[0] == "name" else None


def _assignment_or_call(line: SourceLine) -> str | None:
    kinds, end = line.kinds, _behind_variable(line.kinds)
    following = kinds[end] if end < len(kinds) else "end"
    if following == "=":
        return _operands(kinds[end + 1 :])
    if end > 1 or (line.lead.startswith("$") and following != "name"):
        return "a line that begins with a variable gives it a value"
    if following in _RELATIONS or following in ("*", "/", "AND", "OR"):
        return "an expression is no statement"
    if following == "(":
        end += 1 + (closer_of(kinds[end:]) or 0)
        if kinds[end : end + 1] in (("name",), ("number",), ("=",)):
            return "a call is followed by nothing"
    return None


def _behind_variable(kinds: Sequence[str]) -> int:
    """Return the index after the variable that begins a line, with indices and members."""
    at = 1
    while at < len(kinds):
        if kinds[at] == "[":
            at += 1 + (closer_of(kinds[at:]) or 0)
        elif kinds[at] == "." and kinds[at + 1 : at + 2] == ("name",):
            at += 2
        else:
            break
    return at


# -------------------------------------------------------------------------------------- blocks


@dataclass(slots=True)
class _Block:
    """An open block; ``branched`` after its ELSE or first CASE."""

    opener: str
    branched: bool = False


def _blocks(program: Sequence[SourceLine]) -> Violation | None:
    """Return the first line at which blocks do not match, or ``None``."""
    open_blocks: list[_Block] = []
    for number, line in enumerate(program, 1):
        if not line.tokens:
            continue
        fact = _enter(_block_word(line), open_blocks)
        if fact is None and open_blocks:
            fact = _misplaced(line, is_data=open_blocks[0].opener == "DEFDAT")
        if fact:
            return Violation(number, fact)
    if open_blocks:
        return Violation(len(program), f"{BLOCKS[open_blocks[-1].opener].closer} closes its block")
    return None


# Lines that begin with such a word are statements, unless it is a name there.
_STATEMENTS = frozenset(MOTIONS).union(
    "CONTINUE EXIT GOTO HALT INTERRUPT RESUME RETURN TRIGGER WAIT".split()
)
_POSITIONS = frozenset("FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split())
_DEFINING = frozenset("ENUM IMPORT SIGNAL STRUC".split())


def _misplaced(line: SourceLine, *, is_data: bool) -> str | None:
    """Return what is wrong with a line in the wrong kind of module [SCO-03, SCO-04]."""
    head, behind = line.kinds[0], line.kinds[1:2]
    if is_data:
        is_call = head == "name" and behind == ("(",)
        is_named = behind in (("=",), ("[",), (".",))
        is_statement = is_call or (line.lead in _STATEMENTS and not is_named)
        return "a data list has no statements" if is_statement else None
    ahead = _words(line)[: _words(line).index(line.lead)] if line.lead else []
    is_variable = (
        "DECL" in ahead
        or line.lead == "CONST"
        or "type" in line.kinds[: len(ahead) + 1]
        or (not ahead and line.lead in _POSITIONS and behind == ("name",))
    )
    if not is_variable or line.lead in _DEFINING or behind == ("=",):
        return None
    if "GLOBAL" in ahead or line.lead == "CONST":
        return "the variables of a routine are neither global nor constant"
    return "only a data list gives initial values" if "=" in line.kinds else None


def _block_word(line: SourceLine) -> str:
    """Return the lead, unless it is a name that looks like a spline block."""
    is_name = "SPLINE" in line.lead and line.kinds[1:2] in (("=",), ("[",), (".",), ("(",))
    return "" if is_name else line.lead


def _enter(lead: str, open_blocks: list[_Block]) -> str | None:
    """Process the first word of a line; return the fact it breaks, or ``None``."""
    if not open_blocks and lead not in OUTERMOST:
        return "nothing stands outside of routines and data lists"
    block = open_blocks[-1] if open_blocks else _Block("")
    if block.opener == "SWITCH" and not block.branched and lead not in ("CASE", "DEFAULT"):
        return "SWITCH is followed by its first CASE"
    if lead in BLOCKS:
        return _open(lead, block, open_blocks)
    if lead in CLOSERS:
        del open_blocks[-1]
        if BLOCKS[block.opener].closer != lead:
            return f"{BLOCKS[block.opener].closer} closes its block before any other closer"
    elif lead == "ELSE":
        if block.opener != "IF" or block.branched:
            return "ELSE stands once, in an IF"
        block.branched = True
    elif lead in ("CASE", "DEFAULT"):
        if block.opener != "SWITCH":
            return f"{lead} stands in a SWITCH"
        block.branched = True
    return None


def _open(lead: str, block: _Block, open_blocks: list[_Block]) -> str | None:
    if block.opener and lead in OUTERMOST:
        return f"{BLOCKS[block.opener].closer} closes its block before the next {lead}"
    if block.opener == "DEFDAT":
        return "a data list has no statements"
    open_blocks.append(_Block(lead))
    return None
