"""What a check gives back: side tables, findings that can be kept, notes for a whole project."""

import pickle
from collections.abc import Callable, Mapping
from typing import TypeVar

from grammar.check.names.unresolved_name import Files
from grammar.check.project.framework import Checked, Findings, check_project
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.types import BOOL, INT, REAL, Array, Constant, Text
from grammar.syntax import ast
from grammar.syntax.source import Source
from grammar.syntax.walk import walk

Check = Callable[..., Checked]
Find = Callable[..., list[Diagnostic]]
_N = TypeVar("_N", bound=ast.Node)

TEXT = """DEF NEG()
  DECL INT I, LIST[3]
  DECL REAL R
  I = LIST[2] + 1
  R = I * 0.5
  $ORI_TYPE = #VAR
  IF $MODE_OP == (#T1) THEN
    LIN {X 1.5, Y -2}
  ENDIF
  FOR I = 1 TO 9 STEP (1 + 1) * 2
  ENDFOR
  SIZE(#CP_PARAMS, "ABC")
END
"""


def node(checked: Checked, kind: type[_N], place: int = 0) -> _N:
    """A node of the tree by its kind and its place among them."""
    assert checked.module.syntax is not None
    return [one for one in walk(checked.module.syntax) if isinstance(one, kind)][place]


def test_every_expression_has_a_type(checked: Check) -> None:
    """No executor computes types again: all expressions are in the table."""
    made = checked(TEXT, others={"SIZE.src": "DEF SIZE(A:IN, B[]:IN)\n  DECL CHAR B[]\nEND\n"})
    assert made.module.syntax is not None
    sizes = {
        size
        for one in walk(made.module.syntax)
        if isinstance(one, ast.Declarator)
        for size in one.indices or ()
    }
    missing = [
        one
        for one in walk(made.module.syntax)
        if isinstance(one, ast.Expression) and one not in made.types and one not in sizes
    ]
    assert [] == missing


def test_types(checked: Check) -> None:
    """Types are those of the expressions themselves, whatever becomes of them."""
    made = checked(TEXT)
    sums = [made.types[node(made, ast.Binary, place)] for place in range(3)]
    assert [INT, REAL, BOOL] == sums
    assert INT == made.types[node(made, ast.Subscript)]
    assert Constant("VAR") == made.types[node(made, ast.EnumConstant)]
    assert Text(3) == made.types[node(made, ast.StringLiteral)]
    assert "E6POS" == str(made.types[node(made, ast.Aggregate)])
    array = made.types[node(made, ast.Subscript).base]
    assert Array(INT, (3,)) == array


def test_enumerations(checked: Check) -> None:
    """A constant has the enumeration of its place [TYP-16]."""
    made = checked(TEXT)
    names = {one.name.text: str(type_) for one, type_ in made.enumerations.items()}
    assert {"VAR": "ORI_TYPE", "T1": "MODE_OP"} == names


def test_values(checked: Check) -> None:
    """What has to be constant is folded."""
    made = checked(TEXT)
    loop = node(made, ast.For)
    assert isinstance(loop, ast.For)
    assert loop.step is not None
    assert 4 == made.values[loop.step]


def test_findings_can_be_kept(checked: Check) -> None:
    """What was found in a file survives pickling; notes on a project are made of it."""
    text = "DEF NEG()\n  OTHER()\n  I = TRUE + 1\nEND\n"
    files: Mapping[str, str] = {"B.src": text.replace("NEG", "B")}
    made = checked(text, others=files)
    kept = pickle.loads(pickle.dumps(made.findings))
    assert made.findings == kept
    file = Source(text, "NEG.src")

    def found(findings: Findings) -> list[Diagnostic]:
        return check_project([findings], Files.of([(file, made.module.table)]))

    assert found(made.findings) == found(kept)


def test_an_unknown_external_is_reported_once(finds: Find) -> None:
    """A name that several files take from elsewhere gives one note, at its first place."""
    text = "DEF {}()\n  FOREIGN()\n  FOREIGN()\nEND\n"
    found = finds({f"{name}.src": text.format(name) for name in "ABC"}, is_complete=False)
    assert [("A.src", 2, "KRL701")] == [(one.path, one.region.line, one.code) for one in found]
    assert "6 times" in found[0].message


def test_bodies_of_other_files_do_not_matter(checked: Check) -> None:
    """A file is judged by what others declare and not by what they do."""
    text = "DEF NEG()\n  OTHER(1, 2)\nEND\n"
    other = "DEF OTHER(A:IN)\n  DECL INT A\n{}END\n"
    plain = checked(text, others={"OTHER.src": other.format("")})
    busy = checked(text, others={"OTHER.src": other.format("  A = TRUE\n  HALT\n")})
    assert plain.findings == busy.findings
    assert plain.findings.diagnostics


def test_hints(finds: Find) -> None:
    """Names that are near, or begin alike, are offered, and nothing is wrong with them.

    Components that an aggregate has are not.
    """
    text = """DEF NEG()
  DECL INT COUNT
  COUNTT = 1
  $ORI_TYPE = #CONST
  $VEL.CB = 1
  PTP {A1 0, A2 0, A3 0, A4 0, A5 0, AA 0}
END
"""
    found = finds({"NEG.src": text})
    hints = {one.region.line: one.fix.text for one in found if one.fix}
    meant = {3: "COUNT", 4: "#CONSTANT", 5: "CP", 6: "A6"}
    assert {line: f"did you mean {name}?" for line, name in meant.items()} == hints
    lines = text.splitlines(keepends=True)
    for _, at, name in (one.edits[0] for one in found if one.fix):
        line = lines[at.line - 1]
        lines[at.line - 1] = line[: at.column - 1] + name + line[at.end_column - 1 :]
    assert not any(one.fix for one in finds({"NEG.src": "".join(lines)}))
