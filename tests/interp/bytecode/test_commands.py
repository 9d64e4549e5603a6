"""`krl compile`, `asm`, `disasm`, `bench real-code`, and one line for whatever is wrong."""

from __future__ import annotations

import json
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


def test_what_was_compiled_is_not_compiled_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second time the same image is written and the same said; another text is compiled."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source, image = tmp_path / "a.src", tmp_path / "a.krlb"
    source.write_text("DEF A()\nINT I\nI=NOWHERE()\nEND\n" + ";\n" * 5_000, encoding="utf-8")
    assert 1 == main(["compile", str(source)])
    told, made = capsys.readouterr(), image.read_bytes()
    with monkeypatch.context() as patched:
        patched.delattr("interp.bytecode.compiler.project.compile_program")
        assert 1 == main(["compile", str(source)])
    assert (told, made) == (capsys.readouterr(), image.read_bytes())
    source.write_text("DEF A()\nINT I\nI=1\nEND\n" + ";\n" * 5_000, encoding="utf-8")
    assert 0 == main(["compile", str(source)])


def test_folders_are_no_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder is neither read nor written."""
    source = tmp_path / "a.kasm"
    source.write_text('bytecode 4\ncode M routine "m" 1\nbegin\n  RETURN\nend\n', encoding="utf-8")
    assert 2 == main(["asm", str(tmp_path)])
    assert 2 == main(["disasm", str(tmp_path)])
    assert 2 == main(["asm", str(source), "-o", str(tmp_path)])
    assert 3 == capsys.readouterr().err.count("a folder, not a file")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A program with its data list; gives the program."""
    source = tmp_path / "main.src"
    source.write_text("DEF main()\nN=N+1\nGone(N)\nEND\n", encoding="utf-8")
    data = "DEFDAT main\nINT N=4\nENDDAT\n"
    source.with_suffix(".dat").write_text(data, encoding="utf-8")
    return source


def test_compiled_programs_round_trip(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A file is compiled with its project; its image is disassembled and assembled to itself."""
    image, text = tmp_path / "main.krlb", tmp_path / "main.kasm"
    assert 1 == main(["compile", str(project)])
    told = capsys.readouterr()
    assert "main.src:3: Gone is declared nowhere" in told.err
    assert "1 code objects, 8 instructions, from 2 files of the project" in told.out
    assert 0 == main(["disasm", str(image)])
    text.write_text(capsys.readouterr().out, encoding="utf-8")
    assert "data MAIN.N INT = 4" in text.read_text(encoding="utf-8")
    assert 0 == main(["asm", str(text), "-o", str(tmp_path / "again.krlb")])
    assert image.read_bytes() == (tmp_path / "again.krlb").read_bytes()


def test_strict_compiling(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With --strict nothing is written while the checker finds an error."""
    project.write_text("DEF main()\nN=TRUE\nEND\n", encoding="utf-8")
    assert 2 == main(["compile", str(project), "--strict"])
    assert 1 == capsys.readouterr().err.count("\n")
    assert not project.with_suffix(".krlb").exists()


def test_real_code(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each routine has its line in the record: how far it came, how it ended on each executor."""
    project.write_text(
        "DEF main()\nN=N+1\nEND\nDEF lost()\nGone()\nEND\n"
        "DEF wrong()\nN=TRUE\nEND\nDEFFCT INT half(K:IN)\nINT K\nRETURN 1/(K-1)\nENDFCT\n",
        encoding="utf-8",
    )
    record = tmp_path / "record.json"
    command = ["bench", "real-code", str(project.parent), "--executor", "tree", "--executor", "vm"]
    assert 0 == main([*command, "--json", str(record)])
    assert "0 routines on which executors differ" in capsys.readouterr().out
    found = json.loads(record.read_text(encoding="utf-8"))
    assert ["runs", "unlinked", "errors", "runs"] == [one["stage"] for one in found["trials"]]
    assert {"end": 1, "unlinked": 1, "fault": 1} == found["endings"]["vm"]
    assert (4, 3, 0) == (found["routines"], found["ran"], found["differences"])
