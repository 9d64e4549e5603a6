"""The generator of ``docs/semantics.md``, the reference of all rules, and of the table of tiers.

Its input is the registry (`conformance.suite.registry`) and the codes of findings
(`grammar.diagnostics.codes`). Run ``python -m conformance.suite.rules_page`` after a change to
either; a test fails if the page is stale.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from conformance.suite.registry import Rule, registry, searches
from conformance.suite.templates import template
from grammar.diagnostics.codes import by_slug
from grammar.semantics.rules import is_confirmed, tiers

PAGE = Path(__file__).parents[2] / "docs" / "semantics.md"
#: The tier of each rule, for the packages below this one (`grammar.semantics.rules`).
TIERS = Path(__file__).parents[2] / "grammar" / "system" / "rules.tsv"

#: What implements a rule, and its name on the page; codes of findings are added to it.
_TODAY = {
    "grammar": "grammar",
    "tables": "tables",
    "check": "checked",
    "lint": "lint",
    "run": "running",
}

_TOPICS: Mapping[str, tuple[str, str]] = {
    "TYP": ("Types, literals, declarations", "What data there are and how they are declared."),
    "ARI": ("Operators and conversion", "The values of expressions."),
    "FCT": ("Functions", "What the controller brings along, without any file."),
    "SCO": ("Files, scope, parameters", "Who sees what, for how long, and how it is passed."),
    "CTL": ("Control flow", "In which order statements are executed."),
    "ADV": ("Advance run", "Why a program is ahead of its robot, and what stops it."),
    "BLD": ("Approximate positioning", "How one motion blends into the next."),
    "MOT": ("Motions", "Kinds, velocities, limits."),
    "POS": ("Status, Turn, singularities", "Which of several axis positions a pose means."),
    "ORI": ("Orientation", "How the tool turns on its way."),
    "SPL": ("Splines", "Motions that are planned as one."),
    "TRG": ("Triggers", "What happens at a point of a path."),
    "INT": ("Interrupts", "What happens when something happens."),
    "IOT": ("Inputs, outputs, signals", "What connects a program with its cell."),
    "TIM": ("Timers", "What time it is."),
    "SUB": ("Submit interpreter", "What runs beside the robot's program."),
    "MSG": ("Messages", "The controller's own numbers."),
    "CON": ("Conflicts", "Where sources contradict one another, and what was decided."),
}


def codes_of() -> Mapping[str, tuple[str, ...]]:
    """Return the codes of the findings that rest on each rule, by the rule's ID."""
    found: dict[str, tuple[str, ...]] = dict.fromkeys(registry(), ())
    for code in by_slug().values():
        for rule in code.rules:
            found[rule] += (code.code,)
    return found


def page() -> str:
    """Return the content of the page."""
    codes = codes_of()

    def today(rule: Rule) -> Iterator[str]:
        """Yield in words what is done about a rule, with the codes that report it."""
        for word in rule.today:
            is_lint = word == "lint"
            wanted = [code for code in codes[rule.id] if code.startswith("KRL6") == is_lint]
            listed = f" ({', '.join(wanted)})" if wanted and word in ("check", "lint") else ""
            yield _TODAY[word] + listed

    topics = [_topic(topic, *words) for topic, words in _TOPICS.items()]
    totals = map(sum, zip(*(one["counts"] for one in topics), strict=True))
    given = {"topics": topics, "totals": list(totals), "today": today}
    return template("rules_page.md.j2").render(given, searches=searches().items())


def _topic(topic: str, title: str, about: str) -> dict[str, Any]:
    """Return a topic as the template shows it: its rules, and how many are how far."""
    rules = [rule for rule in registry().values() if rule.topic == topic]
    done = [set(rule.today) for rule in rules]
    return {
        "id": topic,
        "title": title,
        "about": about,
        "rules": rules,
        "counts": (
            len(rules),
            sum(not is_confirmed([rule.id]) for rule in rules),
            sum(bool({"grammar", "tables"} & words) for words in done),
            sum(bool({"check", "lint"} & words) for words in done),
            done.count({"run"}),
        ),
    }


def tier_table() -> str:
    """Return the text of `TIERS`."""
    return "rule\ttier\n" + "".join(f"{one.id}\t{one.tier}\n" for one in registry().values())


if __name__ == "__main__":
    TIERS.write_text(tier_table(), encoding="utf-8", newline="\n")
    tiers.cache_clear()
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
