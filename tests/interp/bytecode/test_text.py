"""Text and program say the same, both ways; what is no program is refused with its line."""

from __future__ import annotations

import pytest

from interp.bytecode.assembly.assembler import AssemblyError, assemble
from interp.bytecode.assembly.disassembler import disassemble
from interp.bytecode.program import Import
from interp.bytecode.verifier.verify import verify

HEAD = "bytecode 4\n"
BODY = 'code MAIN routine "main.src" 1\n  local X INT\nbegin\n{}\n  RETURN\nend\n'


def test_program_survives_its_text(everything: str) -> None:
    """Disassembled and assembled, a program is what it was."""
    program = assemble(everything)
    assert program == assemble(disassemble(program))


def test_text_survives_its_program(everything: str) -> None:
    """Assembled and disassembled, a written program is what it was, to the letter."""
    text = disassemble(assemble(everything))
    assert text == disassemble(assemble(text))


def test_names_of_any_kind_survive() -> None:
    """Names that are no names, and names that are there twice, are told apart."""
    text = HEAD + (
        'data "a b.c".X INT\ndata MAIN.X INT\ndata MAIN.x@2 INT\n'
        'code "MY PROG" routine "my prog.src" 1\n'
        '  local X INT\n  local X@2 INT\n  local "ö;\\"" INT\n'
        'begin\n  LOAD_DATA MAIN.X@2\n  STORE_DATA "a b.c".X\n  LOAD_LOCAL X@2\n'
        '  STORE_LOCAL "ö;\\""\n  RETURN\nend\n'
    )
    program = assemble(text)
    assert [2, 0, 1, 2] == [one.operands[0] for one in program.codes[0].instructions[:4]]
    assert program == assemble(disassemble(program))


def test_places_are_named_by_path() -> None:
    """A path leads to a cell: members in order, elements row by row."""
    text = HEAD + (
        "struct S A:INT B:REAL[2,3] C:BOOL\ndata M.X INT\ndata M.V S[2]\n"
        + BODY.format("  LOAD_DATA M.V[2].B[2,1]\n  STORE_DATA M.V[1].B[1,3]")
    )
    operands = [one.operands[0] for one in assemble(text).codes[0].instructions[:2]]
    assert [1 + 8 + 1 + 3, 1 + 1 + 2] == operands
    assert "LOAD_DATA M.V[2].B[2,1]" in disassemble(assemble(text))


@pytest.mark.parametrize(
    "written",
    ["0.0", "-0.0", "0.1", "1e+20", "3.4028235e+38", "1.4013e-45", "16777216.0", "0.33333334"],
)
def test_reals_keep_their_bits(written: str) -> None:
    """A REAL is written so that reading gives the same single, minus zero included."""
    text = HEAD + BODY.format(f"  PUSH_REAL {written}\n  DROP")
    program = assemble(text)
    assert program == assemble(disassemble(program))
    assert f"PUSH_REAL {written}" in disassemble(program)


def test_initial_values_are_written_by_their_kinds() -> None:
    """Values stand in the order of the cells, gaps as offsets, letters as texts."""
    text = HEAD + (
        "enum E ONE TWO\nstruct S A:INT T:CHAR[4] E:E\n"
        'data M.V S[2] = 1 "ab" @5 !TWO @7 "cd"\n' + BODY.format("")
    )
    program = assemble(text)
    assert ((0, 1), (1, 97), (2, 98), (5, 1), (7, 99), (8, 100)) == program.initial
    assert 'data M.V S[2] = 1 "ab" @5 !TWO @7 "cd"' in disassemble(program)


def test_imports_are_names_of_a_module_or_of_a_routine() -> None:
    """Each stands for a variable of a data list, by its number."""
    imports = "import P.HERE M.W\nimport P.P.THERE M.V"
    program = assemble(f"{HEAD}data M.V INT\ndata M.W INT\n{imports}\n{BODY.format('')}")
    assert program.imports == (Import("P", "", "HERE", 1), Import("P", "P", "THERE", 0))
    assert imports in disassemble(program)


def test_stacks_and_array_types_may_be_left_out() -> None:
    """What can be worked out need not be written."""
    text = HEAD + BODY.format("  PUSH_INT 1\n  PUSH_INT 2\n  ADD_INT\n  STORE_LOCAL X")
    assert 2 == assemble(text).codes[0].stack
    verify(assemble(text))


def test_requests_are_written_as_they_are_nested() -> None:
    """Parts of requests keep their structure, and inputs how they are handed over."""
    text = HEAD + (
        'ask A Invoke "F" (in:INT ref:REAL= view:BOOL[,] nil "x" 2 2.0 FALSE) -> INT\n'
        + BODY.format("")
    )
    program = assemble(text)
    assert text.splitlines()[1].replace("ask A ", "ask A0 ") in disassemble(program)
    assert program == assemble(disassemble(program))


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", 1, "ends early"),
        ("bytecode 1\n", 1, "format 1"),
        ("bytecode 4\n\nwhat X\n", 3, "begins no section"),
        ("bytecode 4\ndata M.X NOTHING\n", 2, "no type NOTHING"),
        ("bytecode 4\ndata M.X INT\ndata m.x INT\n", 3, "already"),
        ("bytecode 4\ndata M.X INT[2] = 1 2 3\n", 2, "more values"),
        ("bytecode 4\ndata M.X INT[1048577]\n", 2, "more than 1,048,576"),
        ("bytecode 4\nstruct S A:INT\nstruct s B:INT\n", 3, "already"),
        ("bytecode 4\ntext T 'a'\n", 2, "means nothing"),
        ('bytecode 4\ntext T "\\x"\n', 2, "not a text"),
        ('bytecode 4\ntext T "\\ud800"\n', 2, "not a text"),
        ("bytecode 4\nask A Read %\n", 2, "no part"),
        ('bytecode 4\ncode P routine "p.src" 1\n  in X #9999\n', 3, "no type #9999"),
        ("bytecode 4\ndata M.X INT[0]\n", 2, "no variable can be of"),
        ("bytecode 4\ndata M.X INT[-1]\n", 2, "no variable can be of"),
        ('bytecode 4\ncode P routine "p.src" 1\n  in X #-1\n', 3, "no type #-1"),
        ("bytecode 4\ndata M.X INT\nimport M@2.Y M.X\n", 3, r"\. is needed, not @"),
        (HEAD + BODY.format("  PUSH_REAL 1"), 5, "a REAL is needed, not 1"),
        (HEAD + BODY.format("  FAIL 1"), 5, "a word is needed, not 1"),
        (HEAD + BODY.format("  NOTHING"), 5, "no instruction NOTHING"),
        (HEAD + BODY.format("  JUMP L"), 5, "no label L"),
        (HEAD + BODY.format("L:\nL:"), 6, "label L already"),
        (HEAD + BODY.format("  CALL X"), 5, "no code object X"),
        (HEAD + BODY.format("  LOAD_LOCAL Y"), 5, "no parameter or local Y"),
        (HEAD + BODY.format("  LOAD_LOCAL X.Y"), 5, "has no part .Y"),
        (HEAD + BODY.format("  PUSH_INT 2147483648"), 5, "not between"),
        (HEAD + BODY.format("  PUSH_REAL 3.5e38"), 5, "too large"),
        (HEAD + BODY.format("  PUSH_INT 1 2"), 5, "too much"),
        (HEAD + BODY.format("  PUSH_INT"), 5, "missing"),
        (HEAD + BODY.format("  FAIL nothing"), 5, "no fault"),
        ('bytecode 4\ncode M routine "m" 1\nbegin\n', 3, "ends early"),
        ('bytecode 4\ncode M nothing "m" 1\n', 2, "a code object is"),
        ("bytecode 4\nask A Read " + "(" * 70 + "\n", 2, "too deep"),
    ],
)
def test_what_is_no_program_is_refused(text: str, line: int, message: str) -> None:
    """The error names the line and what is wrong there."""
    with pytest.raises(AssemblyError, match=message) as caught:
        assemble(text)
    assert line == caught.value.line
    assert str(caught.value).startswith(f"line {line}: ")
