"""Clusters held against the constructs that answer their failures."""

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddAlternative, apply
from grammar.notation.model import Grammar
from recovery.bench.cause_agreement import agreement, answers, measured
from recovery.clustering.cluster import cluster
from recovery.survey.survey import Survey, survey

START = g4.read("""grammar S;
options { caseInsensitive = true; }
program : DEF NAME '(' ')' eol line* END eol* EOF ;
eol : NEWLINE+ ;
line : (HALT | WAIT NAME) eol ;
DEF : 'DEF' ;
END : 'END' ;
HALT : 'HALT' ;
RETURN : 'RETURN' ;
WAIT : 'WAIT' ;
LPAREN : '(' ;
RPAREN : ')' ;
NAME : [A-Z] [A-Z0-9]* ;
INTEGER : [0-9]+ ;
NEWLINE : '\\r'? '\\n' ;
SPACE : ' '+ -> skip ;
""")
NAMES = ("waits", "returns")


@pytest.fixture(scope="module")
def grammars() -> list[Grammar]:
    waits = apply(START, [AddAlternative("line", "WAIT INTEGER eol")])
    return [START, waits, apply(waits, [AddAlternative("line", "RETURN eol")])]


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Survey:
    """Two origins: lines that wait for a number, that return, and that nothing answers."""
    folder = tmp_path_factory.mktemp("corpus")
    for origin, lines in (("a", "WAIT 1\nRETURN\n"), ("b", "WAIT 2\nHALT 3\n")):
        path = folder / origin / "p.src"
        path.parent.mkdir()
        path.write_text(f"DEF P()\n{lines}END\n", encoding="ascii")
    return survey([folder], START, jobs=1)


def test_a_failure_is_answered_from_the_grammar_that_reads_past_it(
    found: Survey, grammars: list[Grammar]
) -> None:
    """What the last grammar cannot read is answered by none."""
    lines = {
        (file.digest, index): failed.source.strip()
        for file in found.files
        for index, failed in enumerate(file.failures)
    }
    said = {lines[key]: number for key, number in answers(found, grammars).items()}
    assert {"WAIT 1": 1, "WAIT 2": 1, "RETURN": 2} == said


def test_a_cluster_for_each_construct_is_in_full_agreement(
    found: Survey, grammars: list[Grammar]
) -> None:
    """Two clusters for two constructs; where one stands for both, the smaller one is hidden."""
    answered = answers(found, grammars)
    apart = agreement(cluster(found), answered, NAMES)
    assert (2, 1.0, 1.0, []) == tuple(
        apart[name] for name in ("clusters", "clusters_per_construct", "purity", "hidden")
    )
    clusters = cluster(found)
    merged = dict.fromkeys(clusters.cluster_of, clusters.ranked[0].id)
    clusters.cluster_of.update(merged)
    mixed = agreement(clusters, answered, NAMES)
    assert (1, 0.6667, ["returns"]) == (mixed["clusters"], mixed["purity"], mixed["hidden"])


def test_halves_have_half_of_the_origins(found: Survey, grammars: list[Grammar]) -> None:
    """The whole comes first; the same seed draws the same halves."""
    rows = list(measured(found, grammars, NAMES, (), 2, 7))
    assert [("all", 2), ("half 1", 1), ("half 2", 1)] == [(r["part"], r["files"]) for r in rows]
    assert rows == list(measured(found, grammars, NAMES, (), 2, 7))
