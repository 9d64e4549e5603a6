"""Git repositories as places to read files from."""

import os
import subprocess
from pathlib import Path

import pytest

from recovery.corpus.git_objects import BlobReader, GitError, fetch_commit, find_mirror


def _git(folder: Path, *arguments: str) -> None:
    quiet = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    person = ["-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "core.autocrlf=false"]
    subprocess.run(["git", *person, *arguments], cwd=folder, env=os.environ | quiet, check=True)


@pytest.fixture
def git_dir(tmp_path: Path) -> Path:
    """The git directory of a repository with a long file, a short one and a folder."""
    folder = tmp_path / "work"
    (folder / "R1").mkdir(parents=True)
    (folder / "R1" / "long.src").write_bytes(b"; a\n" * 100_000)
    (folder / "R1" / "a b.src").write_bytes(b"DEF a( )\nEND")
    _git(folder, "init", "--quiet")
    _git(folder, "add", "--all")
    _git(folder, "commit", "--quiet", "--message=all")
    return folder / ".git"


@pytest.mark.parametrize(
    ("place", "found"),
    [
        ("someone/cell", "someone/cell/.git"),
        ("someone/cell.git", "someone/cell.git/.git"),
        ("someone__cell", "someone__cell/.git"),
        ("someone+cell/repo", "someone+cell/repo/.git"),
        ("someone+cell/4f/repo", "someone+cell/4f/repo/.git"),
    ],
)
def test_mirror_is_found(place: str, found: str, tmp_path: Path) -> None:
    """A mirror is found under each of its usual names."""
    (tmp_path / place).mkdir(parents=True)
    _git(tmp_path / place, "init", "--quiet")
    assert tmp_path / found == find_mirror(tmp_path, "someone/cell")


def test_bare_mirror_is_found(tmp_path: Path) -> None:
    """A mirror may be a bare repository."""
    (tmp_path / "someone").mkdir()
    _git(tmp_path, "init", "--quiet", "--bare", "someone/cell.git")
    assert tmp_path / "someone" / "cell.git" == find_mirror(tmp_path, "someone/cell")


def test_other_folders_are_no_mirror(tmp_path: Path) -> None:
    """A folder without a git directory is no mirror, nor is another repository."""
    (tmp_path / "someone" / "cell").mkdir(parents=True)
    (tmp_path / "someone" / "cell" / "HEAD").touch()
    (tmp_path / "someone" / "cells").mkdir()
    _git(tmp_path / "someone" / "cells", "init", "--quiet")
    assert find_mirror(tmp_path, "someone/cell") is None
    assert find_mirror(tmp_path / "gone", "someone/cell") is None


def test_files_are_read_one_after_the_other(git_dir: Path) -> None:
    """Blanks in names, lost files, folders and cut files do not put the reader out of step."""
    with BlobReader(git_dir) as reader:
        assert b"DEF a( )\nEND" == reader.read("HEAD", "R1/a b.src", 1000)
        assert reader.read("HEAD", "R1/gone b.src", 1000) is None
        assert reader.read("HEAD", "R1", 1000) is None
        assert reader.read("0" * 40, "R1/a b.src", 1000) is None
        assert b"; a\n; a" == reader.read("HEAD", "R1/long.src", 6)
        assert 400_000 == len(reader.read("HEAD", "R1/long.src", 400_000) or b"")
        assert b"DEF a( )\nEND" == reader.read("HEAD", "R1/a b.src", 12)


def test_surrounding_git_command_does_not_interfere(
    git_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Run from a git hook, the reader still reads the repository that it was given."""
    _git(tmp_path, "init", "--quiet", "--bare", "other.git")
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "other.git"))
    monkeypatch.setenv("GIT_OBJECT_DIRECTORY", str(tmp_path / "other.git" / "objects"))
    with BlobReader(git_dir) as reader:
        assert reader.read("HEAD", "R1/a b.src", 1000) is not None


def test_what_is_no_repository_is_an_error(tmp_path: Path) -> None:
    """Reading where there is no repository raises the error that names the place."""
    with BlobReader(tmp_path) as reader, pytest.raises(GitError, match="git cannot read"):
        reader.read("HEAD", "a.src", 10)


@pytest.mark.parametrize("transport", ["http", "git", "ssh", "ext"])
def test_only_https_is_spoken(transport: str, tmp_path: Path) -> None:
    """Git refuses any other way to a server before it calls there, whatever else allows it."""
    url = "ext::true" if transport == "ext" else f"{transport}://127.0.0.1:9/cell"
    with pytest.raises(GitError, match=f"transport '{transport}' not allowed"):
        fetch_commit(url, "0" * 40, tmp_path / "new")


def test_missing_git_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without git, both reading and fetching say so."""
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(GitError, match="git is not installed"):
        BlobReader(tmp_path)
    with pytest.raises(GitError, match="git is not installed"):
        fetch_commit("https://example.org", "0" * 40, tmp_path / "new")
