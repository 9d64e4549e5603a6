"""Damaged grammars, and how the tool does on them."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddAlternative
from grammar.parser.recognizer import Recognizer
from recovery.bench import repair_assessment
from recovery.bench.damaged_grammars import (
    DamagedGrammar,
    choose_damaged,
    combined,
    damaged_grammars,
)
from recovery.bench.repair_assessment import (
    Assessment,
    BenchMaterial,
    assess,
    assess_all,
    covering,
    figures,
)
from recovery.clustering.cause import Proposal
from recovery.clustering.cluster import Clusters, cluster

SMALL = g4.read("""grammar S;
options { caseInsensitive = true; }
program : DEF NAME '(' ')' eol statement* END eol* EOF ;
eol : NEWLINE+ ;
statement : (halt | wait | assignment) eol ;
halt : HALT ;
wait : WAIT FOR value | WAIT SEC value ;
assignment : NAME ('[' value ']')? '=' value ;
value : NAME | INTEGER | TRUE ;
DEF : 'DEF' ;
END : 'END' ;
FOR : 'FOR' ;
HALT : 'HALT' ;
SEC : 'SEC' ;
TRUE : 'TRUE' ;
WAIT : 'WAIT' ;
ASSIGN : '=' ;
LPAREN : '(' ;
RPAREN : ')' ;
LBRACKET : '[' ;
RBRACKET : ']' ;
NAME : [A-Z] [A-Z0-9]* ;
INTEGER : [0-9]+ ;
NEWLINE : '\\r'? '\\n' ;
SPACE : ' '+ -> skip ;
""")
PROGRAMS = [
    f"DEF P{n}()\nHALT\nWAIT FOR X{n}\nWAIT SEC {n}\nA[{n}]=TRUE\nB=C{n}\nEND\n" for n in range(6)
]


@pytest.fixture(scope="module")
def every() -> list[DamagedGrammar]:
    return list(damaged_grammars(SMALL))


@pytest.fixture(scope="module")
def material() -> BenchMaterial:
    """Return half of the programs and the covering ones as shown, the other half as held out."""
    shown = [*PROGRAMS[::2], *covering(SMALL)]
    numbered = tuple((f"program {n}", text) for n, text in enumerate(shown))
    return BenchMaterial(SMALL, numbered, tuple(PROGRAMS[1::2]), ())


def test_every_kind_of_part_is_taken_out(every: list[DamagedGrammar]) -> None:
    """Alternatives, optional parts and keywords each give some, and every one is a grammar."""
    kinds = Counter(damaged.kind for damaged in every)
    assert {"alternative", "optional part", "keyword"} <= set(kinds)
    assert all(g4.read(m.grammar.text) == m.grammar for m in every)


def test_a_damaged_grammar_lacks_something(every: list[DamagedGrammar]) -> None:
    """None reads every program that the whole grammar reads, but where a word is swallowed."""
    texts = [*PROGRAMS, *covering(SMALL)]
    blind = [m for m in every if all(map(Recognizer(m.grammar).accepts, texts))]
    assert all(m.keywords for m in blind)


def test_several_parts_are_of_different_rules(every: list[DamagedGrammar]) -> None:
    """Combined ones lack two or three parts and say so."""
    several = combined(every, SMALL, 10, seed=3)
    assert {m.parts for m in several} <= {2, 3}
    assert several == combined(every, SMALL, 10, seed=3)


def test_choosing_is_by_seed() -> None:
    """The same seed draws the same grammars."""
    assert choose_damaged(SMALL, 4, 2, 7) == choose_damaged(SMALL, 4, 2, 7)


def test_the_tool_finds_its_way_back(every: list[DamagedGrammar], material: BenchMaterial) -> None:
    """On this small grammar an alternative or part taken out is noticed and put back."""
    wanted = [m for m in every if m.kind == "alternative" and "halt" not in m.title(SMALL)]
    record = assess_all(material, wanted)
    assert record["detected"] == 1.0
    mended = [row for row in record["assessments"] if row["repair_rank"]]
    assert record["repair_top5"] == round(len(mended) / len(wanted), 4) >= 0.8
    assert record == {
        **assess_all(material, wanted),
        "seconds_per_mutant": record["seconds_per_mutant"],
    } | {"by_kind": record["by_kind"]}


def test_a_bench_goes_on_where_it_ended(
    every: list[DamagedGrammar], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was assessed is kept, and not assessed again; another grammar is."""
    material = BenchMaterial(SMALL, (("program", PROGRAMS[0]),), (), ())
    first = assess_all(material, every[:2], cache=tmp_path)
    asked: list[DamagedGrammar] = []

    def counted(*given: Any) -> Assessment:
        asked.append(given[0])
        return assess(*given)

    monkeypatch.setattr(repair_assessment, "assess", counted)
    assert first == assess_all(material, every[:2], cache=tmp_path)
    assess_all(material, every[:3], cache=tmp_path)
    assert every[2:3] == asked


def test_several_parts_are_ranked_by_how_deep_a_person_looks(
    every: list[DamagedGrammar], material: BenchMaterial, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The best of all clusters together are 1; else the deepest proposal that is needed counts.

    Without any that mends one of the clusters not everything can be read, and there is no rank.
    """
    chosen = [
        m
        for title in ("wait: without the alternative WAIT SEC", "assignment: without ('['")
        for m in every
        if title in m.title(SMALL)
    ]
    [damaged] = combined(chosen, SMALL, 1, seed=1)
    assert 2 == damaged.parts
    useless = Proposal((AddAlternative("halt", "HALT HALT"),), frozenset(), frozenset(), 0, 0)

    def rank_with(proposals: Callable[[tuple[Proposal, ...]], tuple[Proposal, ...]]) -> int | None:
        def changed(*args: Any, **named: Any) -> Clusters:
            found = cluster(*args, **named)
            last = found.ranked[-1]
            last = replace(last, proposals=proposals(last.proposals))
            return replace(found, ranked=(*found.ranked[:-1], last))

        monkeypatch.setattr(repair_assessment, "cluster", changed)
        return assess(damaged, material).repair_rank

    assert 1 == rank_with(lambda found: found)
    assert 3 == rank_with(lambda found: (useless, useless, found[0]))
    assert rank_with(lambda _: (useless,)) is None


def test_figures_count_ranks(every: list[DamagedGrammar]) -> None:
    """A rank within one or five counts; clusters are counted for each part taken out."""
    verdicts = [
        Assessment(every[0], True, 1, 4, None, 2, 0, (3,), 1.0),
        Assessment(every[1], False, None, None, None, 0, 0, (), 1.0),
    ]
    found = figures(verdicts, 10)
    assert (0.5, 0.5, 0.0, 0.5, 0.0) == (
        found["detected"],
        found["rule_top1"],
        found["item_top1"],
        found["item_top5"],
        found["repair_top5"],
    )
    assert (2, 3) == (found["clusters_per_cause"], found["reproducer_median_tokens"])
