"""Generated negatives: many, distinct, short, and invalid under any grammar."""

import os
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grammar.notation.g4 import read_file
from grammar.parser.recognizer import Recognizer
from recovery.negatives.fragments import fragment_pool
from recovery.negatives.generate import evenly, generate
from recovery.negatives.language_facts import adjacent, violation
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.negatives.tokens import lines
from support.files.decode import Decoded, decode

ROOT = Path(__file__).parents[3]


def own_programs() -> list[str]:
    """The texts of the own corpus, in a fixed order."""
    paths = sorted((ROOT / "corpus" / "programs").rglob("*"))
    sources = [
        decode(p.read_bytes()) for p in paths if p.suffix.lower() in (".src", ".dat", ".sub")
    ]
    return [source.text for source in sources if isinstance(source, Decoded)]


@pytest.fixture(scope="module")
def negatives() -> tuple[Negative, ...]:
    return tuple(generate(own_programs(), count=5_000, seed=1))


@pytest.fixture(scope="module")
def permissive() -> Recognizer:
    return Recognizer(read_file(Path(__file__).with_name("permissive.g4")))


def test_there_are_as_many_as_wanted_and_all_differ(negatives: tuple[Negative, ...]) -> None:
    """5,000 programs come, no two with the same tokens, none longer than 15 lines."""
    tokens = {
        tuple(tuple(token.word for token in line.tokens) for line in lines(negative.text))
        for negative in negatives
    }
    assert 5_000 == len(negatives)
    assert 5_000 == len(tokens)
    assert max(negative.text.count("\n") for negative in negatives) <= 15


def test_each_breaks_the_fact_it_gives_as_its_reason(negatives: tuple[Negative, ...]) -> None:
    """Reason and line of a generated negative are a fact it breaks, and it is for the grammar."""
    for negative in negatives[::7]:
        found = violation(negative.text)
        assert found is not None
        assert (found.fact, found.line) == (negative.reason, negative.line)
        assert (None, "parse") == (negative.path, negative.phase)


def test_a_generous_grammar_takes_every_program_and_no_negative(
    negatives: tuple[Negative, ...], permissive: Recognizer
) -> None:
    """A grammar that shares nothing with the facts and takes the own corpus rejects all of them."""
    assert [] == [text for text in own_programs() if not permissive.accepts(text)]
    assert [] == NegativeSet(negatives).accepted(permissive)


def test_the_grammar_in_force_accepts_none(negatives: tuple[Negative, ...]) -> None:
    """What is invalid under any grammar is invalid under ours."""
    recognizer = Recognizer(read_file(ROOT / "grammar" / "KRL.g4"))
    assert [] == NegativeSet(negatives).accepted(recognizer)


def test_reasons_are_spread(negatives: tuple[Negative, ...]) -> None:
    """No reason stands for more than a fifth, and those the grammar's growth hangs on all occur."""
    reasons = Counter(negative.reason for negative in negatives)
    assert max(reasons.values()) < 1_000
    wanted = """THEN ends the line of IF
FOR has TO
FOR or SEC follows WAIT
TRIGGER has DO
WHEN follows TRIGGER
INTERRUPT DECL has WHEN and then DO
an expression has no equals sign
an expression is no statement
two operands have an operator between them
a bracket is closed on its line
nothing follows this word on its line
nothing stands outside of routines and data lists
SWITCH is followed by its first CASE
ELSE stands once, in an IF
a predefined type is no operand"""
    # as many as an inference draws: of 5,000 the rarest are a few, and how many is chance
    often = Counter(one.reason for one in generate(own_programs(), count=10_000, seed=1))
    assert [] == [reason for reason in wanted.splitlines() if often[reason] < 3]


def test_every_row_of_the_table_gives_a_reason(negatives: tuple[Negative, ...]) -> None:
    """Each reason of the table of neighbours is the reason of some negative."""
    assert set() == set(adjacent().values()) - {negative.reason for negative in negatives}


def test_reasons_are_drawn_evenly(negatives: tuple[Negative, ...]) -> None:
    """Of each reason as many come as there are, up to a bound that is the same for all."""
    every = Counter(n.reason for n in negatives)
    drawn = Counter(n.reason for n in evenly(negatives, 1_000))
    assert 1_000 == drawn.total()
    most = max(drawn.values())
    assert [] == [r for r in every if drawn[r] < min(every[r], most - 1)]


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32), count=st.integers(0, 60))
def test_a_seed_gives_the_same_programs(seed: int, count: int) -> None:
    """The same seed gives the same programs; fewer are the beginning of more."""
    programs = ["DEF A()\n  OTHER_CALL(1)\nEND\n"]
    some = list(generate(programs, count=count, seed=seed))
    more = list(generate(programs, count=count + 5, seed=seed))
    assert count == len(some)
    assert some == more[:count]


def test_another_process_gives_the_same_programs() -> None:
    """The order of sets, which differs between processes, has no part in what comes."""
    script = (
        "import hashlib; from recovery.negatives.generate import generate;"
        "texts = ''.join(n.text for n in generate(count=300, seed=7));"
        "print(hashlib.sha256(texts.encode()).hexdigest())"
    )
    digests = {
        subprocess.run(
            [sys.executable, "-c", script],
            env=os.environ | {"PYTHONHASHSEED": seed},
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert 1 == len(digests)


def test_it_works_without_programs() -> None:
    """The built-in pieces alone are enough for thousands, and are valid themselves."""
    assert 3_000 == len({n.text for n in generate(count=3_000, seed=3)})


def test_pieces_of_the_programs_are_used() -> None:
    """Statements and blocks of the caller's programs turn up, their comments do not."""
    text = """DEF A()
  IF RARE_NAME THEN ; a comment
    LOOP
      RARE_CALL(1, 2, 3, 4, 5, 6, 7, 8, 9)
    ENDLOOP
  ENDIF
END
"""
    found = "".join(n.text for n in generate([text], count=2_000, seed=4))
    assert "    LOOP\n      RARE_CALL(1, 2, 3, 4, 5, 6, 7, 8, 9)\n    ENDLOOP\n" in found
    assert "IF RARE_NAME THEN\n" in found
    assert "comment" not in found


def test_invalid_programs_are_no_source_of_pieces() -> None:
    """A text that breaks a fact itself is left aside."""
    text = "DEF A()\n  IF RARE_NAME\n  RARE_CALL()\n  ENDIF\nEND\n"
    assert fragment_pool([text]) == fragment_pool([])


def test_programs_put_together_are_valid(permissive: Recognizer) -> None:
    """Before something in them is spoilt, the programs are programs."""
    stock, chance = fragment_pool(own_programs()), random.Random(5)
    texts = ["\n".join(stock.program(chance)) + "\n" for _ in range(1_000)]
    assert [] == [text for text in texts if violation(text)]
    assert [] == [text for text in texts if not permissive.accepts(text)]
