"""The syntax by cases: `syntax/TOPIC.txt` holds sources with the trees or errors they must give.

How a case is written is told in `grammar.parser.syntax_cases`. To rewrite the trees after a change
of the grammar: ``python -m grammar.parser.syntax_cases --update tests/grammar/syntax_cases``, and
read the diff.
"""

import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation.g4 import read as read_grammar
from grammar.parser.coverage import GrammarCoverage
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.sexpr import Shortener, write
from grammar.parser.syntax_cases import CaseReader, SyntaxCaseError, main, read_cases
from grammar.parser.tree import Tree

TOPICS = sorted(Path(__file__).parents[1].joinpath("syntax_cases").glob("*.txt"))
CASES = [(topic.stem, c) for topic in TOPICS for c in read_cases(topic.read_text("utf-8"))]

HEAD = "grammar T;\n"
TOKENS = """
IF : 'IF' ; NOT : 'NOT' ; PTP : 'PTP' ; LIN : 'LIN' ; VIA : 'VIA' ; GO : 'GO' ;
LPAREN : '(' ; RPAREN : ')' ; COMMA : ',' ; DOT : '.' ; PLUS : '+' ;
NAME : [a-z]+ ; TEXT : '"' ~["\\n]* '"' ; HEX : '<' [0-9 ()]+ '>' ;
NEWLINE : '\\n' ; SPACE : ' ' -> skip ;
"""


@pytest.fixture(scope="module")
def reader(krl_recognizer: Recognizer) -> CaseReader:
    return CaseReader(krl_recognizer)


@pytest.mark.parametrize("topic", sorted({topic for topic, _ in CASES}))
def test_syntax(reader: CaseReader, topic: str) -> None:
    """The sources of a topic give the trees, or stop at the tokens, that stand below them."""
    cases = [case for its, case in CASES if its == topic]
    assert all(case.expected for case in cases)
    found = {case.title: reader.difference(case) for case in cases}
    assert {} == {title: difference for title, difference in found.items() if difference}


def test_cases_differ() -> None:
    """No two cases of a topic have the same title, and no two cases the same source."""
    titles = Counter((topic, case.title) for topic, case in CASES)
    sources = Counter(case.source for _, case in CASES)
    assert [] == [title for title, count in titles.items() if count > 1]
    assert [] == [source for source, count in sources.items() if count > 1]


@pytest.fixture(scope="module")
def trees(krl_recognizer: Recognizer) -> list[tuple[str, Tree]]:
    """The trees of all cases that are no errors, with their titles."""
    parser = Parser(krl_recognizer)
    parsed = [(case.title, parser.parse(case.source)) for _, case in CASES]
    return [(title, tree) for title, tree in parsed if isinstance(tree, Tree)]


def test_every_alternative_has_a_case(
    krl_recognizer: Recognizer, trees: Sequence[tuple[str, Tree]]
) -> None:
    """Each alternative of each rule of the grammar in force is read by some case."""
    coverage = GrammarCoverage(krl_recognizer.grammar)
    for _, tree in trees:
        coverage.add(tree)
    assert [] == coverage.unused_alternatives


def test_cases_have_one_reading(trees: Sequence[tuple[str, Tree]]) -> None:
    """No case is ambiguous, soft keywords in the oddest places included."""
    assert [] == [title for title, tree in trees if not tree.is_unique]


def _with_comments(source: str) -> str:
    """A comment behind every line, and a fold, a comment and a blank line above it."""
    return re.sub(r"(?m)^(?!&)(.+)$", r';FOLD "x {\n; END\n\n\1;(((', source)


@pytest.mark.parametrize(
    ("change", "of_errors"),
    [
        pytest.param(lambda s: s.replace("\n", "\r\n"), True, id="line ends of Windows"),
        pytest.param(lambda s: s.replace("\n", "\r"), True, id="carriage returns"),
        pytest.param(lambda s: s.rstrip("\n"), False, id="no line end at the end of the file"),
        pytest.param(str.lower, True, id="small letters"),
        pytest.param(_with_comments, False, id="comments and blank lines"),
        pytest.param(lambda s: re.sub("(?m)^", "\t ", s), False, id="indentation"),
    ],
)
def test_what_makes_no_difference(
    reader: CaseReader, change: Callable[[str], str], of_errors: bool
) -> None:
    """Line ends, letter case, comments, blank lines and blanks before a line change no case.

    Comments and blanks move errors to other places, so only trees are compared there.
    """
    differing = [
        (topic, case.title, changed)
        for topic, case in CASES
        if (of_errors or not case.is_error)
        for changed in [reader.outcome(replace(case, source=change(case.source)))]
        if _folded(reader.outcome(case)) != _folded(changed)
    ]
    assert [] == differing


def _folded(outcome: tuple[bool, str]) -> tuple[bool, str]:
    """The outcome in small letters: trees show tokens as they are written."""
    return outcome[0], outcome[1].lower()


# ------------------------------------------------------------------------- what trees show


@pytest.mark.parametrize(
    ("rules", "text", "expected"),
    [
        # a rule with one rule in it is not shown, one with a token more is
        (["s : a EOF", "a : b", "b : c c", "c : NAME"], "x y", "(b x y)"),
        (["s : a EOF", "a : '(' b ')'", "b : NAME"], "(x)", "(a x)"),
        (["s : a EOF", "a : NAME"], "x", "x"),
        # what a rule cannot do without is left out, in every alternative or in a loop
        (["s : a EOF", "a : IF NAME VIA NAME"], "IF x VIA y", "(a x y)"),
        (["s : a EOF", "a : IF NAME | NOT NAME"], "NOT x", "(a NOT x)"),
        (["s : a EOF", "a : IF NAME | IF NOT"], "IF NOT", "(a NOT)"),
        (["s : a EOF", "a : IF (VIA NAME)+"], "IF VIA x VIA y", "(a x y)"),
        (["s : a EOF", "a : IF (VIA NAME)*"], "IF VIA x VIA y", "(a VIA x VIA y)"),
        (["s : a EOF", "a : (IF | NOT) GO"], "IF GO", "(a IF)"),
        (["s : a EOF", "a : IF"], "IF", "(a)"),
        # separators are left out between neighbours only
        (["s : a EOF", "a : NAME? (',' NAME?)*"], "x,y", "(a x y)"),
        (["s : a EOF", "a : NAME? (',' NAME?)*"], "x,,y,", "(a x , , y ,)"),
        (["s : a EOF", "a : NAME? (',' NAME?)*"], ",x", "(a , x)"),
        (["s : a EOF", "a : NAME ('.' b)*", "b : NAME"], "x.y", "(a x y)"),
        (["s : a EOF", "a : NAME (PLUS NAME)*"], "x+y", "(a x + y)"),
        # line ends and rules without text say nothing
        (["s : (a e)+ EOF", "e : NEWLINE+", "a : IF NAME"], "IF x\n\n", "(a x)"),
        (["s : a EOF", "a : IF NAME b", "b : NOT?"], "IF x", "(a x)"),
        (["s : NAME? EOF"], "", "(s)"),
        # tokens that hold blanks
        (["s : a EOF", "a : IF TEXT HEX"], 'IF "x (y" <1 (2>', '(a "x (y" `<1 (2>`)'),
    ],
)  # fmt: skip
def test_what_is_shown(rules: Sequence[str], text: str, expected: str) -> None:
    """Names, values, operators and what is optional; not what every reader knows."""
    grammar = read_grammar(HEAD + "".join(f"{rule} ;\n" for rule in rules) + TOKENS)
    tree = Parser(Recognizer(grammar)).parse(text)
    assert isinstance(tree, Tree)
    assert expected == write(Shortener(grammar).expression(tree))


# ------------------------------------------------------------------------- files of cases

GOOD = """\
=====
one
=====

DEF A()
END

---

(procedure A)

=====
two
:error
=====
DEF A()

HALT HALT
END
---
3:6 HALT
"""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"x\n{GOOD}", "line 1: cases begin with a title between two bars of ="),
        (f"{GOOD}=====\n", "line 1: cases begin with a title between two bars of ="),
        (GOOD.replace("one\n", "\n"), "line 2: a title, and :error below it or nothing"),
        (GOOD.replace(":error", ":eror"), "line 13: a title, and :error below it or nothing"),
        (GOOD.replace("---\n\n", ""), "line 3: between source and expectation stands one bar of -"),
        (f"{GOOD}---\n", "line 15: between source and expectation stands one bar of -"),
    ],
)
def test_what_are_no_cases(text: str, message: str) -> None:
    """The message says what is missing, and on which line."""
    with pytest.raises(SyntaxCaseError) as error:
        read_cases(text)
    assert message == str(error.value)


def test_what_differs(reader: CaseReader) -> None:
    """Another tree, another error, a tree for an error and the other way round are told apart."""
    one, two = read_cases(GOOD)
    assert [None, None] == [reader.difference(one), reader.difference(two)]
    wrong = read_cases(GOOD.replace("(procedure A)", "(procedure  B)").replace("3:6", "3:5"))
    assert [
        "found\n(procedure A)\nexpected\n(procedure  B)",
        "found\n3:6 HALT\nexpected\n3:5 HALT",
    ] == [reader.difference(case) for case in wrong]
    swapped = read_cases(GOOD.replace("\n:error", "").replace("one\n", "one\n:error\n"))
    assert ["no error, but\n(procedure A)", "no program: 3:6 HALT"] == [
        reader.difference(case) for case in swapped
    ]


def test_updating(reader: CaseReader) -> None:
    """New trees are written where others stood or none; everything else stays as it was."""
    assert GOOD == reader.updated(GOOD)
    assert GOOD == reader.updated(GOOD.replace("(procedure A)", "(x\n y)\n\n"))
    assert GOOD == reader.updated(GOOD.replace("(procedure A)\n", ""))
    updated = reader.updated(GOOD.replace("3:6 HALT", "1:1"))
    assert GOOD.replace("---\n3:6 HALT\n", "---\n\n3:6 HALT\n") == updated
    swapped = GOOD.replace("\n:error", "")
    assert swapped == reader.updated(swapped)


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It tells what differs, writes only when asked to, and ends with 0, 1 or 2."""
    path = tmp_path / "a.txt"
    path.write_text(GOOD, encoding="utf-8")
    assert (0, "") == (main([str(path)]), capsys.readouterr().out)
    wrong = GOOD.replace("(procedure A)", "(procedure B)")
    path.write_text(wrong, encoding="utf-8")
    assert 1 == main([str(path)])
    expected = "8: one\nfound\n(procedure A)\nexpected\n(procedure B)\n\n"
    assert capsys.readouterr().out.endswith(expected)
    assert wrong == path.read_text(encoding="utf-8")
    assert 0 == main(["--update", str(tmp_path)])
    assert GOOD == path.read_text(encoding="utf-8")
    path.write_bytes(b"\xff")
    assert [2, 2] == [main([str(path)]), main([str(tmp_path / "none.txt")])]
    path.write_text("=====\n", encoding="utf-8")
    assert 2 == main(["--update", str(path)])
    assert 3 == len(capsys.readouterr().err.splitlines())
