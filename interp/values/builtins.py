"""The predefined functions of KRL, and the names of those that need the controller.

`FUNCTIONS` are functions of numbers and poses, in the form of primitives that the machines have as
instructions. `BUILTINS` are all functions that only compute; `call` executes one of them. `WORLD`
are the others, which an executor passes to the controller as `interp.port.requests.Invoke`.

Angles are in degrees [FCT-02]. The functions of the C library compute in double precision, and the
result is rounded to single once. An angle is reduced to less than a full circle first, so that
large angles stay exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from grammar.semantics.predefined import PredefinedFunction, System
from grammar.semantics.types import (
    AXES,
    CARTESIAN,
    CHAR,
    Array,
    Enumeration,
    Scalar,
    Structure,
    Type,
)
from interp.values.faults import fault
from interp.values.formats import sread, swrite
from interp.values.geometric_operator import RADIAN, inverted, radians
from interp.values.operators import Kind, Primitive
from interp.values.predefined_values import word
from interp.values.texts import TEXTS, Outcome
from interp.values.values import (
    Value,
    converted,
    has_value,
    known,
    single,
    text_of,
)
from support.lazy_dataclass import dataclass

# ------------------------------------------------------------------------------- numbers


def _sqrt(number: float) -> float:
    if number < 0:
        raise fault("domain")
    return single(math.sqrt(number))


def _tan(degrees: float) -> float:
    if abs(math.fmod(degrees, 180.0)) == 90.0:
        raise fault("domain")
    return single(math.tan(radians(degrees)))


def _acos(cosine: float) -> float:
    if not -1 <= cosine <= 1:
        raise fault("domain")
    return single(math.acos(cosine) * RADIAN)


def _atan2(y: float, x: float) -> float:
    if x == 0 and y == 0:
        raise fault("domain")
    return single(math.atan2(y, x) * RADIAN)


def _function(
    name: str,
    function: Callable[..., Any],
    faults: str = "",
    operands: tuple[Kind, ...] = ("REAL",),
) -> Primitive:
    return Primitive(name, operands, "REAL", function, tuple(faults.split()))


#: Functions of numbers and poses, by their names in KRL.
FUNCTIONS: Mapping[str, Primitive] = MappingProxyType(
    {
        "ABS": _function("abs", abs),
        "SQRT": _function("sqrt", _sqrt, "domain"),
        "SIN": _function("sin", lambda a: single(math.sin(radians(a)))),
        "COS": _function("cos", lambda a: single(math.cos(radians(a)))),
        "TAN": _function("tan", _tan, "domain"),
        "ACOS": _function("acos", _acos, "domain"),
        "ATAN2": _function("atan2", _atan2, "domain", ("REAL", "REAL")),
        "INV_POS": Primitive(
            "inv_pos", ("FRAME",), "FRAME", inverted, ("uninitialised", "overflow")
        ),
    }
)


# ------------------------------------------------------------------------------- surroundings


class Randomness:
    """A random number generator that all executors share: Marsaglia's 32-bit xorshift.

    ``state`` is never 0; a seed of 0 is replaced by 1.
    """

    def __init__(self, seed: int = 1) -> None:
        self.state = seed & 0xFFFFFFFF or 1

    def __call__(self) -> float:
        """Return the next number in [0, 1), a multiple of 2**-32."""
        state = self.state
        state ^= state << 13 & 0xFFFFFFFF
        state ^= state >> 17
        state ^= state << 5 & 0xFFFFFFFF
        self.state = state
        return state / 2**32


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What predefined functions need from the executor that calls them.

    ``random`` returns a number in [0, 1). ``find`` returns the type and the value of a variable by
    its name as text (``"I"``, ``"F.X"``, ``"T[]"``), or ``None`` if it is not declared.
    """

    random: Callable[[], float]
    find: Callable[[str], tuple[Type, Value | None] | None]


def _frand(surroundings: Surroundings, least: float, most: float) -> Outcome:
    return single(least + (most - least) * surroundings.random()), {}


def _varstate(surroundings: Surroundings, name: Value) -> Outcome:
    """Return INITIALIZED if any part of the variable has a value [TYP-18]."""
    found = surroundings.find(text_of(name))
    if found is None:
        return word("VAR_STATE", "UNKNOWN"), {}
    return word("VAR_STATE", "INITIALIZED" if has_value(found[1]) else "DECLARED"), {}


def _vartype(surroundings: Surroundings, name: Value) -> Outcome:
    """Return the type of a variable; for an array that of its elements (unconfirmed) [TYP-18]."""
    found = surroundings.find(text_of(name))
    type_ = None if found is None else found[0]
    if isinstance(type_, Array):
        type_ = type_.element
    match type_:
        case Enumeration():
            kind = "ENUM"
        case Structure():
            kind = type_.name.upper() if type_.name.upper() in CARTESIAN | AXES else "STRUC"
        case Scalar(name=kind):
            pass
        case _:
            kind = "UNKNOWN"
    return word("VAR_TYPE", f"TYP_{kind}"), {}


# ------------------------------------------------------------------------------- all of them


@dataclass(frozen=True, slots=True)
class ComputingFunction:
    """A predefined function that only computes.

    One that ``uses_surroundings`` receives a `Surroundings` before its arguments.
    """

    declared: PredefinedFunction
    function: Callable[..., Outcome]
    uses_surroundings: bool


def _plain(function: Callable[..., Any]) -> Callable[..., Outcome]:
    return lambda *arguments: (function(*arguments), {})


_COMPUTING: Mapping[str, Callable[..., Outcome]] = {
    **{name: _plain(primitive.function) for name, primitive in FUNCTIONS.items()},
    **TEXTS,
    "SWRITE": swrite,
    "SREAD": sread,
}
_ASKING: Mapping[str, Callable[..., Outcome]] = {
    "FRAND": _frand,
    "VARSTATE": _varstate,
    "VARTYPE": _vartype,
}


#: All predefined functions that only compute, by their names in upper case.
BUILTINS: Mapping[str, ComputingFunction] = MappingProxyType(
    {
        name: ComputingFunction(System.load().functions[name], function, name in _ASKING)
        for name, function in sorted({**_COMPUTING, **_ASKING}.items())
    }
)

#: As how many statements functions and the operator ``:`` count. One is the time of an
#: ``I=I+1``, measured with texts of 80 letters on the bytecode machine in Python, where functions
#: take longest in comparison. All others take no longer than the statement they are in.
WEIGHTS: Mapping[str, int] = MappingProxyType(
    {
        ":": 64,
        "FRAND": 30,
        "INV_POS": 138,
        "SREAD": 160,
        "STRADD": 52,
        "STRCLEAR": 32,
        "STRCOMP": 52,
        "STRCOPY": 68,
        "STRDECLLEN": 26,
        "STRFIND": 62,
        "STRLEN": 40,
        "STRTOAXIS": 82,
        "STRTOBOOL": 24,
        "STRTOE3AXIS": 102,
        "STRTOE3POS": 124,
        "STRTOE6AXIS": 120,
        "STRTOE6POS": 124,
        "STRTOFRAME": 84,
        "STRTOINT": 24,
        "STRTOPOS": 92,
        "STRTOREAL": 28,
        "STRTOSTRING": 40,
        "SWRITE": 210,
        "VARSTATE": 28,
        "VARTYPE": 38,
    }
)

#: All predefined routines that need the controller. CAST_FROM and CAST_TO are among them because
#: no rule says how values are laid out in a buffer.
WORLD: frozenset[str] = frozenset(
    """
    ACTIVATE_FORCE_MODE ADVANCEDVECTORMOVEON CAL_TO_RDC CANCELPROGSYNC CAST_FROM CAST_TO CCLOSE
    CHECKPIDONRDC CHECK_MAM_ON_RDC CHG_KRL_BP CIOCTL CLEAR_KRLMSG CLR_ALL_KRL_BP CLR_KRL_BP COPEN
    COPY_MAM_HD_TO_RDC CREAD CREATE_RDC_ARCHIVE CWRITE DELETE_BACKWARD_BUFFER DELETE_PID_ON_RDC
    DELETE_RDC_CONTENT DIAG_START DIAG_STOP DISABLE_KRL_BP EB EB_ABS EK EMI_RECSTATE EMI_STARTPOS
    ENABLE_KRL_BP EO ERR_CLEAR ERR_RAISE EXISTS_KRLDLG EXISTS_KRLMSG FORWARD GETCYCDEF GETSYSSTATE
    GETVARSIZE GET_AXESMASK GET_BRAKETEST_TIME GET_DECL_PLACE GET_DIAGSTATE GET_MSGBUFFER
    GET_RDC_FS_STATE GET_SYSTEM_DATA INTERIMENERGY INVERSE IOCTL ISMESSAGESET IS_KEY_PRESSED LK
    MAXIMIZE_USEDXROBVERS MBX_REC MD_CMD MD_SETSTATE MOVE_BACKWARD MOVE_FORWARD PIDTORDC PULSE
    RDC_FILE_TO_HD REMOTECMD REMOTEREAD RESET_TORQUE_LIMITS RESTORE_RDC_ARCHIVE ROB_STOP
    ROB_STOP_RELEASE SET_BRAKE_DELAY SET_KRLDLG SET_KRLDLGANSWER SET_KRLMSG SET_KRL_BP SET_MAM_ON_HD
    SET_OPT_FILTER SET_SYSTEM_DATA SET_SYSTEM_DATA_DELAYED SET_TORQUE_LIMITS SET_USEDXROBVERS
    SUPPRESS_REPOSITIONING SYNC SYNCCMD TEST_BRAKE TIMER_LIMIT TOOL_ADJ VECTORMOVEOFF VECTORMOVEON
    VECTORMOVEZEROVELOCITY WSPACEGIVE WSPACETAKE
    """.split()
)


def call(name: str, arguments: Sequence[Value | None], surroundings: Surroundings) -> Outcome:
    """Execute a function of `BUILTINS` and return its result and the new values of its arguments.

    An omitted argument is ``None``. An argument passed :IN is converted to the parameter's type
    [ARI-04]. The arguments are not modified: the caller assigns the new values by the usual rules
    of assignment (a text to an array of CHAR, an INT to a REAL).

    Faults ``uninitialised`` if an argument has no value, ``argument`` if there are too few or too
    many arguments or one has the wrong type, and whatever the function faults.
    """
    builtin = BUILTINS[name.upper()]
    parameters = builtin.declared.parameters
    if not builtin.declared.takes(len(arguments)):
        raise fault("argument")
    given: list[Any] = [
        argument if parameter.is_out else _passed(parameter.type, argument)
        for parameter, argument in zip(parameters, arguments, strict=False)
    ]
    given += arguments[len(parameters) :]
    if builtin.uses_surroundings:
        given.insert(0, surroundings)
    return builtin.function(*given)


def reads_text(type_: Type) -> bool:
    """Return whether a function reads a text through a parameter :IN of this type [FCT-04].

    For such a parameter, an omitted array of CHAR is the empty text, and so is one that never had
    a value (unconfirmed: the message routines in backups of three independent controllers call
    STRLEN of an omitted parameter, and continue only if it is not 0).
    """
    return isinstance(type_, Array) and type_.element == CHAR and len(type_.sizes) == 1


def _passed(type_: Type, argument: Value | None) -> Value:
    """Return an argument passed :IN as the parameter's type; arrays are not converted."""
    value = known(argument)
    return value if isinstance(type_, Array) else converted(value, type_)
