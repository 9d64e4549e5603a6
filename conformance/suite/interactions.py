"""Cases of feature interactions in ``cases/interaction/``: pairwise testing of features.

A case has one value for each feature: the path of the motion, what an interrupt or the operator
does and when, what is triggered on the path, what follows the motion, and so on. Its expectations
follow from these values, each by the rule that it cites. The rows are a covering array of strength
two (every pair of values occurs), constructed greedily. Run ``python -m
conformance.suite.interactions`` after a change; a test fails if the cases are stale.

`drawn` generates further cases from a seed, with more values of each feature. They are not stored
and expect nothing specific: all executors must behave the same, and no law may be violated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations, product
from pathlib import Path
from random import Random
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Final

from conformance.suite.case import CASES, Case, find_cases

FOLDER: Final = CASES / "interaction"
#: An arm with external axes.
_MACHINE: Final = CASES / "motion" / "$machine.dat"
Row = Mapping[str, str]

FEATURES: Final[Mapping[str, tuple[str, ...]]] = {
    "path": (
        *("lin", "lin_blend", "circ", "circ_blend", "spline", "ptp", "ptp_blend", "rel"),
        *("circ_rel", "external_blend"),
    ),
    "act": (
        "run",
        "brake",
        "brake_hard",
        "halt",
        "nested",
        "pulse",
        "override",
        "proceed",
        "resume",
        "resume_deep",
        "operator",
        "dialogue",
    ),
    "when": ("0.15", "0.42"),
    "trigger": ("none", "end", "path", "call"),
    "behind": ("none", "position", "output", "continue", "wait_for", "wait_sec", "pulse"),
    "beside": ("none", "submit"),
    "override": ("100", "70"),
    "advance": ("1", "3", "5"),
}

#: More values, whose effects no rule states completely; `drawn` uses them too.
_MORE: Final[Mapping[str, tuple[str, ...]]] = {
    "path": (
        *("chain_blend", "circ_long", "ori_blend", "vel_blend", "slin", "scirc"),
        *("ptp_spline", "spline_blend", "turn_blend"),
    ),
    "act": ("brake_moves", "anout", "switch", "timer"),
    "when": ("0.05", "0.7"),
    "trigger": ("delay", "pulse", "onstart"),
    "behind": ("out_c", "anin", "act_read", "tool"),
    "override": ("35",),
    "advance": ("0",),
}

_CP: Final = ("lin", "spline", "rel")
#: For each path, its statements with their expectations, and its end point.
_PATHS: Final[Mapping[str, tuple[tuple[str, ...], str]]] = {
    "lin": (("LIN {X 545} ;> path line 445 0 810 to 545 0 810 [MOT-20]",), "545 0 810"),
    "lin_blend": (
        ("LIN {X 545} C_DIS ;> misses 545 0 810 by 20 within 19.9 [BLD-08]", "LIN {Y 100}"),
        "545 100 810",
    ),
    "circ": (
        (
            "CIRC {X 495, Y 50}, {X 545, Y 0}",
            ";> path circle 445 0 810 by 495 50 810 to 545 0 810 [MOT-20]",
        ),
        "545 0 810",
    ),
    "circ_blend": (
        (
            "CIRC {X 495, Y 50}, {X 545, Y 0} C_DIS",
            ";> path circle 445 0 810 by 495 50 810 to 545 0 810 [MOT-20]",
            ";> misses 545 0 810 by 20 within 19.9 [BLD-08]",
            "LIN {X 645}",
        ),
        "645 0 810",
    ),
    "spline": (
        (
            "SPLINE ;> passes 500 20 810 within 0.3 [SPL-03]",
            "  SPL {X 500, Y 20, Z 810}",
            "  SPL {X 545, Y 0, Z 810}",
            "ENDSPLINE",
        ),
        "545 0 810",
    ),
    "ptp": (("PTP {A1 40} ;> axes 40 -90 90 0 90 0 [MOT-20]",), ""),
    "ptp_blend": (
        (
            "PTP {A1 40} C_PTP ;> limits [MOT-06]",
            "PTP {A1 60, A2 -80} ;> axes 60 -80 90 0 90 0 [MOT-20]",
        ),
        "",
    ),
    "rel": (("LIN_REL {X 100} ;> path line 445 0 810 to 545 0 810 [MOT-20]",), "545 0 810"),
    "chain_blend": (
        ("LIN {X 490} C_DIS", "LIN {Y 40} C_DIS", "LIN {X 545} C_DIS", "PTP {A1 10}"),
        "",
    ),
    "circ_rel": (
        (
            "CIRC_REL {X 50, Y 50}, {X 100, Y 0}",
            ";> path circle 445 0 810 by 495 50 810 to 545 0 810 [MOT-20]",
        ),
        "545 0 810",
    ),
    "external_blend": (
        (
            "LIN {X 545, E1 30} C_DIS ;> misses 545 0 810 by 20 within 19.9 [BLD-08]",
            "LIN {Y 100, E1 60, E2 20} ;> limits [MOT-06]",
        ),
        "545 100 810",
    ),
    "circ_long": (("CIRC {X 495, Y 50}, {X 545, Y 0}, CA 220",), ""),
    "ori_blend": (("LIN {X 545, A 160} C_ORI", "LIN {Y 100}"), ""),
    "vel_blend": (("LIN {X 545} C_VEL", "LIN {Y 100}"), ""),
    "turn_blend": (("PTP {A1 30, A4 100} C_PTP", "LIN_REL {Z 60, C 20} C_DIS", "PTP {A1 0}"), ""),
    "slin": (("SLIN {X 545}",), ""),
    "scirc": (("SCIRC {X 495, Y 50}, {X 545, Y 0}",), ""),
    "ptp_spline": (("PTP_SPLINE", "  SPTP {A1 20}", "  SPTP {A1 40, A2 -80}", "ENDSPLINE"), ""),
    "spline_blend": (
        (
            *("SPLINE", "  SPL {X 500, Y 20, Z 810}", "  SLIN {X 545, Y 0, Z 810}"),
            *("ENDSPLINE C_SPL", "SLIN {Y 100}"),
        ),
        "",
    ),
}
_ROUTINES: Final[Mapping[str, tuple[str, ...]]] = {
    "run": ("$OUT[3] = TRUE ;> out 3 TRUE at in 1 [INT-06.a]",),
    "brake": ("BRAKE ;> brake at in 1 [INT-09.a]", "WAIT SEC 0.3", "$OUT[3] = TRUE"),
    "brake_hard": ("BRAKE F ;> brake at in 1 [INT-09.a]", "WAIT SEC 0.3", "$OUT[3] = TRUE"),
    "halt": ("HALT ;> halt [INT-16]", "$OUT[3] = TRUE ;> out 3 TRUE after in 1 + 0.4 [INT-16]"),
    "nested": (
        "INTERRUPT ON 4",
        "$FLAG[1] = TRUE",
        "WAIT SEC 0.2",
        "$OUT[3] = TRUE ;> out 3 TRUE at in 1 + 0.22 within 0.04 [INT-05]",
        "INTERRUPT OFF 4",
    ),
    "pulse": (
        "PULSE($OUT[3], TRUE, 0.2)",
        ";> out 3 TRUE at in 1 [IOT-08] ;> out 3 FALSE at out 3 + 0.2 [IOT-07.a]",
    ),
    "override": ("$OV_PRO = 25", "$OUT[3] = TRUE ;> out 3 TRUE at in 1 [INT-06.a]"),
    "proceed": (
        "A[1] = 0",
        "ON_ERROR_PROCEED",
        "A[1] = A[A[1]]",
        "A[2] = $ERR.NUMBER ;> value A[2] 1444 [TYP-13]",
        "ERR_CLEAR($ERR)",
        "$OUT[3] = TRUE ;> out 3 TRUE at in 1 [TYP-13]",
    ),
    "dialogue": (
        *("DECL KRLMSG_T M", "DECL KRLMSGPAR_T P[3]", "DECL KRLMSGDLGSK_T K[7]"),
        *("DECL INT ANSWER, H, I", "DECL BOOL IS_OPEN"),
        'M = {MODUL[] "CASE", NR 9, MSG_TXT[] "Which?"}',
        *("FOR I = 1 TO 3", "  P[I] = {PAR_TYPE #EMPTY}", "ENDFOR"),
        *("FOR I = 1 TO 7", '  K[I] = {SK_TYPE #VALUE, SK_TXT[] "A"}', "ENDFOR"),
        *("ANSWER = 0", "H = SET_KRLDLG(M, ANSWER, P[], K[]) ;> message 9 [FCT-10]"),
        *("REPEAT", "  WAIT SEC 0.1", "  IS_OPEN = EXISTS_KRLDLG(H, ANSWER)", "UNTIL NOT IS_OPEN"),
        "I = ANSWER ;> value I 2 [FCT-10]",
        "$OUT[3] = TRUE ;> out 3 TRUE after in 1 + 0.3 [FCT-10]",
    ),
    "brake_moves": ("BRAKE", "PTP_REL {A6 10}", "$OUT[3] = TRUE"),
    "anout": ("$ANOUT[1] = 0.25", "$OUT[3] = TRUE"),
    "switch": ("INTERRUPT OFF 5", "INTERRUPT ON 5", "$OUT[3] = TRUE"),
    "timer": ("$TIMER[1] = -100", "$TIMER_STOP[1] = FALSE", "WAIT SEC 0.05", "$OUT[3] = TRUE"),
    "resume": ("BRAKE", "RESUME ;> resume after in 1 [INT-10]"),
    "resume_deep": (
        "INTERRUPT ON 4",
        "$FLAG[1] = TRUE",
        "WAIT SEC 1",
        "$OUT[3] = TRUE ;> out 3 never [INT-10]",
    ),
}
_BESIDE: Final = (
    "DEF BESIDE()\n  LOOP\n    IF $OUT[1] THEN\n"
    "      $OUT[40] = TRUE ;> out 40 TRUE after out 1 [SUB-01]\n    ENDIF\n"
    "    WAIT SEC 0.024\n  ENDLOOP\nEND\n"
)
_FIRST: Final = "INT-01"
_SPEED: Final = "  $VEL.CP = 0.25"
#: Triggers whose moment no single rule determines.
_WORDS: Final = {
    "delay": "DISTANCE=1 DELAY=-60 DO $OUT[2]=TRUE",
    "pulse": "DISTANCE=1 DELAY=20 DO PULSE($OUT[2], TRUE, 0.2)",
    "onstart": "PATH=10 ONSTART DELAY=5 DO $OUT[2]=TRUE",
}
#: The statements after the motions; ``LAST`` stands for the number of the last motion.
_BEHIND: Final[Mapping[str, tuple[str, ...]]] = {
    "none": (),
    "position": ("R = $POS_ACT.X", "R = 1 ;> line at end LAST [ADV-07]"),
    "output": ("$OUT[6] = TRUE ;> out 6 TRUE at end LAST [ADV-05]",),
    "continue": (
        "CONTINUE",
        "$OUT[7] = TRUE ;> runs-ahead [ADV-08] ;> out 7 TRUE before end LAST [ADV-09]",
    ),
    "wait_for": ("WAIT FOR $OUT[1]", "R = 1 ;> line at end LAST [ADV-04]"),
    "wait_sec": ("WAIT SEC 0.2", "R = 1 ;> line at end LAST + 0.2 [ADV-04]"),
    "out_c": ("$OUT_C[11] = TRUE",),
    "anin": ("R = $ANIN[1]",),
    "act_read": ("WAIT FOR $POS_ACT.X > 0", "R = $VEL_ACT"),
    "tool": ("$TOOL = {X 0, Y 0, Z 20, A 0, B 0, C 0}", "$TOOL = $NULLFRAME"),
    "pulse": (
        "PULSE($OUT[8], TRUE, 0.5) ;> out 8 TRUE at end LAST [ADV-04] ;> out 8 FALSE [IOT-07.a]",
    ),
}


def covering(features: Mapping[str, tuple[str, ...]]) -> list[dict[str, str]]:
    """Return rows in which every pair of values of two features occurs at least once."""
    names = list(features)
    missing = {
        frozenset(((one, left), (other, right)))
        for one, other in combinations(names, 2)
        for left, right in product(features[one], features[other])
    }
    rows: list[dict[str, str]] = []
    while missing:
        row = dict(min(missing, key=sorted))  # start with a missing pair, then add greedily
        for name in names:
            if name not in row:
                row[name] = max(
                    features[name],
                    key=lambda value, name=name: sum(  # type: ignore[misc]
                        frozenset(((name, value), each)) in missing for each in row.items()
                    ),
                )
        missing -= {frozenset(pair) for pair in combinations(row.items(), 2)}
        rows.append({name: row[name] for name in names})
    return rows


def cases() -> Iterator[tuple[str, str]]:
    """Yield the names and contents of all files."""
    for number, row in enumerate(covering(FEATURES), 1):
        name = f"pair_{number:03}"
        yield f"{name}.src", "\n".join([*_front(row), *_main(name, row), ""])
    yield "beside.sub", _BESIDE
    yield "$machine.dat", _MACHINE.read_text(encoding="utf-8")


def drawn(seed: int) -> list[Case]:
    """Return cases that cover all pairs of values; the seed determines the combinations."""
    chance = Random(f"interactions {seed}")
    every = {name: (*values, *_MORE.get(name, ())) for name, values in FEATURES.items()}
    features = {
        name: tuple(chance.sample(every[name], len(every[name])))
        for name in chance.sample(list(every), len(every))
    }
    rows = covering(features)
    for row in rows:
        if row["act"] == "resume" and row["when"] == "0.7":
            row["when"] = "0.05"  # after 0.7 s the motion may be over, and RESUME a fault
    with TemporaryDirectory() as place:
        folder = Path(place, "pairs")
        folder.mkdir()
        (folder / "beside.sub").write_text(_BESIDE, encoding="utf-8")
        copyfile(_MACHINE, folder / _MACHINE.name)
        for number, row in enumerate(rows, 1):
            name = f"drawn_{number:03}"
            head = [one for one in _front(row) if not one.startswith((";@ rule", ";@ title"))]
            body = [one.partition(";>")[0].rstrip() for one in _main(name, row)]
            body[body.index(_SPEED)] += f" ;> runs 1 [{_FIRST}]"
            title = ", ".join(f"{name} {row[name]}" for name in sorted(row))
            lines = [f";@ rule: {_FIRST}", f";@ title: {title}", *head, *filter(None, body), ""]
            (folder / f"{name}.src").write_text("\n".join(lines), encoding="utf-8", newline="\n")
        return find_cases(Path(place))


def _front(row: Row) -> Iterator[str]:
    lines = [*_main("", row), *(["[SUB-01]"] if row["beside"] == "submit" else [])]
    cited = sorted({text[at + 1 : at + 7] for text in lines for at in _places(text)})
    first = _FIRST if row["act"] != "operator" else cited[0]
    others = [one for one in cited if one != first]
    yield f";@ rule: {', '.join([first, *others])}"
    parts = (row["trigger"], "trigger"), (row["behind"], "behind"), (row["beside"], "too")
    words = ", ".join(f"{value} {what}" for value, what in parts if value != "none")
    words = f"{row['path']}, {row['act']} at {row['when']} s; {words or 'nothing else'}; "
    words += f"{row['override']} %, {row['advance']} ahead"
    yield f";@ title: {words}".replace("_", " ")
    yield ";@ phase: run"
    yield ";@ robot: kinematic"
    act = "press STOP" if row["act"] == "operator" else "IN[1]=TRUE"
    yield f";@ io: on OUT[1]=TRUE after {row['when']} {act}"
    if row["act"] == "operator":
        yield f";@ io: on OUT[1]=TRUE after {float(row['when']) + 1:g} press START"
    if row["act"] == "dialogue":
        yield f";@ io: on OUT[1]=TRUE after {float(row['when']) + 0.3:g} answer 2"
    if row["act"] == "halt":
        yield ";@ io: on HALT after 0.5 press START"
    beside = ["beside.sub"] if row["beside"] == "submit" else []
    if row["path"] == "external_blend":
        beside.insert(0, "$machine.dat")
    if beside:
        yield f";@ with: {', '.join(beside)}"


def _places(text: str) -> Iterator[int]:
    return (at for at in range(len(text)) if text[at] == "[" and text[at + 4 : at + 5] == "-")


def _main(name: str, row: Row) -> Iterator[str]:
    is_left = row["act"].startswith("resume")
    yield f"DEF {name}()"
    if row["act"] != "operator":
        yield "  INTERRUPT DECL 5 WHEN $IN[1] DO act()"
    if row["act"] in ("nested", "resume_deep"):
        yield "  INTERRUPT DECL 4 WHEN $FLAG[1] DO higher()"
    yield "  $TOOL = $NULLFRAME"
    yield "  $BASE = $NULLFRAME"
    yield "  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}"
    yield _SPEED
    yield "  $APO.CDIS = 20"
    yield "  $VEL_AXIS[1] = 20"
    yield f"  $ADVANCE = {row['advance']}"
    yield f"  $OV_PRO = {row['override']}"
    if row["act"] != "operator":
        yield "  INTERRUPT ON 5"
    yield "  way()"
    yield "  $OUT[5] = TRUE" + (" ;> out 5 TRUE after start 2 [INT-10]" if is_left else "")
    yield "  LIN {X 445, Y 0, Z 790, A 180, B 0, C 180} ;> pose 445 0 790 [ARI-09]"
    yield "END"
    yield from _way(row, is_left=is_left)
    if row["act"] in _ROUTINES:
        yield "DEF act()"
        if row["act"] == "proceed":
            yield "  DECL INT A[2]"
        yield from (f"  {text}" for text in _ROUTINES[row["act"]])
        if not is_left and row["act"] != "halt":
            yield "  $FLAG[2] = TRUE ;> interrupt 5 times 1 [INT-06.a]"
        yield "END"
    if row["act"] in ("nested", "resume_deep"):
        yield "DEF higher()"
        if is_left:
            yield "  BRAKE"
            yield "  RESUME ;> resume after in 1 [INT-10]"
        else:
            yield "  $OUT[9] = TRUE ;> out 9 TRUE at in 1 within 0.03 [INT-05]"
        yield "END"
    if row["trigger"] == "call":
        yield "DEF called()"
        yield "  $OUT[10] = TRUE"
        yield "END"


def _way(row: Row, *, is_left: bool) -> Iterator[str]:
    statements, _ = _PATHS[row["path"]]
    blends = row["path"].endswith("_blend")
    yield "DEF way()"
    yield "  DECL REAL R"
    yield "  R = 0"
    yield "  TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE ;> out 1 TRUE at start 2 [TRG-01]"
    yield from _trigger(row, is_left=is_left, moment=f"{'apex' if blends else 'end'} 2")
    if is_left:
        yield from (
            f"  {text.partition(';>')[0].rstrip()}" for text in statements if text[0] != ";"
        )
    else:
        yield from (f"  {text}" for text in statements)
    last = "3" if blends else "2"
    for text in _BEHIND[row["behind"]]:
        shown = text.replace("LAST", last)
        if row["act"] == "halt":  # it halts for half a second, and the arm continues
            shown = shown.replace(" at end", " after end").replace(f" before end {last}", "")
        yield f"  {text.partition(' ;>')[0] if is_left else shown}"
    if is_left:
        yield "  WAIT SEC 0"
        yield "  R = 2 ;> never [INT-10]"
    else:
        yield "  R = 2"
    yield "END"


def _trigger(row: Row, *, is_left: bool, moment: str) -> Iterator[str]:
    if row["trigger"] == "none" or (
        row["trigger"] in ("path", "onstart") and row["path"] not in _CP
    ):
        return
    if row["trigger"] in _WORDS:
        yield f"  TRIGGER WHEN {_WORDS[row['trigger']]}"
        return
    if row["trigger"] == "call":
        seen = ";> trigger never [INT-10]" if is_left else ";> trigger times 1 [TRG-06]"
        yield f"  TRIGGER WHEN DISTANCE=1 DELAY=0 DO called() PRIO=-1 {seen}"
        return
    rule = "TRG-02" if moment.startswith("apex") else "TRG-01"
    seen = f"TRUE at {moment} [{rule}]"
    word = "DISTANCE=1"
    if row["trigger"] == "path":
        word, seen = "PATH=-1", f"TRUE between {moment} - 1 and {moment} [TRG-04]"
    yield f"  TRIGGER WHEN {word} DELAY=0 DO $OUT[2]=TRUE"
    yield f"  ;> out 2 {'never [INT-10]' if is_left else seen}"


def _write() -> None:
    FOLDER.mkdir(exist_ok=True)
    for old in FOLDER.glob("*.s*"):
        old.unlink()
    for name, text in cases():
        (FOLDER / name).write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    _write()
