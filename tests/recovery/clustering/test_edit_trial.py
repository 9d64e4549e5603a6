"""Trying an edit on failing lines tells what reading whole programs under the new grammar tells."""

from collections.abc import Sequence
from functools import cache
from random import Random

import pytest

from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    RemoveElement,
    Widen,
    apply,
)
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from recovery import tuning
from recovery.clustering.edit_trial import EditTrial, TrialResult, edited
from recovery.proposals.candidates import CandidateFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.survey import survey_texts

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)
KEYWORDS = frozenset({"STEP", "SWITCH", "GLOBAL", "C_VEL"})
#: One failing line each, wherever a line of a procedure can stand.
FAILING = (
    "FOR I=1 TO 9 STEP 2\nENDFOR",
    "FOR I=1 TO 9 STEP K\nENDFOR",
    "FOR I=1 TO 9 STEP\nENDFOR",
    "LOOP\nFOR I=1 TO F(X) STEP A+1\nENDFOR\nENDLOOP",
    "FOR I=A TO B DO\nENDFOR",
    "X[1,2]=3",
    "A=X[I,J+1]",
    "X[,]=3",
    "IF X[1,2,3]==4 THEN\nENDIF",
    "LIN P1 C_VEL",
    "CIRC P1,P2 C_VEL",
    "PTP P1 C_PTP C_VEL",
    "RETURN 1",
    "RETURN A+1 2",
    "SWITCH X",
    "GLOBAL INTERRUPT DECL 3 WHEN A DO B()",
    "WAIT FOR",
    "A 1",
    "A=",
    "A=1 2 3",
    "A=STEP STEP STEP",
    "HALT ?",
    "LIN {X 1}",
    "DECL STEP STEP STEP",
)
EDITS: dict[str, Sequence[Edit]] = {
    "insert at the end": [Insert("return", (1, 2), "expression?")],
    "insert in the middle": [Insert("index", (1, 3), "(',' expression)*")],
    "insert in a group": [Insert("variable", (1, 3, 1, 3), "index?")],
    "widen a token": [Widen("wait", (1, 2), "ON")],
    "widen a rule": [Widen("target", (1, 1), "call")],
    "optional": [MakeOptional("assignment", (1, 2))],
    "two optional": [MakeOptional("forStatement", (1, 5), 2)],
    "alternative": [AddAlternative("relation", "','")],
    "alternative of rules": [AddAlternative("simpleStatement", "variable literal")],
    "alternative that begins others": [AddAlternative("simpleStatement", "RETURN INTEGER")],
    "empty alternative": [MakeOptional("exit", (1, 1))],
    "keyword": [AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")],
    "keyword that was a name": [AddToken("STEP"), AddAlternative("simpleStatement", "STEP")],
    "two keywords": [
        AddToken("C_VEL"),
        AddToken("SWITCH"),
        AddAlternative("simpleStatement", "SWITCH expression | motion C_VEL"),
    ],
    "two rules": [MakeOptional("motion", (1, 2)), Insert("return", (1, 2), "literal?")],
    "new rule": [
        AddRule("return", "returned\n    : RETURN expression\n    ;"),
        AddAlternative("simpleStatement", "returned"),
    ],
    "taken away": [RemoveAlternative("simpleStatement", 12)],
    "taken away and another": [
        RemoveAlternative("wait", 1),
        AddAlternative("assignment", "NAME literal"),
    ],
    "nothing but the same": [AddAlternative("simpleStatement", "assignment")],
}


def program(line: str) -> str:
    return f"DEF A()\n{line}\nEND\n"


@cache
def fresh(name: str) -> Recognizer:
    """A recogniser that has nothing but the text of the edited grammar."""
    return Recognizer(read(apply(PRELIMINARY, EDITS[name]).text))


@cache
def trial() -> EditTrial:
    found = survey_texts([(line, program(line)) for line in FAILING], PRELIMINARY)
    lines = []
    for file in found.files:
        (failed,) = file.failures
        meant = tuple((i, word) for i, word in enumerate(failed.words) if word in KEYWORDS)
        lines.append(LinePattern(found.forms[failed.form], meant))
    return EditTrial(RECOGNIZER, lines)


def failing_token(recognizer: Recognizer, text: str) -> int | None:
    """How many tokens of a text can be read before it fails; ``None`` where it does not."""
    return recognizer.run(recognizer.start, recognizer.kinds(text))[1]


@pytest.mark.parametrize("name", EDITS)
def test_lines_are_mended_that_whole_programs_say_are(name: str) -> None:
    """A line counts as mended, or read further, exactly when its program is."""
    mended, advanced = set(), set()
    for number, line in enumerate(FAILING):
        before, after = (failing_token(r, program(line)) for r in (RECOGNIZER, fresh(name)))
        assert before is not None
        if after is None:
            mended.add(number)
        elif after > before:
            advanced.add(number)
    assert TrialResult(frozenset(mended), frozenset(advanced)) == trial().result(EDITS[name])


@pytest.mark.parametrize("name", ["insert in the middle", "keyword", "new rule"])
def test_only_the_lines_asked_about_are_tried(name: str) -> None:
    """The outcome among some lines is that among all, cut to them."""
    file_trial = trial().result(EDITS[name])
    some = frozenset(range(0, len(FAILING), 3))
    assert TrialResult(file_trial.mended & some, file_trial.advanced & some) == trial().result(
        EDITS[name], some
    )
    assert TrialResult(frozenset(), frozenset()) == trial().result(EDITS[name], [])


def test_candidates_mend_what_they_say() -> None:
    """A line whose program an edit lets be read is mended in the trial too."""
    finder = CandidateFinder(RECOGNIZER)
    chance = Random(3)
    for number in (0, 5, 9, 12, 17):
        found = finder.find_common([trial().lines[number]], tuning.MOST_TRIED)
        for candidate in chance.sample(found, min(3, len(found))):
            grammar = Recognizer(read(apply(PRELIMINARY, candidate.edits).text))
            expected = {i for i, line in enumerate(FAILING) if grammar.accepts(program(line))}
            new = {edit.name for edit in candidate.edits if isinstance(edit, AddToken)}
            # a line is tried with a new keyword only where it may mean one
            relevant = {i for i, line in enumerate(trial().lines) if new <= words_of(line)}
            assert expected & relevant <= trial().result(candidate.edits).mended


@pytest.mark.parametrize("number", range(0, len(FAILING), 3))
def test_a_detour_is_what_the_edited_grammar_reads(number: int) -> None:
    """Candidates read as detours do to lines what a recogniser of the edited grammar does."""
    finder = CandidateFinder(RECOGNIZER)
    tried = trial()
    found = finder.find_common([tried.lines[number]], tuning.MOST_TRIED)
    for candidate in Random(number).sample(found, min(30, len(found))):
        wider, places = edited(RECOGNIZER, candidate.edits), tried.relevant(candidate.edits)
        mended, advanced = set(), set()
        for place, start, kinds in tried.read_by(wider, candidate.edits, places) if wider else ():
            assert wider is not None
            read = wider.run(start, kinds)[1]
            if read is None:
                mended.add(place)
            elif read > tried.lines[place].form.index:
                advanced.add(place)
        expected = TrialResult(frozenset(mended), frozenset(advanced))
        assert expected == tried.result(candidate.edits), candidate


def words_of(line: LinePattern) -> set[str]:
    return {word for _, word in line.keywords}


# ----------------------------------------------------------------------- the edited network


def texts(grammar: Grammar, count: int, chance: Random) -> list[str]:
    """Random programs of a grammar, and as many with a token or two changed."""
    sentences, speller = Sentences(grammar), Speller(grammar)
    names = [r.name for r in grammar.rules if r.is_lexer and r.name not in ("COMMENT", "SPACE")]
    out = []
    for _ in range(count):
        sentence = sentences.random(chance, 12)
        out.append(speller.text(sentence))
        for _ in range(chance.randint(1, 2)):
            place = chance.randrange(len(sentence) + 1)
            sentence[place : place + chance.randint(0, 1)] = [chance.choice(names)]
        out.append(speller.text(sentence))
    return out


@pytest.mark.parametrize("name", EDITS)
def test_a_patched_network_is_one_built_afresh(name: str) -> None:
    """A recogniser of edits accepts what one made from the new grammar's text accepts."""
    patched = edited(RECOGNIZER, EDITS[name])
    assert patched is not None
    assert fresh(name).grammar.text == patched.grammar.text
    chance = Random(name)
    written = [
        *map(program, FAILING),
        *texts(patched.grammar, 25, chance),
        *texts(PRELIMINARY, 10, chance),
    ]
    expected = [failing_token(fresh(name), text) for text in written]
    assert expected == [failing_token(patched, text) for text in written]
    assert None in expected
    assert any(index is not None for index in expected)


def test_edits_leave_the_recogniser_as_it_was() -> None:
    """Trying an edit changes nothing: what was refused before is refused after."""
    before = [failing_token(RECOGNIZER, program(line)) for line in FAILING]
    for edits in EDITS.values():
        trial().result(edits)
    assert before == [failing_token(RECOGNIZER, program(line)) for line in FAILING]


@pytest.mark.parametrize(
    "edits",
    [
        [Insert("nowhere", (1, 1), "NAME")],
        [Insert("return", (7, 1), "NAME")],
        [AddToken("HALT")],
        [AddAlternative("return", "(")],
        [AddAlternative("return", "nowhere")],
        [AddAlternative("return", "NOWHERE")],
        [AddAlternative("expression", "expression '+' expression")],
        [Insert("index", (1, 1), "variable?"), AddAlternative("variable", "index")],
        [AddAlternative("simpleStatement", "statement")],
    ],
)
def test_edits_that_make_no_grammar_mend_nothing(edits: list[Edit]) -> None:
    """An edit that does not fit, or that no recogniser could read, is no error and no mend."""
    assert edited(RECOGNIZER, edits) is None
    assert TrialResult(frozenset(), frozenset()) == trial().result(edits)


def test_a_line_is_tried_behind_what_lets_it_begin_in_every_way() -> None:
    """A second routine follows a routine: what leads there through a data list does not count."""
    text = "DEFDAT A\nENDDAT\n", "DEF A()\nEND\nDEF B(X)\nEND\n"
    file_trial = read_file(GRAMMAR)
    grammar = apply(file_trial, [RemoveElement("procedure", (1, 5))])
    found = survey_texts([(f"{n}.src", t) for n, t in enumerate(text)], grammar)
    form = found.forms[found.files[1].failures[0].form]
    trial = EditTrial(Recognizer(grammar), [LinePattern(form, ())])
    edit = Insert("procedure", (1, 5), "parameters?")
    assert frozenset([0]) == trial.result([edit]).mended


def test_two_readings_are_reported() -> None:
    """A word that is read as it is and by a rule has two readings; the rule alone gives one."""
    grammar = read_file(GRAMMAR)
    found = survey_texts([("a.src", "DEF A()\nHALT C_DIS\nEND\n")], grammar)
    form = found.forms[found.files[0].failures[0].form]
    trial = EditTrial(Recognizer(grammar), [LinePattern(form, ())])
    assert trial.is_ambiguous([Insert("halt", (1, 2), "(C_DIS | criterion)?")], [0])
    assert not trial.is_ambiguous([Insert("halt", (1, 2), "criterion?")], [0])


def test_large_recognisers_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kept are many small recognisers or few large ones."""
    trial = EditTrial(Recognizer(read_file(GRAMMAR)), ())
    edits = [[AddAlternative("simpleStatement", " ".join(["INTEGER"] * n))] for n in range(1, 4)]
    first = trial.wider(edits[0])
    assert first is not None
    assert first.start is not None, "one that is used has configurations"
    assert first is trial.wider(edits[0])
    assert trial.wider(edits[1]) is not None
    assert first is trial.wider(edits[0])
    monkeypatch.setattr(tuning, "MOST_CONFIGURATIONS_KEPT", 0)
    assert trial.wider(edits[2]) is not None
    assert first is not trial.wider(edits[0])


def test_an_edit_leads_to_lines_that_can_follow_what_it_mends() -> None:
    """The end of a block follows its beginning; what can be read again and again leads nowhere."""
    found = survey_texts([("a", program("SWITCH\nENDSWITCH A"))], PRELIMINARY)
    lines = [
        LinePattern(found.forms[failed.form], ((0, failed.words[0]),))
        for failed in found.files[0].failures
    ]
    words = AddToken("SWITCH"), AddToken("ENDSWITCH")
    trial = EditTrial(RECOGNIZER, lines)
    block = AddAlternative("statement", "SWITCH eol statement* ENDSWITCH expression eol")
    assert trial.leads_to([*words, block], [0], [1])
    assert not trial.leads_to([*words, AddAlternative("simpleStatement", "SWITCH")], [0], [1])
    assert not trial.leads_to([*words, block], [0], [])
