"""SWRITE, SREAD and STRTO… in C leave in every variable what Python leaves there."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.executors import Prepared
from interp.native import AVAILABLE
from interp.port.requests import End, Fail
from interp.program.load import Limits, load

_DATA = """\
DEFDAT RUN
ENUM COLOUR RED, Green
DECL COLOUR E = #GREEN
INT I = {number}
REAL R = {real}
BOOL B = TRUE
CHAR C = "x"
INT UNSET
CHAR S[6]
S[] = "part"
CHAR G[2,9]
{variables}
ENDDAT
"""
#: What one call may change.
_VARIABLES = (
    "INT O{0} = {1}\nDECL STATE_T T{0}\nCHAR A{0}[12]\nA{0}[] = {2}\n"
    "INT I{0}\nREAL R{0}\nCHAR C{0}\n"
)

_LETTERS = st.text(st.sampled_from("abx %.-+#019eE,TRUE"), max_size=9)
_SPECIFICATIONS = st.builds(
    "%{}{}{}{}".format,
    st.text(st.sampled_from("-+#0"), max_size=2),
    st.sampled_from(["", "", "", "1", "4", "11", "2047", "2048", "12345"]),
    st.sampled_from(["", "", ".0", ".2", ".9", "."]),
    st.sampled_from("diuxefgcsX"),
)
_FORMATS = st.lists(_SPECIFICATIONS | _LETTERS | st.just("%%"), max_size=4).map("".join)
_SCANNED = st.lists(
    st.builds("%{}{}".format, st.sampled_from(["", "", "1", "3"]), st.sampled_from("diuxefgcs"))
    | st.sampled_from([" ", "x", "%%", "%.2f"]),
    max_size=4,
).map("".join)
_VALUES = st.lists(
    st.sampled_from(
        [
            "I",
            "R",
            "B",
            "C",
            "E",
            "S[]",
            "A{0}[]",
            "G[1,]",
            '"lit"',
            '"l"',
            "-I",
            "T{0}.HITS",
        ]
    ),
    max_size=4,
)
_PLACES = st.lists(
    st.sampled_from(["I{0}", "R{0}", "C{0}", "A{0}[]", "G[2,]", "O{0}", "T{0}.LENGTH", "B", "S[]"]),
    max_size=4,
)
_TEXTS = (
    st.sampled_from(
        [
            "12 3.5 abc",
            "0x1f -7 .5e1",
            "4294967295 1e39",
            " 2147483648",
            "-2147483648 TRUE x",
            "5.",
            "",
        ]
    )
    | _LETTERS
)
_NUMBERS = st.sampled_from([0, 1, -1, 65, 255, 256, 2147483647, -2147483647])
_REALS = st.floats(width=32, allow_nan=False, allow_infinity=False)
_OFFSETS = st.sampled_from([0, 0, 0, 1, 5, 12, 13, -1])


def _literal(text: str) -> str:
    return f'"{text}"' if text else '" "'


_CALLS = st.one_of(
    st.builds(
        lambda to, offset, form, values: (
            f"SWRITE({to}, T{{0}}, {offset}, {_literal(form)}{''.join(', ' + v for v in values)})"
        ),
        st.sampled_from(["A{0}[]", "A{0}[]", "S[]", "G[1,]", "T{0}.MSG_TXT[]"]),
        st.sampled_from(["O{0}", "O{0}", "O{0}", "UNSET", "T{0}.HITS", "0"]),
        _FORMATS,
        _VALUES,
    ),
    st.builds(
        lambda text, form, places: (
            f"SREAD({text}, T{{0}}, O{{0}}, {_literal(form)}{''.join(', ' + p for p in places)})"
        ),
        _TEXTS.map(_literal) | st.just("A{0}[]"),
        _SCANNED,
        _PLACES,
    ),
    st.builds(
        lambda name, text: f"B = STRTO{name[0]}({text}, {name[1]})",
        st.sampled_from([("INT", "I{0}"), ("REAL", "R{0}"), ("BOOL", "B"), ("STRING", "A{0}[]")]),
        _TEXTS.map(_literal) | st.just("A{0}[]"),
    ),
)


def _left(program: Prepared, executor: str) -> list[str]:
    """What is asked, how it ends, and the values of all variables then."""
    running: Any = program.executor(executor, Limits())
    asked = [running.advance()]
    while not isinstance(asked[-1], End | Fail):
        asked.append(running.advance())
    return [*map(repr, asked), repr(running.data())]


@pytest.mark.skipif(not AVAILABLE, reason="there is no machine in C")
@given(
    calls=st.lists(st.tuples(_CALLS, _OFFSETS, _TEXTS), min_size=4, max_size=8),
    number=_NUMBERS,
    real=_REALS,
)
@example(
    calls=[
        ('SWRITE(A{0}[], T{0}, O{0}, "%+08.3f|%s", R, E)', 0, ""),
        ('SREAD(A{0}[], T{0}, O{0}, "%d %f%2c", I{0}, R{0}, A{0}[])', 0, "7 1.5 ab"),
        ('SREAD("3.7", T{0}, O{0}, "%f", I{0})', 0, ""),
        ('SWRITE(A{0}[], T{0}, O{0}, "%s%s", A{0}[], A{0}[])', 1, "abc"),
    ],
    number=-1,
    real=-0.0,
)
@example(
    calls=[
        ('SWRITE(A{0}[], T{0}, O{0}, "%d%u%x%i", I, I, I, B)', 0, ""),
        ('SWRITE(A{0}[], T{0}, O{0}, "%.2d%.2u%#.2x", I, I, I)', 0, ""),
        ('SWRITE(A{0}[], T{0}, O{0}, "%e", R)', 0, ""),
        ('SWRITE(A{0}[], T{0}, O{0}, "%#g%-2c%.2s", R, C, S[])', 0, ""),
    ],
    number=7,
    real=1.5,
)
def test_as_in_python(calls: list[tuple[str, int, str]], number: int, real: float) -> None:
    """Values, faults, states and offsets are the same for any format, text and arguments."""
    variables = "".join(
        _VARIABLES.format(place, offset, _literal(text))
        for place, (_, offset, text) in enumerate(calls)
    )
    data = _DATA.format(number=number, real=f"{real:.9E}", variables=variables)
    lines = "".join(
        f"ON_ERROR_PROCEED\n{call.format(place)}\n" for place, (call, _, _) in enumerate(calls)
    )
    files = [Source(f"DEF RUN()\n{lines}END\n", "run.src"), Source(data, "run.dat")]
    program = Prepared(load(files, "run.src"))
    assert _left(program, "vm") == _left(program, "native")
