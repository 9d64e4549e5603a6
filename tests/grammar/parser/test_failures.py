"""Every failure of a file is found, where it stands, with what was expected and what follows."""

import re
from collections.abc import Callable, Sequence
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import grammar.parser.failures
from grammar.blocks import BLOCKS
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.failures import Failure, FailureFinder, beginning
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller

Mutated = Callable[[Sequence[str], Random, Sequence[str]], list[str]]

OWN = {p.stem: Recognizer(read_file(p)) for p in (GRAMMAR, GRAMMAR.with_name("preliminary.g4"))}
FINDERS = {name: FailureFinder(recognizer) for name, recognizer in OWN.items()}
FINDER = FINDERS["preliminary"]
MANY = st.randoms(use_true_random=True)


def program(*lines: str) -> str:
    """A procedure with these lines, which therefore count from 2."""
    return "\n".join(["DEF A()", *lines, "END", ""])


def found(text: str) -> list[tuple[int, int, str]]:
    return [(f.line, f.column, f.text) for f in FINDER.find(text)]


def direct(text: str) -> list[int]:
    """Lines with failures that follow from no other."""
    return [f.line for f in FINDER.find(text) if not f.follows]


def following(text: str) -> list[int]:
    return [f.line for f in FINDER.find(text) if f.follows]


# ------------------------------------------------------------------------------- places


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("DEF A()\nEND", []),
        ("", [(1, 1, "")]),
        (" ;c", [(1, 4, "")]),
        ("\n\n", [(3, 1, "")]),
        ("\r\r\n", [(3, 1, "")]),
        ("DEF A()", [(1, 8, "")]),
        ("DEF A()\n", [(2, 1, "")]),
        ("DEF A()\r\nX=1", [(2, 4, "")]),
        ("DEF A()\nX=1 1", [(2, 5, "1"), (2, 6, "")]),
        ("DEF A()\n X=\nEND", [(2, 4, "\n")]),
        ("DEF A()\r\n X=\r\nEND", [(2, 4, "\r\n")]),
        ("DEF A()\r\n\tX=\t?\r\rX=$ \nEND\r\n", [(2, 5, "?"), (4, 3, "$")]),
        ("DEF A()\nX=1 ? ?\n\0\n ÄX=1\nEND", [(2, 5, "?"), (3, 1, "\0"), (4, 2, "Ä")]),
        ('DEF A()\nX="open\nX="1"\nEND', [(2, 3, '"')]),
        ("DEF A()\nX=1;?\n;?\nEND ; ?", []),
        ("DEF A()\nX='B2'\nX=1.5.2\nX=#\nEND", [(2, 3, "'"), (3, 6, "."), (4, 3, "#")]),
        ("DEF A()\n\U0001f916 X\nEND", [(2, 1, "\U0001f916")]),
        ("DEF A()\nEND\n\n  END ;x\n", [(4, 3, "END")]),
        ("\ufeffDEF A()\nEND\n", [(1, 1, "\ufeff")]),
    ],
)
def test_where_failures_stand(text: str, expected: list[tuple[int, int, str]]) -> None:
    """Lines end with CR, LF or both, columns count characters from 1, a file's end is a place."""
    assert expected == found(text)


GOOD = [
    "X=1",
    "  F(1,2)",
    "\tPTP P1",
    "",
    "  ; X=1 1 ?",
    "HALT ;'é",
    "X=(1+2)*A[3].B",
    "LOOP",
    "IF X THEN",
]
CLOSERS = {"LOOP": "ENDLOOP", "IF X THEN": "ENDIF"}
#: Lines that cannot be read, with the column of the offending token.
BAD = [
    ("X=1 1", 5),
    ("\tX= ?", 5),
    ("WAIT 5", 6),
    ("?", 1),
    ("  HALT \t$ é", 9),
    ("X=(1", 5),
    ("  ENDFOR", 3),
]


@given(chance=MANY)
def test_every_bad_line_is_found_and_no_other(chance: Random) -> None:
    """Among lines of nested blocks, under any line ends, the bad ones fail and no other."""
    lines, expected, opened = ["DEF A()"], [], list[str]()
    for _ in range(chance.randint(1, 25)):
        if chance.random() < 0.3:
            text, column = chance.choice(BAD)
            lines.append(text)
            expected.append((len(lines), column))
        elif opened and chance.random() < 0.3:
            lines.append(opened.pop())
        else:
            lines.append(chance.choice(GOOD))
            opened += [CLOSERS[lines[-1]]] if lines[-1] in CLOSERS else []
    lines += [*reversed(opened), "END"]
    ends = chance.choice([["\n"], ["\r\n"], ["\r"], ["\n", "\r\n", "\r"]])
    text = lines[0]
    for line in lines[1:]:
        # a line end of CR before an empty line's LF would be one line end
        end = chance.choice(ends)
        text += (end if end != "\n" or not text.endswith("\r") else "\r\n") + line
    failures = FINDER.find(text)
    assert expected == [(f.line, f.column) for f in failures]
    assert not any(f.follows for f in failures)


@pytest.mark.parametrize("name", OWN)
@given(chance=MANY)
def test_what_holds_for_any_text(name: str, chance: Random, mutated: Mutated) -> None:
    """Failures are data that can be replayed, one a line, the first where the recogniser stops."""
    recognizer, finder = OWN[name], FINDERS[name]
    speller = Speller(recognizer.grammar)
    tokens = Sentences(recognizer.grammar).random(chance, 60)
    for _ in range(chance.randint(0, 3)):
        tokens = mutated(tokens, chance, list(speller.samples))
    text = speller.text(tokens).replace("\n", chance.choice(["\n", "\r", "\r\n"]))
    failures = finder.find(text)
    assert recognizer.accepts(text) == (not failures)
    kinds = recognizer.kinds(text)
    _, index = recognizer.run(recognizer.start, kinds)
    assert (index is not None) == bool(failures)
    if index is not None:
        rest = [k for k, _ in visible(recognizer, text[failures[0].offset :])]
        assert kinds[index:] == [*rest, 0]
        assert not failures[0].follows
    for failure in failures:
        check_one(finder, text, failure)
    lines = [f.line for f in failures if f.form.kinds != (0,)]
    assert sorted(set(lines)) == lines
    assert [f.offset for f in failures] == sorted(f.offset for f in failures)
    fresh = FailureFinder(Recognizer(recognizer.grammar)).find(text)
    assert [(f.offset, f.form, f.follows) for f in fresh] == [
        (f.offset, f.form, f.follows) for f in failures
    ]


def visible(recognizer: Recognizer, text: str) -> list[tuple[int, str]]:
    """Kinds and texts of the tokens that are not skipped."""
    lexer = recognizer.lexer
    return [(lexer.kinds[x], x) for x in lexer.lexemes(text) if lexer.kinds[x] != -1]


def check_one(finder: FailureFinder, text: str, failure: Failure) -> None:
    recognizer, lexer = finder.recognizer, finder.recognizer.lexer
    assert text.startswith(failure.text, failure.offset)
    ahead = re.split("\r\n|\r|\n", text[: failure.offset])
    assert (len(ahead), len(ahead[-1]) + 1) == (failure.line, failure.column)
    kinds = [lexer.kinds[lexeme] for lexeme in failure.lexemes] or [0]
    assert tuple(kinds) == failure.form.kinds
    before = recognizer.restore(failure.form.before)
    state, index = recognizer.run(before, failure.form.kinds)
    assert failure.form.index == index
    assert recognizer.frames(failure.state) == recognizer.frames(state)
    context = finder.context(failure.state)
    expected = {lexer.display[kind] for kind in recognizer.expected(state)}
    assert tuple(sorted(expected)) == context.expected
    assert (recognizer.grammar.start, context.rule) == (context.rules[0], context.rules[-1])


ODD = """grammar Odd;
s : NEWLINE* (line NEWLINE+)* EOF ;
line : NAME ('=' (NAME | TEXT))? ;
NAME : [A-Z]+ ;
EQUALS : '=' ;
NEWLINE : '\\r\\n' | '\\n' | '\\r' ;
TEXT : '"' %s '"' ;
BLOCK : '{' ~'}'* '}' -> skip ;
SPACE : ' '+ -> skip ;
"""
#: Tokens and skipped text that hold line ends; the last is cut by no pattern of ``re``.
ODD_FINDERS = [
    FailureFinder(Recognizer(read(ODD % body))) for body in ("~'\"'*", "(~'\"' | '\"\"')*")
]


@pytest.mark.parametrize("finder", ODD_FINDERS, ids=["plain", "doubled quotes"])
@given(chance=MANY)
def test_line_ends_inside_tokens(finder: FailureFinder, chance: Random) -> None:
    """Lines are counted right where strings and comments run over several of them."""
    pieces = [
        "A",
        "=",
        " ",
        "\n",
        "\r\n",
        "\r",
        '"',
        '"X\nY"',
        "{\r\n}",
        "{ ",
        "?",
        "A=B\n",
        "\n\n",
    ]
    text = "".join(chance.choice(pieces) for _ in range(chance.randint(2, 30)))
    failures = finder.find(text)
    assert finder.recognizer.accepts(text) == (not failures)
    for failure in failures:
        check_one(finder, text, failure)


# ---------------------------------------------------------------------------- contexts


@pytest.mark.parametrize(
    ("text", "rules", "expected"),
    [
        ("", "module", "DEF DEFDAT HEADER NEWLINE"),
        ("DEF A(X)\nEND", "module program procedure", ")"),
        ("DEF A()\nEND\nDECL", "module", "DEF EOF NEWLINE"),
        (program("WAIT 5"), "module program procedure statement simpleStatement wait", "FOR SEC"),
        (program("CONTINUE 1"), "module program procedure statement", "NEWLINE"),
        (
            program("INTERRUPT ENABLE 3"),
            "module program procedure statement simpleStatement interrupt",
            "DECL OFF ON",
        ),
        (
            program("IF X THEN", "LIN P1,", "ENDIF"),
            "module program procedure statement ifStatement statement",
            ". C_DIS NEWLINE [",
        ),
        (program("X=A[1,2]"), None, "* + - / < <= <> == > >= AND OR ]"),
        (program("X={POS:}"), None, "NAME"),
        ("DEFDAT A\nDECL INT X\nENDDAT\n", "module dataList initialisation", "="),
    ],
)
def test_what_was_expected(text: str, rules: str | None, expected: str) -> None:
    """The innermost rule that cannot end, the way to it from the start, and all that could come."""
    context = FINDER.context(FINDER.find(text)[0].state)
    assert expected.split() == list(context.expected)
    if rules is not None:
        assert rules.split() == list(context.rules)
        assert rules.split()[-1] == context.rule


def test_contexts_show_people_what_they_write() -> None:
    """Keywords and punctuation are shown as written, classes of tokens by their name."""
    (failure,) = FINDER.find(program("X=", "HALT"))
    expected = "( - BIT_STRING ENUM_CONSTANT FALSE INTEGER NAME NOT REAL_NUMBER STRING TRUE {"
    assert expected.split() == list(FINDER.context(failure.state).expected)


# -------------------------------------------------------------------------- reading on


UNKNOWN = {
    "SWITCH": ["SWITCH X", "CASE 1", "X=1", "CASE 2,3", "WAIT SEC 1", "DEFAULT", "ENDSWITCH"],
    "SPLINE": ["SPLINE", "SPL P1", "SLIN P2", "SCIRC P3,P4", "SPL P5", "ENDSPLINE"],
    "PTP_SPLINE": ["PTP_SPLINE", "SPTP P1", "SPTP P2", "ENDSPLINE"],
}


@pytest.mark.parametrize("lines", UNKNOWN.values(), ids=UNKNOWN)
@pytest.mark.parametrize("around", [[], ["LOOP", "ENDLOOP"], ["IF X THEN", "ENDIF"]], ids=str)
def test_an_unknown_block_is_one_failure(lines: list[str], around: list[str]) -> None:
    """Its opener fails; its inner markers and its closer only follow; all else is read."""
    text = program(*around[:1], *lines, *around[1:], "X= ?", "Y=1", lines[1], "HALT")
    first = 2 + len(around) // 2
    after = 2 + len(around) + len(lines)
    assert [first, after, after + 2] == direct(text)
    markers = [
        n for n, line in enumerate(lines) if line.split()[0] in BLOCKS[lines[0].split()[0]].words
    ]
    assert [first + n for n in markers] == following(text)


def test_unknown_blocks_within_one_another() -> None:
    """A marker belongs to the innermost block it fits; known blocks inside are read."""
    text = program(
        *("SWITCH X", "CASE 1", "SWITCH Y", "CASE 2", "LOOP", "EXIT", "ENDLOOP", "ENDSWITCH"),
        *("CASE 3", "SPLINE", "SPL P1", "ENDSPLINE", "ENDSWITCH", "CASE 4"),
    )
    assert [2, 4, 11, 15] == direct(text)
    assert [3, 5, 9, 10, 12, 13, 14] == following(text)


@pytest.mark.parametrize("opener", ["DEFFCT INT F(N:IN)", "GLOBAL DEFFCT INT F()", "DEFFCT F"])
def test_the_body_of_an_unknown_routine_is_read(opener: str) -> None:
    """The lines of a function are read as those of a procedure; its ENDFCT follows."""
    body = ["DECL INT I", "X=1", "IF X THEN", "Y= ?", "ENDIF", "ENDFCT"]
    text = "\n".join([*program("X=1").split("\n")[:3], opener, *body, "DEF B()", "X=1", "END", ""])
    assert [4, 8] == direct(text)
    assert [10] == following(text)
    assert [1, 5] == direct("\n".join([opener, *body, ""]))
    assert [7] == following("\n".join([opener, *body, ""]))


def test_deep_nesting_and_long_lines() -> None:
    """Failures in 300 blocks, 5,000 parentheses and a line of 5,000 tokens are found in place."""
    depth = 300
    deep = program(*["IF X THEN"] * depth, "X= ?", *["ENDIF"] * depth, "X= ?")
    assert [(depth + 2, 4, "?"), (2 * depth + 3, 4, "?")] == found(deep)
    line = "X=" + "(" * 5_000
    assert [(2, 5_003, "\n")] == found(program(line))
    (failure,) = FINDER.find(program(line))
    assert FINDER.context(failure.state).rule == "primary"
    assert [(2, 5, "1")] == found(program("X=1 1" + " 1" * 5000))


def test_memory_does_not_change_what_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """A finder that keeps forgetting finds what one finds that remembers."""
    texts = [program(*lines, "X= ?") for lines in UNKNOWN.values()] * 2
    expected = [[(f.line, f.column, f.follows) for f in FINDER.find(text)] for text in texts]
    monkeypatch.setattr(grammar.parser.failures, "_MOST_REMEMBERED", 2)
    forgetful = FailureFinder(Recognizer(OWN["preliminary"].grammar))
    assert expected == [
        [(f.line, f.column, f.follows) for f in forgetful.find(text)] for text in texts
    ]


@given(MANY)
def test_the_beginning_of_a_text_is_read_as_in_all_of_it(chance: Random) -> None:
    """Up to each line, whatever lines come behind it."""
    some = [line for lines in UNKNOWN.values() for line in lines] + ["X=1 1", "", "HALT", "ENDIF"]
    text = program(*chance.choices(some, k=40))
    failing = [failure.line for failure in FINDER.find(text)]
    for line in range(1, 44):
        early = [f.line for f in FINDER.find(beginning(text, line)) if f.line <= line]
        assert [n for n in failing if n <= line] == early
