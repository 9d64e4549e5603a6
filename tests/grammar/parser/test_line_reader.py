"""Lines are numbered, and reading one from a known place is the recogniser's step, remembered."""

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from grammar.parser.lexer import EOF
from grammar.parser.line_reader import LineReader
from grammar.parser.recognizer import Recognizer

LINES = ["X=1", "IF X THEN", "ELSE", "ENDIF", "X=1 1", "", "END", "LOOP", "ENDLOOP", "?"]


def test_lines_of_a_file(recognizer: Recognizer) -> None:
    """Equal lines have one number, blank lines count, and the end of file is a line of its own."""
    reader = LineReader(recognizer)
    assert [0, 1, 1, 2, 3] == reader.numbers(recognizer.kinds("X=1\n\n\nX\n"))
    assert [0, 2, 4, 3] == reader.numbers(recognizer.kinds("Y=2 ;c\nY\nY"))
    assert [3] == reader.numbers(recognizer.kinds(""))
    assert (EOF,) == reader.kinds[3]
    names = [recognizer.lexer.names[kind] for kind in reader.kinds[0]]
    assert ["NAME", "ASSIGN", "INTEGER", "NEWLINE"] == names
    assert 5 == len(reader)


@given(chance=st.randoms(use_true_random=True))
def test_lines_put_together_are_the_file(recognizer: Recognizer, chance: Random) -> None:
    """The kinds of all lines in a row are those of the file, whatever is at its end."""
    text = "\n".join(chance.choice(LINES) for _ in range(12)) + chance.choice(["", "\n", " ;c"])
    reader = LineReader(recognizer)
    kinds = recognizer.kinds(text)
    numbers = reader.numbers(kinds)
    assert kinds == [kind for number in numbers for kind in reader.kinds[number]]
    assert len(set(reader.kinds)) == len(reader.kinds)


@given(chance=st.randoms(use_true_random=True))
def test_reading_a_line_is_reading_its_tokens(recognizer: Recognizer, chance: Random) -> None:
    """From one state a line leads to one spot, or to none, also when it is remembered."""
    reader = LineReader(recognizer)
    chosen = ["DEF A()", *(chance.choice(LINES) for _ in range(40))]
    spot = reader.spot(recognizer.start)
    state = recognizer.start
    for number in reader.numbers(recognizer.kinds("\n".join([*chosen, ""])))[:-1]:
        after = reader.after(spot, number)
        read, failed = recognizer.run(state, reader.kinds[number])
        assert (after is None) == (failed is not None)
        assert after is reader.after(spot, number)
        if after is not None:
            assert read == after.state
            assert after is reader.spot(read)
            spot, state = after, read


def test_forgetting(recognizer: Recognizer) -> None:
    """After `forget` nothing is remembered, and numbers begin anew."""
    reader = LineReader(recognizer)
    numbers = reader.numbers(recognizer.kinds("DEF A()\nEND\n"))
    spot = reader.spot(recognizer.start)
    after = reader.after(spot, numbers[0])
    assert after is not None
    assert len(numbers) + 2 == len(reader)
    reader.forget()
    assert 0 == len(reader)
    assert [0] == reader.numbers(recognizer.kinds(""))
    assert spot is not reader.spot(recognizer.start)
