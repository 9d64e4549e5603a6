"""A construct weighed: its evidence, its effect, and every reason to refuse it."""

from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, SetComment, Widen
from recovery.ledger.baseline import Corpora
from recovery.ledger.construct import Construct, Evidence
from recovery.ledger.evaluation import Evaluation, evaluate, losses
from recovery.ledger.ledger import grown
from recovery.negatives.negatives import Negative

START = g4.read_file(Path(g4.__file__).parents[1].joinpath("preliminary.g4"))
STEP = Construct(
    name="for-step",
    title="FOR … STEP",
    edits=(AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")),
    summary="A step.",
    evidence=Evidence(rules=("CTL-05",)),
    accept=("DEF A()\nFOR I=1 TO 9 STEP 2\nENDFOR\nEND\n",),
    reject=("DEF A()\nFOR I=1 TO 9 STEP=2\nENDFOR\nEND\n",),
)
LOOP = "FOR I=1 TO 9 STEP 2\nENDFOR\n"


def written(folder: Path, **files: str) -> Path:
    for name, text in files.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.with_suffix(".src").write_text(text, encoding="utf-8", newline="")
    return folder


def weighed(
    construct: Construct,
    evidence: Path | None = None,
    own: Path | None = None,
    negatives: tuple[Negative, ...] = (),
    generated: int = 0,
) -> Evaluation:
    roots = [evidence] if evidence else []
    corpora = Corpora(roots, own, negatives, generated=generated, jobs=1)
    after = grown(START, construct)
    return evaluate(construct, corpora.measure(START), corpora.measure(after))


def refusals(construct: Construct, **more: object) -> tuple[str, ...]:
    return weighed(construct, **more).refusals  # type: ignore[arg-type]


def edited(*edits: Edit, **changes: object) -> Construct:
    return replace(STEP, edits=edits, **changes)  # type: ignore[arg-type]


# ------------------------------------------------------------------------- what is measured


def test_evidence_and_effect_are_measured(tmp_path: Path) -> None:
    """Lines mended, files restored and read, our own programs; nothing speaks against it."""
    evidence = written(
        tmp_path / "open",
        o1__a=f"DEF A()\n{LOOP}END\n",
        o2__b=f"DEF B()\n{LOOP}{LOOP}WEAVE 7\nEND\n",
        o2__c="DEF C()\nEND\n",
    )
    own = written(
        tmp_path / "programs", cell__d=f"DEF D()\n{LOOP}END\n", cell__e="DEF E()\nWEAVE 7\nEND\n"
    )
    found = weighed(STEP, evidence, own)
    counts, effect = found.construct.evidence, found.construct.effect
    assert () == found.refusals
    assert found.is_counted
    assert (2, 2, 3) == (counts.files, counts.origins, counts.lines)
    assert effect is not None
    assert (3, 2, 1) == (effect.files, effect.parsed, effect.restores)
    sizes = {path.name: path.stat().st_size for path in evidence.rglob("*.src")}
    assert sum(sizes.values()) == effect.bytes
    assert sizes["a.src"] + sizes["c.src"] == effect.parsed_bytes
    assert (2, 1) == (effect.own_files, effect.own_parsed)
    assert (0, 0) == (effect.negatives, effect.ambiguities)
    assert effect.metrics["TERM"] > 0


def test_our_own_programs_are_no_evidence(tmp_path: Path) -> None:
    """Not where the evidence is looked for in a folder that holds them, and no copy of them."""
    own = written(tmp_path / "programs", a__d=f"DEF D()\n{LOOP}END\n", b__e=f"DEF E()\n{LOOP}END\n")
    written(tmp_path, another__d=f"DEF D()\n{LOOP}END\n")
    counts = weighed(STEP, tmp_path, own).construct.evidence
    assert (0, 0, 0) == (counts.files, counts.origins, counts.lines)


def test_without_a_corpus_the_figures_stay(tmp_path: Path) -> None:
    """Counts that were written stay as they are, and that is told."""
    old = Evidence(45, 12, 783, seen=("A/b.src:1",))
    found = weighed(replace(STEP, evidence=old), own=written(tmp_path, a="DEF A()\nEND\n"))
    assert (old, False) == (found.construct.evidence, found.is_counted)
    assert () == found.refusals


def test_the_state_follows_the_evidence(tmp_path: Path) -> None:
    """What is kept of evaluating a proposal: evidence, the state it gives, and no effect."""
    evidence = written(tmp_path, o1__a=f"DEF A()\n{LOOP}END\n", o2__b=f"DEF B()\n{LOOP}END\n")
    kept = weighed(replace(STEP, evidence=Evidence()), evidence).kept
    assert ("corroborated", None, 2) == (kept.state, kept.effect, kept.evidence.origins)
    accepted = weighed(replace(STEP, state="accepted"), evidence).kept
    assert "accepted" == accepted.state
    assert accepted.effect is not None


def test_second_readings_are_counted(tmp_path: Path) -> None:
    """In the accept examples, and in lines of any corpus that can now be read."""
    twice = edited(
        AddToken("STEP"),
        Insert("forStatement", (1, 7), "(STEP expression)? (STEP sum)?"),
        AddAlternative("simpleStatement", "STEP sum"),
    )
    evidence = written(tmp_path, o1__a=f"DEF A()\n{LOOP}END\n")
    for corpora in ((evidence, None), (None, evidence)):
        effect = weighed(twice, *corpora).construct.effect
        assert effect is not None
        assert 2 == effect.ambiguities


# ------------------------------------------------------------------------------ what refuses


@pytest.mark.parametrize("origins", [0, 1])
def test_without_a_ground_it_is_refused(origins: int, tmp_path: Path) -> None:
    """What at most one origin shows needs a rule, a manual or a verdict."""
    text = f"DEF A()\n{LOOP}END\n" if origins else "DEF A()\nEND\n"
    (why,) = refusals(replace(STEP, evidence=Evidence()), evidence=written(tmp_path, o__a=text))
    assert why.startswith(f"no ground: {'only one' if origins else 'no'} file shows it")


def test_what_the_oracle_refused_is_refused() -> None:
    """Whatever else speaks for it."""
    evidence = Evidence(9, 9, 9, ("CTL-05",), verdict="refused: KSS2023")
    assert ("the oracle refused it: KSS2023",) == refusals(replace(STEP, evidence=evidence))


def test_what_the_ledger_rejects_is_refused() -> None:
    """A rejected construct needs another state first."""
    (why,) = refusals(replace(STEP, state="rejected", summary="no"))
    assert why.startswith("the ledger rejects it")


def test_a_file_that_no_longer_parses_refuses(tmp_path: Path) -> None:
    """Other people's or our own; the place is named, and of many the first."""
    text = "DEF A()\nSTEP=1\nEND\n"
    (why,) = refusals(STEP, evidence=written(tmp_path / "open", o__a=text))
    assert "no longer parses: o/a.src:2, at 'STEP'" == why
    (why,) = refusals(STEP, own=written(tmp_path / "programs", cell__a=text))
    assert "no longer parses: cell/a.src:2, at 'STEP'" == why
    many = {f"o__p{n}": f"DEF P{n}()\nSTEP=1\nEND\n" for n in range(5)}
    *named, rest = refusals(STEP, evidence=written(tmp_path / "many", **many))
    assert (3, "no longer parse: 2 more files") == (len(named), rest)


def test_a_negative_that_is_accepted_refuses() -> None:
    """It is named with its reason; one that was accepted before does not count."""
    texts = ("DEF N()\nFOR I=1 TO 9 STEP 2\nENDFOR\nEND\n", "DEF N()\nX=1\nEND\n")
    new, old = (Negative(Path("corpus", f"{n}.src"), t, "so", "parse") for n, t in enumerate(texts))
    assert ("accepts a negative: corpus/0.src: so",) == refusals(STEP, negatives=(new, old))


def test_a_generated_negative_that_is_accepted_names_its_fact() -> None:
    """With the shortest program that breaks it, for the fact may be wrong."""
    wide = edited(
        AddAlternative("simpleStatement", "expression"),
        accept=("DEF A()\nX==1\nEND\n",),
        reject=("DEF A()\nX==\nEND\n",),
    )
    found = refusals(wide, generated=3_000)  # as many as a construct is tried by
    assert found
    assert all(why.startswith("accepts what breaks a fact") for why in found)
    assert any(": a line that begins with a variable gives it a value: DEF" in why for why in found)
    assert all("\n" not in why for why in found)


def test_a_keyword_that_is_still_a_name_cannot_be_judged() -> None:
    """A construct is blamed for a program once all keywords in it are reserved, not before."""
    text = "DEF N()\nFOR I=SWITCH TO 9 STEP 2\nENDFOR\nEND\n"
    negatives = (Negative(Path("n.src"), text, "so", "parse"),)
    assert () == refusals(STEP, negatives=negatives)
    reserved = replace(
        STEP, edits=(*STEP.edits, AddToken("SWITCH"), AddAlternative("primary", "SWITCH"))
    )
    assert ("accepts a negative: n.src: so",) == refusals(reserved, negatives=negatives)


def test_examples_are_tried() -> None:
    """There is one to accept, which is accepted, and what must be rejected is."""
    wrong = replace(STEP, accept=("DEF A()\nEND",), reject=STEP.accept)
    first, second, third = refusals(replace(wrong, accept=("DEF A()\nEND", "DEF A(\n")))
    assert "examples.accept: number 2 is not accepted" == first
    assert "examples.reject: number 1 is accepted" == second
    assert "examples.accept: number 1 is read the same way without the construct" == third


def test_what_is_not_said_refuses() -> None:
    """A summary, a program that shows it and one that stays rejected; blanks say nothing."""
    assert (
        "summary: does not say what it is",
        "examples.accept: there is no program that shows it",
        "examples.reject: there is no similar program that stays rejected",
    ) == refusals(replace(STEP, summary=" \n", accept=(), reject=()))


def test_an_example_may_show_another_reading() -> None:
    """What was accepted as something else before shows the construct as well."""
    word = edited(
        AddToken("ENABLE"),
        AddAlternative("primary", "ENABLE"),
        accept=("DEF A()\nX=ENABLE\nEND\n",),
        reject=("DEF A()\nENABLE=1\nEND\n",),
    )
    assert () == refusals(word)
    rule = edited(Widen("literal", (1, 1), "STRING STRING"), accept=("DEF A()\nX=1\nEND\n",))
    (why,) = refusals(replace(rule, reject=("DEF A(",)))
    assert "number 1 is read the same way" in why


def test_wording_needs_no_evidence() -> None:
    """Comments and layout may change without a ground and without an example."""
    words = edited(SetComment("literal", "What is written out."), evidence=Evidence(), accept=())
    assert () == refusals(replace(words, reject=()))
    assert 3 == len(refusals(edited(AddToken("X"), evidence=Evidence(), accept=(), reject=())))


def test_losses_are_between_any_two_grammars(tmp_path: Path) -> None:
    """What the first did rightly and the second does not; nothing the other way round."""
    own = written(tmp_path, cell__a=f"DEF A()\n{LOOP}END\n")
    corpora = Corpora([], own, [], generated=0, jobs=1)
    narrow, wide = corpora.measure(START), corpora.measure(grown(START, STEP))
    assert [] == list(losses(narrow, wide))
    assert ["no longer parses: cell/a.src:2, at 'STEP'"] == list(losses(wide, narrow))
