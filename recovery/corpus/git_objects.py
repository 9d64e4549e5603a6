"""Reading files from git repositories: local mirrors, or fetched ones.

Only git itself runs, as a child process, and only to read objects. Nothing is checked out, no hook
or filter of a repository runs, and git never asks for a password.
"""

import os
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Self

_MIRROR_DEPTH = 3
"""How many folders below OWNER+NAME a mirror's git directory may lie."""

_CHUNK = 1 << 16

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


class BlobReader:
    """Reads many files of a git directory through one git process; a context manager."""

    def __init__(self, git_dir: Path) -> None:
        """Start git in `git_dir`; raises GitError if git is not installed."""
        command = ["git", f"--git-dir={git_dir.resolve()}", "cat-file", "--batch"]
        self._git_dir = git_dir
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env=_environment(),
            )
        except FileNotFoundError as error:
            raise GitError("git is not installed") from error

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(self, *_error: object) -> None:
        """End the git process."""
        with suppress(OSError):  # git may have ended already
            self._stdin.close()
        self._stdout.close()
        self._process.wait()

    def read(self, revision: str, path: str, limit: int) -> bytes | None:
        """Return the bytes of `path` at `revision`, or None if there is no such file.

        Of a longer file only `limit + 1` bytes are returned. Raises GitError if git stops.
        """
        try:
            self._stdin.write(f"{revision}:{path}\n".encode())
            self._stdin.flush()
        except OSError as error:
            raise self._stopped() from error
        header = self._stdout.readline()
        if not header.endswith(b"\n"):
            raise self._stopped()
        match header.split():
            case [_, b"blob", size] if size.isdigit():
                return self._content(int(size), limit)
            case [_, b"tree" | b"commit" | b"tag", size] if size.isdigit():
                self._content(int(size), 0)
        return None

    def _content(self, size: int, limit: int) -> bytes:
        kept = self._exactly(min(size, limit + 1))
        rest = size - len(kept) + 1  # and the line end after it
        while rest:
            rest -= len(self._exactly(min(rest, _CHUNK)))
        return kept

    def _exactly(self, count: int) -> bytes:
        data = self._stdout.read(count)
        if len(data) != count:
            raise self._stopped()
        return data

    def _stopped(self) -> GitError:
        return GitError(f"git cannot read {self._git_dir}")

    @property
    def _stdin(self) -> IO[bytes]:
        assert self._process.stdin is not None
        return self._process.stdin

    @property
    def _stdout(self) -> IO[bytes]:
        assert self._process.stdout is not None
        return self._process.stdout


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
