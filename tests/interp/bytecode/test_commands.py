"""`krl asm` and `krl disasm`: text to image and back, and one line for whatever is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from krl.cli import main


def test_text_and_image_round_trip(
    tmp_path: Path, everything: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is disassembled is assembled to the same bytes."""
    source, image = tmp_path / "all.kasm", tmp_path / "out" / "all.krlb"
    source.write_text(everything, encoding="utf-8")
    assert 0 == main(["asm", str(source), "-o", str(image)])
    assert 0 == main(["disasm", str(image)])
    source.write_text(capsys.readouterr().out, encoding="utf-8")
    assert 0 == main(["asm", str(source)])
    assert image.read_bytes() == source.with_suffix(".krlb").read_bytes()


@pytest.mark.parametrize(
    ("command", "content", "message"),
    [
        ("asm", b"\xff\xfe", "not a text in UTF-8"),
        ("asm", b"bytecode 1\nnothing\n", "line 2: nothing begins no section"),
        ("asm", b"bytecode 1\n", "there is no code object"),
        ("disasm", b"", "not an image"),
        ("disasm", b"KRLI" + bytes(40), "has format 0"),
    ],
)
def test_what_is_wrong_is_told_on_one_line(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    command: str,
    content: bytes,
    message: str,
) -> None:
    """Status 2, the file, and why; no image is left behind."""
    file = tmp_path / "program"
    file.write_bytes(content)
    assert 2 == main([command, str(file)])
    told = capsys.readouterr().err
    assert message in told
    assert 1 == told.count("\n")
    assert [file] == list(tmp_path.iterdir())


def test_folders_are_no_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder is neither read nor written."""
    source = tmp_path / "a.kasm"
    source.write_text('bytecode 1\ncode M routine "m" 1\nbegin\n  RETURN\nend\n', encoding="utf-8")
    assert 2 == main(["asm", str(tmp_path)])
    assert 2 == main(["disasm", str(tmp_path)])
    assert 2 == main(["asm", str(source), "-o", str(tmp_path)])
    assert 3 == capsys.readouterr().err.count("a folder, not a file")
