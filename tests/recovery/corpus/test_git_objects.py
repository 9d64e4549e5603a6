"""Git repositories as places to read files from."""

import os
import subprocess
from pathlib import Path

import pytest

from recovery.corpus.git_objects import GitError, fetch_commit, find_mirror, read_files


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


def test_files_are_read(git_dir: Path) -> None:
    """Blanks in names are no matter, what is lost or a folder is left out, and no size exceeded."""
    sizes = {"R1/a b.src": 12, "R1/gone b.src": 12, "R1": 12, "R1/long.src": 6}
    found = [("R1/a b.src", b"DEF a( )\nEND"), ("R1/long.src", None)]
    assert found == list(read_files(git_dir, "HEAD", sizes))
    assert [] == list(read_files(git_dir, "0" * 40, sizes))
    whole = dict(read_files(git_dir, "HEAD", {"R1/long.src": 400_000, "R1/a b.src": 12}))
    assert [b"; a\n" * 100_000, b"DEF a( )\nEND"] == list(whole.values())


def test_surrounding_git_command_does_not_interfere(
    git_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Run from a git hook, files are still read from the repository that is given."""
    _git(tmp_path, "init", "--quiet", "--bare", "other.git")
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "other.git"))
    monkeypatch.setenv("GIT_OBJECT_DIRECTORY", str(tmp_path / "other.git" / "objects"))
    assert list(read_files(git_dir, "HEAD", {"R1/a b.src": 12}))


def test_what_is_no_repository_is_an_error(tmp_path: Path) -> None:
    """Reading where there is no repository raises the error that names the place."""
    with pytest.raises(GitError, match="git cannot read"):
        list(read_files(tmp_path, "HEAD", {"a.src": 10}))


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
        list(read_files(tmp_path, "HEAD", {}))
    with pytest.raises(GitError, match="git is not installed"):
        fetch_commit("https://example.org", "0" * 40, tmp_path / "new")
