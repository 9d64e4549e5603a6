"""Fragments of valid programs, and short programs composed of them.

A fragment is a statement or a small block, without comments. Of fragments that differ only in names
and values, the first is kept.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from grammar.blocks import BLOCKS, CLOSERS
from recovery.negatives.language_facts import violation
from recovery.negatives.tokens import SourceLine, lines

#: Lines, each indented by two blanks or more.
Fragment = tuple[str, ...]

# A program has at most 14 lines, so that it has at most 15 with one more.
_MOST_LINES = 14
_LONGEST_BLOCK = 9
_LONGEST_LINE = 90

#: Built-in fragments in their simplest forms, so that the generator never lacks any.
_BUILT_IN = """DEF PLAIN()
  DECL INT I
  DECL E6POS PLACE
  INT COUNT, LIMIT[3]
  $OUT[1] = TRUE
  COUNT = COUNT + 1
  SPEED = 0.5 * (LIMIT[1] - 2) / COUNT
  READY = $IN[1] AND NOT (COUNT >= 3) OR DONE
  STATE.STEP = #HOME
  MASK = 'B101' B_AND 'HFF'
  PLACE = {X 100, Y 0, Z -5.5}
  NAME[] = "A;B"
  TURNED = BASE_DATA[1]:PLACE
  WORK()
  MOVE_TO(PLACE, 3, TRUE)
  PTP HOME
  PTP {A1 0, A2 -90, A3 90} C_PTP
  LIN PLACE C_DIS
  CIRC VIA, PLACE
  WAIT SEC 0.5
  WAIT FOR $IN[2] == TRUE
  PULSE($OUT[3], TRUE, 0.5)
  TRIGGER WHEN DISTANCE = 0 DELAY = 20 DO $OUT[4] = TRUE
  TRIGGER WHEN PATH = -30 DELAY = 0 DO WORK() PRIO = -1
  INTERRUPT DECL 21 WHEN $IN[3] DO WORK()
  INTERRUPT ON 21
  INTERRUPT OFF 21
  GOTO DONE
  HALT
  CONTINUE
  BRAKE
  IF COUNT == 3 THEN
    WORK()
  ENDIF
  IF $IN[1] AND (COUNT < 5) THEN
    COUNT = 0
  ELSE
    HALT
  ENDIF
  FOR I = 1 TO 5
    $OUT[I] = FALSE
  ENDFOR
  FOR I = 10 TO 1 STEP -2
    IF $IN[I] THEN
      LIN PLACE
    ENDIF
  ENDFOR
  WHILE NOT $IN[1]
    COUNT = COUNT + 1
  ENDWHILE
  REPEAT
    WAIT SEC 0.1
  UNTIL COUNT > 9
  LOOP
    IF DONE THEN
      EXIT
    ENDIF
  ENDLOOP
  SWITCH COUNT
    CASE 1, 2
      WORK()
    CASE 3
      HALT
    DEFAULT
      COUNT = 1
  ENDSWITCH
  SWITCH STATE
    CASE #HOME
      LOOP
        WORK()
      ENDLOOP
  ENDSWITCH
  SPLINE
    SPL PLACE
    SLIN PLACE
  ENDSPLINE
END
DEFDAT PLAIN
  DECL INT COUNT = 1
  DECL E6POS PLACE = {X 100, Y 0, Z -5.5, S 2, T 'B10'}
  REAL SPEED = -0.25
  DECL GLOBAL INT SHARED[2]
  DECL GLOBAL CONST INT MOST = 7
  DECL CONST REAL LEAST = 0.5
  FRAME ORIGIN = {X 0, Y 0, Z 0}
  BOOL DONE = FALSE
  CHAR NAME[8]
  NAME[] = "A"
  LIMIT[1] = 5
  ENUM STATE_T HOME, WORKING
  STRUC JOB_T INT NUMBER, REAL SPEED
  SIGNAL GRIPPER $OUT[5] TO $OUT[6]
ENDDAT
"""


@dataclass(frozen=True, slots=True)
class FragmentPool:
    """Fragments by where they can be used: head of a routine, its body, or a data list.

    Each list has one list of fragments for each form. All forms are equally likely, although there
    are many more assignments than TRIGGERs.
    """

    declarations: tuple[tuple[Fragment, ...], ...]
    statements: tuple[tuple[Fragment, ...], ...]
    data: tuple[tuple[Fragment, ...], ...]

    def program(self, chance: random.Random) -> list[str]:
        """Return the lines of a program with one to four fragments."""
        if chance.random() < 0.1:
            return ["DEFDAT NEG", *_some(self.data, 4, chance), "ENDDAT"]
        function = chance.random() < 0.1
        head, end = ("DEFFCT INT NEG(N:IN)", "ENDFCT") if function else ("DEF NEG()", "END")
        out = [head]
        if chance.random() < 0.25:
            out += _some(self.declarations, 1, chance)
        out += _some(self.statements, 3, chance, room=_MOST_LINES - len(out) - 4)
        if function:
            out.append("  RETURN N")
        out.append(end)
        if chance.random() < 0.15:
            out += ["DEF NEXT()", "END"]
        return out


def _some(
    forms: Sequence[Sequence[Fragment]], most: int, chance: random.Random, room: int = _MOST_LINES
) -> list[str]:
    """Return the lines of one to ``most`` fragments, as long as there is room."""
    out: list[str] = []
    for _ in range(chance.randint(1, most)):
        piece = chance.choice(chance.choice(forms))
        if len(out) + len(piece) <= room:
            out += piece
    return out


def fragment_pool(programs: Iterable[str]) -> FragmentPool:
    """Return the fragments of valid programs and the built-in ones.

    A text that breaks a fact of the language contributes none.
    """
    found: dict[str, dict[str, dict[object, Fragment]]] = {
        "declarations": {},
        "statements": {},
        "data": {},
    }
    for text in (_BUILT_IN, *programs):
        if violation(text) is None:
            for where, piece in _pieces(text):
                alike = tuple(line.kinds for line in piece)
                form = found[where].setdefault(_form(piece[0]), {})
                form.setdefault(alike, _trim(piece))
    return FragmentPool(
        **{
            where: tuple(tuple(form.values()) for form in forms.values())
            for where, forms in found.items()
        }
    )


def _form(line: SourceLine) -> str:
    """Return the form of a line: the sign after its first word if there is one, else its lead."""
    second = line.kinds[1:2]
    return second[0] if second and second[0] in "=[.(:" else line.lead


def _pieces(text: str) -> Iterator[tuple[str, list[SourceLine]]]:
    """Yield the statements and small blocks of a program, with where they can be used."""
    program = [line for line in lines(text) if line.tokens]
    open_blocks: list[int] = []
    for index, line in enumerate(program):
        if line.lead in BLOCKS:
            open_blocks.append(index)
        elif line.lead in CLOSERS:
            block = program[open_blocks.pop() : index + 1]
            if open_blocks and len(block) <= _LONGEST_BLOCK and _is_narrow(block):
                yield "statements", block
        elif line.lead not in ("ELSE", "CASE", "DEFAULT") and _is_narrow([line]):
            block_of = program[open_blocks[-1]].lead
            if block_of == "DEFDAT":
                yield "data", [line]
            elif "SPLINE" not in block_of:
                yield "declarations" if _is_declaration(line) else "statements", [line]


def _is_narrow(piece: list[SourceLine]) -> bool:
    return all(line.tokens[-1].end - line.tokens[0].start <= _LONGEST_LINE for line in piece)


_DECLARING = frozenset("INT REAL BOOL CHAR ENUM STRUC SIGNAL EXT EXTFCT EXTP EXTFCTP".split())


def _is_declaration(line: SourceLine) -> bool:
    return line.tokens[0].kind == "DECL" or line.lead in _DECLARING


def _trim(piece: list[SourceLine]) -> Fragment:
    """Return the lines without comments, indented by two blanks and relative to the first."""
    margin = piece[0].tokens[0].start
    out = []
    for line in piece:
        start, end = line.tokens[0].start, line.tokens[-1].end
        out.append("  " + " " * max(0, start - margin) + line.text[start:end])
    return tuple(out)
