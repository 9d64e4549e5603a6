"""How far whole files can be read tells edits apart that mend the same line."""

from grammar.edits import AddAlternative
from grammar.g4 import read_file
from grammar.generate import GRAMMAR
from grammar.recognizer import Recognizer
from recovery.trial import edited
from recovery.whole import FailingFile, WholeFiles

RECOGNIZER = Recognizer(read_file(GRAMMAR.with_name("preliminary.g4")))
TEXT = "DEF A()\nWAIT 1\nWAIT 2\nEND\n"


def file(text: str, *failing: tuple[int, int]) -> FailingFile:
    return FailingFile(text, len(text), lambda: text, failing)


def share(alternative: str) -> float:
    wider = edited(RECOGNIZER, [AddAlternative("simpleStatement", alternative)])
    assert wider is not None
    return WholeFiles(RECOGNIZER, [file(TEXT, (2, 0))]).share(wider, [0])


def test_a_file_read_to_its_end_counts_whole() -> None:
    """All of what lies behind the failure, some of it, or nothing."""
    assert share("WAIT INTEGER") == 1.0
    assert 0.0 < share("WAIT INTEGER NEWLINE WAIT") < 1.0
    assert share("HALT HALT") == 0.0


def test_without_files_nothing_speaks_against_an_edit() -> None:
    """Lines of which no file is at hand, and files that parse, do not count."""
    assert WholeFiles(RECOGNIZER).share(RECOGNIZER, [0]) == 1.0
    parsing = WholeFiles(RECOGNIZER, [file("DEF A()\nEND\n", (1, 0))])
    assert parsing.share(RECOGNIZER, [0]) == 1.0
