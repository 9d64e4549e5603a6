"""Steps tried on the files shown, and the failing lines of these."""

import pytest

from grammar.notation.edits import AddAlternative, AddRule, AddToken, Replace
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.failing_lines import FailingLines
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.induction.language import CorpusFile
from recovery.induction.shown_files import ShownFiles
from recovery.induction.steps import AcceptedStep
from recovery.ledger.construct import Evidence


def test_a_step_that_needs_one_not_taken(toy: Grammar, toy_files: tuple[CorpusFile, ...]) -> None:
    """It goes too, with the reason."""
    shrunk = AcceptedStep(
        "a", (AddRule("halt", "word : HALT ;"), Replace("halt", (1, 1), "NUMBER"))
    )
    resting = AcceptedStep("b", (Replace("factor", (1, 1), "word"),))
    halting = (*toy_files, CorpusFile("four/a.toy", "HALT\n", frozenset({"four"})))
    taken, lost = ShownFiles(halting).kept(toy, [shrunk, resting], None)
    assert ([], ["a", "b"]) == (taken, [step.title for step in lost])


@pytest.mark.parametrize(("form", "kept"), [("GO NUMBER", 1), ("NUMBER GO", 1), ("GO", 0)])
def test_one_file_that_uses_a_word_as_a_name(toy: Grammar, form: str, kept: int) -> None:
    """It keeps no word from leading lines of its own in more files, of one origin too."""
    files = tuple(CorpusFile(f"a/{n}", f"{form}\n", frozenset("a")) for n in range(3))
    named = CorpusFile("b", "GO := 1\n", frozenset("b"))
    edits = (AddToken("GO"), AddAlternative("simpleStatement", form))
    step = AcceptedStep("go", edits, Evidence(3, 1, 3))
    taken, _ = ShownFiles((*files, named)).kept(toy, [step], None)
    assert kept == len(taken)


def test_a_word_that_lines_use_as_a_type(toy: Grammar) -> None:
    """It becomes one where types are listed, even if more files have such lines than the step.

    Where there is a rule of names it becomes one of these.
    """
    text = toy.text.replace("    | halt\n", "    | halt\n    | HALT kind NAME\n")
    rules = "kind : name ;\n\nname : NAME ;\n\nhalt\n    : HALT"
    start = read(text.replace("halt\n    : HALT", rules))
    files = [CorpusFile(f"a/{n}", f"HALT WIDE {n}\n", frozenset("a")) for n in "ABC"]
    shown = CorpusFile("b", "WIDE A 1\n", frozenset("b"))
    edits = (AddToken("WIDE"), AddAlternative("simpleStatement", "WIDE NAME NUMBER"))
    step = AcceptedStep("wide", edits, Evidence(1, 1, 1))
    for names, types, found in (
        (None, [], None),
        (None, ["kind"], "kind"),
        ("name", ["kind"], "name"),
    ):
        taken, _ = ShownFiles((*files, shown)).kept(start, [step], names, types)
        added = [e for s in taken for e in s.edits if e not in edits]
        assert ([AddAlternative(found, "WIDE")] if found else []) == added


def test_a_stray_sign_moves_no_word(toy: Grammar) -> None:
    """A sign that the lexer does not know stands where it stands in the line."""
    files = tuple(CorpusFile(o, f"\r MOVE (A{o})\nMOVE 1\nMOVE 2\n", frozenset({o})) for o in "ABC")
    lexer = Recognizer(toy).lexer
    keywords = InferredKeywords(CorpusLines(files, lexer), lexer, {}, ())
    failures = ShownFiles(files).failures(toy)[1]
    patterns = FailingLines(files, failures, keywords).patterns
    shown = {lexer.names[p.form.kinds[place]] for p in patterns for place, _ in p.keywords}
    assert {"NAME"} == shown
