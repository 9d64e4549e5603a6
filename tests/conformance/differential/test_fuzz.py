"""The fuzzer: executors that agree, wrong ones that are found, programs made small."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from conformance.differential import campaign, runs
from conformance.differential.campaign import fuzz, record_of
from conformance.differential.divergence import difference, diverged, prepared
from conformance.differential.random_world import RandomWorld
from conformance.differential.reduction import reduce_program, statement_count
from conformance.differential.runs import EXECUTORS, LIMITS, trace_of
from conformance.differential.traces import plain, shown
from conformance.suite import case
from grammar.generation.programs import seeded
from grammar.semantics.types import INT, Array
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.vm.executor import Machine
from interp.executors import Prepared, available
from interp.port.events import Sink
from interp.port.requests import At, Invoke, Poll, Read, Write
from interp.program.load import Limits
from interp.values.faults import Fault
from interp.values.values import ArrayValue
from krl.cli import main

AT = At("PROG.SRC", 1, 0)


@pytest.fixture
def wrong(monkeypatch: pytest.MonkeyPatch) -> Callable[[Op, Op], None]:
    """Has an instruction of the machine in Python do what another one does."""

    def planted(op: Op, other: Op) -> None:
        def made(program: Prepared, limits: Limits, sink: Sink) -> Machine:
            machine = Machine(program.verified, program.start, limits, sink)
            rules = machine._threaded._rules
            machine._threaded._rules = {**rules, op: rules[other]}
            return machine

        monkeypatch.setitem(runs.EXECUTORS, "vm", made)

    return planted


# ------------------------------------------------------------------------------- agreement


def test_executors_agree() -> None:
    """All executors that there are ask and tell the same."""
    found = fuzz(12, 21, available())
    assert [] == [(one.number, one.difference.executor) for one in found.findings]
    assert 12 == sum(found.ends.values())


def test_the_reference_agrees_with_itself() -> None:
    """A run follows from the program and the seed of its world alone."""
    program = prepared(seeded(22, 3).files)
    assert trace_of(program, EXECUTORS["tree"], "w") == trace_of(program, EXECUTORS["tree"], "w")


def test_findings_do_not_depend_on_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two processes find what one finds."""
    monkeypatch.setattr(campaign, "_SHARD", 2)
    alone, shared = (record_of(fuzz(3, 23, ["tree"], jobs), 0.0) for jobs in (1, 2))
    assert alone == shared


# ------------------------------------------------------------------------------- reduction


def test_reduction_keeps_what_holds() -> None:
    """Lines, blocks, branches, files and operands go as long as the fact stays true."""
    main_text = "\n".join(
        [
            "DEF PROG()",
            "INT I,J",
            "I=1",
            "WHILE I<10",
            "  IF I==3 THEN",
            "    J=(I+7)*(2+3)",
            "  ELSE",
            "    J=2",
            "  ENDIF",
            "  I=I+1",
            "ENDWHILE",
            "HALT",
            "END",
            "DEF OTHER()",
            "HALT",
            "END",
            "",
        ]
    )
    files = (("PROG.SRC", main_text), ("PROG.DAT", "DEFDAT PROG\nINT K=1\nENDDAT\n"))
    found = reduce_program(files, lambda given: "I+7" in given[0][1] and _loads(given))
    assert (("PROG.SRC", "DEF PROG()\n    J=I+7\nEND\n"),) == found.files
    assert 1 == found.statements == statement_count(found.files)


def _loads(files: Any) -> bool:
    return campaign.loaded(files) is not None


def test_difference_has_the_first_fact() -> None:
    """The first fact that differs is shown, or that there is none on one side."""
    left, right = [("line", AT), ("call", AT, "A")], [("line", AT), ("call", AT, "B")]
    found = difference("vm", left, right)
    assert found is not None
    assert (1, "PROG.SRC:1 (depth 0) call 'A'") == (found.place, found.expected_text)
    short = difference("vm", left, left[:1])
    assert short is not None
    assert "nothing more" == short.actual_text
    assert difference("vm", left, list(left)) is None


# ------------------------------------------------------------------------------- facts


def test_values_of_different_types_differ() -> None:
    """1, 1.0 and TRUE are three values, and -0.0 is not 0.0."""
    values = [plain(one) for one in (1, 1.0, True, "1", 0.0, -0.0, None)]
    assert len(values) == len({repr(one) for one in values})
    assert all(one != other for n, one in enumerate(values) for other in values[:n])
    array = ArrayValue(Array(INT, (2,)), [1, None])
    assert ("ARRAY", (2,), (1, None)) == plain(array)
    assert "PROG.SRC:1 (depth 0) assign ('A') ('ARRAY' (2) (1 -))" == shown(
        ("assign", AT, ("A",), plain(array))
    )


# ------------------------------------------------------------------------------- the world


def test_world_keeps_what_is_written() -> None:
    """Members and elements keep their values; the rest has some from the seed."""
    world = RandomWorld("x", has_faults=False)
    assert None is world.reply(Write(AT, ("$BASE", "X"), 7.5))
    assert 7.5 == world.reply(Read(AT, ("$BASE", "X")))
    assert 7.5 == world.reply(Read(AT, ("$BASE",))).get("X")
    assert None is world.reply(Write(AT, ("$OUT", 4), True))
    assert True is world.reply(Read(AT, ("$OUT", 4)))
    answer = world.reply(Read(AT, ("$OUT", 99_999)))
    assert isinstance(answer, Fault)
    assert "index" == answer.slug


def test_no_wait_is_endless() -> None:
    """After some looks in vain every input is TRUE."""
    world = RandomWorld("x", has_faults=False)
    for _ in range(4):
        world.reply(Poll(AT, is_first=False))
    assert [True] * 20 == [world.read(("$IN", number)) for number in range(1, 21)]


def test_world_answers_routines() -> None:
    """A routine of the world has a result, and values for what is passed :OUT."""
    world = RandomWorld("x", has_faults=False)
    result, after = world.reply(Invoke(AT, "EXISTS_KRLDLG", (1, None)))
    assert isinstance(result, bool)
    assert isinstance(after[1], int)


def test_world_faults_now_and_then() -> None:
    """Some requests are answered by a fault, always the same ones for a seed."""
    request = Write(AT, ("$FLAG", 1), True)
    first, second = RandomWorld("y"), RandomWorld("y")
    answers = [first.reply(request) for _ in range(2000)]
    assert answers == [second.reply(request) for _ in range(2000)]
    assert 2 <= sum(isinstance(one, Fault) for one in answers) <= 30


def test_interference_is_compared() -> None:
    """Conditions are looked at, actions entered, and RESUME unwinds, on some programs."""
    wanted = {"evaluated", "entered"}
    for number in range(90):
        program = prepared(seeded(31, number).files)
        facts = trace_of(program, EXECUTORS["tree"], campaign.world_seed(31, number))
        wanted -= {str(one[0]) for one in facts}
        if not wanted:
            break
    assert set() == wanted


def test_executor_that_raises_is_a_finding() -> None:
    """An exception of an executor is a fact, and so a difference."""

    def broken(_program: Prepared, _limits: object, _sink: object) -> Any:
        raise RuntimeError("broken")

    program = prepared(seeded(1, 1).files)
    assert [("raised", None, "RuntimeError", "broken")] == trace_of(program, broken, "x", LIMITS)


# ------------------------------------------------------------------------------- the command


def test_a_program_that_the_check_refuses_ends_no_campaign(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is counted by itself, and the others run."""

    def made(seed: int, number: int) -> Any:
        refused = SimpleNamespace(files=(("main.src", "DEF MAIN()\nX=\nEND\n"),))
        return refused if number == 1 else seeded(seed, number)

    monkeypatch.setattr(campaign, "seeded", made)
    found = fuzz(3, 1, ["tree", "vm"])
    assert (1, 3, []) == (found.ends["LinkError"], found.ends.total(), found.findings)


def test_time_that_is_up_ends_a_campaign(monkeypatch: pytest.MonkeyPatch) -> None:
    """What has begun is finished and reported as if no more had been asked for."""
    expected = record_of(fuzz(4, 5, ["tree"]), 0.0)
    monkeypatch.setattr(campaign, "_SHARD", 2)
    clock = iter([0.0, 0.0, 59.0, 61.0])
    monkeypatch.setattr(campaign, "time", SimpleNamespace(monotonic=lambda: next(clock)))
    assert expected == record_of(fuzz(100, 5, ["tree"], minutes=1.0), 0.0)


def test_command_without_difference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exit status 0, and a record with what was covered, rules by their cases."""
    known = [case.read_case(case.CASES / "control/if_else.src")]
    monkeypatch.setattr(case, "find_cases", lambda: known)
    target = tmp_path / "fuzz.json"
    arguments = ["fuzz", "--programs", "2", "--seed", "5", "--jobs", "1", "--json", str(target)]
    assert 0 == main(arguments)
    record = json.loads(target.read_text(encoding="utf-8"))
    assert (2, 5, list(available())) == (record["programs"], record["seed"], record["executors"])
    assert record["coverage"]["node"]["Assignment"] > 5
    assert [] == record["differences"]
    assert [known[0].basis] == [*record["rules"]]
    assert "No difference." in capsys.readouterr().out


def test_command_with_differences(
    wrong: Callable[[Op, Op], None],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Exit status 1; a program is made small and shown with what both sides, still apart, did."""
    wrong(Op.MUL_INT, Op.ADD_INT)
    monkeypatch.setattr(campaign, "_MOST_REDUCED", 1)
    monkeypatch.setattr(case, "find_cases", list)
    target = tmp_path / "fuzz.json"
    arguments = [*"fuzz --programs 4 --seed 6 --jobs 1 --json".split(), str(target)]
    assert 1 == main([*arguments, "--executor", "tree", "--executor", "vm"])
    first = json.loads(target.read_text(encoding="utf-8"))["differences"][0]
    assert "vm" == first["executor"]
    assert first["statements"] <= 10
    assert first["expected"] != first["actual"]
    assert "*" in "".join(first["files"].values())
    program = prepared(tuple(first["files"].items()))
    worlds = (campaign.world_seed(6, first["program"], n) for n in range(campaign._SEEDS))
    assert any(
        diverged(program, "vm", trace_of(program, EXECUTORS["tree"], world), world)
        for world in worlds
    )
    out = capsys.readouterr().out
    assert first["expected"] in out
    assert "reduced to" in out
