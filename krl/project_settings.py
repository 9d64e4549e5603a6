"""`krl.toml`: the settings that a team has agreed on for one project.

The file is at the root of the project and applies to everything below. Every key has the meaning of
the `krl check` option with the same name; docs/settings.md lists them.
"""

import difflib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from fnmatch import fnmatchcase
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, get_args

from krl.errors import InputError
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    from grammar.diagnostics.diagnostic import Diagnostic
    from support.files.discovery import FoundFile

FILE_NAME: Final = "krl.toml"

_Level = Literal["error", "warning", "note", "off"]


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a project; paths and patterns are relative to ``root``.

    ``select`` and ``ignore`` are prefixes of codes, as are the keys of ``severity``, of which the
    longest decides. A pattern without a slash matches any file or folder with that name; others
    match a path or that of a folder above it. Letter case is ignored.
    """

    root: Path
    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    severity: Mapping[str, _Level] = field(default_factory=dict, hash=False)
    exclude: tuple[str, ...] = ()
    ignored_in: Mapping[str, tuple[str, ...]] = field(default_factory=dict, hash=False)
    baseline: Path | None = None
    complete: bool = False
    packages: tuple[str, ...] = ()
    profile: str | None = None

    def leaves_out(self, found: "FoundFile") -> bool:
        """Return whether a file is excluded."""
        return any(_fits(self._below(found.file, found.member), one) for one in self.exclude)

    def adjusted(self, found: "Diagnostic") -> "Diagnostic | None":
        """Return a finding with the agreed severity; ``None`` if it is switched off."""
        for pattern, codes in self.ignored_in.items():
            if found.code.startswith(codes) and _fits(self._below(Path(found.path)), pattern):
                return None
        fitting = [prefix for prefix in self.severity if found.code.startswith(prefix)]
        if not fitting:
            return found
        level = self.severity[max(fitting, key=len)]
        return None if level == "off" else replace(found, severity=level)

    def _below(self, file: Path, member: str | None = None) -> str:
        """Return the path of a file relative to the root, or its full path if it is elsewhere."""
        path = file.absolute()
        shown = (path.relative_to(self.root) if path.is_relative_to(self.root) else path).as_posix()
        return f"{shown}/{member}" if member else shown


def _fits(path: str, pattern: str) -> bool:
    parts = path.casefold().split("/")
    wanted = pattern.casefold().rstrip("/")
    if "/" not in wanted:
        return any(fnmatchcase(part, wanted) for part in parts)
    wanted = wanted.removeprefix("./").removeprefix("/")
    return any(fnmatchcase("/".join(parts[:end]), wanted) for end in range(1, len(parts) + 1))


def settings_of(paths: Sequence[Path]) -> Settings | None:
    """Return the settings for some paths, in or above them; ``None`` if there are none.

    Raises `InputError` if different settings apply to them.
    """
    found = {one for path in paths if (one := settings_file(path))}
    if len(found) > 1:
        listed = " and ".join(map(str, sorted(found)))
        raise InputError(f"{listed} are settings of different projects: check them one by one")
    return read_settings(found.pop()) if found else None


def settings_file(path: Path) -> Path | None:
    """Return the file of settings that applies to a path: the nearest in or above it."""
    return next((one for one in settings_places(path) if one.is_file()), None)


def settings_places(path: Path) -> Iterator[Path]:
    """Yield where the settings for a path may be, the nearest first."""
    return (at / FILE_NAME for at in (path.absolute(), *path.absolute().parents))


def read_settings(file: Path) -> Settings:
    """Return the settings in a file; raises `InputError` with the wrong key."""
    from support.files.untrusted import read_text, toml_of

    try:
        table = toml_of(read_text(file, "utf-8-sig"))
    except OSError as error:
        raise InputError(f"{file}: {error.strerror or error}") from None
    except ValueError as error:
        raise InputError(f"{file}: {error}") from None
    try:
        return _settings(file.absolute().parent, table)
    except ValueError as error:
        raise InputError(f"{file}: {error}") from None


def _settings(root: Path, table: Mapping[str, Any]) -> Settings:
    for key in table:
        if key not in _READ:
            near = difflib.get_close_matches(key, _READ, 1)
            raise ValueError(f"no setting is called {key}" + (f"; {near[0]}?" if near else ""))
    given = {name: read(key, table[key]) for key, (name, read) in _READ.items() if key in table}
    if "baseline" in given:
        given["baseline"] = root / given["baseline"]
    if "profile" in given:
        given["profile"] = _profile(root, given["profile"])
    return Settings(root, **given)


# ------------------------------------------------------------------------------- kinds of values


def _profile(root: Path, name: str) -> str:
    """Return the name of a built-in profile, or the path of the file that ``name`` gives."""
    if name.lower().endswith(".toml"):
        if not (root / name).is_file():
            raise ValueError(f"profile: there is no file {name}")
        return str(root / name)
    # not by interp.controller, whose import takes as long as a small check
    built_in = resources.files("interp").joinpath("controller", "state", "profiles")
    names = sorted(one.name.removesuffix(".toml") for one in built_in.iterdir())
    if name not in names:
        known = ", ".join(names)
        raise ValueError(f"profile: {name} is unknown; there are {known}, and any .toml file")
    return name


def _of(kind: type[Any], what: str) -> Callable[[str, object], Any]:
    """Return the function that reads a value of this kind."""

    def read(key: str, value: object) -> Any:
        if not isinstance(value, kind):
            raise ValueError(f"{key} must be {what}")
        return value

    return read


_text, _truth, _table = _of(str, "a text"), _of(bool, "true or false"), _of(dict, "a table")


def _texts(key: str, value: object) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(one, str) for one in value):
        raise ValueError(f"{key} must be a list of texts")
    return tuple(value)


def _codes(key: str, value: object) -> tuple[str, ...]:
    from grammar.diagnostics.selection import Selection

    texts = _texts(key, value)
    try:
        return Selection.of(texts).select
    except ValueError as error:
        raise ValueError(f"{key}: {error}") from None


def _severity(key: str, value: object) -> dict[str, _Level]:
    found: dict[str, _Level] = {}
    for code, level in _table(key, value).items():
        (prefix,) = _codes(key, [code]) or ("",)
        known = next((one for one in get_args(_Level) if one == level), None)
        if known is None:
            raise ValueError(f"{key}: {code} must be one of {', '.join(get_args(_Level))}")
        found[prefix] = known
    return found


def _ignored_in(key: str, value: object) -> dict[str, tuple[str, ...]]:
    return {one: _codes(f"{key}: {one}", codes) for one, codes in _table(key, value).items()}


#: For each key its field and the function that reads its value.
_READ: Final[Mapping[str, tuple[str, Callable[[str, object], Any]]]] = {
    "profile": ("profile", _text),
    "complete": ("complete", _truth),
    "packages": ("packages", _texts),
    "select": ("select", _codes),
    "ignore": ("ignore", _codes),
    "exclude": ("exclude", _texts),
    "baseline": ("baseline", _text),
    "severity": ("severity", _severity),
    "per-file-ignores": ("ignored_in", _ignored_in),
}
