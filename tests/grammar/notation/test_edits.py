"""Edits change the text of one rule, the data follows, and what fitted before still fits."""

import json
from collections.abc import Iterator
from random import Random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from grammar.notation.addresses import element_at, sequences
from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    Preamble,
    RemoveAlternative,
    RemoveElement,
    RemoveRule,
    Replace,
    SetComment,
    Widen,
    apply,
    describe,
    from_data,
    to_data,
)
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar, GrammarError, Group, Repeat, Rule
from grammar.parser.lexer import lexer_of
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
TOKENS = "A : 'A' ;\nB : 'B' ;\nC : 'C' ;\nD : 'D' ;\n"
PLAIN = "s : A (B | C t)? B+ ;"
TALL = "s // of the start\n    : A // first | second\n    | B C // last\n    ;"


def grammar_of(rule: str) -> Grammar:
    return read(
        f"// top\ngrammar T;\n\n// of s\n{rule}\n\n// of t\nt : B | C ;\n\n{TOKENS}// end\n"
    )


def edited(rule: str, edit: Edit) -> str:
    """The text of rule ``s`` after an edit of it."""
    return apply(grammar_of(rule), [edit]).by_name["s"].text


# ------------------------------------------------------------------------ what each does


@pytest.mark.parametrize(
    ("rule", "edit", "expected"),
    [
        (PLAIN, Insert("s", (1, 1), "C?"), "s : C? A (B | C t)? B+ ;"),
        (PLAIN, Insert("s", (1, 3), "C"), "s : A (B | C t)? C B+ ;"),
        (PLAIN, Insert("s", (1, 4), "(C t)*"), "s : A (B | C t)? B+ (C t)* ;"),
        (PLAIN, Insert("s", (1, 2, 1, 1), "'A'"), "s : A ('A' B | C t)? B+ ;"),
        (PLAIN, Insert("s", (1, 2, 2, 3), "A"), "s : A (B | C t A)? B+ ;"),
        (PLAIN, Widen("s", (1, 1), "B C"), "s : (A | B C) (B | C t)? B+ ;"),
        (PLAIN, Widen("s", (1, 2), "A"), "s : A (B | C t | A)? B+ ;"),
        (PLAIN, Widen("s", (1, 3), "A"), "s : A (B | C t)? (B | A)+ ;"),
        (PLAIN, Widen("s", (1, 2, 2, 2), "A"), "s : A (B | C (t | A))? B+ ;"),
        ("s : (A | B) ;", Widen("s", (1, 1), "C"), "s : (A | B | C) ;"),
        (PLAIN, MakeOptional("s", (1, 1)), "s : A? (B | C t)? B+ ;"),
        (PLAIN, MakeOptional("s", (1, 2)), PLAIN),
        (PLAIN, MakeOptional("s", (1, 3)), "s : A (B | C t)? B* ;"),
        (PLAIN, MakeOptional("s", (1, 2, 2, 1), 2), "s : A (B | (C t)?)? B+ ;"),
        (PLAIN, MakeOptional("s", (1, 1), 3), "s : (A (B | C t)? B+)? ;"),
        ("s : (A | B) ;", MakeOptional("s", (1, 1)), "s : (A | B)? ;"),
        (PLAIN, AddAlternative("s", "C t"), "s : A (B | C t)? B+ | C t ;"),
        (TALL, AddAlternative("s", "C"), TALL.replace("// last\n", "// last\n    | C\n")),
        ("s : A | B | C ;", RemoveAlternative("s", 1), "s : B | C ;"),
        ("s : A | B | C ;", RemoveAlternative("s", 2), "s : A | C ;"),
        ("s : A | B | C ;", RemoveAlternative("s", 3), "s : A | B ;"),
        ("s : A # x | B # y ;", RemoveAlternative("s", 1), "s : B # y ;"),
        ("s : A # x | B # y ;", RemoveAlternative("s", 2), "s : A # x ;"),
        (
            "s\n    : A\n    | B\n    | C\n    ;",
            RemoveAlternative("s", 1),
            "s\n    : B\n    | C\n    ;",
        ),
        (
            "s\n    : A\n    | B\n    | C\n    ;",
            RemoveAlternative("s", 3),
            "s\n    : A\n    | B\n    ;",
        ),
        (PLAIN, RemoveElement("s", (1, 1)), "s : (B | C t)? B+ ;"),
        (PLAIN, RemoveElement("s", (1, 3)), "s : A (B | C t)? ;"),
        (PLAIN, RemoveElement("s", (1, 2, 2, 1)), "s : A (B | t)? B+ ;"),
        (PLAIN, RemoveElement("s", (1, 2, 2, 2)), "s : A (B | C)? B+ ;"),
        ("s : (A B)* C ;", RemoveElement("s", (1, 1, 1, 1)), "s : (B)* C ;"),
        ("s\n    : A B\n    ;", RemoveElement("s", (1, 2)), "s\n    : A\n    ;"),
        ("s : A ;", RemoveElement("s", (1, 1)), "s : ;"),
        (PLAIN, Replace("s", (1, 1), "C t"), "s : C t (B | C t)? B+ ;"),
        (PLAIN, Replace("s", (1, 2), "C", 2), "s : A C ;"),
        (PLAIN, Replace("s", (1, 2, 2, 2), "A"), "s : A (B | C A)? B+ ;"),
    ],
)
def test_edits_of_a_rule(rule: str, edit: Edit, expected: str) -> None:
    """Each edit writes what its name says, layout and comments around it kept."""
    assert expected == edited(rule, edit)


@pytest.mark.parametrize(
    ("edit", "old", "new"),
    [
        (AddRule("s", "u\n    : A\n    ;"), "s : C ;\n", "s : C ;\n\nu\n    : A\n    ;\n"),
        (
            AddRule("s", "u : A ;", "of u\nmore"),
            "s : C ;\n",
            "s : C ;\n\n// of u\n// more\nu : A ;\n",
        ),
        (SetComment("s", "new\n\nmore"), "// of s\n", "// new\n//\n// more\n"),
        (SetComment("s", ""), "// of s\n", ""),
        (SetComment("t", "of t"), "\n\nt : B", "\n\n// of t\nt : B"),
        (Preamble("one\ntwo"), "// top\n", "/*\n * one\n * two\n */\n// top\n"),
        (AddRule("t", "u : A ;"), "t : B | C ;\n", "t : B | C ;\n\nu : A ;\n"),
        (AddToken("AB"), "A : 'A' ;\n", "A : 'A' ;\nAB : 'AB' ;\n"),
        (AddToken("BC"), "B : 'B' ;\n", "B : 'B' ;\nBC : 'BC' ;\n"),
        (AddToken("E"), "D : 'D' ;\n", "D : 'D' ;\nE : 'E' ;\n"),
        (RemoveRule("t"), "\n\nt : B | C ;\n", "\n"),
        (RemoveRule("D"), "D : 'D' ;\n", ""),
    ],
    ids=repr,
)
def test_edits_of_the_rules(edit: Edit, old: str, new: str) -> None:
    """Rules come and go in their place, and all other text stays."""
    grammar = read(grammar_of("s : C ;").text.replace("// of t\n", ""))
    assert old in grammar.text
    changed = apply(grammar, [edit])
    assert grammar.text.replace(old, new) == changed.text
    assert repr(read(changed.text)) == repr(changed)


def test_a_first_keyword() -> None:
    """A keyword ahead of all others comes before them, behind what introduces them."""
    grammar = grammar_of("s : C ;")
    text = grammar.text.replace("A : 'A' ;", "AB : 'AB' ;").replace("s : A", "s : AB")
    changed = apply(read(text), [AddToken("AA"), AddToken("AAA")])
    assert text.replace("AB : ", "AA : 'AA' ;\nAAA : 'AAA' ;\nAB : ") == changed.text


def test_edits_are_applied_in_order() -> None:
    """A later edit sees what an earlier one wrote, and the grammar they started from stays."""
    grammar = grammar_of("s : A ;")
    edits: list[Edit] = [
        AddToken("NEW"),
        AddRule("s", "u : NEW ;"),
        AddAlternative("s", "u C"),
        MakeOptional("s", (2, 2)),
        Insert("u", (1, 2), "A"),
    ]
    changed = apply(grammar, edits)
    assert "s : A | u C? ;" == changed.by_name["s"].text
    assert "u : NEW A ;" == changed.by_name["u"].text
    assert changed.literal_tokens["NEW"] == "NEW"
    assert grammar_of("s : A ;").text == grammar.text


# --------------------------------------------------------------------- what does not fit


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (AddAlternative("q", "A"), "there is no rule q"),
        (AddRule("q", "u : A ;"), "there is no rule q"),
        (RemoveRule("q"), "there is no rule q"),
        (AddRule("s", "t : A ;"), "rule t exists already"),
        (AddRule("s", "u : A"), "syntax error at end"),
        (AddToken("A"), "token A exists already"),
        (AddToken("s"), "token s exists already"),
        (AddToken("9"), "'9' is not the name of a token"),
        (AddToken("x : 'dwell x"), "is not the name of a token"),
        (AddAlternative("s", "{a}"), "syntax error at '{a}"),
        (AddAlternative("s", "A ; u : B"), "syntax error at 'u : B"),
        (Insert("s", (1, 5), "A"), "rule s has no place 1.5"),
        (Insert("s", (1, 0), "A"), "rule s has no place 1.0"),
        (Insert("s", (2, 1), "A"), "rule s has no place 2"),
        (Insert("s", (0, 1), "A"), "rule s has no place 0"),
        (Insert("s", (1, 2, 3, 1), "A"), "rule s has no place 1.2.3"),
        (Insert("s", (1, 0, 1, 1), "A"), "rule s has no place 1.0.1"),
        (Insert("s", (1, 1, 1, 1), "A"), "rule s has no place 1.1.1"),
        (Insert("s", (1,), "A"), "rule s has no place"),
        (Insert("s", (), "A"), "rule s has no place"),
        (Widen("s", (1, 4), "A"), "rule s has no place 1.4"),
        (MakeOptional("s", (1, 3), 2), "rule s has no place 1.4"),
        (RemoveElement("s", (1, -1)), "rule s has no place 1.-1"),
        (RemoveAlternative("s", 1), "rule s cannot lose alternative 1"),
        (RemoveAlternative("t", 3), "rule t cannot lose alternative 3"),
        (RemoveAlternative("t", 0), "rule t cannot lose alternative 0"),
    ],
    ids=repr,
)
def test_what_does_not_fit_is_refused(edit: Edit, message: str) -> None:
    """A rule, token or place that is not there, or text that is no rule, gives one clear line."""
    with pytest.raises(GrammarError) as raised:
        apply(grammar_of(PLAIN), [edit])
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("rule", ["s : A | ;", "s : | A ;"])
def test_empty_alternatives_are_refused(rule: str) -> None:
    """An alternative without elements has no place to insert at and cannot be taken away."""
    empty = 2 if rule.endswith("| ;") else 1
    for edit in (RemoveAlternative("s", empty), Insert("s", (empty, 1), "B")):
        with pytest.raises(GrammarError, match="empty"):
            edited(rule, edit)


def test_a_first_keyword_comes_before_what_could_read_it() -> None:
    """Of two tokens that read the same the first one wins."""
    grammar = apply(read("grammar T;\ns : A ;\n\nA : [A-Z] ;\nD : 'x' ;\n"), [AddToken("B")])
    assert ["B", "A"] == [lexer_of(grammar).names[lexer_of(grammar).kinds[w]] for w in "BC"]


# ------------------------------------------------------------------------------ addresses


@pytest.mark.parametrize("name", ["krl", "preliminary"])
def test_addresses_lead_to_every_element(name: str, request: pytest.FixtureRequest) -> None:
    """`sequences` and `element_at` name the same elements, each once, and nothing beyond them."""
    grammar: Grammar = request.getfixturevalue(name)
    for rule in grammar.rules:
        found = dict(sequences(rule))
        assert len(found) == len(list(sequences(rule)))
        for address, alternative in found.items():
            for place, element in enumerate(alternative.elements, 1):
                assert element_at(rule, (*address, place)) is element
                inner = element.item if isinstance(element, Repeat) else element
                if isinstance(inner, Group):
                    for number, below in enumerate(inner.alternatives, 1):
                        assert found[(*address, place, number)] is below
            with pytest.raises(GrammarError):
                element_at(rule, (*address, len(alternative.elements) + 1))
        assert {(n,) for n in range(1, len(rule.alternatives) + 1)} == {
            address for address in found if len(address) == 1
        }


# ----------------------------------------------------------------------------------- laws

TEXTS = ["CIRC", "'='", "NAME", "expression", "index (',' index)*", "(STRING | 'ON')", "eol"]


def places_of(rule: Rule) -> Iterator[tuple[tuple[int, ...], int]]:
    """The addresses of a rule's sequences with how many elements each has."""
    for address, alternative in sequences(rule):
        if alternative.elements:
            yield address, len(alternative.elements)


def a_widening(chance: Random, grammar: Grammar) -> Edit:
    """An edit that only ever adds programs."""
    rule = chance.choice(grammar.parser_rules)
    address, size = chance.choice(list(places_of(rule)))
    text = chance.choice(TEXTS)
    place = chance.randint(1, size)
    edits: list[Edit] = [
        AddAlternative(rule.name, text),
        Insert(rule.name, (*address, chance.randint(1, size + 1)), f"({text})?"),
        Widen(rule.name, (*address, place), text),
        MakeOptional(rule.name, (*address, place), chance.randint(1, size + 1 - place)),
    ]
    return chance.choice(edits)


def a_narrowing(chance: Random, grammar: Grammar) -> Edit:
    """An edit that only ever takes programs away."""
    rules = [r for r in grammar.parser_rules if len(r.alternatives) > 1]
    rule = chance.choice(rules)
    return RemoveAlternative(rule.name, chance.randint(1, len(rule.alternatives)))


def an_omission(chance: Random, grammar: Grammar) -> Edit:
    """An edit that changes programs."""
    rule = chance.choice(grammar.parser_rules)
    address, size = chance.choice(list(places_of(rule)))
    return RemoveElement(rule.name, (*address, chance.randint(1, size)))


def result_of(grammar: Grammar, edit: Edit) -> Grammar:
    """The grammar after an edit; draws that leave no grammar of our style are given up."""
    changed = apply(grammar, [edit])
    try:
        again = read(changed.text)
    except GrammarError as error:
        assume("left recursion" not in str(error) and "has no end" not in str(error))
        raise
    assert repr(again) == repr(changed)
    return changed


@given(st.randoms(use_true_random=True))
def test_an_edit_touches_its_rule_only(chance: Random) -> None:
    """All other text stays as it was, and reading the new text gives the edited data."""
    edit = chance.choice([a_widening, a_narrowing, an_omission])(chance, PRELIMINARY)
    assert not isinstance(edit, AddToken | AddRule | RemoveRule | Preamble)
    changed = result_of(PRELIMINARY, edit)
    assert PRELIMINARY.gaps == changed.gaps
    for old, new in zip(PRELIMINARY.rules, changed.rules, strict=True):
        assert old.name == new.name
        if old.name != edit.rule:
            assert old is new
    old, new = PRELIMINARY.by_name[edit.rule], changed.by_name[edit.rule]
    blanks = [line for line in new.text.splitlines() if line != line.rstrip()]
    assert [] == blanks
    assert old == new or old.text != new.text


@given(st.randoms(use_true_random=True))
def test_widening_rejects_nothing(chance: Random) -> None:
    """What a grammar accepts it still accepts after an alternative or an option more."""
    wider = Recognizer(result_of(PRELIMINARY, a_widening(chance, PRELIMINARY)))
    sentences = Sentences(PRELIMINARY)
    for _ in range(10):
        tokens = [*sentences.random(chance, 40), "EOF"]
        kinds = [wider.lexer.kind_of[t] for t in tokens]
        assert wider.run(wider.start, kinds)[1] is None


@given(st.randoms(use_true_random=True))
def test_narrowing_accepts_nothing_new(chance: Random) -> None:
    """What a grammar accepts without one alternative it accepted with it."""
    narrower = result_of(PRELIMINARY, a_narrowing(chance, PRELIMINARY))
    wider = Recognizer(PRELIMINARY)
    sentences = Sentences(narrower)
    for _ in range(10):
        tokens = [*sentences.random(chance, 40), "EOF"]
        kinds = [wider.lexer.kind_of[t] for t in tokens]
        assert wider.run(wider.start, kinds)[1] is None


# -------------------------------------------------------------------------- files and people


EDITS: list[Edit] = [
    Insert("s", (1, 2, 1, 1), "A?"),
    Widen("s", (1, 1), "B"),
    MakeOptional("s", (1, 1), 2),
    AddAlternative("s", "A B"),
    AddRule("s", "u\n    : A\n    ;"),
    AddToken("NEW"),
    RemoveAlternative("s", 1),
    RemoveElement("s", (1, 1)),
    RemoveRule("t"),
    Replace("s", (1, 1), "B", 2),
    SetComment("s", "new"),
    Preamble("new"),
]


@pytest.mark.parametrize("edit", EDITS, ids=lambda e: type(e).__name__)
def test_edits_as_plain_data(edit: Edit) -> None:
    """An edit becomes plain data that JSON and TOML can hold, and comes back from it."""
    data = to_data(edit)
    assert edit == from_data(json.loads(json.dumps(data)))


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"edit": "nonsense"},
        {**to_data(EDITS[0]), "more": 1},
        {k: v for k, v in to_data(EDITS[0]).items() if k != "text"},
        {**to_data(EDITS[0]), "at": "1.2"},
        {**to_data(EDITS[0]), "at": [1, "2"]},
        {**to_data(EDITS[0]), "rule": 3},
        {**to_data(EDITS[2]), "count": "2"},
    ],
    ids=lambda d: " ".join(map(str, d.values())) or "nothing",
)
def test_data_that_is_no_edit_is_refused(data: dict[str, object]) -> None:
    """Unknown kinds, missing, further and ill-typed fields give a `GrammarError` of one line."""
    with pytest.raises(GrammarError) as raised:
        from_data(data)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("edit", "expected"),
    [
        (AddToken("SWITCH"), "reserve SWITCH"),
        (AddRule("s", "u\n    : A\n    ;"), "new rule u : A ;"),
        (AddAlternative("s", "C t"), "s: or C t"),
        (RemoveRule("t"), "without rule t"),
        (RemoveAlternative("t", 2), "t: without the alternative C"),
        (Insert("s", (1, 1), "C?"), "s: »C?« A (B | C t)? B+"),
        (Insert("s", (1, 4), "C?"), "s: A (B | C t)? B+ »C?«"),
        (Insert("s", (1, 2, 2, 2), "A"), "s: C »A« t"),
        (Widen("s", (1, 3), "A"), "s: »A« too where B+ stands"),
        (MakeOptional("s", (1, 2, 2, 1), 2), "s: C t may be left out"),
        (RemoveElement("s", (1, 3)), "s: without B+"),
        (Replace("s", (1, 1), "C", 2), "s: »C« instead of A (B | C t)?"),
        (SetComment("s", "new"), "s: its comment"),
        (Preamble("new"), "the opening comment"),
    ],
    ids=repr,
)
def test_an_edit_is_described_in_one_line(edit: Edit, expected: str) -> None:
    """The line names the rule, what changes, and the words around the place."""
    assert expected == describe(grammar_of(PLAIN), edit)
