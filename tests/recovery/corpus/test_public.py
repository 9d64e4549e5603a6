"""Public repositories: listed, fetched, verified, resumed; trouble is named, not raised."""

import hashlib
import os
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from recovery.corpus.public import (
    KrlFile,
    PublicSource,
    SourceListError,
    absent,
    fetch,
    read_sources,
)
from support.files.discovery import SUFFIXES

CORPUS = Path(__file__).parents[3] / "corpus"

MAIN = "DEF main( )\r\n; Gr\xf6\xdfe\r\nEND\r\n".encode("latin-1")
POINTS = b"DEFDAT main\nENDDAT\n"
CONTENT = {"R1/main.src": MAIN, "R1/main.dat": POINTS}


def _git(folder: Path, *arguments: str) -> str:
    quiet = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    person = ["-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "core.autocrlf=false"]
    return subprocess.run(
        ["git", *person, *arguments],
        cwd=folder,
        env=os.environ | quiet,
        check=True,
        capture_output=True,
        text=True,
    ).stdout.strip()


def _commit(folder: Path, content: Mapping[str, bytes]) -> str:
    """Commit `content` and a file that is no KRL in the repository `folder`; return the hash."""
    if not (folder / ".git").exists():
        folder.mkdir(parents=True)
        _git(folder, "init", "--quiet")
    for path, data in {**content, "readme.txt": b"hello\n"}.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    _git(folder, "add", "--all")
    _git(folder, "commit", "--quiet", "--allow-empty", "--message=all")
    return _git(folder, "rev-parse", "HEAD")


def _source(folder: Path, commit: str, content: Mapping[str, bytes] = CONTENT) -> PublicSource:
    files = tuple(
        KrlFile(path, len(data), hashlib.sha256(data).hexdigest(), "user", "real")
        for path, data in content.items()
    )
    return PublicSource("someone/cell", str(folder), commit, "MIT", "KR C4", "A cell.", files)


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Where the mirror of someone/cell below `tmp_path` has its place."""
    return tmp_path / "someone" / "cell"


@pytest.mark.parametrize("mirrored", [True, False])
def test_fetch_writes_the_exact_bytes(mirrored: bool, repository: Path, tmp_path: Path) -> None:
    """Every listed file arrives byte for byte, from a mirror or by clone, and nothing else does."""
    source = _source(repository, _commit(repository, CONTENT))
    counts: list[int] = []
    out = tmp_path / "open"
    result = fetch(source, out, tmp_path if mirrored else None, counts.append)
    assert (2, 0, ()) == (result.written, result.kept, result.problems)
    found = {
        path.relative_to(out / "someone__cell").as_posix(): path.read_bytes()
        for path in out.rglob("*")
        if path.is_file()
    }
    assert CONTENT == found
    assert 2 == sum(counts)


def test_fetch_resumes(repository: Path, tmp_path: Path) -> None:
    """What is there and right stays untouched; what is damaged or missing is written again."""
    source = _source(repository, _commit(repository, CONTENT))
    out = tmp_path / "open"
    fetch(source, out, tmp_path)
    kept = out / "someone__cell" / "R1" / "main.dat"
    damaged = out / "someone__cell" / "R1" / "main.src"
    os.utime(kept, (1, 1))
    damaged.write_bytes(MAIN.swapcase())
    assert [source.files[0]] == absent(source, out)
    counts: list[int] = []
    result = fetch(source, out, tmp_path, counts.append)
    assert (1, 1, ()) == (result.written, result.kept, result.problems)
    assert [1, 1] == counts
    assert MAIN == damaged.read_bytes()
    assert 1 == kept.stat().st_mtime


def test_nothing_is_asked_of_git_when_all_is_there(repository: Path, tmp_path: Path) -> None:
    """With every file verified the repository itself is not needed any more."""
    source = _source(repository, _commit(repository, CONTENT))
    fetch(source, tmp_path / "open", tmp_path)
    shutil.rmtree(repository, ignore_errors=True)
    result = fetch(source, tmp_path / "open", tmp_path)
    assert (0, 2, ()) == (result.written, result.kept, result.problems)


def test_pinned_commit_comes_before_the_branch(repository: Path, tmp_path: Path) -> None:
    """The pinned commit is read even where the branch has gone on."""
    commit = _commit(repository, CONTENT)
    _commit(repository, {"R1/main.src": b"DEF other( )\nEND\n"})
    assert () == fetch(_source(repository, commit), tmp_path / "open", tmp_path).problems


@pytest.mark.parametrize("mirrored", [True, False])
def test_branch_stands_in_for_a_lost_commit(
    mirrored: bool, repository: Path, tmp_path: Path
) -> None:
    """Where the pinned commit is gone, files of the branch do if their checksums fit."""
    _commit(repository, CONTENT)
    source = _source(repository, "0123456789" * 4)
    assert () == fetch(source, tmp_path / "open", tmp_path if mirrored else None).problems


@pytest.mark.parametrize("mirrored", [True, False])
def test_missing_and_changed_files_are_named(
    mirrored: bool, repository: Path, tmp_path: Path
) -> None:
    """A lost file and a changed one are one line each, and the rest is written."""
    longer = {"R1/main.src": MAIN + b"; more\r\n", "R1/kept.src": MAIN}
    source = _source(repository, _commit(repository, longer), {**CONTENT, "R1/kept.src": MAIN})
    result = fetch(source, tmp_path / "open", tmp_path if mirrored else None)
    assert (1, 0) == (result.written, result.kept)
    expected = (
        "someone/cell: R1/main.src: changed, its checksum is not the listed one",
        "someone/cell: R1/main.dat: not in the repository any more",
    )
    assert expected == result.problems
    written = [path.name for path in (tmp_path / "open").rglob("*") if path.is_file()]
    assert ["kept.src"] == written


def test_missing_mirror_is_named(tmp_path: Path) -> None:
    """A repository without a mirror is one line."""
    source = _source(tmp_path / "nowhere", "0" * 40)
    expected = (f"someone/cell: no mirror in {tmp_path} (2 files missing)",)
    assert expected == fetch(source, tmp_path / "open", tmp_path).problems


def test_unreachable_repository_is_named(tmp_path: Path) -> None:
    """A repository that cannot be reached is one line, with git's reason."""
    (problem,) = fetch(_source(tmp_path / "nowhere", "0" * 40), tmp_path / "open").problems
    assert problem.startswith("someone/cell: ")
    assert problem.endswith("(2 files missing)")
    assert "nowhere" in problem
    assert "\n" not in problem


def test_damaged_repository_is_named(repository: Path, tmp_path: Path) -> None:
    """A mirror that git cannot read is one line; what was there before counts."""
    source = _source(repository, _commit(repository, CONTENT))
    (repository / ".git" / "HEAD").write_bytes(b"\x00junk")
    result = fetch(source, tmp_path / "open", tmp_path)
    git_dir = repository / ".git"
    assert (f"someone/cell: git cannot read {git_dir} (2 files missing)",) == result.problems


def test_failed_write_leaves_no_krl_file(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A write that breaks off leaves nothing that a survey would read."""

    def break_off(self: Path, target: Path) -> None:
        raise OSError(f"{self} to {target}")

    source = _source(repository, _commit(repository, CONTENT))
    monkeypatch.setattr(Path, "replace", break_off)
    with pytest.raises(OSError, match=r"main\.src"):
        fetch(source, tmp_path / "open", tmp_path)
    left = [path for path in (tmp_path / "open").rglob("*") if path.is_file()]
    assert all(path.suffix not in SUFFIXES for path in left)


def test_our_list_is_whole() -> None:
    """The committed list names 19 repositories with 583 files and 4.3 MB."""
    listed = read_sources(CORPUS)
    assert 19 == len(listed)
    assert 583 == sum(len(source.files) for source in listed)
    assert 4_305_939 == sum(source.size for source in listed)
    assert all(source.url == f"https://github.com/{source.repository}" for source in listed)
    kinds = {(file.kind, file.quality) for source in listed for file in source.files}
    assert {kind for kind, _ in kinds} == {"user", "vendor", "config"}
    assert {quality for _, quality in kinds} == {"real", "generated", "template"}


ENTRY = {
    "repository": "someone/cell",
    "url": "https://example.org/someone/cell",
    "commit": "0" * 40,
    "licence": "MIT",
    "generation": "KR C4",
    "note": "A cell.",
}
ROW = ["someone/cell", "R1/main.src", "3", "0" * 64, "user", "real"]
COLUMNS = "repository\tpath\tbytes\tsha256\tkind\tquality\n"


def _write_list(folder: Path, entry: Mapping[str, str], *rows: list[str]) -> None:
    lines = ["[[source]]", *(f'{name} = "{value}"' for name, value in entry.items())]
    (folder / "sources.toml").write_text("\n".join(lines), encoding="utf-8")
    table = COLUMNS + "".join("\t".join(row) + "\n" for row in rows)
    (folder / "checksums.tsv").write_text(table, encoding="utf-8")


def test_list_is_read(tmp_path: Path) -> None:
    """A source is its entry and its rows."""
    _write_list(tmp_path, ENTRY, ROW)
    expected = PublicSource(**ENTRY, files=(KrlFile("R1/main.src", 3, "0" * 64, "user", "real"),))
    assert (expected,) == read_sources(tmp_path)


@pytest.mark.parametrize(
    ("path", "why"),
    [
        ("../main.src", "leads elsewhere"),
        ("/etc/main.src", "leads elsewhere"),
        ("R1//main.src", "leads elsewhere"),
        ("R1/./main.src", "leads elsewhere"),
        ("C:/main.src", "not every system"),
        ("R1\\main.src", "not every system"),
        ("R1/what?.src", "not every system"),
        ("R1/ma\x1bin.src", "not every system"),
        ("R1 /main.src", "not every system"),
        ("R1./main.src", "not every system"),
        ("R1/nul.src", "not every system"),
        ("R1/COM1 .old.src", "not every system"),
        (".git/main.src", "leads into a git directory"),
        ("R1/main.exe", "not a KRL file"),
        ("R1/main", "not a KRL file"),
    ],
)
def test_unsafe_path_is_refused(path: str, why: str, tmp_path: Path) -> None:
    """A path that leads elsewhere, or that some system cannot store, is refused with its line."""
    _write_list(tmp_path, ENTRY, ROW, [ROW[0], path, *ROW[2:]])
    with pytest.raises(SourceListError, match=rf"checksums\.tsv:3: .*{why}"):
        read_sources(tmp_path)


@pytest.mark.parametrize(
    ("entry", "rows", "why"),
    [
        (ENTRY | {"url": "ext::sh -c true"}, [ROW], "must begin with https://"),
        (ENTRY | {"commit": "main"}, [ROW], "not a full hash"),
        (ENTRY | {"repository": "../cell"}, [ROW], "not OWNER/NAME"),
        (ENTRY | {"branch": "main"}, [ROW], "a source has exactly"),
        (ENTRY | {"note": ""}, [ROW], "every value must be a text"),
        (ENTRY, [], "no files of it"),
        (ENTRY, [ROW, ["other/cell", *ROW[1:]]], "no source for the files of other/cell"),
        (ENTRY, [ROW, [ROW[0], "r1/MAIN.src", *ROW[2:]]], "listed twice"),
        (ENTRY, [[*ROW[:2], "-3", *ROW[3:]]], "not a size and a SHA-256"),
        (ENTRY, [[*ROW[:2], "9" * 5_000, *ROW[3:]]], "not a size and a SHA-256"),
        (ENTRY, [[*ROW[:3], "abc", *ROW[4:]]], "not a size and a SHA-256"),
        (ENTRY, [ROW[:4]], "6 columns expected"),
    ],
)
def test_damaged_list_is_refused(
    entry: Mapping[str, str], rows: list[list[str]], why: str, tmp_path: Path
) -> None:
    """A list that cannot be trusted is refused with the reason."""
    _write_list(tmp_path, entry, *rows)
    with pytest.raises(SourceListError, match=why):
        read_sources(tmp_path)


def test_repository_listed_twice_is_refused(tmp_path: Path) -> None:
    """A repository has one entry."""
    _write_list(tmp_path, ENTRY, ROW)
    entry = (tmp_path / "sources.toml").read_text(encoding="utf-8")
    (tmp_path / "sources.toml").write_text(f"{entry}\n{entry}", encoding="utf-8")
    with pytest.raises(SourceListError, match="a repository is listed twice"):
        read_sources(tmp_path)


@pytest.mark.parametrize("name", ["sources.toml", "checksums.tsv"])
@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"[[junk", b"a\tb\n", b"a" + b".a" * 9_000])
def test_junk_is_refused(name: str, content: bytes, tmp_path: Path) -> None:
    """Junk in place of a list is refused, and the file is named."""
    _write_list(tmp_path, ENTRY, ROW)
    (tmp_path / name).write_bytes(content)
    with pytest.raises(SourceListError, match=name):
        read_sources(tmp_path)
