"""What the tests of several packages share."""

from __future__ import annotations

import ctypes
import gc
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from support import gc_pause

if TYPE_CHECKING:
    from selenium import webdriver

# No test depends on the clock, nor on chance: who changes nothing sees the same examples again.
# `HYPOTHESIS_PROFILE=search` looks for new ones, and for many.
settings.register_profile(
    "suite",
    max_examples=20,
    derandomize=True,
    deadline=None,
    suppress_health_check=[
        HealthCheck.data_too_large,
        HealthCheck.function_scoped_fixture,
        HealthCheck.too_slow,
    ],
)
settings.register_profile(
    "search", settings.get_profile("suite"), derandomize=False, max_examples=250
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "suite"))

# What tests work on is small: garbage may wait, of short work and of long.
gc.set_threshold(100_000, 8, 20)
gc_pause._MANY *= 4

# Nor does what a command says depend on how long it takes.
os.environ["KRL_PROGRESS"] = "0"

_FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1280,900",
)


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """What is imported and collected stays: the garbage collector need not go through it again."""
    _keep()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Nor through what a finished file of tests leaves in caches, grammars and their states."""
    if nextitem is None or nextitem.path != item.path:
        _keep()


def _keep() -> None:
    gc.collect()
    gc.freeze()
    if sys.platform == "linux" and hasattr(libc := ctypes.CDLL(None), "malloc_trim"):
        libc.malloc_trim(0)  # a worker holds what its largest test took otherwise


@pytest.fixture(scope="session")
def small_grammar() -> str:
    """The text of a grammar of two statements, which is surveyed in no time."""
    return (Path(__file__).parent / "small.g4").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    """A headless chromium with an empty profile; without one the test is skipped."""
    from selenium import webdriver

    chromium = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "chrome"))), None
    )
    driver_path = shutil.which("chromedriver")
    if chromium is None or driver_path is None:
        pytest.skip("no chromium or no chromedriver on the path")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    for flag in (*_FLAGS, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(flag)
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver_path))
    yield driver
    driver.quit()


# ------------------------------------------------------------------------ random grammars


def _random_grammar(chance: Random) -> Grammar:
    names = [f"r{number}" for number in range(chance.randint(1, 4))]

    def sequence(number: int, guarded: bool, depth: int) -> str:
        out = []
        for _ in range(chance.randint(1, 3)):
            text = element(number, guarded, depth)
            guarded = guarded or text in _TOKENS
            out.append(text)
        return " ".join(out)

    def element(number: int, guarded: bool, depth: int) -> str:
        kind = chance.choice("ttttrrrgo" if depth else "ttr")
        # a rule before the first token is a later one, so that there is no left recursion
        callable_rules = names if guarded else names[number + 1 :]
        if kind == "r" and callable_rules:
            return chance.choice(callable_rules)
        if kind in "go" and depth:
            inner = " | ".join(
                sequence(number, guarded, depth - 1) for _ in range(chance.randint(1, 2))
            )
            return f"({inner})" + (chance.choice("?*+") if kind == "o" else "")
        return chance.choice(_TOKENS)

    rules = ["s : r0 EOF ;"]
    for number, name in enumerate(names):
        alternatives = [sequence(number, False, 2) for _ in range(chance.randint(0, 2))]
        alternatives.append(chance.choice([*_TOKENS, *names[number + 1 :], ""]))
        rules.append(f"{name} : {' | '.join(alternatives)} ;")
    tokens = [f"{name} : '{name}' ;" for name in _TOKENS[:-1]]
    return read("\n".join(["grammar Random;", *rules, *tokens, "NEWLINE : '\\n' ;", ""]))


# the recogniser treats the ends of lines in a way of its own
_TOKENS = ["A", "B", "C", "NEWLINE"]


@pytest.fixture(scope="session")
def random_grammar() -> Callable[[Random], Grammar]:
    """Makes small grammars of our style with every kind of element, most of them ambiguous."""
    return _random_grammar


def _mutated(tokens: Sequence[str], chance: Random, names: Sequence[str]) -> list[str]:
    out = list(tokens)
    for _ in range(chance.randint(1, 3)):
        place = chance.randrange(len(out) + 1)
        kind = chance.choice("dri")
        put = [] if kind == "d" else [chance.choice(names)]
        out[place : place + (kind != "i")] = put
    return out


@pytest.fixture(scope="session")
def mutated() -> Callable[[Sequence[str], Random, Sequence[str]], list[str]]:
    """``mutated(tokens, chance, names)``: one to three tokens deleted, replaced or inserted."""
    return _mutated


@pytest.fixture(scope="session", autouse=True)
def _tests_are_no_project(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Keep the folders of two tests from being one project: a name occurs twice beside them."""
    for number in "12":
        folder = tmp_path_factory.getbasetemp() / "apart" / number
        folder.mkdir(parents=True)
        (folder / "apart.src").touch()
