"""Bytes become KRL text, or a reason why they are not."""

import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.files.decode import Decoded, decode, digest

PROGRAM = "&ACCESS RVP\r\nDEF CELL1 ( )\r\n;FOLD INI\r\n  $OUT[1]=TRUE\r\n;ENDFOLD\r\nEND\r\n"
BOMS = {"utf-16-le": b"\xff\xfe", "utf-16-be": b"\xfe\xff"}
BOMS |= {"utf-32-le": b"\xff\xfe\0\0", "utf-32-be": b"\0\0\xfe\xff"}


def text_of(data: bytes) -> str:
    source = decode(data)
    assert isinstance(source, Decoded), source
    return source.text


def reason_of(data: bytes) -> str:
    reason = decode(data)
    assert isinstance(reason, str)
    return reason


# -- encodings -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("data", "encoding"),
    [
        (b"DEF A()\nEND", "utf-8"),
        ("DEF A() ; Übergabe\nEND".encode(), "utf-8"),
        ("DEF A() ; Übergabe\nEND".encode("utf-8-sig"), "utf-8-sig"),
        ("DEF A() ; Übergabe 5 €\nEND".encode("cp1252"), "cp1252"),
        (b"DEF A() ; \xdcbergabe \x81\nEND", "latin-1"),
    ],
)
def test_the_encoding_is_found_by_what_is_valid(data: bytes, encoding: str) -> None:
    """UTF-8 comes before cp1252, and cp1252 before Latin-1, which alone reads byte 0x81."""
    source = decode(data)
    assert isinstance(source, Decoded)
    assert encoding == source.encoding
    assert data == source.text.encode(source.encoding)


@pytest.mark.parametrize("encoding", BOMS)
@given(tail=st.text(st.characters(exclude_categories=["Cc", "Cs"])))
def test_wide_text_is_read_by_its_mark(encoding: str, tail: str) -> None:
    """UTF-16 and UTF-32 with a byte order mark give back the text, without the mark."""
    text = f"{PROGRAM}; {tail}."
    assert Decoded(text, encoding) == decode(BOMS[encoding] + text.encode(encoding))


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_utf16_is_read_without_a_mark(encoding: str) -> None:
    """Every other byte of it is zero; a file that was cut may end within a character."""
    data = f"{PROGRAM}; Ü 5 €".encode(encoding)
    assert Decoded(f"{PROGRAM}; Ü 5 €", encoding) == decode(data)
    assert Decoded(f"{PROGRAM}; Ü 5 ", encoding) == decode(data[:-1])


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@given(tail=st.text(st.characters(exclude_categories=["Cc", "Cs"])))
def test_utf8_round_trip(encoding: str, tail: str) -> None:
    """Whatever is written in UTF-8 is read as it was, with a byte order mark or without."""
    text = f"{PROGRAM}; {tail}."
    assert Decoded(text, encoding) == decode(text.encode(encoding))


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1"])
@given(tail=st.data())
def test_single_byte_round_trip(encoding: str, tail: st.DataObject) -> None:
    """Single-byte text that is no valid UTF-8 is read as it was written."""
    # An umlaut before a letter is never UTF-8, and 0x9d is one of the five bytes without cp1252.
    start = f"{PROGRAM}; Ünn" + ("\x9d" if encoding == "latin-1" else "")
    allowed = [sign for sign in bytes(range(256)).decode(encoding, "ignore") if sign.isprintable()]
    text = f"{start}{tail.draw(st.text(st.sampled_from(allowed)))}."
    assert Decoded(text, encoding) == decode(text.encode(encoding))


@given(st.binary() | st.binary().map(lambda junk: b"DEF A()\n" + junk))
def test_any_bytes_give_text_or_one_line(data: bytes) -> None:
    """`decode` never raises, its reasons are one line, and its text gives the bytes back."""
    source = decode(data)
    if isinstance(source, str):
        assert source
        assert source.isprintable()
        return
    body = data.rstrip(b"\0\x1a")
    again = source.text.encode(source.encoding)
    marks = (b"", b"\xef\xbb\xbf", *BOMS.values())
    assert any(mark + again in (body, data) for mark in marks)


def test_newlines_stay_as_they_are() -> None:
    """CRLF, LF and CR are neither translated nor completed at the end of the file."""
    text = "DEF A()\r\nI=1\nJ=2\rEND"
    assert text == text_of(text.encode())


def test_cr_alone_separates_lines() -> None:
    """A file with carriage returns only is KRL when one of its lines opens a module."""
    assert "&REL 1\rDEFDAT A\rENDDAT\r" == text_of(b"&REL 1\rDEFDAT A\rENDDAT\r")


@pytest.mark.parametrize("padding", [b"\x1a", b"\0\0\0", b"\x1a\0\0", b"\0\x1a"])
def test_padding_at_the_end_is_dropped(padding: bytes) -> None:
    """Ctrl-Z and NUL bytes at the very end, as old controllers write them, are no text."""
    assert text_of(b"DEF A()\r\nEND\r\n" + padding) == "DEF A()\r\nEND\r\n"


def test_padding_is_dropped_from_wide_text_by_characters() -> None:
    """In UTF-16 the padding is characters: the zero byte of a last line feed stays."""
    data = b"\xff\xfe" + "DEF A()\nEND\n\0\x1a".encode("utf-16-le")
    assert text_of(data) == "DEF A()\nEND\n"


def test_a_marked_file_with_foreign_bytes_is_still_read() -> None:
    """A UTF-8 mark before text that is not UTF-8 is removed, and the text read as cp1252."""
    assert Decoded("DEF A() ;Ü\nEND", "cp1252") == decode(b"\xef\xbb\xbfDEF A() ;\xdc\nEND")


def test_digest_is_sha256() -> None:
    """Files are compared by the hexadecimal SHA-256 of their bytes."""
    assert hashlib.sha256(b"DEF").hexdigest() == digest(b"DEF")


# -- what is KRL -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "DEF A()\nEND",
        "def a ( )\nend",
        "  DEF A(X:IN,Y[]:OUT) ; comment\nEND",
        "GLOBAL DEF A()\nEND",
        "DEFFCT INT F(X:IN)\nRETURN X\nENDFCT",
        "GLOBAL DEFFCT CHAR[128] F(X:IN)\nENDFCT",
        "DEFDAT A PUBLIC\nENDDAT",
        "DEFDAT $CONFIG\nENDDAT",
        "DEFTP A()\nEND",
        "DEG A()\nEND",
        "DFE A(X:IN)\nB()\nEND",
        "&ACCESS RVO\n&REL 3\n;a comment\n\nDEFDAT  A\nENDDAT",
        "DEF {{name}}()\n{{body}}\nEND",
        "\n" * 5000 + "DEF A()\nEND",
        "; comment\n" * 5000 + "DEF A()\nEND",
    ],
)
def test_an_opening_line_makes_a_file_krl(text: str) -> None:
    """A line that opens a module or routine is enough, wherever it stands."""
    assert text == text_of(text.encode())


@pytest.mark.parametrize(
    "text",
    [
        "PTP HOME\nLIN {X 100,Y 0,Z 50} C_DIS",
        "DECL E6POS XP1={X 1.5,Y 2,Z 3,A 0,B 0,C 0,S 2,T 35}\nDECL FDAT FP1={TOOL_NO 1}",
        "XP1={X 1.5,Y 2,Z 3}\nXP2={X 4,Y 5,Z 6}",
        "&ACCESS RVP\n&REL 2\nI=1",
        ";FOLD INI\n;ENDFOLD (INI)\nI=1",
        "$OUT[3]=TRUE ; gripper\nI=1\nWAIT SEC 0.5",
        "IF A==1 THEN\nEND\nENDIF\nINTERRUPT ON 3",
        "&PARAM EDITMASK = *\nDEF A\nI=1\nENDDAT",
    ],
)
def test_several_signs_make_a_file_krl(text: str) -> None:
    """A file without an opening line is KRL when at least two of its lines can be nothing else."""
    assert text == text_of(text.encode())


NOT_KRL = {
    "numbers": ("\n".join(f"{i} {i * 0.5:.3f} -1.2e-3" for i in range(5000)), "a data table"),
    "csv": ("time,x,y\n0.0,1.5,2.5\n0.1,1.6,2.6\n", "a data table"),
    "words": ("name;colour;state\nleft;red;new\nright;blue;old\n", "a data table"),
    "gnuplot": ("# time  force\n0.0 1.0\n0.1 1.1\n\n0.2 1.2\n", "a data table"),
    "fortran": (
        "      PROGRAM MAIN\n      INTEGER I\n      I=1\n      ENDIF\n      END\n",
        "Fortran",
    ),
    "c": ("#include <stdio.h>\nint main(void) {\n  return 0;\n}\n", "C source"),
    "c comment": ("/* table */\nstatic int x[] = {\n 1,\n};\n", "C source"),
    "xml": ('<?xml version="1.0"?>\n<robot>\nDEF A()\n</robot>\n', "XML"),
    "html": ("<!DOCTYPE html>\n<html></html>\n", "XML or HTML"),
    "json": ('{\n  "points": [\n    1, 2\n  ]\n}\n', "JSON"),
    "registry": ("Windows Registry Editor Version 5.00\n\n[HKEY_X]\n", "registry"),
    "ini": ("[EXTERNAL]\nHost=1\nPort=7\n", "INI"),
    "settings": ("host = a\nport = 7\n", "settings"),
    "log": ("2019-03-02 10:11:12 started\n2019-03-02 10:11:13 stopped\n", "a log"),
    "shell": ("#!/bin/sh\necho hello\nexit 0\n", "shell"),
    "python": ("def f(x):\n    return x\n\ndef g(\n    y,\n):\n    continue\n", "other text"),
    "perl": ("$base = 1;\n$load = 2;\n$tool = 3;\n", "settings"),
    "groovy": ("def x = 3\ndef f(a) { a }\ndef y = f(x)\n", ""),
    "prose": ("The robot waits.\nThen it moves on.\n", "other text"),
    "chance": ("PTP HOME\n" + "a line of prose\n" * 10, "other text"),
}


@pytest.mark.parametrize("kind", NOT_KRL)
def test_other_text_is_not_krl(kind: str) -> None:
    """What else hides behind `.src` and `.dat` is turned away, and the reason says what it is."""
    text, likeness = NOT_KRL[kind]
    assert likeness in reason_of(text.encode()).partition("looks like ")[2]


def test_the_reason_says_how_much_was_looked_at() -> None:
    """The number of lines looked at is named: all of a short file, the first ones of a long one."""
    assert reason_of(b"1 2\n3 4") == "no KRL statement in its 2 lines: looks like a data table"
    assert reason_of(b"1 2\n" * 9000).startswith("no KRL statement in its first 2,000 lines:")
    assert reason_of(b"1 2").startswith("no KRL statement in its only line:")


def test_two_signs_in_a_long_text_are_chance() -> None:
    """A long text does not become KRL because two of its lines might be."""
    assert "no KRL statement" in reason_of(b"PTP HOME\n" * 2 + b"1 2 3\n" * 1900)


@pytest.mark.parametrize("text", ["&ACCESS RVP\n&REL 1\n", "; only\n;FOLD x\n", "\n \r\n", " "])
def test_a_file_without_statements_is_not_surveyed(text: str) -> None:
    """Header, comment and blank lines alone are no program."""
    expected = "no statements, only header, comment or blank lines"
    assert expected == reason_of(text.encode())


def test_an_endless_comment_is_not_read_to_its_end() -> None:
    """Past the lines that are looked at, only an opening line counts."""
    assert reason_of(b";\n" * 3000 + b"I=1").startswith("no statements in its first 2,000 lines")


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", "empty file"),
        (b"\xff\xd8\xff\xe0\0\x10JFIF\0" + bytes(range(256)), "binary data: a JPEG image"),
        (b"MZ\x90\0\x03", "binary data: a Windows program"),
        (b"DEF A()\nI=\0\0\0\nEND", "binary data: NUL bytes in it"),
        (b"DEF A()\n" + b"\x01\x02" * 30, "binary data: 60 control characters in it"),
        ("DEF A(\0)\nEND".encode("utf-16-le"), "binary data: NUL bytes in it"),
        (b"\xff\xfe" + "DEF A(\0)\nEND".encode("utf-16-le"), "binary data: NUL bytes in it"),
        (b"\xff\xfe\0", "no statements, only header, comment or blank lines"),
    ],
)
def test_binary_data_is_named(data: bytes, expected: str) -> None:
    """Empty and binary files are turned away by name, wherever the name is known."""
    assert expected == reason_of(data)


def test_a_few_control_characters_are_no_reason() -> None:
    """Real programs hold stray control characters; those are for the survey to report."""
    assert text_of(b"DEF A()\n;\x05\x1c\x1d\nEND") == "DEF A()\n;\x05\x1c\x1d\nEND"
