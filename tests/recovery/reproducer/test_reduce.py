"""Reproducers: they fail as the line did, and nothing of them can go."""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, Widen
from grammar.notation.g4 import read_file
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.proposals.edit_site import LinePattern
from recovery.reproducer.reduce import Reducer, Reproducer

PRELIMINARY = Path(__file__).parents[3] / "grammar" / "preliminary.g4"
STEP: list[Edit] = [AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")]
LISTED_INDEX: list[Edit] = [Widen("index", (1, 2), "expression (',' expression)*")]
VELOCITY: list[Edit] = [AddToken("VEL"), Insert("motion", (1, 4), "(VEL '=' INTEGER)?")]


class Bench:
    """A grammar, and programs that fail under it."""

    def __init__(self) -> None:
        self.recognizer = Recognizer(read_file(PRELIMINARY))
        self.finder = FailureFinder(self.recognizer)
        self.reducer = Reducer(self.recognizer)

    def first(self, text: str) -> Failure:
        """The first failure of a program."""
        return self.finder.find(text)[0]

    def wider(self, edits: Sequence[Edit]) -> Recognizer:
        """A recogniser of the grammar with these edits."""
        wider = edited(self.recognizer, edits)
        assert wider is not None
        return wider

    def reduce(
        self, text: str, *meant: str, edits: Sequence[Edit] = (), words: int = 24
    ) -> Reproducer:
        """The reproducer of the first failure; the words given are suspected keywords."""
        failure = self.first(text)
        lexemes = [lexeme.upper() for lexeme in failure.lexemes]
        line = LinePattern(failure.form, tuple((i, w) for i, w in enumerate(lexemes) if w in meant))
        mended = self.wider(edits) if edits else None
        found = self.reducer.reduce(line, lexemes[:words], mended=mended)
        assert found is not None
        return found

    def way(self, text: str) -> object:
        """How a program fails, if one line of it does and nothing follows."""
        failures = self.finder.find(text)
        if len(failures) != 1:
            return None
        failure = failures[0]
        context = self.finder.context(failure.state)
        return failure.form.kinds[failure.form.index], context.rule, context.expected

    def shorter(self, text: str) -> list[str]:
        """The program without each of its tokens."""
        lexer = self.recognizer.lexer
        cuts = zip(lexer.offsets(text), lexer.lexemes(text), strict=True)
        return [f"{text[:at]} {text[at + len(token) :]}" for at, token in cuts if token]


@pytest.fixture(scope="module")
def bench() -> Bench:
    return Bench()


def body(*lines: str) -> str:
    """A program with these lines in its only routine."""
    return "\n".join(["DEF MAIN()", *lines, "END"])


def test_the_line_without_what_does_not_matter(bench: Bench) -> None:
    """Without a grammar that mends it, a line ends where it fails."""
    expected = Reproducer("DEF A()\n  B[C,\nEND", line=2, column=6, tokens=11, beyond=5)
    assert bench.reduce(body("GRIPPED = PLACES[NR, ROW + 1].PART")) == expected


def test_the_whole_construct_where_a_grammar_reads_it(bench: Bench) -> None:
    """With a grammar that mends the line the reproducer is a program of that grammar."""
    expected = Reproducer("DEF A()\n  B = C[D, E]\nEND", line=2, column=10, tokens=15, beyond=9)
    text = body("GRIPPED = PLACES[NR, ROW + 1].PART")
    assert bench.reduce(text, edits=LISTED_INDEX) == expected


def test_a_block_is_closed_where_a_grammar_reads_it(bench: Bench) -> None:
    """The rest of a block whose first line failed belongs to the construct."""
    text = body("FOR I = 1 TO N * 2 STEP 3", "X = I", "ENDFOR")
    expected = "DEF A()\n  FOR B = 1 TO 2 STEP 3\n  ENDFOR\nEND"
    assert bench.reduce(text, "STEP", edits=STEP).text == expected


def test_what_fails_for_another_reason_goes(bench: Bench) -> None:
    """Of a line with two causes only the one that the grammar mends is shown."""
    text = body("PTP HOME VEL = 100 % PDAT1")
    assert bench.reduce(text, "VEL", edits=VELOCITY).text == "DEF A()\n  PTP B VEL = 1\nEND"


def test_a_construct_that_breaks_off_is_finished(bench: Bench) -> None:
    """Where the mended grammar fails further on, the line ends there as it would have it."""
    text = body("PTP HOME VEL = PTP HOME")
    assert bench.reduce(text, "VEL", edits=VELOCITY).text == "DEF A()\n  PTP B VEL = 1\nEND"


def test_a_grammar_that_does_not_read_the_line_is_left_out(bench: Bench) -> None:
    """An edit that mends something else asks nothing of the reproducer."""
    text = body("SWITCH MODE")
    assert bench.reduce(text, "SWITCH", edits=STEP) == bench.reduce(text, "SWITCH")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (body('X = "ONE" 2.5'), 'DEF A()\n  B = "A" 1.0\nEND'),
        (body("X = #OPEN #SHUT"), "DEF A()\n  B = #A #B\nEND"),
        (body("X = SAME SAME"), "DEF A()\n  B = C C\nEND"),
        (body("X = 1 ? 2 ?"), "DEF A()\n  B = 1 ?\nEND"),
        ("DEFDAT D\nDECL INT COUNT\nENDDAT", "DEFDAT A\n  DECL INT B\nENDDAT"),
        ("DEF MAIN(NR :IN)\nEND", "DEF A(B)\nEND"),
        ("%\nDEF MAIN()\nEND", "%\nDEFDAT A\nENDDAT"),
    ],
)
def test_kinds_stay(bench: Bench, text: str, expected: str) -> None:
    """What a token is stays, and what it is called only where that matters."""
    assert bench.reduce(text).text == expected


def test_words_that_are_meant_stay(bench: Bench) -> None:
    """Suspected keywords are written as they were; without them the failure is another."""
    text = body("SWITCH MODE")
    assert bench.reduce(text, "SWITCH").text == "DEF A()\n  SWITCH B\nEND"
    assert bench.reduce(text).text == "DEF A()\n  B C\nEND"


def test_a_meant_word_before_the_failure_stays(bench: Bench) -> None:
    """A line that fails behind a suspected keyword fails because of it."""
    text = body("X = A OR B_NOT C")
    assert bench.reduce(text, "B_NOT").text == "DEF A()\n  B = B_NOT C\nEND"


def test_a_meant_word_that_begins_the_line_stays(bench: Bench) -> None:
    """Whatever goes, the line is still of the kind that its first word says."""
    text = body("WITH.SPEED[1] = 2 3")
    assert bench.reduce(text, "WITH").text == "DEF A()\n  WITH = 1 2\nEND"


def test_the_statement_stays_that_does_not_go_on(bench: Bench) -> None:
    """Where the line could have ended, its first word says what has one token too many."""
    text = body("TRIGGER WHEN DISTANCE = 0 DELAY = 5 DO TOGGLE(LAMP) PRIO = -1")
    assert bench.reduce(text).text == (
        "DEF A()\n  TRIGGER WHEN DISTANCE = 1 DELAY = 2 DO B() C\nEND"
    )


def test_blocks_around_the_line_go(bench: Bench) -> None:
    """A line fails in any block as it does in the routine itself."""
    text = body("IF DONE THEN", "LOOP", "I = K +", "ENDLOOP", "ENDIF")
    assert bench.reduce(text).text == "DEF A()\n  B = C +\nEND"


def test_a_block_that_matters_stays(bench: Bench) -> None:
    """In a block other lines can come than outside it; one level of it is enough."""
    text = body("LOOP", "LOOP", "X = 1", "%", "ENDLOOP", "ENDLOOP")
    assert bench.reduce(text).text == "DEF A()\n  LOOP\n    %\n  ENDLOOP\nEND"


def test_a_missing_end(bench: Bench) -> None:
    """Where the end of the file is what fails, the program stops there."""
    found = bench.reduce("DEF MAIN()\nX = 1\nY = 2\n")
    assert found == Reproducer("DEF A()\n  BRAKE\n", line=3, column=1, tokens=7, beyond=0)


def test_a_last_line_that_does_not_end(bench: Bench) -> None:
    """A failing line without a line end gets one where something has to follow it."""
    assert bench.reduce("DEF MAIN()\nX = 1 Y").text == "DEF A()\n  B = 1 C\nEND"


def test_fewer_words_than_tokens(bench: Bench) -> None:
    """Tokens whose texts were not kept get texts of their kind."""
    text = body("CALL(A, B, C, D[1, 2])")
    assert bench.reduce(text, words=1, edits=LISTED_INDEX).text == ("DEF A()\n  B(C[1, 2])\nEND")


LINES: list[tuple[str, list[Edit]]] = [
    ("X = A B", [AddAlternative("primary", "NAME NAME")]),
    ("IF PLACES[1, 2] THEN", LISTED_INDEX),
    ("FOO(PLACES[1, 2].X, (A + B) * 3)", LISTED_INDEX),
    ("X = {POS: X Y}", [AddAlternative("literal", "NAME")]),
    ("X = {Y 1}", [AddAlternative("aggregate", "'{' component (',' component)* '}'")]),
    ("WAIT FOR (A AND B) == C == D", []),
    ("INTERRUPT DECL NR WHEN A DO B()", [Widen("interrupt", (1, 3), "NAME")]),
    ("DECL INT A, B, C", [Insert("declaration", (1, 4), "(',' NAME)*")]),
    ("LABEL:", [AddAlternative("simpleStatement", "NAME ':'")]),
    ("CIRC P, {POS: X 1}, CA 30", [Insert("motion", (3, 5), "(',' NAME INTEGER)?")]),
    ("ENDWHILE", []),
    ("X = ((1 + 2) * ?)", []),
]


@pytest.mark.parametrize(("source", "edits"), LINES)
def test_it_fails_as_the_line_did(bench: Bench, source: str, edits: list[Edit]) -> None:
    """One line fails, at the same kind of token, in the same rule, with the same expected set."""
    text = body(source)
    failure = bench.first(text)
    context = bench.finder.context(failure.state)
    found = bench.reduce(text, edits=edits)
    expected = (failure.form.kinds[failure.form.index], context.rule, context.expected)
    assert expected == bench.way(found.text)
    again = bench.first(found.text)
    assert (again.line, again.column) == (found.line, found.column)
    assert found.tokens == len(bench.shorter(found.text))
    if edits:
        assert bench.wider(edits).accepts(found.text)


@pytest.mark.parametrize(("source", "edits"), LINES)
def test_no_token_can_go(bench: Bench, source: str, edits: list[Edit]) -> None:
    """Without any one token it fails otherwise, or the mended grammar does not read it."""
    found = bench.reduce(body(source), edits=edits)
    way = bench.way(found.text)
    alike = [shorter for shorter in bench.shorter(found.text) if bench.way(shorter) == way]
    if edits:
        alike = [shorter for shorter in alike if bench.wider(edits).accepts(shorter)]
    assert alike == []


def test_reproducers_of_reproducers_are_the_same(bench: Bench) -> None:
    """There is nothing left to reduce in a reproducer."""
    for source, edits in LINES:
        found = bench.reduce(body(source), edits=edits)
        assert bench.reduce(found.text, edits=edits) == found


@pytest.mark.parametrize(
    "line",
    [
        lambda size: "X = " + " + ".join(f"N{i}" for i in range(size)) + " 1",
        lambda size: "X = 1 2 " + "(" * size,
        lambda size: "?!" * size,
        lambda size: "CALL(" + ", ".join(f"N{i}" for i in range(size)) + ", A[1, 2])",
    ],
)
def test_work_grows_with_the_line_and_not_with_its_square(
    bench: Bench, line: Callable[[int], str]
) -> None:
    """Four times as many operands take some four times as many calls of functions."""
    calls: list[int] = []

    def count(_frame: FrameType, event: str, _value: object) -> None:
        calls[-1] += event == "call"

    for size in (500, 500, 2_000):  # the first also fills caches
        text = body(line(size))
        bench.first(text)
        calls.append(0)
        sys.setprofile(count)
        try:
            found = bench.reduce(text, edits=LISTED_INDEX)
        finally:
            sys.setprofile(None)
        assert found.beyond <= 10
    assert calls[-1] < 6 * calls[1]
