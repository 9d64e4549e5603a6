"""Programs with one repeated part and any size, to measure how cost grows with size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Shape:
    """A text that repeats a part, in which ``{i}`` is the number of the repetition, from 1.

    ``closing`` is repeated as often after ``middle``, so that the parts are nested.
    """

    part: str
    head: str = "DEF A()\nINT I,J\nREAL R\nBOOL B\n"
    tail: str = "END\n"
    middle: str = ""
    closing: str = ""
    name: str = "a.src"

    def text(self, size: int) -> str:
        """Return the text with about ``size`` characters."""
        parts: list[str] = []
        length = 0
        while length < size or not parts:
            parts.append(self.part.replace("{i}", str(len(parts) + 1)))
            length += len(parts[-1]) + len(self.closing)
        return "".join((self.head, *parts, self.middle, self.closing * len(parts), self.tail))


def _line(before: str, part: str, after: str, **more: str) -> Shape:
    """Return a shape with one long line in a routine."""
    return Shape(
        part,
        head=f"DEF A()\nINT I,J\nREAL R\nBOOL B\nCHAR C[80]\n{before}",
        tail=f"{after}\nEND\n",
        **more,
    )


def _list(part: str, head: str = "") -> Shape:
    """Return a shape that is a data list."""
    return Shape(part, head=f"DEFDAT A PUBLIC\n{head}", tail="\nENDDAT\n", name="a.dat")


#: The shapes by the name of what repeats in them.
SHAPES: Final[Mapping[str, Shape]] = {
    # lines
    "assignments": Shape("I={i}\n"),
    "blank lines": Shape("\n"),
    "comments": Shape("; a comment of the line {i}\n"),
    "folds beside one another": Shape(";FOLD one {i}\n;ENDFOLD\n"),
    "points": Shape("PTP {X {i},Y 0,Z 500,A 0,B 90,C 0}\n"),
    "blended points": Shape("LIN {X {i},Y 0,Z 500,A 0,B 90,C 0} C_DIS\n"),
    "triggers": Shape("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\n"),
    "outputs": Shape("$OUT[1]=NOT $OUT[1]\n"),
    "waits": Shape("WAIT FOR $IN[1] OR $IN[2]\n"),
    "declarations": Shape("INT I{i}\n", head="DEF A()\n"),
    "declarations and uses": Shape("INT I{i}\n", head="DEF A()\n", middle="", closing="I1=I1+1\n"),
    "labels and jumps": Shape("L{i}:\nIF B THEN\nGOTO L{i}\nENDIF\n"),
    "interrupts": Shape("INTERRUPT DECL 3 WHEN $IN[{i}] DO A()\n"),
    "few lines again and again": Shape("".join(f"I=I+{n}\n" for n in range(150))),
    "ends of folds in one line": _line("", ";ENDFOLD", ""),
    # blocks
    "IF beside IF": Shape("IF B THEN\nI=1\nELSE\nI=2\nENDIF\n"),
    "IF in IF": Shape("IF B THEN\n", closing="ENDIF\n"),
    "LOOP in LOOP": Shape("LOOP\n", closing="ENDLOOP\n"),
    "FOR in FOR": Shape("FOR I=1 TO 2\n", closing="ENDFOR\n"),
    "folds in folds": Shape(";FOLD one {i}\n", closing=";ENDFOLD\n"),
    "CASE": Shape("CASE {i}\nI={i}\n", head="DEF A()\nINT I\nSWITCH I\n", tail="ENDSWITCH\nEND\n"),
    "values of one CASE": _line("SWITCH I\nCASE 0", ",{i}", "\nENDSWITCH"),
    "spline segments": Shape(
        "SLIN {X {i},Y 0,Z 500,A 0,B 90,C 0}\n", head="DEF A()\nSPLINE\n", tail="ENDSPLINE\nEND\n"
    ),
    # routines
    "routines": Shape("DEF A{i}()\nEND\n", head="DEF A()\nEND\n", tail=""),
    "routines that call the next": Shape(
        "DEF A{i}(P:IN)\nINT P\nA{i}(P+1)\nEND\n", head="DEF A()\nA1(1)\nEND\n", tail=""
    ),
    "functions": Shape("DEFFCT INT F{i}()\nRETURN {i}\nENDFCT\n", head="DEF A()\nEND\n", tail=""),
    "calls": Shape("A()\n"),
    "parameters": Shape(",P{i}:IN", head="DEF A()\nEND\nDEF B(P:IN", tail=")\nINT P\nEND\n"),
    "variables of one declaration": Shape(",I{i}", head="DEF A()\nINT I", tail="\nEND\n"),
    # expressions
    "a long sum": _line("I=1", "+1", ""),
    "a long sum of products": _line("R=1", "+2*R-3/R", ""),
    "a long sum beside an umlaut": _line("I=1", "+I", " ; \xe4"),
    "unknown names in one line": _line("I=1", "+U{i}", ""),
    "a long condition": _line("B=TRUE", " AND B OR NOT B", ""),
    "brackets in brackets": _line("I=", "(", "", middle="1", closing=")"),
    "NOT of NOT": _line("B=", "NOT ", "TRUE"),
    "signs of signs": _line("I=", "-", "1"),
    "calls in calls": _line("R=", "ABS(", "", middle="1", closing=")"),
    "indices in indices": _line("I=", "X[", "", middle="1", closing="]"),
    "members of members": _line("I=X", ".Y", ""),
    "frames in a chain": _line("X=X", ":X", ""),
    "one long name": _line("", "N", "=1"),
    "one long number": _line("I=", "9", ""),
    "one long text": _line('C[]="', "x", '"'),
    "one long comment": _line("I=1 ;", "x", ""),
    "one aggregate": _line("X={A 1", ",B{i} {i}", "}"),
    "aggregates in aggregates": _line("X=", "{A ", "", middle="1", closing="}"),
    # data lists
    "frames of a data list": _list("DECL FRAME F{i}={X {i},Y 0,Z 0,A 0,B 0,C 0}\n"),
    "places of a data list": _list(
        "DECL E6POS XP{i}={X {i},Y 0,Z 0,A 0,B 0,C 0,S 2,T 2,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}\n"
    ),
    "elements of an array": _list("X[{i}]={i}\n", head="DECL INT X[1000000]\n"),
    "structures": _list("STRUC S{i} INT A,B,C\n"),
    "members of a structure": _list(",M{i}", head="GLOBAL STRUC S INT M"),
    "words of an ENUM": _list(",W{i}", head="GLOBAL ENUM E W"),
    "signals": _list("SIGNAL S{i} $IN[7]\n"),
    # errors
    "lines that cannot be read": Shape("?? {i} ??\n"),
    "lines of one missing word": Shape("I 1\n"),
    "unknown names": Shape("U{i}=1\n"),
    "misspelt names": Shape("VALU{i}=1\n", head="DEF A()\nINT VALUE\n"),
    "wrong types": Shape("B=1\n"),
    "names declared again": Shape("INT I\n"),
    "blocks never closed": Shape("IF B THEN\n"),
    "blocks never opened": Shape("ENDIF\n"),
    "folds never closed": Shape(";FOLD one {i}\n"),
    "brackets never closed": Shape("I=(1\n"),
    "brackets never closed in one line": _line("I=", "(", "1"),
    "texts never closed": Shape('C[]="abc\n'),
    "END again and again": Shape("END\n"),
    "unknown routines": Shape("U{i}()\n"),
}
