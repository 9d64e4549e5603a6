"""How fast the executors compute: kernels on each of them, beside Lua, and the cost of a request.

Each kernel runs on every executor for the time that it takes, the processor's time and not that of
the clock on the wall, and the best of some rounds counts. What is slow gets less to do; what is
compared is the time for a unit of work, so that amounts need not be the same. Every executor must
come to the same result where the amount is the same, and Lua to that of the machine in C.

The full trace is off and a slice is a million statements, so that nothing but computing is
measured; what a request costs is measured by itself.
"""

from __future__ import annotations

import gc
import math
import platform
import shutil
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from grammar.syntax.source import Source
from interp.bench.kernels import KERNELS, Kernel
from interp.executors import COMPILED, EXECUTORS, Prepared, available, is_available
from interp.native import AVAILABLE
from interp.port.requests import Crash, End, Fail, Write
from interp.program.load import Limits, load

__all__ = ["MEASURED", "MeasurementError", "measure_executors", "steps"]

#: What is measured; the machine in C where it was built, native code where there is a C compiler,
#: Lua where it is installed.
MEASURED: Final = (*EXECUTORS, COMPILED, "lua")
#: What gets the full amount of work.
_FAST: Final = frozenset({"native", COMPILED, "lua"})
ROUNDS = 3
_LIMITS = Limits(statements=2**31 - 1, per_slice=1_000_000)
_LUA = "lua5.4"
#: Where the result of a kernel goes.
_RESULT = "$OV_PRO"
_REQUESTS = 20_000


class MeasurementError(Exception):
    """Executors do not come to the same result; the message says which."""


def measure_executors(
    names: Sequence[str] = tuple(KERNELS),
    rounds: int = ROUNDS,
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Measure; ``on_step`` is called `steps` times. `KeyError` for a kernel that there is not.

    In the record, ``kernels`` have the nanoseconds for a unit of work on each executor, ``None``
    where there is none. ``vm_vs_tree``, ``native_vs_tree``, ``native_vs_vm``, ``native_vs_lua`` and
    ``compiled_vs_native`` are geometric means of how many times as fast the first is;
    ``request_us`` is what a request costs that writes or reads, from the instruction to behind the
    reply, in microseconds, with the statement and the loop around it.

    Raises `MeasurementError` where executors disagree.
    """
    rows = []
    for name in names:
        rows.append(_measured(KERNELS[name], rounds))
        on_step()
    requests = {name: _request_cost(name, rounds) for name in available()}
    on_step()
    return {
        "rounds": rounds,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "lua": _lua_version(),
        "native": AVAILABLE,
        "kernels": rows,
        "vm_vs_tree": _mean(rows, "tree", "vm"),
        "native_vs_tree": _mean(rows, "tree", "native"),
        "native_vs_vm": _mean(rows, "vm", "native"),
        "native_vs_lua": _mean(rows, "lua", "native"),
        "compiled_vs_native": _mean(rows, "native", COMPILED),
        "request_us": requests,
    }


def steps(names: Sequence[str] = tuple(KERNELS)) -> int:
    """How often `measure_executors` calls ``on_step``."""
    return len(names) + 1


# ------------------------------------------------------------------------------- kernels


def _measured(kernel: Kernel, rounds: int) -> dict[str, Any]:
    """Nanoseconds for a unit of work on each executor, and the amount that each was given."""
    few, many = _prepared(kernel, kernel.small), _prepared(kernel, kernel.full)
    timed, same_amount = {}, {}
    for name in (*available(), *([COMPILED] if is_available(COMPILED) else [])):
        same_amount[name] = _timed(few, name, 1 if name == "tree" else rounds)
        timed[name] = _timed(many, name, rounds) if name in _FAST else same_amount[name]
    lua = _timed_lua(kernel, rounds)
    if lua is not None:
        timed["lua"] = lua
    _check(kernel, same_amount)
    _check(kernel, {name: one for name, one in timed.items() if name in _FAST})
    amounts = {name: kernel.full if name in _FAST else kernel.small for name in timed}
    return {
        "name": kernel.name,
        "unit": kernel.unit,
        "amounts": amounts,
        "ns": {
            name: 1e9 * timed[name].seconds / kernel.work(amounts[name]) if name in timed else None
            for name in MEASURED
        },
    }


@dataclass(frozen=True, slots=True)
class _Timed:
    """The best of some runs, and what the kernel gave."""

    seconds: float
    result: int


def _prepared(kernel: Kernel, amount: int) -> Prepared:
    """A program that does so much work."""
    begin = f"DEF RUN()\n{_RESULT} = WORK({amount})\nEND\n"
    return Prepared(load([Source(begin + kernel.krl, "run.src")], "run.src"))


def _timed(program: Prepared, executor: str, rounds: int) -> _Timed:
    best, result = math.inf, 0
    for _ in range(rounds):
        running = program.executor(executor, _LIMITS)
        gc.collect()
        began = time.process_time()
        request = running.advance()
        while not isinstance(request, End | Fail | Crash):
            if isinstance(request, Write):
                result = request.value
            request = running.advance()
        best = min(best, time.process_time() - began)
        if not isinstance(request, End):
            raise MeasurementError(f"{executor}: {request}")
    return _Timed(best, result)


def _check(kernel: Kernel, timed: Mapping[str, _Timed]) -> None:
    """All have come to the same result."""
    results = {name: one.result for name, one in timed.items()}
    if len(set(results.values())) > 1:
        raise MeasurementError(f"{kernel.name}: the results differ: {results}")


def _mean(rows: Sequence[Mapping[str, Any]], slow: str, fast: str) -> float | None:
    """How many times as fast one is as the other: the geometric mean over all kernels."""
    pairs = [(row["ns"][slow], row["ns"][fast]) for row in rows]
    if not pairs or any(None in pair for pair in pairs):
        return None
    return math.exp(sum(math.log(one / other) for one, other in pairs) / len(pairs))


# ------------------------------------------------------------------------------- Lua

_LUA_DRIVER = """
local work = assert(load(io.read("a")))()
local best, result = math.huge, 0
for _ = 1, {rounds} do
   collectgarbage()
   local began = os.clock()
   result = work({amount})
   best = math.min(best, os.clock() - began)
end
print(string.format("%.9f %d", best, result))
"""


def _timed_lua(kernel: Kernel, rounds: int) -> _Timed | None:
    """The same in Lua, by the processor's time as well; ``None`` where it is not installed."""
    if shutil.which(_LUA) is None:
        return None
    driver = _LUA_DRIVER.format(rounds=rounds, amount=kernel.full)
    ended = subprocess.run(
        [_LUA, "-e", driver],
        input=kernel.lua,
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=600,
    )
    if ended.returncode:
        raise MeasurementError(f"{kernel.name}: {_LUA} says {ended.stderr.strip()}")
    seconds, result = ended.stdout.split()
    return _Timed(float(seconds), int(result))


def _lua_version() -> str | None:
    if shutil.which(_LUA) is None:
        return None
    told = subprocess.run([_LUA, "-v"], capture_output=True, encoding="utf-8", check=False)
    return " ".join(told.stdout.split()[:2])


# ------------------------------------------------------------------------------- requests

_WRITING = f"""
DEF RUN()
   DECL INT I
   FOR I = 1 TO {_REQUESTS}
      {_RESULT} = I
   ENDFOR
END
"""
_READING = f"""
DEF RUN()
   DECL INT I, K
   FOR I = 1 TO {_REQUESTS}
      K = {_RESULT}
   ENDFOR
END
"""


def _request_cost(executor: str, rounds: int) -> dict[str, float]:
    """Microseconds for a request that writes and one that reads, with their replies."""
    return {
        "write": _cost(_WRITING, executor, rounds),
        "read": _cost(_READING, executor, rounds),
    }


def _cost(text: str, executor: str, rounds: int) -> float:
    program = Prepared(load([Source(text.lstrip(), "run.src")], "run.src"))
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
