"""The reference of rules is complete, fresh, and says what the project does."""

import re
from importlib import resources
from pathlib import Path

from conformance.suite import rules_page
from conformance.suite.case import Case
from conformance.suite.registry import registry, searches, unconfirmed
from conformance.suite.rules_page import PAGE, TIERS, codes_of, page, tier_table
from grammar.diagnostics.codes import by_code
from grammar.semantics.predefined import System
from grammar.semantics.rules import tiers

WORDS = {"grammar", "tables", "check", "lint", "run"}


def test_what_is_generated_is_fresh() -> None:
    """Page and tiers are fresh: after a change run python -m conformance.suite.rules_page."""
    assert page() == PAGE.read_text(encoding="utf-8")
    assert tier_table() == TIERS.read_text(encoding="utf-8")


def test_every_rule_has_one_statement() -> None:
    """No two rules say the same, and each says it in one sentence."""
    found = registry()
    assert len(found) == 254
    assert len(found) == len({rule.statement for rule in found.values()})
    assert all(r.statement.endswith(".") and len(r.statement) < 240 for r in found.values())


def test_only_what_is_confirmed_may_fail() -> None:
    """A rule of tier R or X alone fails nobody, nor one that leaves a question open."""
    hard = {rule.id for rule in registry().values() if rule.may_fail}
    assert hard <= {rule for rule, tier in tiers().items() if not set("RX").issuperset(tier)}
    assert len(hard) == 218


def test_what_is_done_is_one_of_few_words() -> None:
    """Each rule says what is done for it, and no finding rests on a rule that is not checked."""
    codes = codes_of()
    for rule in registry().values():
        assert rule.today, rule
        assert WORDS >= set(rule.today), rule
        if codes[rule.id]:
            assert {"check", "lint"} & set(rule.today), rule


def test_what_runs_has_a_case_that_runs(own_cases: list[Case]) -> None:
    """A rule that executors or the controller are said to follow is shown by a case that runs."""
    shown = {id_ for case in own_cases if case.phase == "run" for id_ in case.rules}
    said = {rule.id for rule in registry().values() if "run" in rule.today}
    assert set() == said - shown


def test_what_runs_is_cited_where_it_is_implemented() -> None:
    """`git grep` for a rule, or for the number of its message, finds the code that follows it."""
    folder = Path(__file__).parents[3] / "interp"
    files = [path for path in folder.rglob("*") if path.suffix in {".py", ".c", ".h", ".toml"}]
    source = "".join(path.read_text(encoding="utf-8") for path in files)
    cited = set(re.findall(r"\b(?:[A-Z]{3}-\d\d(?:\.\w\b)?|\d+)\b", source))
    cited |= {word.partition(".")[0] for word in cited}
    cited |= {rule for m in System.load().messages if str(m.number) in cited for rule in m.source}
    said = {rule.id for rule in registry().values() if "run" in rule.today}
    assert set() == said - cited


def test_every_code_is_given_by_a_check() -> None:
    """What no check tells is not claimed to be checked."""
    grammar = Path(str(resources.files("grammar")))
    modules = [path for path in grammar.rglob("*.py") if path.name != "codes.py"]
    modules += (grammar.parent / "recovery").glob("*check*.py")
    source = "".join(path.read_text(encoding="utf-8") for path in modules)

    def is_given(code: str, slug: str) -> bool:
        return f'"{slug}"' in source or bool(re.search(rf"\b{code.removeprefix('KSS')}\b", source))

    never = {name for name, code in by_code().items() if not is_given(name, code.slug)}
    assert set() == never


def test_topics_are_those_of_the_rules() -> None:
    """Every topic has rules, and every rule has a topic."""
    assert set(rules_page._TOPICS) == {rule.topic for rule in registry().values()}


def test_each_unconfirmed_clause_was_looked_for() -> None:
    """What was searched is told of each, and of no clause that is not there."""
    known = {*registry(), *(one.id for rule in registry().values() for one in rule.clauses)}
    assert set(unconfirmed()) <= set(searches()) <= known
    assert all(one.wanted and one.found for one in searches().values())
