"""Packages that only some commands need, and the extras of the package that install them."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from krl.errors import InputError

_EXTRA_OF = {
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

#: Packages that the arm imports when it first needs them, which would be in the midst of work.
ARM = ("scipy",)


@contextmanager
def expected_extras(*names: str) -> Iterator[None]:
    """Turn the absence of such a package into `InputError`; any other is a defect.

    ``names`` are packages that are imported later: their absence is found at once.
    """
    try:
        for name in names:
            need(name)
        yield
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        if name not in _EXTRA_OF:
            raise
        raise _refused(name) from error


def need(name: str) -> None:
    """Raise `InputError` where the package is not installed, before any work."""
    if find_spec(name) is None:
        raise _refused(name)


def _refused(name: str) -> InputError:
    return InputError(f"this needs {name}, which is not installed: {_cure(_EXTRA_OF[name])}")


def _cure(extra: str) -> str:
    """The command that installs an extra, by the tool and from the file that installed us.

    The environments of `uv tool` and pipx have no pip, and are made anew: what is there is named.
    """
    from importlib import metadata

    prefix = Path(sys.prefix)
    tool = "pip install"
    if (prefix / "uv-receipt.toml").is_file():
        tool = "uv tool install"
    elif (prefix / "pipx_metadata.json").is_file():
        tool = "pipx install --force"
    extras = {extra}
    if tool != "pip install":
        extras.update(extra for package, extra in _EXTRA_OF.items() if find_spec(package))
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
