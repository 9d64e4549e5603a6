"""A failing line has the signature that a person would see in it."""

import pytest

from tests.recovery.survey.signed import each, program, signature_texts, signatures


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("DECL INT A,B", "DECL … ,"),
        ("X[1,2]=3", "… [ … ,"),
        ("X[,]=3", "… [ ,"),
        ("A=F(1)[2]", "… ["),
        ("A=1.B", "… ."),
        ("HALT 3", "HALT … INTEGER"),
        ("WAIT SEC", "WAIT … end of line"),
        ("IF A", "IF … end of line"),
        ("LIN P1 CONTINUE", "LIN … CONTINUE"),
        ("A B", "… name"),
        ("B?", "… unknown character"),
        ("A=(1,2)", "… ( … ,"),
        ("A=F(1)+X[2,3]", "… [ … ,"),
        ("A=F(X[2],3;", "… ( … end of line"),
        ("A={POS: X F(1)}", "… { … name"),
    ],
)
def test_text_is_the_word_the_line_begins_with_and_what_could_not_come(
    line: str, text: str
) -> None:
    """The keyword in front, the bracket that is open, and the token that failed."""
    assert [text] == signature_texts(program(line))


def test_a_program_cut_off_fails_at_the_end_of_the_file() -> None:
    """The end of the file is named as such."""
    assert ["… end of file"] == signature_texts("DEF A()\nHALT\n")


def test_shape_names_the_rule_at_work() -> None:
    """The rule is the innermost that cannot end where the line fails."""
    ((signature,),) = signatures(program("FOR I=1 STEP 2 TO 9"))
    assert ("forStatement", "FOR", "", "name") == (
        signature.rule,
        signature.lead,
        signature.bracket,
        signature.offender,
    )


def test_names_numbers_and_place_do_not_matter() -> None:
    """Lines that differ in names and numbers only have one shape, in whatever block they stand."""
    programs = [
        program("X[1,2]=3"),
        program("LOOP", "  POSITIONS[I,Jay]= K", "ENDLOOP"),
        program("HALT", "x [ 100 , 7 ] = 5 ; why not"),
    ]
    assert 1 == len({signature for found in signatures(*programs) for signature in found})


def test_what_comes_right_behind_a_bracket_is_a_text_of_its_own_but_no_shape() -> None:
    """A dimension left out has another text; whether one edit mends both is not yet known."""
    ((one,), (other,)) = signatures(*each("X[1,2]=3", "X[,]=3"))
    assert ("… [ … ,", "… [ ,") == (one.text, other.text)
    assert one == other
