"""The generator of ``docs/semantics.md``, the reference of all rules, and of the table of tiers.

Its input is the registry (`conformance.suite.registry`) and the codes of findings
(`grammar.diagnostics.codes`). Run ``python -m conformance.suite.semantics`` after a change to
either; a test fails if the page is stale.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from conformance.suite.registry import Rule, registry, searches
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

_HEAD = """\
# Semantics

<!-- Made by conformance/suite/semantics.py from conformance/rules.toml, conformance/searches.tsv
and grammar/diagnostics/codes.tsv. Do not edit. -->

For anyone who asks what KRL means: all rules that are known, and what the workbench does about
each. There is no public specification. Each rule has its certainty, its source, and what is done.

**How well it is known.** `P`: a manual page, or a file that KUKA wrote. `T`: a transcription or
translation of one. `F`: practitioners on a forum. `D`: measured on real controller files. `R`:
recollection of a manual that could not be read again. `X`: a page of unknown origin. What rests on
`R` or `X` alone is *unconfirmed*: it is never reported as an error. What was looked for to confirm
it stands [at the end](#searches).

**What is done.** *grammar*: `KRL.g4` reads it, or refuses what is wrong. *tables*: it is in the
tables of types, variables and functions in `grammar/system/`. *checked*: `krl check` reports it,
with these codes. *lint*: `krl check --stops` reports it. *running*: interpreters and controller act
on it.
A rule whose parts are not equally well known has clauses, and what a case expects rests on one of
them.
What shows it are the conformance cases: `krl conform RULE` runs them.
"""

_SOURCES = """\
## Sources

| key | source |
| --- | --- |
| S1 | KSS 8.2, operating and programming instructions for system integrators, pages 258 to 263 |
| S2 | symbol lists that a controller made (`$operate.dat`, `$operate_r1.dat`), release 8.6 |
| S3 | delivered with a controller: `bas.src`, `ir_stopm.src`, `$config.dat`, `$custom.dat` |
| S4 | the message base of KSS: 511 texts with their numbers, published by Intrinsic |
| S5 | machine data of several robots |
| S6 | a public list of 445 system variables with descriptions |
| S7 | KUKA.PLC mxAutomation Logix 1.0, programming, pages 25 and 81 |
| S8 | KUKA's quick guide to the syntax of KRL, KSS 8.x, its beginning: names, data, arrays |
| S9 | KR C2, operating handbook, machine data (2005), pages 14 and 74 to 77 |
| S10 | delivered with controllers, in public backups: `MsgLib`, `BrakeTestReq`, `BrakeTestPark`, \
`masref_main`, `tm_bib`, `p00`, `RSI`, `EthernetKRL`, `Grp_Func` |
| T1 to T23 but T21 | manuals and texts of KUKA College, transcribed or translated on public pages |
| T21 | KUKA.PLC mxAutomation, its function blocks described again by Beckhoff (TF5120) |
| T24, T25 | m.elecfans.com/article/1905092: signals; m.163wenku.com/p-4165416.html: waits |
| T26 | huluic.cn/article/i1g6a9h3j1i951068.html: timers and flags, from Expert Programming |
| T27 | news.eeworld.com.cn/robot/ic661686.html: interrupts |
| T28 | m.elecfans.com, 1855831 and 1952046: $ERR and ON_ERROR_PROCEED, from a manual |
| T29 | zlcrobot.com on motions to absolute targets, from a text of KUKA College; on constants |
| T30 to T32 | m.elecfans.com, 1990193, 2189475 and 1993339: numbers, logic, frames |
| T33 | wxredian.com/art?id=b2ebd5a111fd52ab5c4cd7a9c9989972: relations |
| T34 | blog.csdn.net/weixin_39973410/article/details/111205424: functions on texts |
| T35, T36 | citih.cn/i116162.htm: $ERR; m.elecfans.com/article/2049892: CWRITE |
| T37 | programming user-defined messages: scribd.com/document/617606976, openkuka.github.io/krl |
| T38 | wenku.csdn.net/doc/jere816oec: dialogues, from KUKA's course Programming 3, KSS 8 |
| T39 | m.elecfans.com/article/2081633 and 2078651: CREAD and its channels |
| T40 | m.hlo-trade.com/info/4/114.html: loops and branches, from a text of KUKA College |
| T41 | m.elecfans.com/article/2037888: $PRO_IP, parts of which have no value; excerpt only |
| T42 | m.elecfans.com/article/2078130: BRAKE; excerpt only |
| T43 | wxredian.com/art?id=437c338c679012684d4d9d393ecc8696: analogue outputs; excerpt only |
| T44 | m.elecfans.com/article/2097891: analogue outputs, from a manual; excerpt only |
| T45, T46 | m.elecfans.com/article/2063709: structures; asorrir.com/d/2369151.html: validity |
| T47 | husay.cn/a/202201/272043.html: block coincidence, running backwards; excerpt only |
| F1 to F4 | robot-forum.com on blending (14422), triggers (34556), axes (24428), REAL (35090) |
| F5 | blog.davidrobot.com, 2016: outputs and a counter watched on a controller |
| F6 | robot-forum.com on velocities in T1 (43227) |
| F7, F8 | robot-forum.com on characters (1548) and analogue outputs (44124) |
| F9, F10 | robot-forum.com on splines (22822) and on Status and Turn (42877) |
| D1 | 2,920 taught points of ten public repositories, 443 of them with machine data |
| D2 to D4 | programs in public repositories |
| X1 to X7 | pages of unknown or machine-written origin, named where they contradict |
| – | recollection only, or measured here |
"""


_SEARCHES = """\
## Searches

For each rule and clause that rested on recollection alone: what was looked for in November 2026,
and what was found.

| clause | looked for | found |
| --- | --- | --- |"""


def codes_of() -> Mapping[str, tuple[str, ...]]:
    """Return the codes of the findings that rest on each rule, by the rule's ID."""
    found: dict[str, tuple[str, ...]] = dict.fromkeys(registry(), ())
    for code in by_slug().values():
        for rule in code.rules:
            found[rule] += (code.code,)
    return found


def page() -> str:
    """Return the content of the page."""
    by_topic: dict[str, list[Rule]] = {topic: [] for topic in _TOPICS}
    codes = codes_of()
    for rule in registry().values():
        by_topic[rule.topic].append(rule)
    parts = [_HEAD, _overview(by_topic)]
    for topic, (title, about) in _TOPICS.items():
        rows = "\n".join(row for rule in by_topic[topic] for row in _rows(rule, codes[rule.id]))
        parts.append(
            f"## {title}\n\n{about}\n\n| rule | tier | | today | source |\n"
            f"| --- | --- | --- | --- | --- |\n{rows}\n"
        )
    found = [f"| {id_} | {one.wanted} | {one.found} |" for id_, one in searches().items()]
    return "\n".join([*parts, _SOURCES, _SEARCHES, *found, ""])


def _overview(by_topic: Mapping[str, Iterable[Rule]]) -> str:
    lines = [
        "| topic | | rules | unconfirmed | grammar or tables | checked or lint | only running |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    totals = [0] * 5
    for topic, its in by_topic.items():
        counts = list(_counts(list(its)))
        totals = [total + count for total, count in zip(totals, counts, strict=True)]
        title = _TOPICS[topic][0]
        anchor = title.lower().replace(",", "").replace(" ", "-")
        cells = " | ".join(map(str, counts))
        lines.append(f"| {topic} | [{title}](#{anchor}) | {cells} |")
    lines.append(f"| | all | {' | '.join(map(str, totals))} |")
    return "\n".join(lines) + "\n"


def _counts(its: list[Rule]) -> Iterator[int]:
    yield len(its)
    yield sum(not is_confirmed([rule.id]) for rule in its)
    yield sum(bool({"grammar", "tables"} & set(rule.today)) for rule in its)
    yield sum(bool({"check", "lint"} & set(rule.today)) for rule in its)
    yield sum(rule.today == ("run",) for rule in its)


def _rows(rule: Rule, codes: tuple[str, ...]) -> Iterator[str]:
    """Yield the row of a rule, then one for each clause."""
    yield _row(rule, codes)
    for one in rule.clauses:
        sure = "" if one.may_fail else "; fails no case"
        source = "–" if one.source == "-" else one.source
        yield f"| {one.id} | {one.tier} | {one.statement} | clause{sure} | {source} |"


def _row(rule: Rule, codes: tuple[str, ...]) -> str:
    words = []
    for word in rule.today:
        word_shown = _TODAY[word]
        if word in ("check", "lint"):
            wanted = [code for code in codes if code.startswith("KRL6") == (word == "lint")]
            word_shown += f" ({', '.join(wanted)})" if wanted else ""
        words.append(word_shown)
    source = "–" if rule.source == "-" else rule.source
    statement = rule.statement.replace("|", "\\|")
    return f"| {rule.id} | {rule.tier} | {statement} | {'; '.join(words)} | {source} |"


def tier_table() -> str:
    """Return the text of `TIERS`."""
    return "rule\ttier\n" + "".join(f"{one.id}\t{one.tier}\n" for one in registry().values())


if __name__ == "__main__":
    TIERS.write_text(tier_table(), encoding="utf-8", newline="\n")
    tiers.cache_clear()
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
