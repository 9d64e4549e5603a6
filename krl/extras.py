"""Packages that only some commands need, and the extras that install them."""

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from krl.errors import InputError

_EXTRA_OF = {
    "PIL": "video",
    "distributed": "cluster",
    "imageio_ffmpeg": "video",
    "junitparser": "records",
    "lsprotocol": "lsp",
    "mujoco": "arm",
    "numpy": "arm",
    "pandas": "records",
    "pyarrow": "records",
    "pygls": "lsp",
    "pytest": "test",
    "ruckig": "arm",
    "scipy": "arm",
    "watchfiles": "watch",
    "xdist": "test",
}

#: Packages that the arm imports on first use, in the middle of a run.
ARM = ("scipy",)


@contextmanager
def expected_extras(*names: str) -> Iterator[None]:
    """Raise `InputError` if an optional package is missing; for other packages it is a defect.

    ``names`` are packages that are imported later and are checked at once.
    """
    try:
        need(*names)
        yield
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        if name not in _EXTRA_OF:
            raise
        raise _refused([name]) from error


def need(*names: str) -> None:
    """Raise `InputError` if some of the packages are not installed."""
    if missing := [name for name in names if find_spec(name) is None]:
        raise _refused(missing)


def _refused(missing: Sequence[str]) -> InputError:
    *first, last = missing
    said = f"{', '.join(first)} and {last}, which are" if first else f"{last}, which is"
    return InputError(
        f"this needs {said} not installed: {_cure({_EXTRA_OF[name] for name in missing})}"
    )


def _cure(extras: set[str]) -> str:
    """Return the command that installs extras with the tool that installed krl.

    The environments of `uv tool` and pipx have no pip and have to be reinstalled, so the extras
    that are already installed are included.
    """
    from importlib import metadata

    prefix = Path(sys.prefix)
    tool = "pip install"
    if (prefix / "uv-receipt.toml").is_file():
        tool = "uv tool install"
    elif (prefix / "pipx_metadata.json").is_file():
        tool = "pipx install --force"
    if tool != "pip install":
        extras |= {extra for package, extra in _EXTRA_OF.items() if find_spec(package)}
    named = f"[{','.join(sorted(extras))}]"
    try:
        origin = metadata.distribution("krl-workbench").read_text("direct_url.json")
        installed = json.loads(origin or "{}")
    except metadata.PackageNotFoundError:  # a checkout that was not installed
        installed = {}
    if installed.get("dir_info", {}).get("editable"):
        return f"{tool} -e '.{named}'"
    url = installed.get("url")
    return f"{tool} 'krl-workbench{named}{f' @ {url}' if url else ''}'"
