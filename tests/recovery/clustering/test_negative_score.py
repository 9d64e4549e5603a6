"""Negatives that an edit accepts, or only reads further."""

from grammar.notation.edits import AddAlternative, Insert
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.clustering.negative_score import negative_counter
from recovery.negatives.negatives import Negative, NegativeSet

RECOGNIZER = Recognizer(read_file(GRAMMAR))


def test_no_program_is_missed() -> None:
    """The count includes every program that reading all of them finds."""
    lines = ("WAIT 1", "HALT HALT", "LIN P1,P2", "BRAKE 5", "A=1,2")
    programs = [Negative(None, f"DEF A()\n{line}\nEND\n", "", "parse") for line in lines]
    count_negatives = negative_counter(RECOGNIZER.grammar, programs)
    everything = NegativeSet(programs)
    for edit in (
        Insert("assignment", (1, 4), "(',' INTEGER)?"),
        AddAlternative("simpleStatement", "WAIT expression"),
        Insert("brake", (1, 2), "expression?"),
        Insert("halt", (1, 2), "HALT*"),
    ):
        wider = edited(RECOGNIZER, [edit])
        assert wider is not None
        assert len(everything.accepted(wider)) == 1
        assert count_negatives([edit]) >= 1


def test_what_only_leaves_a_block_open_is_no_better() -> None:
    """A negative that a rival accepts counts for all edits that read the line at which it fails."""
    program = Negative(None, "DEF A()\nLOOP 5\nHALT\nENDLOOP\nEND\n", "", "parse")
    count_negatives = negative_counter(RECOGNIZER.grammar, [program])
    whole = (Insert("loopStatement", (1, 2), "INTEGER?"),)
    bare = (AddAlternative("loopStatement", "LOOP INTEGER"),)
    other = (AddAlternative("simpleStatement", "ENDLOOP INTEGER"),)
    assert [1, 0, 0] == [count_negatives(edits) for edits in (whole, bare, other)]
    assert [1, 1, 0] == [count_negatives(edits, [whole]) for edits in (whole, bare, other)]
