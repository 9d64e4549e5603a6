"""How far whole files can be read tells edits apart that mend the same line."""

from grammar.notation.edits import AddAlternative, RemoveAlternative, RemoveRule, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.clustering.file_trial import FailingFile, FileTrial

RECOGNIZER = Recognizer(read_file(GRAMMAR.with_name("preliminary.g4")))
LOOPLESS = Recognizer(
    apply(RECOGNIZER.grammar, [RemoveAlternative("statement", 6), RemoveRule("loopStatement")])
)
TEXT = "DEF A()\nWAIT 1\nWAIT 2\nEND\n"


def file(text: str, *failing: tuple[int, int]) -> FailingFile:
    return FailingFile(text, len(text), lambda: text, *zip(*failing, strict=True))


def readable_share(alternative: str) -> float:
    wider = edited(RECOGNIZER, [AddAlternative("simpleStatement", alternative)])
    assert wider is not None
    return FileTrial(RECOGNIZER, [file(TEXT, (2, 0))]).readable_share(wider, [0])


def test_a_file_read_to_its_end_counts_whole() -> None:
    """All of what lies behind the failure, some of it, or nothing."""
    assert readable_share("WAIT INTEGER") == 1.0
    assert 0.0 < readable_share("WAIT INTEGER NEWLINE WAIT") < 1.0
    assert readable_share("HALT HALT") == 0.0


def test_without_files_nothing_speaks_against_an_edit() -> None:
    """Lines of which no file is at hand, and files that parse, do not count."""
    assert FileTrial(RECOGNIZER).readable_share(RECOGNIZER, [0]) == 1.0
    parsing = FileTrial(RECOGNIZER, [file("DEF A()\nEND\n", (1, 0))])
    assert parsing.readable_share(RECOGNIZER, [0]) == 1.0


def test_what_only_follows_is_entailed() -> None:
    """A line that fails no more once one before it is mended has the same cause; others have not.

    The loop is not known, so its end fails too; the last line fails for a reason of its own.
    """
    text = "DEF A()\nLOOP\nHALT\nENDLOOP\nWAIT 1\nEND\n"
    elsewhere = "DEF A()\nWAIT 1\nEND\n"
    file_trial = FileTrial(LOOPLESS, [file(text, (2, 0), (4, 1), (5, 2)), file(elsewhere, (2, 2))])
    wider = edited(LOOPLESS, [AddAlternative("statement", "LOOP eol statement* ENDLOOP eol")])
    assert wider is not None
    assert frozenset([1]) == file_trial.entailed(wider, [0], {1, 2})
    assert frozenset() == file_trial.entailed(wider, [1], {0, 2})


def test_a_line_met_without_the_cause_is_not_entailed() -> None:
    """Wherever it is met the cause has to stand before it; a file that is gone tells nothing."""
    text = "DEF A()\nLOOP\nHALT\nENDLOOP\nEND\n"
    alone = "DEF A()\nENDLOOP\nEND\n"
    wider = edited(LOOPLESS, [AddAlternative("statement", "LOOP eol statement* ENDLOOP eol")])
    assert wider is not None
    both = FileTrial(LOOPLESS, [file(text, (2, 0), (4, 1)), file(alone, (2, 1))])
    assert frozenset() == both.entailed(wider, [0], {1})
    gone = FileTrial(LOOPLESS, [FailingFile("x", 9, lambda: "", (2, 4), (0, 1))])
    assert frozenset() == gone.entailed(wider, [0], {1})
