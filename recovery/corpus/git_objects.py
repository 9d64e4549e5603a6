"""Reading files from git repositories: local mirrors, or fetched ones.

Only git itself runs, as a child process, and only to read objects. Nothing is checked out, no hook
or filter of a repository runs, and git never asks for a password.
"""

import io
import os
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

#: How many folders below OWNER+NAME a mirror's git directory may lie.
_MIRROR_DEPTH = 3

# If set by a surrounding git command, these would direct git to another repository.
_REPOSITORY_VARIABLES = (
    "GIT_ALTERNATE_OBJECT_DIRECTORIES",
    "GIT_COMMON_DIR",
    "GIT_DIR",
    "GIT_INDEX_FILE",
    "GIT_NAMESPACE",
    "GIT_OBJECT_DIRECTORY",
    "GIT_WORK_TREE",
)

# Messages of servers that do not serve a single commit by its hash.
_REFUSALS = ("not our ref", "unadvertised object", "server does not allow request")

_SETTINGS = (
    "-c",
    "credential.helper=",  # the repositories are public: never ask, never open a window
    "-c",
    "http.lowSpeedLimit=1000",  # a stalled transfer ends, after this many
    "-c",
    "http.lowSpeedTime=60",  # seconds
)


class GitError(Exception):
    """Git is missing or failed; the message is one line."""


class RefusedError(GitError):
    """The server answered, but does not serve this one commit."""


def find_mirror(mirrors: Path, repository: str) -> Path | None:
    """Return the git directory of `repository` (OWNER/NAME) below the folder `mirrors`, or None.

    A mirror is `OWNER/NAME`, `OWNER/NAME.git`, `OWNER__NAME` or `OWNER+NAME`. It is a git
    directory, or has one as `.git` or a few folders further down.
    """
    owner, _, name = repository.partition("/")
    for place in (f"{owner}+{name}", f"{owner}__{name}", f"{owner}/{name}", f"{owner}/{name}.git"):
        for folder in _folders(mirrors / place, _MIRROR_DEPTH):
            if (folder / "HEAD").is_file() and (folder / "objects").is_dir():
                return folder
    return None


def _folders(root: Path, depth: int) -> Iterator[Path]:
    """Yield `root` and the folders below it, nearest first, without following links."""
    level = [root] if root.is_dir() else []
    for _ in range(depth + 1):
        yield from level
        level = [
            below
            for folder in level
            for below in sorted(folder.iterdir())
            if below.is_dir() and not below.is_symlink()
        ]


def fetch_commit(url: str, commit: str, into: Path) -> None:
    """Fetch one commit of `url`, without its history, into the new git directory `into`.

    Raises RefusedError if the server only serves whole branches, GitError for other failures.
    """
    _git(["init", "--quiet", "--bare", str(into)])
    _git([f"--git-dir={into}", "fetch", "--quiet", "--depth=1", "--no-tags", "--", url, commit])


def fetch_all(url: str, into: Path) -> None:
    """Clone all branches of `url`, with their history, into the new git directory `into`.

    Raises GitError.
    """
    _git(["clone", "--quiet", "--bare", "--", url, str(into)])


def read_files(
    git_dir: Path, revision: str, sizes: Mapping[str, int]
) -> Iterator[tuple[str, bytes | None]]:
    """Yield the files at `revision` that have one of the paths, each with its bytes.

    The bytes are None if the size is not the one given in `sizes`. Raises GitError if git cannot
    read `git_dir`.
    """
    found = _objects(git_dir, "--batch-check=%(objecttype) %(objectsize)", revision, sizes)
    kinds = dict(zip(sizes, found.splitlines(), strict=True))
    same = {path: size for path, size in sizes.items() if kinds[path] == b"blob %d" % size}
    contents = io.BytesIO(_objects(git_dir, "--batch", revision, same))
    for path, kind in kinds.items():
        if path in same:
            contents.readline()
            yield path, contents.read(sizes[path])
            contents.readline()
        elif kind.startswith(b"blob "):
            yield path, None


def _objects(git_dir: Path, option: str, revision: str, paths: Iterable[str]) -> bytes:
    """Return what git says of some files, in their order."""
    command = ["git", f"--git-dir={git_dir.resolve()}", "cat-file", option]
    given = "".join(f"{revision}:{path}\n" for path in paths).encode()
    try:
        done = subprocess.run(
            command, input=given, capture_output=True, env=_environment(), check=True
        )
    except FileNotFoundError as error:
        raise GitError("git is not installed") from error
    except subprocess.CalledProcessError as error:
        raise GitError(f"git cannot read {git_dir}") from error
    return done.stdout


def _git(arguments: Sequence[str]) -> None:
    command = ["git", *_SETTINGS, *arguments]
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            env=_environment(),
            check=False,
        )
    except FileNotFoundError as error:
        raise GitError("git is not installed") from error
    if done.returncode == 0:
        return
    said = done.stderr.decode("utf-8", "replace").strip()
    if any(refusal in said.lower() for refusal in _REFUSALS):
        raise RefusedError(_reason(said))
    raise GitError(_reason(said) or f"git ended with status {done.returncode}")


def _reason(said: str) -> str:
    """Return the line of git's output that states the reason, without its prefix."""
    lines = [line for line in said.splitlines() if line.startswith(("fatal:", "error:", "remote:"))]
    return lines[0].partition(":")[2].strip() if lines else said.partition("\n")[0]


def _environment() -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if name not in _REPOSITORY_VARIABLES}
    return kept | {
        "GIT_ALLOW_PROTOCOL": "https:file",  # also for redirects; file is for local mirrors
        "GIT_NO_LAZY_FETCH": "1",  # a partial mirror must not go out to the network
        "GIT_TERMINAL_PROMPT": "0",
        "LC_ALL": "C",  # refusals are recognised by their English words
    }
