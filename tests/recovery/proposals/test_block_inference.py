"""A block the grammar has no form for is found from the lines between its opener and closer."""

from grammar.notation.edits import AddRule, AddToken, RemoveAlternative, RemoveRule, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.proposals.alignment import Aligner
from recovery.proposals.block_inference import BlockFinder
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.phrases import Phraser

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
NO_WHILE = apply(PRELIMINARY, [RemoveAlternative("statement", 4), RemoveRule("whileStatement")])


def blocks(
    opener: str, *bodies: str, meant: frozenset[str] = frozenset(), grammar: Grammar = NO_WHILE
) -> list[str]:
    profile = GrammarProfile(Recognizer(grammar))
    finder = BlockFinder(profile, Aligner(Phraser(profile)))
    texts = [f"DEF A()\n{body}\nEND\n" for body in bodies]
    return [" ".join(block.symbols) for block in finder.find(opener, texts, meant)]


def test_a_lost_block_is_rebuilt() -> None:
    """Opener, body and closer come back as one form, its operand as a rule."""
    found = blocks("WHILE", "WHILE A\nB=1\nENDWHILE", "WHILE B==1\nWHILE C\nENDWHILE\nENDWHILE")
    assert "WHILE expression eol statement* ENDWHILE" in found


def test_an_unknown_block_with_parts_in_the_middle() -> None:
    """Lines led by words of their own that stand only inside are parts of the block."""
    body = "SWITCH A\nCASE 1\nB=1\nCASE 2\nB=2\nDEFAULT\nB=3\nENDSWITCH"
    found = blocks("SWITCH", body, meant=frozenset({"SWITCH", "CASE", "DEFAULT"}))
    assert any(
        form.startswith("SWITCH variable eol (CASE")
        and "(DEFAULT eol statement*)?" in form
        and form.endswith("ENDSWITCH")
        for form in found
    )


def test_words_of_a_rule_that_nothing_calls_are_free() -> None:
    """What is left of a lost block in the grammar does not hide its parts."""
    left = (AddToken("CASE"), AddRule("statement", "caseBranch : CASE NAME eol ;"))
    (form, *_) = blocks(
        "SWITCH",
        "SWITCH A\nCASE 1\nCASE 2\nENDSWITCH",
        meant=frozenset({"SWITCH"}),
        grammar=apply(NO_WHILE, left),
    )
    assert "(CASE" in form


def test_what_no_block_goes_without_has_to_be_there() -> None:
    """A part met in every block, and twice in one, comes once or more; else any number of times."""
    meant = frozenset({"SWITCH", "CASE"})
    twice, once, none = ("SWITCH A\n" + "CASE 1\nB=1\n" * n + "ENDSWITCH" for n in (2, 1, 0))
    forms = blocks("SWITCH", twice, once, meant=meant)
    assert "eol statement*)+ ENDSWITCH" in forms[0]
    forms = blocks("SWITCH", twice, none, meant=meant)
    assert "eol statement*)* ENDSWITCH" in forms[0]


def test_what_nothing_closes_is_no_block() -> None:
    """A statement is not taken for an opener, nor an opener whose closer is missing somewhere."""
    assert [] == blocks("HALT", "HALT\nB=1")
    assert [] == blocks("WHILE", "WHILE A\nENDWHILE", "WHILE A")
