"""The reference of rules is complete, fresh, and says what the project does."""

import re
from importlib import resources
from pathlib import Path

from grammar import semantics
from grammar.codes import by_code
from grammar.rules import tiers
from grammar.semantics import PAGE, UNUSED, page, rules

WORDS = {"grammar", "tables", "check", "lint", "run"}


def test_page_is_fresh() -> None:
    """The page in docs is what the tables make: after a change run python -m grammar.semantics."""
    assert page() == PAGE.read_text(encoding="utf-8")


def test_every_rule_has_one_statement() -> None:
    """All 246 rules are there, in the order of their tiers' table, each in a sentence or more."""
    found = rules()
    assert list(tiers()) == [rule.id for rule in found]
    assert len(found) == len({rule.statement for rule in found})
    assert all(rule.statement.endswith(".") and len(rule.statement) < 240 for rule in found)


def test_what_is_done_is_one_of_few_words() -> None:
    """Each rule says what is done for it, and no finding rests on a rule that is not checked."""
    for rule in rules():
        assert rule.today, rule
        assert WORDS >= set(rule.today), rule
        if rule.codes:
            assert {"check", "lint"} & set(rule.today), rule


def test_every_code_is_given_by_a_check() -> None:
    """What no check tells is not claimed to be checked."""
    grammar = Path(str(resources.files("grammar")))
    modules = [
        path for path in grammar.rglob("*.py") if path.name not in ("codes.py", "semantics.py")
    ]
    modules += (grammar.parent / "recovery").glob("*check*.py")
    source = "".join(path.read_text(encoding="utf-8") for path in modules)

    def is_given(code: str, slug: str) -> bool:
        return f'"{slug}"' in source or bool(re.search(rf"\b{code.removeprefix('KSS')}\b", source))

    never = {name for name, code in by_code().items() if not is_given(name, code.slug)}
    assert set(UNUSED) == never


def test_topics_are_those_of_the_rules() -> None:
    """Every topic has rules, and every rule has a topic."""
    assert set(semantics._TOPICS) == {rule.topic for rule in rules()}
