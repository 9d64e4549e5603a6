"""Every construct becomes the node that it is, where it stands, however deep it lies."""

from collections.abc import Mapping
from dataclasses import fields
from itertools import pairwise
from pathlib import Path

import pytest

from grammar.notation.edits import AddAlternative, AddRule, AddToken, Edit, apply
from grammar.notation.krl_grammar import krl_grammar
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from grammar.syntax import ast
from grammar.syntax.build import BLOCK_RULES, Builder, SyntaxFailure, builder, read_module
from grammar.syntax.node_plans import MAX_DEPTH, NoNode
from grammar.syntax.statement_rules import RULES
from grammar.syntax.unparse import expression
from grammar.syntax.walk import children, walk


def module_of(text: str) -> ast.Module:
    module = read_module(text)
    assert isinstance(module, ast.Module), module
    return module


def failures_of(text: str, path: str = "") -> list[SyntaxFailure]:
    found = read_module(text, path)
    assert isinstance(found, list)
    return found


def statements(*lines: str) -> tuple[ast.Statement, ...]:
    module = module_of("\n".join(["DEF MAIN()", *lines, "END", ""]))
    assert isinstance(module.content, ast.Program)
    return module.content.routines[0].body


def items(*lines: str) -> tuple[ast.Item, ...]:
    module = module_of("\n".join(["DEFDAT D", *lines, "ENDDAT", ""]))
    assert isinstance(module.content, ast.DataList)
    return module.content.items


def outline(value: object) -> str:
    """A node in words: names and literals as text, what is not there left out."""
    match value:
        case ast.Name(text=text):
            return text
        case ast.Variable(name=name):
            return name.text
        case ast.IntegerLiteral(value=number):
            return str(number)
        case ast.RealLiteral(text=text):
            return text
        case tuple():
            return f"[{' '.join('-' if item is None else outline(item) for item in value)}]"
        case ast.Node():
            names = [f.name for f in fields(value) if f.name not in ("span", "called")]
            parts = [(name, getattr(value, name)) for name in names]
            shown = [
                name if part is True else f"{name}={outline(part)}"
                for name, part in parts
                if part is not None and part is not False
            ]
            return f"{type(value).__name__}({' '.join(shown)})"
    return str(value)


# ------------------------------------------------------------------------------- statements

EXPRESSIONS = [
    ("A", "A"),
    ("12", "12"),
    ("007", "7"),
    ("1.5E-3", "1.5E-3"),
    ("true", "BoolLiteral(value)"),
    ("FALSE", "BoolLiteral()"),
    ("'B1 01'", "BitLiteral(text='B1 01' value=5)"),
    ("'hfF'", "BitLiteral(text='hfF' value=255)"),
    ('"a ;b"', "StringLiteral(text=a ;b)"),
    ("#red", "EnumConstant(name=red)"),
    ("$OUT[3]", "Subscript(base=$OUT indices=[3])"),
    ("T[]", "Subscript(base=T indices=[-])"),
    ("T[1,,3]", "Subscript(base=T indices=[1 - 3])"),
    ("P.A[2].B", "Member(base=Subscript(base=Member(base=P name=A) indices=[2]) name=B)"),
    ("F()", "Call(name=F arguments=[])"),
    ("F(1)", "Call(name=F arguments=[1])"),
    ("F(,A,)", "Call(name=F arguments=[- A -])"),
    ("F(:C)", "Call(name=F arguments=[ChannelName(name=C)])"),
    ("(A)", "Parenthesised(inner=A)"),
    ("-A", "Unary(operator=- operand=A)"),
    ("not b_not A", "Unary(operator=NOT operand=Unary(operator=B_NOT operand=A))"),
    ("A-B-C", "Binary(operator=- left=Binary(operator=- left=A right=B) right=C)"),
    ("A+B*C", "Binary(operator=+ left=A right=Binary(operator=* left=B right=C))"),
    ("A==B and C", "Binary(operator=== left=A right=Binary(operator=AND left=B right=C))"),
    (
        "A OR B EXOR C AND D",
        "Binary(operator=OR left=A right=Binary(operator=EXOR left=B "
        "right=Binary(operator=AND left=C right=D)))",
    ),
    ("A=>B", "Binary(operator=>= left=A right=B)"),
    ("A=<B", "Binary(operator=<= left=A right=B)"),
    ("A:B:C", "Binary(operator=: left=Binary(operator=: left=A right=B) right=C)"),
    ("-A:B", "Unary(operator=- operand=Binary(operator=: left=A right=B))"),
    (
        "{X 1,Y[] -2.5}",
        "Aggregate(components=[Component(name=X value=1) "
        "Component(name=Y indices=[-] value=Unary(operator=- operand=2.5))])",
    ),
    (
        "{FRAME: X {Z 1}}",
        "Aggregate(type=FRAME components=[Component(name=X "
        "value=Aggregate(components=[Component(name=Z value=1)]))])",
    ),
]


@pytest.mark.parametrize(("text", "expected"), EXPRESSIONS)
def test_expressions(text: str, expected: str) -> None:
    """An expression becomes a tree in which operators bind as ARI-05 says, from the left."""
    (statement,) = statements(f"X={text}")
    assert isinstance(statement, ast.Assignment)
    assert expected == outline(statement.value)


SIMPLE = [
    ("F(1)", "CallStatement(call=Call(name=F arguments=[1]))"),
    ("EXIT", "Exit()"),
    ("halt", "Halt()"),
    ("CONTINUE", "Continue()"),
    ("RESUME", "Resume()"),
    ("ON_ERROR_PROCEED", "OnErrorProceed()"),
    ("GOTO L", "Goto(label=L)"),
    ("L:", "Label(name=L)"),
    ("RETURN", "Return()"),
    ("RETURN A", "Return(value=A)"),
    ("WAIT FOR A", "WaitFor(condition=A)"),
    ("WAIT SEC 2", "WaitSeconds(duration=2)"),
    ("CONFIRM A", "Confirm(number=A)"),
    ("BRAKE", "Brake()"),
    ("brake ff", "Brake(mode=FF)"),
    ("INTERRUPT ON", "InterruptSwitch(action=ON)"),
    ("INTERRUPT disable 3", "InterruptSwitch(action=DISABLE number=3)"),
    (
        "GLOBAL INTERRUPT DECL 4 WHEN A DO F()",
        "InterruptDeclaration(is_global number=4 condition=A "
        "action=CallStatement(call=Call(name=F arguments=[])))",
    ),
    (
        "INTERRUPT DECL 4 WHEN A DO BRAKE",
        "InterruptDeclaration(number=4 condition=A action=Brake())",
    ),
    (
        "TRIGGER WHEN DISTANCE=0 DELAY=5 DO A=1",
        "Trigger(place_kind=DISTANCE place=0 delay=5 action=Assignment(target=A value=1))",
    ),
    (
        "TRIGGER WHEN PATH=1 ONSTART DELAY=2 DO F() PRIO=40",
        "Trigger(place_kind=PATH place=1 on_start delay=2 "
        "action=CallStatement(call=Call(name=F arguments=[])) priority=40)",
    ),
    ("ANIN OFF A", "SignalOff(keyword=ANIN variable=A)"),
    (
        "ANOUT ON A=B MINIMUM=1 MAXIMUM=2",
        "SignalOn(keyword=ANOUT assignment=Assignment(target=A value=B) minimum=1 maximum=2)",
    ),
    (
        "ANOUT ON A=B DELAY=3",
        "SignalOn(keyword=ANOUT assignment=Assignment(target=A value=B) delay=3)",
    ),
    ('MOVE_EMI A "B" FLT 3', "EmilyMotion(device=A action=StringLiteral(text=B) number=3)"),
]

MOTIONS = [
    ("PTP P", "kind=PTP target=P values=[] criteria=[]"),
    ("LIN P C_DIS c_ori", "kind=LIN target=P values=[] criteria=[C_DIS C_ORI]"),
    ("CIRC A,B,CA 90 C_DIS", "kind=CIRC auxiliary=A target=B angle=90 values=[] criteria=[C_DIS]"),
    (
        "LIN_REL P C_VEL #TOOL",
        "kind=LIN_REL target=P values=[] criteria=[C_VEL] reference=EnumConstant(name=TOOL)",
    ),
    ("ASYPTP P", "kind=ASYPTP target=P values=[] criteria=[]"),
    ("LIN A:B", "kind=LIN target=Binary(operator=: left=A right=B) values=[] criteria=[]"),
    (
        "SLIN P WITH V=1, W=2 C_SPL",
        "kind=SLIN target=P values=[Assignment(target=V value=1) Assignment(target=W value=2)] "
        "criteria=[C_SPL]",
    ),
    (
        "SCIRC_REL A,B,CA 9 #BASE",
        "kind=SCIRC_REL auxiliary=A target=B angle=9 values=[] criteria=[] "
        "reference=EnumConstant(name=BASE)",
    ),
]
SIMPLE += [(text, f"Motion({expected})") for text, expected in MOTIONS]


@pytest.mark.parametrize(("text", "expected"), SIMPLE)
def test_statements_of_one_line(text: str, expected: str) -> None:
    """A statement becomes the node that it is, keywords in upper case."""
    assert [expected] == [outline(statement) for statement in statements(text)]


BLOCKS = [
    ("IF A THEN|HALT|ENDIF", "If(condition=A body=[Halt()])"),
    ("IF A THEN|ELSE||HALT|EXIT|ENDIF", "If(condition=A body=[] otherwise=[Halt() Exit()])"),
    ("IF A THEN|ELSE|ENDIF", "If(condition=A body=[] otherwise=[])"),
    ("FOR I=1 TO N|HALT|ENDFOR", "For(counter=I first=1 last=N body=[Halt()])"),
    ("FOR I=1 TO N STEP 2|ENDFOR", "For(counter=I first=1 last=N step=2 body=[])"),
    ("WHILE A|HALT|ENDWHILE", "While(condition=A body=[Halt()])"),
    ("REPEAT|HALT|UNTIL A", "Repeat(body=[Halt()] condition=A)"),
    ("LOOP|LOOP|EXIT|ENDLOOP|ENDLOOP", "Loop(body=[Loop(body=[Exit()])])"),
    (
        "SWITCH A|CASE 1,B|HALT|CASE #C|DEFAULT|EXIT|ENDSWITCH",
        "Switch(selector=A branches=[CaseBranch(values=[1 B] body=[Halt()]) "
        "CaseBranch(values=[EnumConstant(name=C)] body=[])] default=[Exit()])",
    ),
    ("SWITCH A|CASE 1|ENDSWITCH", "Switch(selector=A branches=[CaseBranch(values=[1] body=[])])"),
    (
        "SPLINE WITH V=1|SPL P|TIME_BLOCK START|TIME_BLOCK PART=3|CONST_VEL END=4 ONSTART"
        "|STOP WHEN PATH=5 IF A|ENDSPLINE C_SPL",
        "SplineBlock(keyword=SPLINE values=[Assignment(target=V value=1)] items=["
        "Motion(kind=SPL target=P values=[] criteria=[]) TimeBlock(edge=START) "
        "TimeBlock(edge=PART value=3) ConstantVelocity(edge=END place=4 on_start) "
        "StopWhen(place=5 condition=A)] is_approximated)",
    ),
    ("PTP_SPLINE|ENDSPLINE", "SplineBlock(keyword=PTP_SPLINE values=[] items=[])"),
]


@pytest.mark.parametrize(("text", "expected"), BLOCKS)
def test_blocks(text: str, expected: str) -> None:
    """A block holds its statements; what was not written is not there."""
    assert [expected] == [outline(statement) for statement in statements(*text.split("|"))]


DECLARATIONS = [
    (
        "DECL frame A[2,3], B",
        "VariableDeclaration(has_decl type=FRAME declarators="
        "[Declarator(name=A indices=[2 3]) Declarator(name=B)])",
    ),
    ("int i", "VariableDeclaration(type=INT declarators=[Declarator(name=i)])"),
    ("DECL my_t i", "VariableDeclaration(has_decl type=my_t declarators=[Declarator(name=i)])"),
    ("GLOBAL ENUM E A, END", "Enumeration(is_global name=E constants=[A END])"),
    (
        "STRUC S INT A,B[2],REAL C",
        "Structure(name=S groups=[MemberGroup(type=INT declarators=[Declarator(name=A) "
        "Declarator(name=B indices=[2])]) "
        "MemberGroup(type=REAL declarators=[Declarator(name=C)])])",
    ),
    (
        "SIGNAL S $IN[1] TO $IN[8]",
        "Signal(name=S first=Subscript(base=$IN indices=[1]) last=Subscript(base=$IN indices=[8]))",
    ),
    ("SIGNAL S FALSE", "Signal(name=S first=BoolLiteral())"),
    (
        "EXT F(INT :IN,REAL A[]:OUT)",
        "External(keyword=EXT name=F parameters=[ExternalParameter(type=INT mode=IN) "
        "ExternalParameter(type=REAL name=A indices=[-] mode=OUT)])",
    ),
    (
        "EXTFCTP CHAR[8] F()",
        "External(keyword=EXTFCTP result=TypeName(name=CHAR indices=[8]) name=F parameters=[])",
    ),
    ("CHANNEL :A :B C", "ChannelDefinition(name=A interface=B description=C)"),
    (
        "IMPORT INT A IS /R1/D..B",
        "Importation(type=INT declarator=Declarator(name=A) path=[R1 D] source=B)",
    ),
]


@pytest.mark.parametrize(("text", "expected"), DECLARATIONS)
def test_declarations(text: str, expected: str) -> None:
    """A declaration becomes the same in a routine and in a data list."""
    assert [expected] == [outline(statement) for statement in statements(text)]
    assert [expected] == [outline(item) for item in items(text)]


def test_called_routines() -> None:
    """A module knows what it calls, wherever it does, and not what it defines or announces."""
    text = """DEF A( )
    EXT E( )
    b(C(1), X[D( )])
    IF F( ) THEN
    TRIGGER WHEN DISTANCE=0 DELAY=0 DO g( ) PRIO=5
    ENDIF
    END
    DEF H( )
    END
    """
    assert frozenset("BCDFG") == module_of(text).called


def test_initial_values() -> None:
    """A data list gives initial values where it declares, and below to elements."""
    expected = [
        "VariableDeclaration(has_decl is_global is_constant type=INT "
        "declarators=[Declarator(name=A value=1) Declarator(name=B indices=[2])])",
        "Assignment(target=Subscript(base=B indices=[1]) value=Unary(operator=- operand=2))",
        "VariableDeclaration(type=E6POS declarators=[Declarator(name=P "
        "value=Aggregate(components=[Component(name=X value=1)]))])",
    ]
    found = items("DECL GLOBAL CONST INT A=1,B[2]", "", "B[1]=-2", "E6POS P={X 1}")
    assert expected == [outline(item) for item in found]


def test_modules() -> None:
    """A module has its header lines, and routines or a data list."""
    text = "\n&ACCESS RVP\n&REL 1\n\nglobal deffct int[2] F(A[,]:in,B)\nendfct\n\nDEF G( )\nEND"
    expected = (
        "Module(headers=[Header(text=&ACCESS RVP) Header(text=&REL 1)] content=Program(routines=["
        "Routine(is_global result=TypeName(name=INT indices=[2]) name=F parameters=["
        "Parameter(name=A indices=[- -] mode=IN) Parameter(name=B)] body=[]) "
        "Routine(name=G parameters=[] body=[])]))"
    )
    assert expected == outline(module_of(text))
    assert "Module(headers=[] content=DataList(name=D is_public items=[]))" == outline(
        module_of("DEFDAT D PUBLIC\nENDDAT\n")
    )


# ------------------------------------------------------------------------------------ spans


def test_spans_hold_what_was_written() -> None:
    """The span of a node is its text: no blanks, comments or line ends around it."""
    text = " DEF A( ) ; one\n  IF B THEN ; two\n  X = - F(1 , C) ; three\n  ENDIF\n END ; four\n"
    module = module_of(text)
    texts = {type(node).__name__: text[slice(*node.span)] for node in walk(module)}
    assert text == texts["Module"]
    assert texts["Routine"] == texts["Program"] == text.strip().removesuffix(" ; four")
    assert "IF B THEN ; two\n  X = - F(1 , C) ; three\n  ENDIF" == texts["If"]
    assert "X = - F(1 , C)" == texts["Assignment"]
    assert "- F(1 , C)" == texts["Unary"]
    assert "F(1 , C)" == texts["Call"]
    assert "1" == texts["IntegerLiteral"]
    assert "C" == texts["Variable"]


def test_a_branch_ends_with_its_last_statement() -> None:
    """A branch of SWITCH reaches from CASE to the end of its last statement, or to its values."""
    text = "DEF A()\nSWITCH B\nCASE 1\nHALT\n\nCASE 2 ;\n\nENDSWITCH\nEND\n"
    branches = [node for node in walk(module_of(text)) if isinstance(node, ast.CaseBranch)]
    assert ["CASE 1\nHALT", "CASE 2"] == [text[slice(*branch.span)] for branch in branches]


def test_spans_nest(corpus: Mapping[Path, str]) -> None:
    """In every third own program nodes lie within their parents, one behind the other."""
    count = 0
    for path, text in list(corpus.items())[::3]:
        module = read_module(text) if "programs" in path.parts else []
        if isinstance(module, list):
            continue
        for node in walk(module):
            below = [child.span for child in children(node)]
            assert all(node.span[0] <= s < e <= node.span[1] for s, e in below), path
            assert all(before[1] <= after[0] for before, after in pairwise(below)), path
            if isinstance(node, ast.Name):
                assert text[slice(*node.span)].upper() == node.key
            count += 1
    assert count > 3_000


# -------------------------------------------------------------------------- what goes wrong


def test_every_rule_becomes_something(krl: Grammar) -> None:
    """Each parser rule is built within a line or over lines; others are but names of nodes."""
    rules = {rule.name for rule in krl.parser_rules}
    built = set(RULES) | BLOCK_RULES | {"eol"}
    names = {kind.__name__[0].lower() + kind.__name__[1:] for kind in ast.TEMPLATES}
    assert set() == rules - built
    assert set() == built - rules - names


def test_all_failures_are_reported() -> None:
    """A text with two syntax errors gives both: path, place, token and what could have come."""
    found = failures_of("DEF A()\nX=(1\nIF 2\nEND\n", "cell/a.src")
    assert [("cell/a.src", 2, 5, 12, "\n"), ("cell/a.src", 3, 5, 17, "\n")] == [
        (f.path, f.line, f.column, f.offset, f.text) for f in found
    ]
    assert [("primary", False), ("ifStatement", False)] == [(f.rule, f.follows) for f in found]
    assert ")" in found[0].expected
    assert "THEN" not in found[0].expected
    assert "THEN" in found[1].expected
    assert [None, None] == [f.reason for f in found]


def test_a_text_without_anything_fails() -> None:
    """An empty text is no module, and its one failure is the end of the file."""
    (failure,) = failures_of("")
    assert (1, 1, "") == (failure.line, failure.column, failure.text)
    assert "DEF" in failure.expected


@pytest.mark.parametrize(
    "line",
    [
        "X=" + "(" * 3_000 + "1" + ")" * 3_000,
        "X=1" + "+(1" * 201 + ")" * 201,
        "X=" + "NOT " * 300 + "A",
    ],
)
def test_too_deep_an_expression_is_a_failure(line: str) -> None:
    """What is nested deeper than the limit is refused with its line, not crashed on."""
    found = failures_of(f"DEF A()\nHALT\n{line}\nEND\n", "a.src")
    assert [("a.src", 3, f"nested more than {MAX_DEPTH} deep", ())] == [
        (f.path, f.line, f.reason, f.expected) for f in found
    ]


def test_what_is_far_too_deep_fails_where_it_gets_so() -> None:
    """The place of such a failure lies within the nesting, not at its start nor behind it."""
    (failure,) = failures_of("DEF A()\nX=" + "(" * 3_000 + "1" + ")" * 3_000 + "\nEND\n")
    assert MAX_DEPTH < failure.column < 2_000
    assert "(" == failure.text


@pytest.mark.parametrize(
    ("edits", "line", "rule"),
    [
        ([AddAlternative("simpleStatement", "DWELL caseValue")], "DWELL 1", "simpleStatement"),
        ([AddAlternative("simpleStatement", "DWELL")], "DWELL", "simpleStatement"),
        ([AddAlternative("goto", "DWELL sum sum")], "DWELL 1 2", "goto"),
        (
            [
                AddRule("halt", "dwell\n    : DWELL eol statement* ENDLOOP\n    ;"),
                AddAlternative("statement", "dwell eol"),
            ],
            "DWELL\nHALT\nENDLOOP",
            "dwell",
        ),
    ],
)
def test_what_has_no_node_is_named(edits: list[Edit], line: str, rule: str) -> None:
    """A construct is in the grammar before its node is here: the rule and what to do are said."""
    wider = apply(krl_grammar(), [AddToken("DWELL"), *edits])
    with pytest.raises(NoNode, match=f"no node for a form of {rule} .*CONTRIBUTING.*step 6"):
        Builder(Recognizer(wider)).read(f"DEF A()\n{line}\nEND\n")


def test_what_is_below_the_limit_is_built() -> None:
    """Nesting close to the limit gives a tree."""
    depth = MAX_DEPTH - 10
    (assignment,) = statements("X=" + "(" * depth + "1" + ")" * depth)
    assert depth == sum(isinstance(node, ast.Parenthesised) for node in walk(assignment))


@pytest.mark.parametrize("operator", ["+", "*", "AND", "EXOR", "==", ":"])
def test_a_chain_of_operators_is_no_nesting(operator: str) -> None:
    """Thousands of operands of equal rank are built, and printed as they were written."""
    text = (operator if operator == ":" else f" {operator} ").join(["A"] * 2_000)
    (assignment,) = statements(f"X={text}")
    assert isinstance(assignment, ast.Assignment)
    assert 1_999 == sum(isinstance(node, ast.Binary) for node in walk(assignment))
    assert text == expression(assignment.value)


def test_blocks_nest_without_limit() -> None:
    """Five thousand nested blocks are built."""
    (outer,) = statements(*["IF A THEN"] * 5_000, "HALT", *["ENDIF"] * 5_000)
    assert 5_000 == sum(isinstance(node, ast.If) for node in walk(outer))


def test_a_number_of_any_length_is_read() -> None:
    """Digits by the thousand neither fail nor take long; they are more than any number fits."""
    numbers = [
        node for s in statements(f"X={'9' * 50_000}", f"X={'0' * 5_000}8") for node in walk(s)
    ]
    assert [10**1_000, 8] == [n.value for n in numbers if isinstance(n, ast.IntegerLiteral)]


def test_the_grammar_is_loaded_once() -> None:
    """All of a process share one builder, and lines that are alike share their plan."""
    reader = builder()
    assert reader is builder()
    reader.read("DEF A()\nQ.R[1]=S\nEND\n")
    known = len(reader._plans)
    reader.read("DEF B()\n" + "T.U[2]=V\n" * 9 + "END\n")
    assert known == len(reader._plans)
