"""Records of surveys that never took place, shaped as ``krl recover --json`` shapes real ones."""

import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from selenium import webdriver

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Cause:
    """One thing a grammar may lack: how it shows in source and what mends it."""

    title: str
    rule: str
    line: str
    token: str
    edit: str
    files: int
    unlocks: int
    follows: bool = False


CAUSES = (
    Cause(
        "TRIGGER … ONSTART",
        "triggerStatement",
        "\t  TRIGGER WHEN DISTANCE=0 ONSTART DELAY=-20 DO $OUT[12]=TRUE ; glue on",
        "ONSTART",
        "triggerStatement: make 'ONSTART' optional after the distance",
        63,
        41,
    ),
    Cause(
        "GLOBAL before DEF",
        "module",
        "GLOBAL DEF Grip_Open(n:IN)",
        "GLOBAL",
        "routine: make 'GLOBAL' optional at the start",
        58,
        33,
    ),
    Cause(
        "DECL without a type prefix: E6POS … = {…}",
        "dataDeclaration",
        'DECL E6POS XP1={X 812.4,Y -77.1,Z 640.0,A 90.0,B 0.0,C 180.0,S 2,T 10,E1 0.0} ; "über"',
        "=",
        "dataDeclaration: add alternative with an initial aggregate",
        121,
        28,
    ),
    Cause(
        "CONTINUE before $OUT",
        "statement",
        "   CONTINUE",
        "CONTINUE",
        "statement: add alternative 'CONTINUE'",
        37,
        17,
    ),
    Cause(
        "PTP … C_PTP C_DIS",
        "motionStatement",
        "PTP XP4 C_PTP C_DIS",
        "C_DIS",
        "ptpMotion: make 'C_DIS' optional after 'C_PTP'",
        29,
        12,
    ),
    Cause(
        "ELSEIF",
        "ifStatement",
        "  ELSEIF nPart == 3 THEN",
        "nPart",
        "ifStatement: add rule elseIfPart",
        9,
        6,
    ),
    Cause(
        "WAIT FOR … without parentheses",
        "waitStatement",
        "WAIT FOR $IN[7] AND NOT $IN[8]",
        "AND",
        "waitStatement: widen the condition to expression",
        22,
        5,
    ),
    Cause(
        "SWITCH … CASE with a list",
        "caseClause",
        "    CASE 4, 5, 9",
        ",",
        "caseClause: allow several constants separated by ','",
        14,
        4,
    ),
    Cause(
        "SIGNAL … TO",
        "signalDeclaration",
        "SIGNAL PART_CODE $IN[33] TO $IN[40]",
        "TO",
        "signalDeclaration: make 'TO' with an end optional",
        18,
        2,
    ),
    Cause(
        "ENDIF without its IF",
        "statement",
        "  ENDIF",
        "ENDIF",
        "",
        9,
        0,
        follows=True,
    ),
    Cause(
        "unknown character '\N{SECTION SIGN}'",
        "lexer",
        "§ 12 Freigabe",
        "§",
        "",
        1,
        0,
    ),
)
ORIGINS = ("cell-07.zip", "palletising-demo", "glue_line_west", "weld-backup-2019", "training")
EXPECTED = (
    "';' '=' '(' '[' ',' '.' ':' NEWLINE IDENTIFIER INT_LITERAL REAL_LITERAL STRING AND "
    "B_AND B_EXOR B_NOT B_OR C_DIS C_ORI C_PTP C_SPL C_VEL DELAY DO ELSE ENDFOR ENDIF "
    "ENDLOOP ENDSWITCH ENDWHILE EXOR FALSE HALT IF INTERRUPT LIN LOOP NOT OR PATH PRIO PTP "
    "REPEAT RETURN STEP SWITCH THEN TO TRUE UNTIL WAIT WHILE"
).split()


def _example(cause: Cause, origin: str, number: int) -> Json:
    line = 23 + 17 * number
    around = [
        "  $BWDSTART=FALSE",
        "  ;FOLD PTP P4 CONT Vel=100 % PDAT4 Tool[2]:Nozzle Base[1]:Fixture;%{PE}%R 8.3.34",
        "  LIN XP3 C_DIS",
        cause.line,
        "  LIN XP4 C_DIS",
        "  ;ENDFOLD",
        "  WAIT SEC 0.2",
    ]
    column = cause.line.index(cause.token) + 1
    return {
        "path": f"{origin}/KRC/R1/Program/Station{number + 1}/part_{cause.files}.src",
        "line": line,
        "column": column,
        "text": cause.line,
        "context": [{"line": line - 3 + i, "text": text} for i, text in enumerate(around)],
    }


def _cluster(cause: Cause, rank: int, origins: tuple[str, ...]) -> Json:
    involved = origins[: 1 + cause.files % len(origins)]
    column = cause.line.index(cause.token) + 1
    failures = cause.files + 3 * rank
    expected = EXPECTED[rank % 5 : rank % 5 + (3 if rank % 3 == 1 else 9 * (rank % 6) + 3)]
    cluster: Json = {
        "id": f"c-{rank * 7919 + 4099:06x}",
        "title": cause.title,
        "failures": failures,
        "files": cause.files,
        "origins": len(involved),
        "unlocks": cause.unlocks,
        "lines": max(1, failures - 2),
        "follows": failures if cause.follows else rank % 3,
        "rule": cause.rule,
        "rule_stack": ["source", "module", "routine", "statement", cause.rule],
        "expected": expected,
        "token": cause.token,
        "example": _example(cause, involved[0], 0),
        "examples": [_example(cause, involved[i % len(involved)], i + 1) for i in range(4)],
        "files_by_origin": [
            {
                "origin": origin,
                "files": [
                    {"path": f"{origin}/KRC/R1/Program/Station{n + 1}/part_{n}.src", "line": 9 + n}
                    for n in range(max(1, min(30, cause.files // len(involved))))
                ],
            }
            for origin in involved
        ],
        "reproducer": {
            "text": f"DEF A()\n{cause.line.strip()}\nEND\n",
            "line": 2,
            "column": column - (len(cause.line) - len(cause.line.lstrip())),
            "tokens": 5 + rank % 4,
        },
        "proposals": [],
    }
    if cause.edit:
        cluster["proposals"] = [
            {
                "edit": cause.edit,
                "kind": "make optional",
                "restores": cause.unlocks,
                "breaks": 0,
                "accepts_negatives": 0,
                "ambiguities": 0,
                "diff": f"@@ {cause.rule} @@\n-    : 'A' 'B'\n+    : 'A' 'X'? 'B'\n",
            },
            {
                "edit": f"{cause.rule}: add alternative identifier",
                "kind": "add alternative",
                "restores": cause.unlocks + 1,
                "breaks": rank % 2,
                "accepts_negatives": 12,
                "ambiguities": 1,
                "diff": f"@@ {cause.rule} @@\n     : 'A' 'B'\n+    | identifier\n",
            },
        ]
    return cluster


def _record(causes: tuple[Cause, ...], files: int, parsed: int) -> Json:
    clusters = [_cluster(cause, rank, ORIGINS) for rank, cause in enumerate(causes)]
    greedy: list[Json] = []
    reached = parsed
    for cluster in clusters:
        if cluster["unlocks"]:
            reached = min(files, reached + int(cluster["unlocks"] * 1.4))
            greedy.append({"cluster": cluster["id"], "parsed": reached})
    share = files // len(ORIGINS)
    return {
        "grammar": "grammar/preliminary.g4",
        "grammar_sha256": "9f2c41d07b" * 6 + "abcd",
        "grammar_note": "the restrictive start",
        "version": "0.1.0",
        "generated": "2031-05-06",
        "files": files,
        "parsed": parsed,
        "bytes": 7412 * files,
        "parsed_bytes": 5120 * parsed,
        "seconds": 12.43,
        "distinct": files - 37,
        "origins": [
            {
                "name": name,
                "files": share,
                "parsed": parsed * (i + 3) // 25,
                "failed": share - parsed * (i + 3) // 25,
            }
            for i, name in enumerate(ORIGINS)
        ],
        "skipped": [
            *(
                {"path": f"training/notes/table_{n}.dat", "reason": "not KRL: no DEFDAT"}
                for n in range(14)
            ),
            {"path": "cell-07.zip/am.ini", "reason": "not KRL: no such suffix"},
            {"path": "weld-backup-2019/KRC/R1/old.src", "reason": "binary: holds NUL bytes"},
        ],
        "copies": [
            {
                "path": f"{ORIGINS[n % 5]}/KRC/R1/System/bas.src",
                "same_as": "training/KRC/R1/System/bas.src",
            }
            for n in range(4)
        ],
        "failures": [
            {
                "path": "cell-07.zip/only-in-failures.src",
                "line": 1,
                "column": 1,
                "cluster": "c-001003",
            }
        ],
        "greedy": greedy,
        "clusters": clusters,
    }


def believable_record() -> Json:
    """A survey of 583 files with eleven clusters, nine of which unlock files."""
    return _record(CAUSES, 583, 312)


def large_record(clusters: int = 500) -> Json:
    """A survey with very many clusters, the fewer files the later they come."""
    chance = random.Random(20)
    causes = []
    for rank in range(clusters):
        base = CAUSES[rank % len(CAUSES)]
        files = 1 + int(900 / (rank + 2)) + chance.randrange(3)
        causes.append(
            Cause(
                f"{base.title} ({rank})",
                base.rule,
                base.line,
                base.token,
                base.edit,
                files,
                files * chance.randrange(4) // 6,
                base.follows,
            )
        )
    causes.sort(key=lambda cause: -cause.unlocks)
    return _record(tuple(causes), 4210, 1033)


def complete_record() -> Json:
    """A survey in which every file parsed."""
    return _record((), 48, 48)


def empty_record() -> Json:
    """A survey that found no KRL."""
    record = _record((), 0, 0)
    return record | {"origins": [], "bytes": 0, "parsed_bytes": 0, "distinct": 0, "copies": []}


# -- the growth of a grammar -----------------------------------------------------------------------

TITLES = (
    "GLOBAL before DEF and DEFFCT",
    "DEFFCT with a return type",
    "Parameters with IN and OUT",
    "DECL with several names and sizes",
    "Initial values in data lists",
    "FOR … STEP",
    "SWITCH with CASE lists",
    "SIGNAL … TO",
    "Motions with C_DIS C_VEL",
    "TRIGGER WHEN PATH … ONSTART",
)
GROUNDS = (("corroborated", "documented"), ("corroborated",), ("documented",), ("confirmed",))


def _growth_step(number: int, parsed: int, before: int) -> Json:
    title = TITLES[(number - 1) % len(TITLES)] if number else "The restrictive start"
    name = f"{number:04}-{'-'.join(title.lower().split()[:3])}" if number else "preliminary"
    restored = parsed - before if number else 0
    return {
        "number": number,
        "id": name,
        "title": title if number <= len(TITLES) else f"{title} ({number})",
        "state": "accepted" if number else "start",
        "summary": "Both kinds of routine take it." if number else "",
        "grounds": list(GROUNDS[number % len(GROUNDS)]) if number else [],
        "evidence": {
            "files": 3 * restored + 2,
            "origins": 1 + number % 9,
            "lines": 17 * restored + 5,
            "rules": ["SCO-04", "SCO-05"] if number % 4 in (0, 2) else [],
            "manual": "Operating instructions, section 5.2" if number % 5 == 0 else "",
            "verdict": "accepted" if number % 4 == 3 else "",
            "oracle": "",
            "seen": [f"{ORIGINS[n % 5]}/KRC/R1/part_{n}.src:{9 + n}" for n in range(6)],
        }
        if number
        else {},
        "edits": [f"reserve WORD{number}", f"routine: »WORD{number}?« DEF NAME '('"]
        if number
        else [],
        "diff": f"@@ -31,3 +31,3 @@\n procedure\n-    : DEF NAME\n+    : WORD{number}? DEF NAME\n"
        if number
        else "",
        "accept": [f"WORD{number} DEF A()\nEND\n", "DEF B()\nHALT\nEND\n"] if number else [],
        "reject": [f"WORD{number} WORD{number} DEF A()\nEND\n"] if number else [],
        "files": 583,
        "parsed": parsed,
        "bytes": 4_305_593,
        "parsed_bytes": int(4_305_593 * (parsed / 583) ** 1.7),
        "restored": restored,
        "broken": 2 if number == 7 else 0,
        "restored_files": [f"{ORIGINS[n % 5]}/KRC/R1/restored_{n}.src" for n in range(restored)],
        "broken_files": ["training/a.src", "training/b.src"] if number == 7 else [],
        "failing_lines": int(42_000 * (1 - parsed / 583) ** 1.5),
        "metrics": {
            "TERM": 76.0 + number // 2,
            "VAR": 44.0 + number // 3,
            "MCC": 77.0 + 3 * number,
            "AVS": round(4.86 + 0.03 * number, 3),
            "HAL": round(17.1 + 0.9 * number, 3),
            "LL1": round(87.5 - 0.05 * number, 3),
        },
    }


def growth_record(steps: int = 40) -> Json:
    """The growth of a grammar over 583 files; three of them remain."""
    parsed = [round(36 + 544 * (1 - (1 - n / steps) ** 2.2)) for n in range(steps + 1)]
    rows = [_growth_step(n, p, parsed[max(0, n - 1)]) for n, p in enumerate(parsed)]
    left = [
        ("training/KRC/R1/template.src", "an aggregate begins with a name", 4),
        ("training/KRC/R1/notes.src", "an expression is no statement", 2),
        ("cell-07.zip/KRC/R1/odd.src", "", 0),
    ]
    return {
        "grammar": "grammar/KRL.g4",
        "grammar_sha256": "5f2c41d07b" * 6 + "abcd",
        "version": "0.1.0",
        "generated": "2031-05-06T07:08:09+00:00",
        "seconds": 21.5,
        "files": 583,
        "distinct": 560,
        "bytes": 4_305_593,
        "skipped": [{"path": "training/table.dat", "reason": "no KRL: a table", "origin": "t"}],
        "meanings": {
            "TERM": "tokens that the rules use",
            "VAR": "rules",
            "MCC": "decisions: alternatives beyond the first, optional and repeated parts",
            "AVS": "average size of a rule, in names of tokens and rules",
            "HAL": "Halstead effort, in thousands",
            "LL1": "decisions that one token decides, in per cent",
        },
        "steps": rows,
        "lookahead": {
            "decisions": 196,
            "one": 85.5,
            "two": 95.2,
            "others": ["program: “(eol routine)*” and “what follows it” can begin alike"],
        },
        "ambiguous": {
            "lines": 1,
            "of": 114_000,
            "examples": [{"path": "training/a.src", "line": 7, "text": "WAIT FOR A (B)"}],
        },
        "remaining": [
            {"path": path, "line": 4, "column": 5, "token": "{", "text": "LIN {{ X 1", "follows": 0}
            for path, _, _ in left
        ],
        "remaining_files": [
            {
                "path": path,
                "origin": "training",
                "copies": [],
                "bytes": 217,
                "lines": 10,
                "failing": 1,
                "fact": fact,
                "fact_line": line,
                "kind": "invalid" if fact else "",
                "reason": fact,
            }
            for path, fact, line in left
        ],
    }


# -- the restrictive start beside the grammar in force ---------------------------------------------


def _started() -> Json:
    """The survey of the start: each cluster but every fourth was answered by a construct."""
    constructs = growth_record(9)["steps"][1:]
    record = believable_record()
    for rank, cluster in enumerate(record["clusters"]):
        cluster["answered_by"] = constructs[rank % 9]["id"] if rank % 4 else None
    del record["failures"]
    return record | {"constructs": constructs}


def story_record() -> Json:
    """A survey in which every file parsed, and what it was like under the start."""
    return complete_record() | {"start": _started()}


def both_record() -> Json:
    """A survey with clusters, and that of the start, whose clusters have the same names."""
    return believable_record() | {"start": _started()}


HOSTILE = (
    "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=1>"
    "<!--\x1b[31m\x00\u202e\ud800\u2028{{ 7*7 }}"
)


def poisoned(value: Any) -> Any:
    """A record in which every text, wherever it stands, tries to break out of the page."""
    if isinstance(value, dict):
        return {name: poisoned(item) for name, item in value.items()}
    if isinstance(value, list):
        return [poisoned(item) for item in value]
    # Ids stay distinct, as in a real record; they too carry the poison.
    return value + HOSTILE if isinstance(value, str) else value


def hostile_record() -> Json:
    """A survey whose texts are poisoned."""
    record: Json = poisoned(both_record())
    return record


@pytest.fixture
def narrow(browser: webdriver.Chrome) -> Iterator[None]:
    """A window of 400 pixels."""
    metrics = {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    yield
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


RecordBuilder = Callable[[], Json]
_BUILDERS: dict[str, RecordBuilder] = {
    "believable": believable_record,
    "large": large_record,
    "complete": complete_record,
    "empty": empty_record,
    "hostile": hostile_record,
    "story": story_record,
    "both": both_record,
}


@pytest.fixture(scope="session")
def survey_record() -> Callable[[str], Json]:
    """Builds a fresh record by name, one of `_BUILDERS`."""
    return lambda name: _BUILDERS[name]()


_GROWN: dict[str, RecordBuilder] = {
    "believable": growth_record,
    "hostile": lambda: poisoned(growth_record(12)),
    "start": lambda: growth_record() | {"steps": growth_record()["steps"][:1]},
    "empty": dict,
}


@pytest.fixture(scope="session")
def grown() -> Callable[[str], Json]:
    """Builds a fresh record of a growth by name: believable, hostile, start, empty."""
    return lambda name: _GROWN[name]()
