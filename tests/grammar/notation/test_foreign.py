"""Grammars in another style are written anew in ours and read the same."""

import pytest

from grammar.notation.foreign import read_foreign
from grammar.notation.g4 import read
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import GrammarError
from grammar.parser.recognizer import Recognizer

_TOKENS = "NAME : [a-z]+ ;\nNL : '\\n' ;\nWS : ' '+ -> skip ;\n"


def _accepts(rules: str, *texts: str) -> list[bool]:
    recognizer = Recognizer(read_foreign(f"grammar x;\n{rules}\n{_TOKENS}"))
    return [recognizer.accepts(text) for text in texts]


@pytest.mark.parametrize("name", ["KRL.g4", "preliminary.g4"])
def test_our_style(name: str) -> None:
    """A grammar in our style stays as it is, to the byte."""
    text = GRAMMAR.with_name(name).read_text()
    assert text == read_foreign(text).text


def test_quoted_texts_get_tokens() -> None:
    """What parser rules quote is a token though no rule names it, ahead of those that are named."""
    assert [True, False] == _accepts("s : 'go' 'é'? NAME '..' NAME EOF ;", "go a..b", "a b..c")


def test_signs_are_quoted_and_words_are_not() -> None:
    """Whichever way they were written: brackets and words of a rule are seen in its text."""
    grammar = read_foreign(f"grammar x;\ns : 'go' OPEN NAME? ')'* EOF ;\nOPEN : '(' ;\n{_TOKENS}")
    assert "GO '(' NAME? ')'* EOF" in grammar.by_name["s"].text
    assert Recognizer(grammar).accepts("go (a))")


def test_rows_of_lines_have_rules() -> None:
    """Their lines are alternatives of a rule, and a row stands where its rule was called."""
    rules = "s : block ;\nblock : (line NL+)* ;\nline : 'if' NAME NL+ block 'fi' | NAME ;"
    grammar = read_foreign(f"grammar x;\n{rules}\n{_TOKENS}")
    assert "s : lineLine* ;" == grammar.by_name["s"].text
    assert {"file", "s", "lineLine", "line", "eol"} == {r.name for r in grammar.parser_rules}
    texts = ("if a\nif b\n\nfi\nc\nfi\n", "a", "if a\nb\n")
    assert [True, False, False] == _accepts(rules, *texts)


def test_a_row_of_lines_that_are_written_out() -> None:
    """Its line is a rule of its own; a row without line ends stays as it is."""
    rules = "s : (('if' | 'as') NAME 'then' NL+)* ('x' ',' NAME)* ;"
    grammar = read_foreign(f"grammar x;\n{rules}\n{_TOKENS}")
    assert "s : sLine* (X ',' NAME)* ;" == grammar.by_name["s"].text
    assert [True, False] == _accepts(rules, "if a then\nx,b", "as a then x,b")


def test_a_row_that_is_a_line_of_another_row() -> None:
    """Its rule stays, as the other row calls it."""
    rules = "s : (x NL)* ;\nx : NAME | 'x' y 'y' | 'c' (y NL)* ;\ny : (x NL)+ ;"
    assert [True, False] == _accepts(rules, "x a\ny\nc\n", "x y\n")


def test_brackets_behind_operands_have_a_rule() -> None:
    """One for all that are alike; brackets with something else in them stay as they are."""
    rules = "s : x ('(' NAME ')')? ;\nx : NAME ('[' x ']')? (',' NAME ('[' x ']')?)* ;"
    grammar = read_foreign(f"grammar x;\n{rules}\n{_TOKENS}")
    assert "x : NAME xBrackets? (',' NAME xBrackets?)* ;" == grammar.by_name["x"].text
    assert "s : x ('(' NAME ')')? ;" == grammar.by_name["s"].text
    assert [True, True, False] == _accepts(rules, "a[b[c],d](e)", "a,b[c]", "a(b[c])")


def test_the_end_of_the_file_is_implied() -> None:
    """A start rule without EOF, also one that calls itself, reads to the end; lines stay."""
    for rules in ("s : NAME+ ;", "s : NAME s? ;", "s : file ;\nfile : NAME+ ;"):
        assert [True, True, False] == _accepts(rules, "a", "a b c", "a b 3")
    with pytest.raises(GrammarError, match="grammar:3: rule t: missing"):
        read_foreign("grammar x;\ns : NAME ;\nt : missing ;\nNAME : [a-z]+ ;\n")


def test_words_spelt_by_fragments() -> None:
    """They are keywords of a grammar that ignores case."""
    letters = "".join(f"fragment {c} : ('{c.lower()}' | '{c}') ;\n" for c in "GO")
    grammar = read_foreign(
        f"// a grammar a;\ngrammar x;\ns : GO NAME EOF ;\nGO : G O ;\n{letters}{_TOKENS}"
    )
    assert ("GO", True) == (grammar.literal_tokens.get("GO"), grammar.case_insensitive)
    assert Recognizer(grammar).accepts("gO A")


def test_left_recursion() -> None:
    """It becomes levels: operators between, ahead of and behind operands, each as often as may."""
    rules = """
        s : e EOF ;
        e : e ('*' | '/') e | e '+' e # Sum | '-' e | e '?' e ':' e | e '[' e ']' | NAME ;
    """
    texts = ("a+b*-c[d+e]", "--a", "a ? b : c + d", "a[b][c]", "a+", "a b", "[a]")
    assert [True, True, True, True, False, False, False] == _accepts(rules, *texts)


def test_the_first_operator_binds_tightest() -> None:
    """Of several alternatives the last one is the level that all others are below."""
    grammar = read_foreign(f"grammar x;\ns : e EOF ;\ne : e '*' e | e '+' e | NAME ;\n{_TOKENS}")
    assert "e2 ('+' e2)*" in grammar.by_name["e"].text
    assert "e3 ('*' e3)*" in grammar.by_name["e2"].text


def test_a_set_in_brackets_is_negated() -> None:
    """Single characters in brackets are a set; a token may end with the file."""
    end = "SIGN : '!' '-' EOF? -> skip ;"
    rules = f"s : NAME* EOF ;\nNOTE : '#' ~('\\n' | '\\r')* ('\\n' | EOF) -> skip ;\n{end}"
    texts = ("a #b\nc", "a #b", "a\nb", "a!-", "a!")
    assert [True, True, False, True, False] == _accepts(rules, *texts)


def test_what_reads_nothing_is_left_out() -> None:
    """Actions, labels and options of elements."""
    rules = "@header { int x; }\ns : (names+=NAME {add($x);})* <assoc=right> last='!' EOF ;"
    assert [True, False] == _accepts(rules, "a b !", "a b")


def test_a_loop_that_ends_early() -> None:
    """Up to one character it is one over all others."""
    rules = "s : TEXT NAME EOF ;\nTEXT : '\"' .*? '\"' ;"
    assert [True, False] == _accepts(rules, '"a b" c', '"a" "b" c')
    once = "s : TEXT EOF ;\nTEXT : '<' .+? '>' ;"
    assert [True, True, False] == _accepts(once, "<a>", "<>>", "<>")


def test_a_quoted_loop_is_a_text() -> None:
    """What stands within quotes is read as it is."""
    assert [True, False] == _accepts("s : TEXT EOF ;\nTEXT : '.*?' 'x' ;", ".*?x", "aax")


def test_what_comes_out_is_in_our_style() -> None:
    """It can be read again as any other of ours."""
    text = read_foreign(f"grammar x;\ns : s ',' NAME | 'x' ;\n{_TOKENS}").text
    assert text == read(text).text
