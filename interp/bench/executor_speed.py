"""Speed of the executors: kernels on each executor and in other languages; the cost of a request.

All do the same work, ``WORK(N)``, in several rounds. In each round they run one after the other,
and the fastest round counts, in processor time. N is determined with the tree interpreter; fast
executors repeat the work in a round. All results must be equal. What happens before the first
statement is measured separately.

The full trace is off, and a slice is a million statements, so that only computation is measured.
The cost of a request is measured separately.
"""

from __future__ import annotations

import gc
import math
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any, Final

from grammar.syntax.source import Source
from interp.bench.kernels import Kernel
from interp.executors import COMPILED, EXECUTORS, Prepared, available, is_available
from interp.native import AVAILABLE
from interp.port.requests import Crash, End, Fail, StopAdvance, Write
from interp.program.load import Limits, load
from interp.session import RunSetup, run_program
from interp.values.faults import LinkError

_LIMITS = Limits(statements=2**31 - 1, functions=2**31 - 1, per_slice=1_000_000)
#: The smallest time in s that the tree interpreter should need for the work of a kernel.
_LEAST = 0.05
_MOST: Final = 1_000_000  # as an amount
#: The number of repetitions of the work in a round for fast executors.
_REPEATS: Final = 200
_FAST: Final = frozenset({"native", COMPILED, "lua", "luajit", "c"})
_PATIENCE: Final = 600  # the longest time in s for a program in another language
#: The variable for the result of a kernel.
_RESULT = "$OV_PRO"
_REQUESTS = 20_000
#: The driver of a kernel, whose text follows it.
_MAIN: Final = f"""DEF KRL_BENCH()
   DECL INT ROUND, RESULT
   RESULT = 0
   FOR ROUND = 1 TO {{repeats}}
      RESULT = WORK({{amount}})
   ENDFOR
   {_RESULT} = RESULT
END
"""


class MeasurementError(Exception):
    """A kernel cannot be measured, or results differ; the text says which."""


def measure_executors(
    kernels: Sequence[Kernel],
    rounds: int,
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Measure kernels in rounds; ``on_step`` is called `steps` times.

    In the record, each of ``kernels`` has the ``amount`` N, and in ``ns`` the time of ``WORK(N)``
    on each executor in ns, ``None`` if it is not available. ``load_ms``, ``translate_ms`` and
    ``start_ms`` are the times to check the source, to compile and verify it, and to create each
    executor. ``vm_vs_tree`` and so on are geometric means of speed ratios. ``request_us`` is the
    time of a request that writes or reads in µs, including its reply, statement and loop.
    ``controlled_vs_bare`` is the ratio of the computing time of the machine in C and of native code
    under the controller to that without it.

    Raises `MeasurementError` if results differ or a kernel fails.
    """
    rows = []
    for kernel in kernels:
        try:
            rows.append(_measured(kernel, rounds))
        except (LinkError, MeasurementError, OSError, subprocess.SubprocessError) as error:
            raise MeasurementError(f"{kernel.name}: {error}") from error
        on_step()
    requests = {name: _request_cost(name, rounds) for name in available()}
    on_step()
    return {
        "rounds": rounds,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "lua": _version("lua"),
        "luajit": _version("luajit"),
        "native": AVAILABLE,
        "kernels": rows,
        "vm_vs_tree": _mean(rows, "tree", "vm"),
        "native_vs_tree": _mean(rows, "tree", "native"),
        "native_vs_vm": _mean(rows, "vm", "native"),
        "native_vs_lua": _mean(rows, "lua", "native"),
        "compiled_vs_native": _mean(rows, "native", COMPILED),
        "c_vs_compiled": _mean(rows, COMPILED, "c"),
        "request_us": requests,
        "controlled_vs_bare": {
            name: _controlled(name, rounds) for name in ("native", COMPILED) if is_available(name)
        },
    }


def steps(kernels: Sequence[Kernel]) -> int:
    """Return how many times `measure_executors` calls ``on_step``."""
    return len(kernels) + 1


# ------------------------------------------------------------------------------- kernels


@dataclass(frozen=True, slots=True)
class _Timed:
    """The seconds that the work took, and the result of the kernel."""

    seconds: float
    result: int


def _measured(kernel: Kernel, rounds: int) -> dict[str, Any]:
    """Return the row of a kernel."""
    amount = _amount(kernel)
    began = time.process_time()
    once = _prepared(kernel, amount, 1)
    loaded = time.process_time()
    _verified = once.verified  # compiles and verifies the program now
    translated = time.process_time()
    programs = {1: once, _REPEATS: _prepared(kernel, amount, _REPEATS)}
    start: dict[str, float] = {}
    best: dict[str, _Timed] = {}
    with tempfile.TemporaryDirectory(prefix="krl-bench-") as work:
        foreign = dict(_foreign(kernel, amount, Path(work)))
        for _ in range(rounds):
            for name in (*available(), *([COMPILED] if is_available(COMPILED) else [])):
                repeats = _repeats(name)
                seconds, timed = _run(programs[repeats], name, repeats)
                start[name] = min(seconds, start.get(name, math.inf))
                best[name] = _better(name, timed, best)
            for name, command in foreign.items():
                best[name] = _better(name, _run_foreign(name, command), best)
    results = {name: one.result for name, one in best.items()}
    if len(set(results.values())) > 1:
        raise MeasurementError(f"the results differ: {results}")
    return {
        "name": kernel.name,
        "amount": amount,
        "ns": {name: 1e9 * best[name].seconds if name in best else None for name in MEASURED},
        "load_ms": 1e3 * (loaded - began),
        "translate_ms": 1e3 * (translated - loaded),
        "start_ms": {name: 1e3 * seconds for name, seconds in start.items()},
    }


def _repeats(name: str) -> int:
    """Return the number of repetitions of the work in a round of an executor or language."""
    return _REPEATS if name in _FAST else 1


def _better(name: str, timed: _Timed, best: Mapping[str, _Timed]) -> _Timed:
    before = best.get(name, timed)
    if before.result != timed.result:
        raise MeasurementError(f"{name} gives {before.result}, then {timed.result}")
    return min(before, timed, key=lambda one: one.seconds)


def _amount(kernel: Kernel) -> int:
    """Return the first of 1, 2, 3, 4, 6, 9, … that takes `_LEAST`, or the last without a fault."""
    amount, working = 1, 0
    while amount <= _MOST:
        try:
            _, timed = _run(_prepared(kernel, amount, 1), "tree", 1)
        except MeasurementError:
            if working == 0:
                raise
            return working
        working = amount
        if timed.seconds >= _LEAST:
            break
        amount = max(amount + 1, amount * 3 // 2)
    return working


def _prepared(kernel: Kernel, amount: int, repeats: int) -> Prepared:
    """Return a program that repeats the work of a kernel."""
    source = _MAIN.format(repeats=repeats, amount=amount) + kernel.krl
    return Prepared(load([Source(source, "krl_bench.src")], "krl_bench.src"))


def _run(program: Prepared, executor: str, repeats: int) -> tuple[float, _Timed]:
    """Create an executor, and run a program that repeats the work.

    Return the seconds for the creation, and those for the work once with its result.
    """
    gc.collect()
    began = time.process_time()
    running = program.executor(executor, _LIMITS)
    ready, result = time.process_time(), 0
    request = running.advance()
    while not isinstance(request, End | Fail | Crash):
        if isinstance(request, Write):
            result = request.value
        request = running.advance(_REPEATS if isinstance(request, StopAdvance) else None)
    ended = time.process_time()
    if isinstance(request, Fail):
        line = request.at.line - _MAIN.count("\n")
        raise MeasurementError(f"{executor} stops at line {line}: {request.fault}")
    if isinstance(request, Crash):
        raise MeasurementError(f"{executor} fails: {request.reason}")
    return ready - began, _Timed((ended - ready) / repeats, result)


def _mean(rows: Sequence[Mapping[str, Any]], slow: str, fast: str) -> float | None:
    """Return the geometric mean of the speed ratios of two executors over all common kernels."""
    pairs = [(row["ns"][slow], row["ns"][fast]) for row in rows]
    ratios = [one / other for one, other in pairs if one and other]
    return math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else None


# ------------------------------------------------------------------------------- other languages

_IN_LUA = """
local work = assert(loadfile("{file}"))()
collectgarbage()
local began, result = os.clock(), 0
for _ = 1, {repeats} do
   result = work({amount})
end
print(string.format("%.9f %d", os.clock() - began, result))
"""
_IN_PYTHON = """
import runpy, time
work = runpy.run_path("{file}")["work"]
began = time.process_time()
result = work({amount})
print(time.process_time() - began, result)
"""
_IN_C = """
#include <stdio.h>
#include <time.h>
int work(int n);
int main(void)
{{
    int result = 0;
    clock_t began = clock();
    for (int i = 0; i < {repeats}; i++)
        result = work({amount});
    printf("%.9f %d\\n", (double)(clock() - began) / CLOCKS_PER_SEC, result);
    return 0;
}}
"""
#: The possible commands of other languages.
_COMMANDS: Final[Mapping[str, tuple[str, ...]]] = {
    "lua": ("lua5.4", "lua"),
    "luajit": ("luajit",),
    "c": ("cc", "gcc", "clang"),
}
#: What is measured: executors, if they are available, and languages, if they are installed.
MEASURED: Final = (*EXECUTORS, COMPILED, *_COMMANDS, "python")


def _foreign(kernel: Kernel, amount: int, work: Path) -> Iterator[tuple[str, list[str]]]:
    """Yield the commands that run the kernel in other languages and print seconds and result."""

    def driver(template: str, file: Path) -> str:
        return template.format(file=file.resolve().as_posix(), amount=amount, repeats=_REPEATS)

    for name in ("lua", "luajit"):
        if (command := _found(name)) and (file := kernel.beside(".lua")):
            yield name, [command, "-e", driver(_IN_LUA, file)]
    if (command := _found("c")) and (file := kernel.beside(".c")):
        main, made = work / "main.c", work / "kernel"
        main.write_text(driver(_IN_C, file), encoding="utf-8")
        _output([command, "-O2", str(main), str(file), "-o", str(made), "-lm"])
        yield "c", [str(made)]
    if file := kernel.beside(".py"):
        yield "python", [sys.executable, "-c", driver(_IN_PYTHON, file)]


def _run_foreign(name: str, command: Sequence[str]) -> _Timed:
    """Return the seconds for the work once in another language, and its result."""
    seconds, result = _output(command).split()
    return _Timed(max(float(seconds), 1e-9) / _repeats(name), int(result))


def _output(command: Sequence[str]) -> str:
    ended = subprocess.run(
        command, capture_output=True, encoding="utf-8", check=False, timeout=_PATIENCE
    )
    if ended.returncode:
        errors = ended.stderr.strip().splitlines()
        raise OSError(f"{Path(command[0]).name} says {errors[0] if errors else 'nothing'}")
    return ended.stdout


def _found(name: str) -> str | None:
    return next(filter(None, map(shutil.which, _COMMANDS[name])), None)


def _version(name: str) -> str | None:
    command = _found(name)
    return " ".join(_output([command, "-v"]).split()[:2]) if command else None


# ------------------------------------------------------------------------------- controller

#: The least time in s for the comparison of one executor with and without a controller.
_CONTROLLED = 5.0
#: The amounts of computing in its short and in its long run.
_COUNTS = (20, 220)
#: A program with a request every 400,000 statements.
_COMPUTING = f"""
DEF RUN()
   DECL INT I, K, SUM
   FOR I = 1 TO {{}}
      SUM = 0
      FOR K = 1 TO 200000
         SUM = SUM + K / 70
      ENDFOR
      {_RESULT} = 1
   ENDFOR
END
"""


def _controlled(executor: str, rounds: int) -> float:
    """Return the ratio of computing time in a run with a controller to that without one.

    Both are differences between a long and a short run, so that the start does not count. The
    fastest run counts, of at least ``rounds`` and in `_CONTROLLED` seconds.
    """
    programs = [_program(_COMPUTING.format(count)) for count in _COUNTS]
    limits = Limits(statements=_LIMITS.statements, functions=_LIMITS.functions)
    setup = RunSetup(executor=executor, is_traced=False, limits=limits)
    best = dict.fromkeys(product((0, 1), (False, True)), math.inf)
    begin, number = time.process_time(), 0
    while number < rounds or time.process_time() - begin < _CONTROLLED:
        number += 1
        for one, is_run in best:
            gc.collect()
            began = time.process_time()
            if is_run:
                ending = run_program(programs[one], setup).outcome.ending
                if ending != "end":
                    raise MeasurementError(f"{executor}: a run ends by {ending}")
                seconds = time.process_time() - began
            else:
                seconds = _run(programs[one], executor, 1)[1].seconds
            best[one, is_run] = min(seconds, best[one, is_run])
    return (best[1, True] - best[0, True]) / (best[1, False] - best[0, False])


# ------------------------------------------------------------------------------- requests

_WRITING = f"""
DEF RUN()
   DECL INT I
   FOR I = 1 TO {{}}
      {_RESULT} = I
   ENDFOR
END
"""
_READING = f"""
DEF RUN()
   DECL INT I, K
   FOR I = 1 TO {{}}
      K = {_RESULT}
   ENDFOR
END
"""


def _program(text: str) -> Prepared:
    return Prepared(load([Source(text.lstrip(), "run.src")], "run.src"))


def _request_cost(executor: str, rounds: int) -> dict[str, float]:
    """Return the µs of a request that writes and of one that reads, with their replies."""
    return {"write": _cost(_WRITING, executor, rounds), "read": _cost(_READING, executor, rounds)}


def _cost(text: str, executor: str, rounds: int) -> float:
    program = _program(text.format(_REQUESTS))
    best = math.inf
    for _ in range(rounds):
        running = program.executor(executor, _LIMITS)
        began = time.process_time()
        request = running.advance()
        while not isinstance(request, End | Fail | Crash):
            request = running.advance(1)
        best = min(best, time.process_time() - began)
        if not isinstance(request, End):
            raise MeasurementError(f"{executor}: {request}")
    return 1e6 * best / _REQUESTS
