"""Profiles: what they say, and what is said of wrong ones."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from interp.controller.state.profile import Profile, ProfileError, profile_names

Go = Callable[..., Any]


def test_all_can_be_read() -> None:
    """Every profile that comes along is complete."""
    assert ["kss5", "kss8"] == profile_names()
    assert [12_000, 12_000] == [Profile.load(name).cycle for name in profile_names()]


def test_releases_differ() -> None:
    """Sizes are those of the release [CON-07]."""
    old, new = Profile.load("kss5"), Profile.load("kss8")
    assert (32, 256) == (old.sizes["cyclic_flags"], new.sizes["cyclic_flags"])
    assert (32, 64) == (old.most["interrupts"], new.most["interrupts"])


def test_unknown_name() -> None:
    """What there is is told."""
    with pytest.raises(ProfileError, match="there is no profile kss9; there are kss5, kss8"):
        Profile.load("kss9")


def test_file(tmp_path: Path) -> None:
    """A profile may be a file of one's own, such as one with a cycle of 4 ms [MOT-19]."""
    folder = Path(__file__).parents[3] / "interp/controller/state/profiles"
    text = (folder / "kss8.toml").read_text(encoding="utf-8")
    file = tmp_path / "fast.toml"
    file.write_text(text.replace("cycle = 12_000", "cycle = 4_000"), encoding="utf-8")
    assert (4_000, "fast") == (Profile.load(str(file)).cycle, Profile.load(str(file)).name)


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("cycle = 12_000", "cycle = 0", "profile x: time.cycle is below 1"),
        ("cycle = 12_000", 'cycle = "a"', "profile x: time.cycle is no int"),
        ("cycle = 12_000", "", "profile x: time.cycle is no int"),
        ("timers = 64", "tymers = 64", "profile x: sizes.timers is no int"),
        ("triggers = 40", "", "profile x: most.triggers is no int"),
        ("inputs = 8192", "inputs = 8_192_000_000", "profile x: sizes.inputs is above 10,000,000"),
        ('"kr6r900"', '"../kr6r900"', "profile x: machine is no name of letters, digits and _"),
        ('"kr6r900"', '"a\\u0000"', "profile x: machine is no name of letters, digits and _"),
        ('"$OV_PRO"', '"$OV_PROO"', "profile x: values.$OV_PROO is no variable of the controller"),
        ("start = 2020", "start = 9020", "profile x: time.start is after 9000"),
        ('"assumed" ', '"never" ', 'profile x: advance.coincidence is neither "assumed" nor "run"'),
    ],
)
def test_wrong_files(tmp_path: Path, before: str, after: str, words: str) -> None:
    """What is wrong is told in one line."""
    folder = Path(__file__).parents[3] / "interp/controller/state/profiles"
    text = (folder / "kss8.toml").read_text(encoding="utf-8")
    assert before in text
    file = tmp_path / "x.toml"
    file.write_text(text.replace(before, after, 1), encoding="utf-8")
    with pytest.raises(ProfileError) as caught:
        Profile.load(str(file))
    assert words == str(caught.value)


def test_what_is_no_file(tmp_path: Path) -> None:
    """A file that is not there, and one that is no TOML."""
    with pytest.raises(ProfileError, match="cannot be read"):
        Profile.load(str(tmp_path / "none.toml"))
    file = tmp_path / "bad.toml"
    file.write_text("a = = b", encoding="utf-8")
    with pytest.raises(ProfileError, match="profile bad: "):
        Profile.load(str(file))


def test_old_release_runs(go: Go) -> None:
    """A program runs on an older release, with its motion parameters [CON-07]."""
    text = "DEF main()\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nEND\n"
    assert "end" == go(text, profile=Profile.load("kss5")).outcome.ending


def test_wrong_initial_value(go: Go) -> None:
    """An initial value that its variable cannot have is told."""
    profile = Profile.load()
    profile = replace(profile, values={**profile.values, "$OV_PRO": "fast"})
    with pytest.raises(ProfileError, match=r"profile kss8: \$OV_PRO: "):
        go("DEF main()\nEND\n", profile=profile)
