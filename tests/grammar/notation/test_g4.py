"""A grammar is read into data and printed back byte for byte; what is no grammar is refused."""

import hashlib
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read, read_file, read_rule
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import (
    MAX_CODE_POINT,
    Alternative,
    CharSet,
    Element,
    Grammar,
    GrammarError,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    walk,
)

FILES = [GRAMMAR, GRAMMAR.with_name("preliminary.g4")]
NOWHERE = (0, 0)
TOKENS = "A : 'a' ;\nB : 'b' ;\nIF : 'if' ;\n"
SMALL = (
    f"grammar Small;\noptions {{ caseInsensitive = true; }}\ns : A b? 'IF' ;\nb : B* ;\n{TOKENS}"
)


def grammar_of(rules: str) -> Grammar:
    return read(f"grammar Small;\n{rules}\n{TOKENS}")


def only(rule: str) -> Element:
    """The one element of the one alternative of a rule."""
    (alternative,) = read_rule(rule).alternatives
    (element,) = alternative.elements
    return element


# ------------------------------------------------------------------- grammars made at random
# Each is drawn twice over: as the data that reading has to give, and as its lexemes, between which
# any layout may stand.

LAYOUT = [" ", "  ", "\t", "\n", "\r\n", "\n\n", " // ' | ; x\n", " /* : 'ä' ; */ ", "/**/", "//\n"]
CHARACTERS = r"'\'\n\u20ac\\'"

Drawn = tuple[Element, list[str]]
MANY = st.randoms(use_true_random=True)  # structure by hypothesis itself would take seconds


def drawn_element(chance: Random, names: list[str], depth: int) -> Drawn:
    kind = chance.choice("nnnlgr" if depth else "nnl")
    if kind == "n":
        name = chance.choice([*names, "A", "EOF"])
        return Reference(name, NOWHERE), [name]
    if kind == "l":
        text, written = chance.choice([("b", "'b'"), ("'\n\u20ac\\", CHARACTERS)])
        return Literal(text, NOWHERE), [written]
    if kind == "g":
        alternatives, lexemes = drawn_alternatives(chance, names, depth - 1)
        return Group(alternatives, NOWHERE), ["(", *lexemes, ")"]
    item, lexemes = drawn_element(chance, names, depth - 1)
    while isinstance(item, Repeat):
        item, lexemes = drawn_element(chance, names, depth - 1)
    operator = chance.choice(("?", "*", "+"))
    return Repeat(item, operator, NOWHERE), [*lexemes, operator]  # type: ignore[arg-type]


def drawn_alternatives(
    chance: Random, names: list[str], depth: int
) -> tuple[tuple[Alternative, ...], list[str]]:
    alternatives: list[Alternative] = []
    lexemes: list[str] = []
    for number in range(chance.randint(1, 3)):
        drawn = [drawn_element(chance, names, depth) for _ in range(chance.randint(0, 3))]
        alternatives.append(Alternative(tuple(e for e, _ in drawn), None, NOWHERE))
        lexemes += ["|"] if number else []
        lexemes += [lexeme for _, inner in drawn for lexeme in inner]
    return tuple(alternatives), lexemes


def drawn_grammar(chance: Random) -> tuple[str, tuple[Rule, ...]]:
    """The text of a grammar in a layout of its own, and its rules."""
    lexemes = ["grammar", "Odd", ";"]
    rules: list[Rule] = []
    names = [f"rule{number}" for number in range(chance.randint(1, 4))]
    for number, name in enumerate(names):
        # only later rules are referred to, so that there is no left recursion
        alternatives, body = drawn_alternatives(chance, names[number + 1 :], 3)
        rules.append(Rule(name, alternatives))
        lexemes += [name, ":", *body, ";"]
    for name, text in (("A", "'a'"), ("B", "'b'"), ("C", CHARACTERS)):
        alternative = Alternative((only(f"X : {text} ;"),), None, NOWHERE)
        rules.append(Rule(name, (alternative,)))
        lexemes += [name, ":", text, ";"]
    return "".join(piece for x in lexemes for piece in (x, chance.choice(LAYOUT))), tuple(rules)


@given(MANY)
def test_any_layout_is_kept(chance: Random) -> None:
    """Whatever stands between the lexemes, the data is the same and the text comes back."""
    text, rules = drawn_grammar(chance)
    grammar = read(text)
    assert rules == grammar.rules
    assert text == grammar.text


@given(MANY)
def test_spans_say_where_an_element_stands(chance: Random) -> None:
    """The text at an element's span, read on its own, is that element."""
    for rule in read(drawn_grammar(chance)[0]).rules:
        assert rule.text.startswith(rule.name)
        assert rule.text.endswith(";")
        for alternative in rule.alternatives:
            for element in walk(alternative):
                assert element == only(f"x : {rule.source_of(element)} ;")


# ---------------------------------------------------------------------- the project's own


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.name)
def test_own_grammars_are_printed_as_they_were_read(path: Path) -> None:
    """Reading and printing the project's grammars changes no byte."""
    data = path.read_bytes()
    grammar = read_file(path)
    assert data == grammar.text.encode()
    assert hashlib.sha256(data).hexdigest() == grammar.sha256


# --------------------------------------------------------------------------- single facts


@pytest.mark.parametrize(
    ("text", "ranges"),
    [
        ("[a-z_]", [("_", "_"), ("a", "z")]),
        ("[ca-bb]", [("a", "c")]),
        (r"[\]\\\-]", [("-", "-"), ("\\", "]")]),
        (r"[\t\n\r\u00e9]", [("\t", "\n"), ("\r", "\r"), ("é", "é")]),
        ("[-a]", [("-", "-"), ("a", "a")]),
        (r"[a\-z]", [("-", "-"), ("a", "a"), ("z", "z")]),
        ("[a-]", [("-", "-"), ("a", "a")]),
        ("'a'..'f'", [("a", "f")]),
        ("~[b-y]", [("\0", "a"), ("z", chr(MAX_CODE_POINT))]),
        ("~'b'", [("\0", "a"), ("c", chr(MAX_CODE_POINT))]),
        (r"~[\u0000-a]", [("b", chr(MAX_CODE_POINT))]),
        (".", [("\0", chr(MAX_CODE_POINT))]),
    ],
)
def test_sets_of_characters(text: str, ranges: list[tuple[str, str]]) -> None:
    """A set is read into sorted, disjoint, non-touching ranges, escapes resolved."""
    element = only(f"X : {text} ;")
    assert CharSet(tuple((ord(a), ord(b)) for a, b in ranges), NOWHERE) == element


def test_fragments_labels_and_commands() -> None:
    """``fragment``, ``# label`` and ``-> command`` are part of the data."""
    fragment = read_rule("fragment DIGIT : [0-9] ;")
    assert (True, "DIGIT", ()) == (fragment.is_fragment, fragment.name, fragment.commands)
    labelled = read_rule("s : A # one | B ;")
    assert ["one", None] == [a.label for a in labelled.alternatives]
    hidden = read_rule("WS : ' ' -> channel(HIDDEN) ;")
    assert ("channel(HIDDEN)",) == hidden.commands
    assert hidden.is_skipped
    assert not read_rule("WS : ' ' ;").is_skipped


def test_tokens_by_their_text() -> None:
    """Quoted text and names lead to the same token; case counts only where the options say so."""
    grammar = read(SMALL)
    assert {"A": "A", "B": "B", "IF": "IF"} == grammar.literal_tokens
    assert ["IF", "IF", "A"] == [
        grammar.token_of(e)
        for e in (Literal("If", NOWHERE), Reference("IF", NOWHERE), Literal("a", NOWHERE))
    ]
    exact = read(SMALL.replace("true", "false").replace("'IF'", "'if'"))
    assert {"a": "A", "b": "B", "if": "IF"} == exact.literal_tokens
    assert not exact.case_insensitive


def test_two_rules_with_one_text() -> None:
    """Of two tokens with the same text the first has it, as in ANTLR."""
    assert {"a": "FIRST", "b": "B", "if": "IF"} == grammar_of(
        "s : A ;\nFIRST : 'a' ;"
    ).literal_tokens


def test_exchanging_a_rule() -> None:
    """A rule is exchanged in its place; nothing else changes, the old grammar included."""
    grammar = read(SMALL)
    changed = grammar.with_rule(read_rule("b : A+ ;"))
    assert SMALL.replace("b : B* ;", "b : A+ ;") == changed.text
    assert SMALL == grammar.text
    assert grammar.literal_tokens == changed.literal_tokens
    keyword = grammar.with_rule(read_rule("IF : 'when' ;"))
    assert {"A": "A", "B": "B", "WHEN": "IF"} == keyword.literal_tokens
    assert len({grammar.sha256, changed.sha256, keyword.sha256}) == 3


# --------------------------------------------------------------------------------- errors


@pytest.mark.parametrize(
    ("rules", "line", "message"),
    [
        ("s\n  : A {skip();}\n  ;", 3, "syntax error at '{skip();}'"),
        ("s : {true}? A ;", 2, "syntax error at '{true}? A ;'"),
        ("s : x=A ;", 2, "syntax error at '=A ;'"),
        ("s : A ;\nimport Other;", 3, "syntax error at 'Other;'"),
        ("s : A\nt : B ;", 3, "syntax error at ': B ;'"),
        ("s : A ;;", 2, "syntax error at ';'"),
        ("s : A ;\nmode INSIDE;", 3, "syntax error at 'INSIDE;'"),
        ("s : 'a ;", 2, 'syntax error at "\'a ;"'),
        ("s : A ;\nC : [] ;", 3, "syntax error at '[] ;'"),
        ("s : A ;\nC : '\\uXY12' ;", 3, "syntax error at"),
        ("s : A ;\nC : '\\u{1F916}' ;", 3, "syntax error at"),
        ("s : A ;\nC : [\\p{Lu}] ;", 3, "syntax error at"),
        ("s : A ;\n\nC : 'x' .*? 'y' ;", 4, "rule C: non-greedy '*?' is not supported"),
        ("s : A ;\nC : ~('x' | 'yz') ;", 3, "rule C: only a set of characters can be negated"),
        ("s : A ;\nC : 'ab'..'c' ;", 3, "rule C: 'ab'..'c' is no range of characters"),
        ("s : A ;\nC : 'z'..'a' ;", 3, "rule C: 'z'..'a' is no range of characters"),
        ("s : A ;\nC : [z-a] ;", 3, "rule C: 'z'-'a' is a range that runs backwards"),
        ("s : A ;\nC : 'x' -> pushMode(M) ;", 3, "rule C: the command pushMode is not supported"),
        ("s : A ;\nC : 'x' -> more ;", 3, "rule C: the command more is not supported"),
        ("s : A ;\ns : B ;", 3, "rule s is defined twice"),
        ("s : mode ;\nmode : A ;", 3, "ANTLR keeps the word mode for itself"),
        ("s\n : A\n   nothing\n ;", 4, "rule s: nothing is not defined"),
        ("s : A (B | NOTHING)* ;", 2, "rule s: NOTHING is not defined"),
        ("s : 'nothing' ;", 2, "rule s: no token is defined as 'nothing'"),
        ("s : [a] ;", 2, "rule s: a set of characters in a parser rule"),
        ("s : D ;\nfragment D : 'd' ;", 2, "rule s: D is a fragment, not a token"),
        ("s : A ;\nC : s ;", 3, "rule C: s is a parser rule"),
        ("s : A ;\nC : EOF ;", 3, "rule C: EOF in a lexer rule"),
        ("t : A ;\ns : s A | B ;", 3, "left recursion through s → s"),
        ("s : x A ;\nx : B | s ;", 2, "left recursion through s → x → s"),
        ("s : A? s B ;", 2, "left recursion through s → s"),
        ("s : A* (B | x) ;\nx : (n | A) s ;\nn : B? ;", 2, "left recursion through s → x → s"),
        ("s : n+ s ;\nn : ;", 2, "left recursion through s → s"),
        ("s : A ;\nC : '(' C? ')' ;", 3, "recursive tokens through C → C"),
        ("s : A ;\nC : 'c' D ;\nD : 'd' C? ;", 3, "recursive tokens through C → D → C"),
        ("s : A ;\nt : A | B ;\nu : A u | B (A u)+ ;", 4, "rule u has no end"),
        (
            f"s : {'(' * 5000}A{')' * 5000} ;",
            2,
            "rule s: brackets or ~ are nested more than 100 deep",
        ),
        (
            "s : A0 ;\n"
            + "\n".join(f"A{n} : 'a' A{n + 1}? ;" for n in range(60))
            + "\nA60 : 'b' ;",
            13,
            "tokens within A10 are nested more than 100 deep",
        ),
        (
            "s : A ;\nC : B0 ;\n"
            + "\n".join(f"fragment B{n} : B{n + 1} B{n + 1} ;" for n in range(40))
            + "\nfragment B40 : 'b' ;",
            3,
            "C and what it refers to: more than 100,000 characters",
        ),
    ],
)
def test_what_is_not_of_our_style_is_refused(rules: str, line: int, message: str) -> None:
    """The error is one line with the file, the line and what is wrong there."""
    with pytest.raises(GrammarError) as raised:
        read(f"grammar Bad;\n{rules}\n{TOKENS}", source="bad.g4")
    text = str(raised.value)
    assert text.startswith(f"bad.g4:{line}: ")
    assert message in text
    assert "\n" not in text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "bad.g4:1: syntax error at end"),
        ("grammar Bad;\ns : A\n", "bad.g4:2: syntax error at end"),
        ("s : A ;", "bad.g4:1: syntax error at 's : A ;'"),
        (f"grammar Bad;\n{TOKENS}", "bad.g4:1: no parser rule"),
        (
            "grammar Bad;\r\ns : {x} ;\r\n",
            "bad.g4:2: syntax error at '{x} ;'; not supported: an action (line 2)",
        ),
    ],
)
def test_what_is_no_grammar_is_refused(text: str, message: str) -> None:
    """An empty, broken off or headless text is refused in one line."""
    with pytest.raises(GrammarError) as raised:
        read(text, source="bad.g4")
    assert message == str(raised.value)


@pytest.mark.parametrize(
    ("rules", "message"),
    [
        ("s\n    : (A? B?)* EOF ;", "3: rule s: (A? B?)* repeats what may be empty"),
        ("s : t+ EOF ;\nt : A* ;", "2: rule s: t+ repeats what may be empty"),
        ("s : A EOF ;\nC : 'a' ;", "4: token A is never read: C has the same text"),
        ("t : A ;", "2: no rule reads EOF, so no file can be read to its end"),
    ],
)
def test_what_nobody_writes_on_purpose(rules: str, message: str, tmp_path: Path) -> None:
    """In a file it is refused with its line, as in ANTLR or where that only warns."""
    file = tmp_path / "bad.g4"
    file.write_text(f"grammar Bad;\n{rules}\nA : 'a' ;\nB : 'b' ;\n", encoding="utf-8")
    with pytest.raises(GrammarError) as raised:
        read_file(file)
    assert f"{file}:{message}" == str(raised.value)


def test_recursion_that_is_not_left() -> None:
    """A rule may call itself once it has read a token, and may be empty before it does."""
    rules = "s : A s | t ;\nt : n+ (B | u) t? | A ;\nu : IF n s | n n B ;\nn : A? | ;"
    assert rules in grammar_of(rules).text


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    """A missing file, a folder and a file in another encoding give one line with the path."""
    latin = tmp_path / "latin.g4"
    latin.write_bytes(SMALL.replace("Small", "Gr\u00f6\u00dfe").encode("latin-1"))
    for path in (tmp_path / "missing.g4", tmp_path, latin):
        with pytest.raises(GrammarError) as raised:
            read_file(path)
        assert str(raised.value).startswith(f"{path}: ")
        assert "\n" not in str(raised.value)
    assert "not UTF-8" in str(raised.value)


def test_line_ends_of_a_file_are_kept(tmp_path: Path) -> None:
    """A grammar file with CRLF is printed with CRLF."""
    path = tmp_path / "windows.g4"
    text = GRAMMAR.read_text(encoding="utf-8")
    path.write_bytes(text.replace("\n", "\r\n").encode())
    assert path.read_bytes() == read_file(path).text.encode()


@given(st.data())
def test_damaged_text_is_read_or_refused(data: st.DataObject) -> None:
    """Whatever is cut out, doubled or put in, the outcome is a grammar or a `GrammarError`."""
    text = SMALL + "C : ~[x-z\\]] 'a'..'b' '\\u0041' -> skip ;\nfragment D : . ;\n"
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(text)))
        end = start + data.draw(st.integers(0, 5))
        put = data.draw(
            st.sampled_from(["", text[start:end] * 2, "'", "\\", "|", "~", "-", "(s)+"])
        )
        text = text[:start] + put + text[end:]
    with suppress(GrammarError):
        grammar = read(text)
        assert text == grammar.text
        assert grammar == read(grammar.text)
