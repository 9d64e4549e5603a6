"""Native code of a program asks and tells what the machine does, and is kept."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from conformance.differential.campaign import world_seed
from conformance.differential.divergence import diverged, prepared
from conformance.differential.runs import EXECUTORS, trace_of
from grammar.generation.programs import seeded
from grammar.syntax.source import Source
from interp.bench.kernels import kernels_in
from interp.executors import Prepared, is_available
from interp.port.requests import End, Fail, Request, StopAdvance
from interp.program.load import Limits, load

pytestmark = pytest.mark.skipif(not is_available("compiled"), reason="there is no C compiler")

DEEP = """DEF RUN()
   $OV_PRO = DEPTH(1000)
END
DEFFCT INT DEPTH(N:IN)
   DECL INT N, K
   K = N
   IF N == 0 THEN
      RETURN 0
   ENDIF
   K = (N - N) + DEPTH(N - 1) + 1
   IF (K == 300) OR (K == 700) THEN
      $FLAG[1] = TRUE
   ENDIF
   RETURN K + N - N
ENDFCT
"""


COPIES = """DEF RUN()
   DECL FRAME P
   DECL INT I
   P = {X 1.5, Y 2.0, Z 3.0, A 0.0, B 0.0, C 0.0}
   FOR I = 1 TO 20
      $OV_PRO = I + MOVED(P, I)
   ENDFOR
   $OV_PRO = P.X * 2.0
END
DEFFCT INT MOVED(P:IN, N:IN)
   DECL FRAME P
   DECL INT N
   P.X = P.X + N
   RETURN P.X * P.Y
ENDFCT
"""


#: A parameter has a value in all calls, another is left out in one.
GIVEN = """DEF RUN()
   DECL INT I
   FOR I = 1 TO 30
      $OV_PRO = SUM(I)
   ENDFOR
END
DEFFCT INT SUM(I:IN)
   DECL INT I
   RETURN FIRST(I, I + 1, I) + FIRST(I, I)
ENDFCT
DEFFCT INT FIRST(N:IN, A:IN, B:IN)
   DECL INT N, A, B, K
   FOR K = 1 TO 3
      A = A + N
   ENDFOR
   IF N < 25 THEN
      RETURN A
   ENDIF
   RETURN A + B
ENDFCT
"""


#: Frames that together have more cells than there are.
WIDE = """DEF RUN()
   DECL INT L[9000]
   L[1] = 90
   $OV_PRO = DEPTH(L[1])
   L[1] = 300
   $OV_PRO = DEPTH(L[1])
END
DEFFCT INT DEPTH(N:IN)
   DECL INT N, L[9000]
   L[N + 1] = N
   IF N == 150 THEN
      $FLAG[1] = TRUE
   ENDIF
   IF N == 0 THEN
      RETURN 0
   ENDIF
   RETURN DEPTH(L[N + 1] - 1) + 1
ENDFCT
"""


FORMATS = 'K = 0\nSWRITE(S[], T, K, "%d", K)\n' * 6 + "K = 1\n" * 4


INDEXED = """DEF RUN()
   DECL INT I, J, K, L[2,3], S, M[2,3,2]
   FOR I = 1 TO 2
      FOR J = 1 TO 3
         L[I,J] = 10 * I + J
         FOR K = 1 TO 2
            M[I,J,K] = 5 * K
            M[I,J,K] = M[I,J,K] + L[1,J] - M[I,J,1+K/2]
         ENDFOR
      ENDFOR
   ENDFOR
   $OV_PRO = TOTAL(L[,], M[,,], 2, 3)
   L[1,2] = M[2,3,2] + M[1,1,1]
   $OV_PRO = TOTAL(L[,], M[,,], {rows}, {columns})
END
DEFFCT INT TOTAL(L[,]:OUT, M[,,]:OUT, ROWS:IN, COLUMNS:IN)
   DECL INT L[,], M[,,], ROWS, COLUMNS, R, C, S
   S = 0
   FOR R = 1 TO ROWS
      FOR C = 1 TO COLUMNS
         L[R,C] = L[R,C] + R
         S = S + L[R,C] * R + M[R,C,2] - L[ROWS,C+1-1]
      ENDFOR
   ENDFOR
   RETURN S
ENDFCT
"""


NEGATED = """DEF RUN()
   DECL INT I
   FOR I = 1 TO 3
      $OV_PRO = SIGN(I * 1.0E19)
   ENDFOR
END
DEFFCT INT SIGN(X:IN)
   DECL REAL X
   IF -(X * X) < 0.0 THEN
      RETURN 1
   ENDIF
   RETURN 2
ENDFCT
"""


@pytest.fixture(autouse=True, scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder of its own for what is kept."""
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        yield folder


def _requests(program: Prepared, executor: str, limits: Limits) -> list[Request]:
    running = program.executor(executor, limits)
    found: list[Request] = []
    while not found or not isinstance(found[-1], End | Fail):
        found.append(running.advance())
    return found


@pytest.mark.parametrize("text", [COPIES, DEEP], ids=["the caller", "what is called"])
def test_long_routines_are_not_compiled(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The interpreter runs them, whether they call what is compiled or are called by it."""
    from interp.native._core import Core
    from interp.native.c_backend import compiled

    monkeypatch.setattr(compiled, "_MOST_STEPS", 10)
    program = Prepared(load([Source(text, "run.src")], "run.src"))
    verified = program.verified
    core = Core(verified.image, verified.depths, 0, 0, None)
    source = compiled.source_of(verified.program, core)
    assert 1 == sum(f"void enter_{number}(" in source for number in range(2))
    limits = Limits(depth=1100)
    assert _requests(program, "vm", limits) == _requests(program, "compiled", limits)


@pytest.mark.parametrize("number", range(6))
def test_as_the_machine(number: int) -> None:
    """In a world that interferes, at random programs, every request and event is the same.

    With a trace the machine stops at every statement; without one it computes in between.
    """
    program = prepared(seeded(20, number).files)
    seed = world_seed(20, number)
    expected = trace_of(program, EXECUTORS["native"], seed)
    assert diverged(program, "compiled", expected, seed) is None
    assert not program.notes


@pytest.mark.parametrize("size", [1, 7, 1000])
@pytest.mark.parametrize("name", kernels_in())
def test_slices(name: str, size: int) -> None:
    """It stops for time to pass at the same statements, and goes on there."""
    text = f"DEF RUN()\n$OV_PRO = WORK(9)\nEND\n{kernels_in()[name].krl}"
    program = Prepared(load([Source(text, "run.src")], "run.src"))
    limits = Limits(statements=3000, per_slice=size)
    expected = repr(_requests(program, "native", limits))  # a budget that is exhausted is no value
    assert expected == repr(_requests(program, "compiled", limits))


@pytest.mark.parametrize("executor", ["vm", "native", "compiled"])
def test_stops_that_pass(executor: str) -> None:
    """So many stops of the advance run pass as the reply says; each begins a slice."""
    text = f"DEF RUN()\nCHAR S[9]\nINT K\nDECL STATE_T T\n{FORMATS}$OV_PRO = 1\nEND\n"
    program = Prepared(load([Source(text, "run.src")], "run.src"))
    running = program.executor(executor, Limits(per_slice=4))
    found = [running.advance()]
    while not isinstance(found[-1], End):
        found.append(running.advance(2 if isinstance(found[-1], StopAdvance) else None))
    kinds = [(type(one).__name__, getattr(one, "count", 0)) for one in found]
    stop, passed, time = ("StopAdvance", 1), ("StopAdvance", 2), ("Slice", 1)
    assert [stop, passed, stop, passed, time, ("Write", 0), ("End", 0)] == kinds


@pytest.mark.parametrize(("rows", "columns"), [(2, 3), (3, 1), (1, 4), (0, 0)])
def test_indices(rows: int, columns: int) -> None:
    """Elements of arrays and views by two and three indices are the same and fault the same."""
    text = INDEXED.format(rows=rows, columns=columns)
    program = Prepared(load([Source(text, "run.src")], "run.src"))
    expected = repr(_requests(program, "vm", Limits()))
    assert ("Fail" in expected) == (rows * columns > 2 and (rows, columns) != (2, 3))
    for executor in ("native", "compiled"):
        assert expected == repr(_requests(program, executor, Limits()))


@pytest.mark.parametrize(
    ("constants", "is_table"),
    [
        ([*range(9, 33), 5, 30, -6], True),
        (range(-(2**31), 24 - 2**31), True),
        (range(2**31 - 24, 2**31), True),
        (range(23), False),
        ([*range(40), 2000], False),
    ],
    ids=["gaps and one twice", "smallest", "largest", "few", "far apart"],
)
def test_constants_of_switch(constants: Sequence[int], is_table: bool) -> None:
    """Many constants that lie close together are a table; the first CASE of a number is taken."""
    from interp.native.c_backend.register_code import listing

    cases = "".join(f"CASE {one}\n$OV_PRO = {place}\n" for place, one in enumerate(constants, 1))
    selectors = {one + by for one in constants for by in (-1, 0, 1)} | {-(2**31), 2**31 - 1}
    calls = "".join(f"TRY({one})\n" for one in sorted(selectors) if -(2**31) <= one < 2**31)
    text = f"DEF RUN()\nINT K\n{calls}TRY(K)\nEND\nDEF TRY(N:IN)\nINT N\nSWITCH N\n{cases}"
    program = Prepared(load([Source(text + "ENDSWITCH\nEND\n", "run.src")], "run.src"))
    steps = listing(program.verified)
    assert is_table == any(" SWITCH " in line for line in steps)
    expected = repr(_requests(program, "tree", Limits()))
    for executor in ("vm", "native", "compiled"):
        assert expected == repr(_requests(program, executor, Limits()))


def test_calls_deeper_than_those_in_c() -> None:
    """Calls are as deep as the limits say, and stop and go on anywhere."""
    program = Prepared(load([Source(DEEP, "run.src")], "run.src"))
    for limits in (Limits(depth=2000, per_slice=13), Limits(depth=900, per_slice=13)):
        expected = _requests(program, "native", limits)
        assert expected == _requests(program, "compiled", limits)


@pytest.mark.parametrize(
    ("text", "ending"), [(COPIES, End), (GIVEN, Fail), (WIDE, Fail)], ids=["copied", "none", "wide"]
)
def test_what_calls_hand_over(text: str, ending: type[Request]) -> None:
    """A structure is copied, what has no value has none, and frames have so many cells at most."""
    program = Prepared(load([Source(text, "run.src")], "run.src"))
    for limits in (Limits(depth=300, per_slice=13), Limits(depth=300)):
        expected = _requests(program, "native", limits)
        assert isinstance(expected[-1], ending)
        assert repr(expected) == repr(_requests(program, "compiled", limits))
    assert not program.notes


def test_overflow_below_a_sign() -> None:
    """A product that is too large faults where all that is made of it is its sign."""
    program = Prepared(load([Source(NEGATED, "run.src")], "run.src"))
    expected = _requests(program, "native", Limits())
    assert isinstance(expected[-1], Fail)
    assert expected == _requests(program, "compiled", Limits())


def test_kept(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was compiled is not compiled again; without a compiler the machine runs the program."""
    program = Prepared(load([Source("DEF RUN()\n$OV_PRO = 7\nEND\n", "run.src")], "run.src"))
    program.executor("compiled", Limits())
    kept = set(cache.rglob("*.so"))
    program.executor("compiled", Limits())
    assert kept == set(cache.rglob("*.so"))
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    assert isinstance(_requests(program, "compiled", Limits())[-1], End)
    assert ["no native code: there is no C compiler; the machine in C runs the program"] == (
        program.notes
    )
