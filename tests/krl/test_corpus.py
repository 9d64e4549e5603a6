"""`krl corpus`: what is listed, fetched and said about it."""

import hashlib
import os
import subprocess
from pathlib import Path

import pytest

from krl.cli import main

PROGRAM = b"&ACCESS RVP\r\nDEF main( )\r\nEND\r\n"
COMMIT = "0" * 40


def _git(folder: Path, *arguments: str) -> None:
    quiet = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    person = ["-c", "user.name=A", "-c", "user.email=a@example.org"]
    subprocess.run(["git", *person, *arguments], cwd=folder, env=os.environ | quiet, check=True)


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with one own cell, one public repository of two files and its mirror."""
    cell = tmp_path / "corpus" / "programs" / "palletiser"
    cell.mkdir(parents=True)
    (cell / "main.src").write_bytes(PROGRAM)
    digest = hashlib.sha256(PROGRAM).hexdigest()
    (tmp_path / "corpus" / "sources.toml").write_text(
        f"""[[source]]
repository = "someone/cell"
url = "https://example.org/someone/cell"
commit = "{COMMIT}"
licence = "none"
generation = "KR C4"
note = "A cell."
""",
        encoding="utf-8",
    )
    (tmp_path / "corpus" / "checksums.tsv").write_text(
        "repository\tpath\tbytes\tsha256\tkind\tquality\n"
        f"someone/cell\tR1/main.src\t{len(PROGRAM)}\t{digest}\tuser\treal\n"
        f"someone/cell\tR1/gone.src\t{len(PROGRAM)}\t{digest}\tuser\treal\n",
        encoding="utf-8",
    )
    mirror = tmp_path / "mirrors" / "someone" / "cell"
    (mirror / "R1").mkdir(parents=True)
    (mirror / "R1" / "main.src").write_bytes(PROGRAM)
    (mirror / "R1" / "gone.src").write_bytes(PROGRAM)
    _git(mirror, "init", "--quiet")
    _git(mirror, "-c", "core.autocrlf=false", "add", ".")
    _git(mirror, "commit", "--quiet", "--message=all")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_list_names_cells_and_repositories(
    checkout: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`corpus list` shows own cells, and public repositories with licence and what is here."""
    assert checkout.is_dir()
    assert 0 == main(["corpus", "list"])
    rows = [line.split("  ") for line in capsys.readouterr().out.splitlines()]
    assert ["", "palletiser", "1 file", "0 kB"] in rows
    assert ["", "someone/cell", "no licence stated", "KR C4", "2 files", "0 kB", "0 here"] in rows


def test_fetch_takes_everything_from_a_mirror(
    checkout: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`corpus fetch` says whose the files are, writes them and counts them; again, none is new."""
    assert 0 == main(["corpus", "fetch", "--mirror", "mirrors"])
    said = capsys.readouterr().out
    assert "These files belong to their authors" in said
    assert "someone/cell  no licence stated  2 of 2 files" in said
    folder = checkout / "corpus" / "open"
    assert f"2 of 2 files in {folder.relative_to(checkout)}, 2 of them new\n" in said
    assert PROGRAM == (folder / "someone__cell" / "R1" / "main.src").read_bytes()
    assert 0 == main(["corpus", "fetch", "--mirror", "mirrors"])
    assert ", 0 of them new\n" in capsys.readouterr().out
    assert 0 == main(["corpus", "list"])
    assert "all here" in capsys.readouterr().out


def test_fetch_names_what_is_missing(checkout: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file that could not be had is one line on stderr, and the status is 1."""
    mirror = checkout / "mirrors" / "someone" / "cell"
    _git(mirror, "rm", "--quiet", "R1/gone.src")
    _git(mirror, "commit", "--quiet", "--message=less")
    assert 1 == main(["corpus", "fetch", "--mirror", "mirrors", "--out", "elsewhere"])
    said = capsys.readouterr()
    expected = "missing: someone/cell: R1/gone.src: not in the repository any more\n"
    assert expected == said.err
    assert "1 of 2 files in elsewhere, 1 of them new\n" in said.out


def test_fetch_without_git(
    checkout: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without git, one line says so."""
    monkeypatch.setenv("PATH", str(checkout))
    assert 2 == main(["corpus", "fetch"])
    assert "krl: fetching needs git, and there is none on the PATH\n" == capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (["--mirror", "gone"], "krl: gone: no such folder of mirrors"),
        (["--out", "a-file"], "krl: a-file: not a folder"),
    ],
)
def test_fetch_refuses_wrong_folders(
    options: list[str], line: str, checkout: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A folder that does not do is one line and status 2."""
    (checkout / "a-file").touch()
    assert 2 == main(["corpus", "fetch", *options])
    assert f"{line}\n" == capsys.readouterr().err


def test_damaged_list_is_one_line(checkout: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A damaged list of sources is one line that names the file."""
    (checkout / "corpus" / "sources.toml").write_text("[[source", encoding="utf-8")
    assert 2 == main(["corpus", "list"])
    said = capsys.readouterr().err
    assert said.startswith(f"krl: {Path('corpus', 'sources.toml')}: ")
    assert 1 == said.count("\n")


@pytest.mark.parametrize(
    ("size", "least"),
    [("20000", 20_000), ("20kB", 20_000), ("0.03 MB", 30_000), ("20K", 20_000), ("25000b", 25_000)],
)
def test_synth_writes_as_much_as_asked_for(
    size: str, least: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`corpus synth` takes sizes as people write them, and says what it wrote and where."""
    out = tmp_path / "made"
    assert 0 == main(["corpus", "synth", "--size", size, "--seed", "3", "--out", str(out)])
    sizes = [path.stat().st_size for path in out.rglob("*") if path.is_file()]
    assert least <= sum(sizes) < least + 20_000
    cells = len(list(out.iterdir()))
    expected = f"{sum(sizes):,} bytes in {len(sizes)} files of {cells} cells in {out}\n"
    assert expected == capsys.readouterr().out


def test_synth_has_a_folder_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a folder the programs go where git ignores them, each size and seed apart."""
    monkeypatch.chdir(tmp_path)
    assert 0 == main(["corpus", "synth", "--size", "2kB", "--seed", "9"])
    folder = Path("reports", "out", "synth", "2000-9")
    assert folder.is_dir()
    assert f" in {folder}\n" in capsys.readouterr().out


def test_synth_reports_other_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Files that were in the folder before stay, and a line on stderr counts them."""
    (tmp_path / "notes.txt").touch()
    assert 0 == main(["corpus", "synth", "--size", "2kB", "--out", str(tmp_path)])
    assert f"{tmp_path} has 1 file beside them, from before\n" == capsys.readouterr().err
