"""Text becomes the tokens that the lexer rules say: the longest match, and of equals the first."""

from collections.abc import Callable, Mapping
from pathlib import Path
from random import Random
from typing import Any

import pytest
from antlr4 import InputStream, Token
from antlr4.error.ErrorListener import ErrorListener
from hypothesis import given
from hypothesis import strategies as st

import grammar.parser.lexer
from grammar._generated.KRLLexer import KRLLexer
from grammar.notation.edits import AddToken, apply
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar, Rule
from grammar.parser.lexer import ABSENT, EOF, ERROR, SKIPPED, Lexer, lexer_of

LexerEnds = Callable[[Grammar, Rule, str, int], frozenset[int]]
#: Name of the token, its text, its offset.
Tokens = list[tuple[str, str, int]]

NASTY = [
    *("1", ".", "1.", "1.5.2", ".5", "0x", "E3", "1.0E-3", "007"),
    *("'B01", "'", "'B01'", "'HfF'", "'H'", "'b2'", '"', '"a', '""', '"a""b"', '";"', '"\n'),
    *("<", "=", ">", "<=>", "<>", "==", "=>", "===", ">=", "<<", ":", "::", "!"),
    *("$", "$$", "$OUT", "$1", "a$b", "#", "#A", "#1", "##", "&", "&ACCESS RVP", "_", "__a9$"),
    *("FOR", "for", "FORT", "foR1", "END", "ENDFOR", "C_DIS", "c_", "é", "ſ", "ı", "\u212a", "K"),
    *(
        "\0",
        "\t",
        " ",
        "\r",
        "\n",
        "\r\n",
        "\x0b",
        "\xa0",
        "\u2028",
        "\ufeff",
        "\U0001f916",
        ";",
        ";é\t",
    ),
    *("{", "}", "[", "]", "(", ")", ",", "+", "-", "*", "/", "?", "%", "\\", "^", "|"),
]
NASTY_TEXT = st.lists(st.sampled_from(NASTY), max_size=14).map("".join)
GRAMMARS = [read_file(GRAMMAR), read_file(GRAMMAR.with_name("preliminary.g4"))]


def lexer_grammar(rules: str, *, folded: bool = True) -> Grammar:
    options = "options { caseInsensitive = true; }\n" if folded else ""
    return read(f"grammar T;\n{options}s : EOF ;\n{rules}\n")


def tokens_of(lexer: Lexer, text: str) -> Tokens:
    """Tokens as the parser gets them, `ERROR` by that name."""
    names = {**dict(enumerate(lexer.names)), ERROR: "ERROR"}
    pairs = zip(lexer.lexemes(text), lexer.offsets(text), strict=True)
    kinds = [(lexer.kinds[lexeme], lexeme, offset) for lexeme, offset in pairs]
    return [(names[kind], lexeme, at) for kind, lexeme, at in kinds if kind != SKIPPED]


def slow_tokens(grammar: Grammar, text: str, lexer_ends: LexerEnds) -> Tokens:
    """The same by trying every rule at every place, straight from the rules."""
    rules = [r for r in grammar.rules if r.is_lexer and not r.is_fragment]
    out: Tokens = []
    start = 0
    while start < len(text):
        matches = [(max(lexer_ends(grammar, r, text, start), default=start), r) for r in rules]
        end = max(e for e, _ in matches)
        if end == start:
            out.append(("ERROR", text[start], start))
            end += 1
        else:
            rule = next(r for e, r in matches if e == end)
            if not rule.is_skipped:
                out.append((rule.name, text[start:end], start))
        start = end
    return out


# ------------------------------------------------------------------------------- the law


@pytest.mark.parametrize("own", GRAMMARS, ids=["KRL", "preliminary"])
@given(text=NASTY_TEXT)
def test_tokens_are_those_of_the_rules(own: Grammar, text: str, lexer_ends: LexerEnds) -> None:
    """On the nastiest text the tokens are the longest matches, the earlier rule first."""
    assert slow_tokens(own, text, lexer_ends) == tokens_of(Lexer(own), text)


def random_grammar(chance: Random) -> Grammar:
    """Lexer rules that overlap in keywords, names, numbers, strings and what is skipped."""
    rules = [
        f"KEY{n} : '{''.join(chance.choice('abC<=') for _ in range(chance.randint(1, 3)))}' ;"
        for n in range(chance.randint(0, 4))
    ]
    rules += chance.sample(
        [
            "NAME : [A-C_] [A-C0-9_]* ;",
            "SIGIL : '$' NAME_REST* ;\nfragment NAME_REST : [a-c] ;",
            "INTEGER : [0-9]+ ;",
            "REAL : [0-9]+ '.' [0-9]* ;",
            "VERSION : [0-9]+ ('.' [0-9]+)+ ;",
            "STRING : '\"' (~[\"\\n] | '\"\"')* '\"' ;",
            "PLAIN : '\"' ~[\"\\n]* '\"' ;",
            "SIGN : '<' | '<=' '>'? | '=' '='? ;",
            "DASHES : '-' ('=-')* ;",
            "LINE : '\\r'? '\\n' ;",
        ],
        chance.randint(1, 6),
    )
    rules += chance.sample(
        [
            "SPACE : [ \\t]+ -> skip ;",
            "COMMENT : ';' ~[\\n]* -> skip ;",
            "BLOCK : '<-' ~'>'* '>' -> skip ;",
            "SIGNS : '<=' -> skip ;",
            "HIDDEN : 'a' 'a'+ -> channel(HIDDEN) ;",
        ],
        chance.randint(0, 3),
    )
    chance.shuffle(rules)
    return lexer_grammar("\n".join(rules), folded=chance.random() < 0.5)


@given(chance=st.randoms(use_true_random=True))
def test_tokens_of_random_rules(chance: Random, lexer_ends: LexerEnds) -> None:
    """The same holds for rules put together at random, patterns or not, skipped or not."""
    made = random_grammar(chance)
    fragments = 'a bC A aa 1 1. .2 " < <= => - -= ; $ é _'.split()
    fragments += [" ", "\n"]
    text = "".join(chance.choice(fragments) for _ in range(25))
    lexer = Lexer(made)
    assert slow_tokens(made, text, lexer_ends) == tokens_of(lexer, text)
    tokens = [(lexeme, at) for _, lexeme, at in tokens_of(lexer, text)]
    assert tokens == list(zip(*lexer.located(text), strict=True))
    if lexer.leaves_out_skipped:
        assert SKIPPED not in map(lexer.kinds.__getitem__, lexer.lexemes(text))


# ---------------------------------------------------------------------------- plain facts


@pytest.mark.parametrize(
    ("rule", "long"), [("([A-Z]+)+ '!'", "A" * 40), ("(('A' 'B')+)+ '!'", "AB" * 20)]
)
def test_no_lexeme_is_tried_in_every_way(rule: str, long: str) -> None:
    """A rule that could read a word in a billion ways costs no more than its letters."""
    grammar = read(f"grammar T;\ns : A ;\nA : {rule} ;\nB : [A-Z]+ ;\n")
    lexer = Lexer(grammar)
    assert ["B", "A"] == [lexer.names[lexer.kinds[word]] for word in (long, f"{long}!")]


def test_names_and_numbers_of_tokens(preliminary: Grammar) -> None:
    """Kind 0 is the end of the file, the others follow the rules; people read quoted text."""
    lexer = lexer_of(preliminary)
    rules = [r for r in preliminary.rules if r.is_lexer and not r.is_fragment]
    assert ("EOF", *(r.name for r in rules)) == lexer.names
    assert EOF == lexer.kind_of["EOF"]
    assert list(range(len(lexer.names))) == [lexer.kind_of[n] for n in lexer.names]
    shown = {name: lexer.display[lexer.kind_of[name]] for name in ("FOR", "AT_MOST", "NAME", "EOF")}
    assert {"FOR": "FOR", "AT_MOST": "<=", "NAME": "NAME", "EOF": "EOF"} == shown


def test_which_tokens_are_keywords(preliminary: Grammar) -> None:
    """A keyword is one reserved word, no operator and no class of texts."""
    lexer = lexer_of(preliminary)
    found = {name for name in lexer.names if lexer.is_keyword(lexer.kind_of[name])}
    words = {r.name for r in preliminary.rules if r.text == f"{r.name} : '{r.name}' ;"}
    assert len(words) == 48
    assert words == found


# ------------------------------------------------------------------------------- sharing


def test_which_tokens_are_signs(preliminary: Grammar) -> None:
    """A sign has one text that is no word, unlike names, values, words and the end of the file."""
    lexer = lexer_of(preliminary)
    kinds = {text: lexer.kinds[text] for text in (":", "==", "(", "A", "1", '"A"', "FOR", "TRUE")}
    assert {":", "==", "("} == {text for text, kind in kinds.items() if lexer.is_sign(kind)}
    assert not lexer.is_sign(EOF)
    assert not lexer.is_sign(ERROR)


@pytest.mark.parametrize(
    ("rules", "name", "line_end"),
    [
        ("IF : 'IF' ; ID : [A-Z]+ ; NL : '\\r'? '\\n' ;", "ID", "NL"),
        ("EOL : [\\n]+ ; HEX : [A-F]+ ; DO : 'DO' ; TO : 'TO' ; W : [A-Z] [A-Z]* ;", "W", "EOL"),
        ("IF : 'IF' ; BLANK : [ \\n]+ -> skip ;", "", ""),
    ],
)
def test_names_and_line_ends_are_found(rules: str, name: str, line_end: str) -> None:
    """Names are what reserved words would be, were they not; both are told, or that none is."""
    lexer = lexer_of(read(f"grammar T; start : EOF ; {rules}"))
    assert (name, line_end) == (lexer.name, lexer.line_end)
    assert [not name, not line_end] == [
        kind == ABSENT for kind in (lexer.name_kind, lexer.line_kind)
    ]


@pytest.mark.parametrize("own", GRAMMARS, ids=["KRL", "preliminary"])
def test_a_further_keyword(own: Grammar) -> None:
    """A reserved word more changes that word's tokens only; the lexer it came from stays."""
    lexer = Lexer(own)
    wider = lexer.with_keyword("ZZWORD")
    text = "FOR zzword=ZZWORD2 TO 'B1' zZwOrD ;zzword\n"
    reserved = apply(own, [AddToken("ZZWORD")])
    assert tokens_of(Lexer(reserved), text) == tokens_of(wider, text)
    assert "ZZWORD" not in {name for name, _, _ in tokens_of(lexer, text)}
    assert lexer.names == wider.names[:-1]
    assert (len(lexer.names), "ZZWORD") == (wider.kind_of["ZZWORD"], wider.display[-1])
    assert wider.is_keyword(wider.kind_of["ZZWORD"])
    assert all(
        kind == wider.kinds[lexeme]
        for lexeme, kind in lexer.kinds.items()
        if lexeme.upper() != "ZZWORD"
    )
    twice = wider.with_keyword("ZZOTHER")
    expected = {"ZZOTHER": len(lexer.names) + 1, "ZZWORD": len(lexer.names)}
    assert expected == {word: twice.kinds[word] for word in expected}
    assert "ZZOTHER" not in lexer.with_keyword("ZZWORD").names


def test_grammars_with_the_same_tokens_share_a_lexer(preliminary: Grammar) -> None:
    """An edit of a parser rule keeps the lexer; another token or option has one of its own."""
    lexer = lexer_of(preliminary)
    text = preliminary.text
    assert lexer is lexer_of(read(text.replace("HALT\n", "HALT HALT\n")))
    assert lexer is not lexer_of(apply(preliminary, [AddToken("ZZWORD")]))
    assert lexer is not lexer_of(read(text.replace("'FOR' ;", "'FOUR' ;")))
    exact = text.replace("caseInsensitive = true", "caseInsensitive = false")
    assert lexer is not lexer_of(read(exact))


def test_memory_stays_flat(preliminary: Grammar, monkeypatch: pytest.MonkeyPatch) -> None:
    """Long lexemes are not remembered, and a full memory starts afresh with the same answers."""
    monkeypatch.setattr(grammar.parser.lexer, "_MOST_REMEMBERED", 50)
    lexer = Lexer(preliminary)
    for number in range(200):
        assert lexer.kind_of["INTEGER"] == lexer.kinds[str(number)]
        assert lexer.kind_of["STRING"] == lexer.kinds[f'"{number:050}"']
        assert len(lexer.kinds) <= 50
    assert not any(len(lexeme) > 50 for lexeme in lexer.kinds)


# --------------------------------------------------------------------------------- ANTLR


class FirstError(ErrorListener):
    """Where the generated lexer found no rule for the first time."""

    def __init__(self) -> None:
        self.offset: int | None = None

    def syntaxError(self, recognizer: Any, *_: object) -> None:  # noqa: N802 - ANTLR's name
        """Note the first error's place; the lexer stands where the failing text begins."""
        if self.offset is None:
            self.offset = recognizer._tokenStartCharIndex


def antlr_tokens(text: str) -> Tokens:
    """Tokens of the generated lexer up to its first error, after which it goes its own way."""
    lexer = KRLLexer(InputStream(text))
    error = FirstError()
    lexer.removeErrorListeners()
    lexer.addErrorListener(error)
    out: Tokens = []
    for token in iter(lexer.nextToken, None):
        assert token is not None
        if token.type == Token.EOF or error.offset is not None:
            break
        out.append((KRLLexer.symbolicNames[token.type], token.text, token.start))
    if error.offset is not None:
        out.append(("ERROR", text[error.offset], error.offset))
    return out


def until_error(tokens: Tokens) -> Tokens:
    errors = (i for i, (name, _, _) in enumerate(tokens) if name == "ERROR")
    return tokens[: next(errors, len(tokens)) + 1]


def test_the_corpus_has_the_tokens_of_antlr(corpus: Mapping[Path, str]) -> None:
    """Both lexers give the same tokens at the same places: every fourth file of the own corpus."""
    lexer = lexer_of(GRAMMARS[0])
    for path, text in list(corpus.items())[::4]:
        assert antlr_tokens(text) == until_error(tokens_of(lexer, text)), path


@given(NASTY_TEXT)
def test_nasty_text_has_the_tokens_of_antlr(text: str) -> None:
    """Both lexers agree where no program would ever go."""
    assert antlr_tokens(text) == until_error(tokens_of(lexer_of(GRAMMARS[0]), text))


def test_a_row_of_skipped_texts_of_any_length(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many are skipped in a row, only tokens come, at their places."""
    monkeypatch.setattr(grammar.parser.lexer, "_LONGEST_ROW", 3)
    lexer = Lexer(
        read("grammar G; file : X* EOF ; X : 'x' ; C : '//' -> skip ; S : [ \\t]+ -> skip ;")
    )
    for count in range(9):
        text = f"x{'//' * count}x/{' //' * count}"
        assert ["x", "x", "/"] == lexer.lexemes(text)
        offsets = [0, 1 + 2 * count, 2 + 2 * count]
        assert offsets == list(lexer.offsets(text))
        assert (["x", "x", "/"], offsets) == lexer.located(text)
