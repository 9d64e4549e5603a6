"""Statements whose effect no rule of KRL states: executors must agree on them all the same."""

from __future__ import annotations

from typing import Final

from grammar.generation.expressions import array, constant, read, target
from grammar.generation.routine_writer import RoutineWriter
from grammar.generation.types import STATE, TEXT
from grammar.semantics.types import INT

#: First value, last value and step of a FOR whose counter leaves the range of INT.
_BEYOND: Final = (
    ("2147483646", "2147483647", ""),
    ("2147483645", "2147483647", " STEP 3"),
    ("-2147483647", "-2147483647-1", " STEP -1"),
    ("-2147483646", "-2147483647-1", " STEP -5"),
)


def order_of_evaluation(code: RoutineWriter) -> bool:
    """Write a sum, an index or arguments whose parts change what the others read."""
    place, text = target(code, INT), array(code, TEXT)
    if place is None or not text:
        return False
    choices = code.choices
    parts = [f"STRLEN({text})", f"STRADD({text}, {constant(code, TEXT)})", f"STRLEN({text})"]
    changing = [
        one
        for one in code.scope.callable(INT, code.left() - 2)
        if len(one.parameters) == 1 and one.parameters[0].is_out and one.parameters[0].type == INT
    ]
    if changing:
        code.spend(changing[0].cost)
        parts += [f"{changing[0].name}({place})", place]
    drawn = [choices.pick(parts) for _ in range(choices.between(2, 3))]
    code.spend()
    match choices.below(3):
        case 0:
            return code.set(place, " ".join("+" + one for one in drawn)[1:])
        case 1:
            return code.set(place, f"STRFIND({drawn[0]}, {text}, {text}, #CASE_SENS)-{drawn[1]}")
    row = read(code, INT)
    if row is None or "[" not in row:
        return code.set(place, f"({drawn[0]}) B_EXOR ({drawn[1]})")
    name, _, rest = row.partition("[")
    _, *others = rest.partition("]")[0].split(",")
    indices = [f"(({one}) B_AND 1)+1" for one in drawn[: len(others) + 1]]
    indices += others[len(indices) - 1 :]
    return code.set(f"{name}[{','.join(indices)}]{rest.partition(']')[2]}", drawn[-1])


def count_beyond_range(code: RoutineWriter) -> bool:
    """Write a FOR to the greatest or least INT, left after a few passes."""
    spare = code.spare()
    if not code.risk or len(spare) < 2 or code.left() < 24:
        return False
    counter, passes = spare[0], spare[1]
    first, last, step = code.choices.pick(_BEYOND)
    if code.choices.chance(30):
        code.line("ON_ERROR_PROCEED")
    code.spend(22)
    code.set(passes, "0")
    with code.block(f"FOR {counter}={first} TO {last}{step}", "ENDFOR"):
        code.set(passes, f"{passes}+1")
        code.guarded(f"{passes}>4", "EXIT")
        if code.choices.chance(20):
            code.line("ON_ERROR_PROCEED")
    place = target(code, INT)
    return place is None or code.set(place, f"{counter} B_EXOR {passes}")


def own_text(code: RoutineWriter) -> bool:
    """Write a statement that reads and writes the same text."""
    text, state, offset = array(code, TEXT), target(code, STATE), target(code, INT)
    if not text or state is None or offset is None:
        return False
    code.spend(3)
    pick = code.choices.pick
    code.set(offset, pick(("0", "1", "3", f"STRLEN({text})")))
    other = pick((text, text, f'"<", {text}'))
    form = pick(("%s", "%s%s", "-%5s", "%.2s|"))
    return code.line(
        pick(
            (
                f'SWRITE({text}, {state}, {offset}, "{form}", {other})',
                f'SREAD({text}, {state}, {offset}, "{pick(("%s", "%3s"))}", {text})',
                f"{offset}=STRADD({text}, {text})+STRLEN({text})",
                f"$FLAG[1]=STRCOPY({text}, {text})",
                f"{offset}=STRADD({text}, {text})",
            )
        )
    )
