"""The abstract syntax tree: one node for each concept of KRL, built by `grammar.syntax.build`.

Nodes are frozen and compare by identity, so side tables (types, symbols) can be keyed by them;
`grammar.syntax.walk.same` compares their content. Every node has a span: the offset of its first
character and the exclusive end offset in its source text. Comments and folds are no nodes. They lie
between the tokens, and `grammar.syntax.source` finds them by line.

Beside its fields a node declares how it is written (`template`). The printer and the list of a
block's bodies follow from that.

Sequences are tuples. An optional part that is missing is ``None``. Blocks nest without a limit, so
walks over statements must not recurse. Within a line, nodes are at most
`grammar.syntax.node_plans.MAX_DEPTH` deep, except along the left operands of operators: a sum may
have any number of terms (`grammar.syntax.walk.left_chain`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from support.lazy_dataclass import node

Span = tuple[int, int]


@node
class Node:
    """The base of all nodes: its span, as offsets into the source text."""

    span: Span


_Node = TypeVar("_Node", bound=type[Node])

#: The lines of each node, see `template`.
TEMPLATES: dict[type[Node], tuple[str, ...]] = {}


def template(*lines: str) -> Callable[[_Node], _Node]:
    """Return a decorator that declares how a node is written, one argument for each line.

    ``<field>`` is the text of a field: lists are separated by commas, ``indices`` are put in
    brackets, a ``path`` has slashes. ``<field|text>`` is ``text`` if the field has a value, with
    ``*`` replaced by that value. ``<<field>>`` are the nodes of a field, each on lines of its own;
    a node with such a field is a block.
    """

    def add(kind: _Node) -> _Node:
        TEMPLATES[kind] = lines
        return kind

    return add


@template("<text>")
@node
class Name(Node):
    """A name as written. Compare names by ``key``, because letter case does not matter.

    Types whose names are keywords (INT, FRAME, E6POS …) are in upper case, as all keywords are.
    """

    text: str

    @property
    def key(self) -> str:
        """The name in upper case [TYP-05]."""
        return self.text.upper()


@template("<name><indices>")
@node
class TypeName(Node):
    """The name of a type, with ``indices`` if it is an array: CHAR[128] [TYP-17]."""

    name: Name
    indices: tuple[Expression | None, ...] | None


# ------------------------------------------------------------------------------------ expressions


@template("<value>")
@node
class IntegerLiteral(Node):
    """A decimal integer; the type checker tests whether it fits into 32 bits [TYP-01].

    Only the least INT includes its sign. A number with more than 1,000 digits becomes ten to the
    power of 1,000.
    """

    value: int


@template("<text>")
@node
class RealLiteral(Node):
    """A number with a decimal point or an exponent; ``text`` as written [TYP-02]."""

    text: str

    @property
    def value(self) -> float:
        """The number, not yet rounded to the controller's precision."""
        return float(self.text)


@template("<value>")
@node
class BoolLiteral(Node):
    """TRUE or FALSE."""

    value: bool


@template("<text>")
@node
class BitLiteral(Node):
    """A binary or hexadecimal integer, ``'B101'`` or ``'HFF'``; ``text`` as written [TYP-04]."""

    text: str
    value: int


@template('"<text>"')
@node
class StringLiteral(Node):
    """A text without its quotation marks; with one letter it is a CHAR as well [TYP-03, TYP-11]."""

    text: str


@template("#<name>")
@node
class EnumConstant(Node):
    """``#NAME``; its enumeration follows from where it is used [TYP-16]."""

    name: Name


Literal = IntegerLiteral | RealLiteral | BoolLiteral | BitLiteral | StringLiteral | EnumConstant


@template("<name>")
@node
class Variable(Node):
    """A variable by its name; system variables begin with a dollar sign."""

    name: Name


@template("<base><indices>")
@node
class Subscript(Node):
    """``base[indices]``; a missing index means all of that dimension [TYP-08, TYP-11]."""

    base: Expression
    indices: tuple[Expression | None, ...]


@template("<base>.<name>")
@node
class Member(Node):
    """``base.name``, a member of a structure."""

    base: Expression
    name: Name


@template(":<name>")
@node
class ChannelName(Node):
    """``:NAME``, a channel as an argument."""

    name: Name


@template("<name>(<arguments>)")
@node
class Call(Node):
    """A call of a routine; a missing argument is ``None`` [SCO-13]. ``F()`` has no arguments."""

    name: Name
    arguments: tuple[Expression | None, ...]


@node
class Unary(Node):
    """``operator`` is NOT, B_NOT, + or -, in upper case."""

    operator: str
    operand: Expression


@node
class Binary(Node):
    """An operation with two operands [ARI-05].

    ``operator`` is one of ``+ - * / : == <> < > <= >=``, AND, OR, EXOR, B_AND, B_OR, B_EXOR; the
    spellings ``=>`` and ``=<`` are normalised.
    """

    operator: str
    left: Expression
    right: Expression


@template("(<inner>)")
@node
class Parenthesised(Node):
    """An expression in parentheses, kept so that it is printed as its author wrote it."""

    inner: Expression


@template("<name><indices> <value>")
@node
class Component(Node):
    """A component of an aggregate: its name, an index if it is an array, and its value."""

    name: Name
    indices: tuple[Expression | None, ...] | None
    value: Expression


@template("{<type|*: ><components>}")
@node
class Aggregate(Node):
    """``{X 1, Y 2}``; missing components get no value [TYP-19]. ``type`` is the prefix."""

    type: Name | None
    components: tuple[Component, ...]


Expression = (
    Literal
    | Variable
    | Subscript
    | Member
    | ChannelName
    | Call
    | Unary
    | Binary
    | Parenthesised
    | Aggregate
)


# ----------------------------------------------------------------------------------- declarations


@template("<name><indices><value|=*>")
@node
class Declarator(Node):
    """A name that a declaration introduces; only data lists have initial values [TYP-10]."""

    name: Name
    indices: tuple[Expression | None, ...] | None
    value: Expression | None


@template("<has_decl|DECL ><is_global|GLOBAL ><is_constant|CONST ><type> <declarators>")
@node
class VariableDeclaration(Node):
    """Variables of one type. ``has_decl`` says whether DECL was written [TYP-06]."""

    has_decl: bool
    is_global: bool
    is_constant: bool
    type: Name
    declarators: tuple[Declarator, ...]


@template("<is_global|GLOBAL >ENUM <name> <constants>")
@node
class Enumeration(Node):
    """ENUM: a type and its constants, in order [TYP-16]."""

    is_global: bool
    name: Name
    constants: tuple[Name, ...]


@template("<type> <declarators>")
@node
class MemberGroup(Node):
    """Members of a structure that share their type."""

    type: Name
    declarators: tuple[Declarator, ...]


@template("<is_global|GLOBAL >STRUC <name> <groups>")
@node
class Structure(Node):
    """STRUC: a type and its members, in order [TYP-14]."""

    is_global: bool
    name: Name
    groups: tuple[MemberGroup, ...]


@template("<has_decl|DECL ><is_global|GLOBAL >SIGNAL <name> <first><last| TO *>")
@node
class Signal(Node):
    """A name for an input or output, or for the range from ``first`` to ``last`` [IOT-03].

    A predefined signal that is not connected has FALSE as its ``first``.
    """

    has_decl: bool
    is_global: bool
    name: Name
    first: Expression
    last: Expression | None


@template("<type><name| *><indices><mode|:*>")
@node
class ExternalParameter(Node):
    """A parameter of an external routine; ``mode`` is IN, OUT or ``None``."""

    type: Name
    name: Name | None
    indices: tuple[Expression | None, ...] | None
    mode: str | None


@template("<keyword><result| *> <name>(<parameters>)")
@node
class External(Node):
    """A routine of another module; ``keyword`` is EXT, EXTP, EXTFCT or EXTFCTP [SCO-10]."""

    keyword: str
    result: TypeName | None
    name: Name
    parameters: tuple[ExternalParameter, ...]


@template("CHANNEL :<name> :<interface> <description>")
@node
class ChannelDefinition(Node):
    """CHANNEL: its name, the interface it uses, and the structure that describes it."""

    name: Name
    interface: Name
    description: Expression


@template("<has_decl|DECL >IMPORT <type> <declarator> IS <path>..<source>")
@node
class Importation(Node):
    """IMPORT: a variable of another data list under a name of its own [ADV-05]."""

    has_decl: bool
    type: Name
    declarator: Declarator
    path: tuple[Name, ...]
    source: Expression


Definition = (
    VariableDeclaration
    | Enumeration
    | Structure
    | Signal
    | External
    | ChannelDefinition
    | Importation
)


# ------------------------------------------------------------------------------------- statements


@template("<target> = <value>")
@node
class Assignment(Node):
    """``target = value``; in a data list, the initial value of an element or a text [TYP-10]."""

    target: Expression
    value: Expression


@template("<call>")
@node
class CallStatement(Node):
    """A call of a routine as a statement."""

    call: Call


@template("IF <condition> THEN", "  <<body>>", "<otherwise|ELSE>", "  <<otherwise>>", "ENDIF")
@node
class If(Node):
    """IF; ``otherwise`` is ``None`` without ELSE."""

    condition: Expression
    body: tuple[Statement, ...]
    otherwise: tuple[Statement, ...] | None


@template("FOR <counter> = <first> TO <last><step| STEP *>", "  <<body>>", "ENDFOR")
@node
class For(Node):
    """FOR: a loop from ``first`` to ``last``, both included [CTL-05]."""

    counter: Name
    first: Expression
    last: Expression
    step: Expression | None
    body: tuple[Statement, ...]


@template("WHILE <condition>", "  <<body>>", "ENDWHILE")
@node
class While(Node):
    """WHILE: a loop that is tested before each pass [CTL-01]."""

    condition: Expression
    body: tuple[Statement, ...]


@template("REPEAT", "  <<body>>", "UNTIL <condition>")
@node
class Repeat(Node):
    """REPEAT … UNTIL: a loop that is tested after each pass and ends when TRUE [CTL-01]."""

    body: tuple[Statement, ...]
    condition: Expression


@template("LOOP", "  <<body>>", "ENDLOOP")
@node
class Loop(Node):
    """LOOP: an endless loop, left by EXIT [CTL-01]."""

    body: tuple[Statement, ...]


@template("CASE <values>", "  <<body>>")
@node
class CaseBranch(Node):
    """CASE: its constants or names of constants, and its statements [CTL-04]."""

    values: tuple[Expression, ...]
    body: tuple[Statement, ...]


@template(
    "SWITCH <selector>", "  <<branches>>", "  <default|DEFAULT>", "    <<default>>", "ENDSWITCH"
)
@node
class Switch(Node):
    """SWITCH; ``default`` is ``None`` without DEFAULT [CTL-03, CTL-04]."""

    selector: Expression
    branches: tuple[CaseBranch, ...]
    default: tuple[Statement, ...] | None


@template("EXIT")
@node
class Exit(Node):
    """EXIT: leaves the innermost loop [CTL-02]."""


@template("GOTO <label>")
@node
class Goto(Node):
    """GOTO a label of the same routine [CTL-07]."""

    label: Name


@template("<name>:")
@node
class Label(Node):
    """``NAME:``, the target of a GOTO."""

    name: Name


@template("RETURN<value| *>")
@node
class Return(Node):
    """RETURN, with a value in functions [CTL-09]."""

    value: Expression | None


@template("HALT")
@node
class Halt(Node):
    """HALT [CTL-08]."""


@template("CONTINUE")
@node
class Continue(Node):
    """CONTINUE: the next line does not stop the advance run [ADV-08]."""


@template("ON_ERROR_PROCEED")
@node
class OnErrorProceed(Node):
    """ON_ERROR_PROCEED: an error of the next statement is stored in $ERR [FCT-12]."""


@template("CONFIRM <number>")
@node
class Confirm(Node):
    """CONFIRM: acknowledges a message by its number."""

    number: Expression


@template("WAIT FOR <condition>")
@node
class WaitFor(Node):
    """WAIT FOR a condition [CTL-12]."""

    condition: Expression


@template("WAIT SEC <duration>")
@node
class WaitSeconds(Node):
    """WAIT SEC, a time in seconds [TIM-06]."""

    duration: Expression


@template("<keyword> ON <assignment><delay| DELAY=*><minimum| MINIMUM=*><maximum| MAXIMUM=*>")
@node
class SignalOn(Node):
    """ANIN ON, ANOUT ON or DIGIN ON; ``keyword`` is the first word [IOT-05, IOT-09]."""

    keyword: str
    assignment: Assignment
    delay: Expression | None
    minimum: Expression | None
    maximum: Expression | None


@template("<keyword> OFF <variable>")
@node
class SignalOff(Node):
    """ANIN OFF, ANOUT OFF or DIGIN OFF."""

    keyword: str
    variable: Expression


# --------------------------------------------------------------------------------------- motions


@template("<kind> <auxiliary|*, ><target><angle|, CA *><values| WITH *><criteria| *><reference| *>")
@node
class Motion(Node):
    """A motion of any kind, except those of option packages.

    ``kind`` is its keyword: PTP, LIN, CIRC, SPTP, SLIN, SCIRC, SPL, their _REL forms, or ASYPTP.
    ``auxiliary`` is the auxiliary point of a circle, ``angle`` follows CA [MOT-13]. ``values``
    follow WITH [SPL-08], ``criteria`` are C_PTP, C_DIS, C_ORI, C_VEL or C_SPL [BLD-06],
    ``reference`` is #BASE or #TOOL [MOT-14].
    """

    kind: str
    auxiliary: Expression | None
    target: Expression
    angle: Expression | None
    values: tuple[Assignment, ...]
    criteria: tuple[str, ...]
    reference: EnumConstant | None


@template("MOVE_EMI <device> <action><number| FLT *>")
@node
class EmilyMotion(Node):
    """MOVE_EMI: a path stored by an option package."""

    device: Expression
    action: Expression
    number: Expression | None


@template("CONST_VEL <edge>=<place><on_start| ONSTART>")
@node
class ConstantVelocity(Node):
    """CONST_VEL: ``edge`` is START or END of the range, ``place`` in mm [SPL-05, SPL-07]."""

    edge: str
    place: Expression
    on_start: bool


@template("TIME_BLOCK <edge><value|=*>")
@node
class TimeBlock(Node):
    """TIME_BLOCK: ``edge`` is START, PART or END; START has no value [SPL-10]."""

    edge: str
    value: Expression | None


@template("STOP WHEN PATH=<place><on_start| ONSTART> IF <condition>")
@node
class StopWhen(Node):
    """STOP WHEN PATH: a conditional stop at a place in mm [SPL-06, SPL-07]."""

    place: Expression
    on_start: bool
    condition: Expression


@template("<keyword><values| WITH *>", "  <<items>>", "ENDSPLINE<is_approximated| C_SPL>")
@node
class SplineBlock(Node):
    """SPLINE or PTP_SPLINE: motions planned and executed as one [SPL-01]."""

    keyword: str
    values: tuple[Assignment, ...]
    items: tuple[Motion | Trigger | ConstantVelocity | TimeBlock | StopWhen, ...]
    is_approximated: bool


# ------------------------------------------------------------------------ interrupts and triggers


@template("BRAKE<mode| *>")
@node
class Brake(Node):
    """BRAKE; ``mode`` is F, FF or ``None`` [INT-09]."""

    mode: str | None


@template("RESUME")
@node
class Resume(Node):
    """RESUME [INT-10]."""


@template("<is_global|GLOBAL >INTERRUPT DECL <number> WHEN <condition> DO <action>")
@node
class InterruptDeclaration(Node):
    """INTERRUPT DECL; its number is its priority [INT-01, INT-02]."""

    is_global: bool
    number: Expression
    condition: Expression
    action: CallStatement | Brake


@template("INTERRUPT <action><number| *>")
@node
class InterruptSwitch(Node):
    """INTERRUPT ON, OFF, ENABLE or DISABLE; without a number, all of them [INT-07]."""

    action: str
    number: Expression | None


@template(
    "TRIGGER WHEN <place_kind>=<place><on_start| ONSTART>"
    " DELAY=<delay> DO <action><priority| PRIO=*>"
)
@node
class Trigger(Node):
    """TRIGGER. ``place_kind`` is DISTANCE or PATH (mm), ``delay`` in ms [TRG-01 to TRG-06]."""

    place_kind: str
    place: Expression
    on_start: bool
    delay: Expression
    action: Assignment | CallStatement
    priority: Expression | None


Statement = (
    Definition
    | Assignment
    | CallStatement
    | If
    | For
    | While
    | Repeat
    | Loop
    | Switch
    | Exit
    | Goto
    | Label
    | Return
    | Halt
    | Continue
    | OnErrorProceed
    | Confirm
    | WaitFor
    | WaitSeconds
    | SignalOn
    | SignalOff
    | Motion
    | EmilyMotion
    | SplineBlock
    | Brake
    | Resume
    | InterruptDeclaration
    | InterruptSwitch
    | Trigger
)
#: What a data list holds.
Item = Definition | Assignment


# ---------------------------------------------------------------------------------------- modules


@template("<name><indices><mode|:*>")
@node
class Parameter(Node):
    """A formal parameter; ``mode`` is IN, OUT, or ``None``, which means OUT [SCO-06, SCO-07]."""

    name: Name
    indices: tuple[Expression | None, ...] | None
    mode: str | None


@template(
    "<is_global|GLOBAL >DEF<result|FCT *> <name>(<parameters>)", "<<body>>", "END<result|FCT>"
)
@node
class Routine(Node):
    """DEF, or DEFFCT if there is a ``result``. The declarations are part of the body."""

    is_global: bool
    result: TypeName | None
    name: Name
    parameters: tuple[Parameter, ...]
    body: tuple[Statement, ...]


@template("<<routines>>")
@node
class Program(Node):
    """A SRC or SUB file; the first routine carries the name of the file [SCO-01]."""

    routines: tuple[Routine, ...]


@template("DEFDAT <name><is_public| PUBLIC>", "<<items>>", "ENDDAT")
@node
class DataList(Node):
    """A DAT file."""

    name: Name
    is_public: bool
    items: tuple[Item, ...]


@template("<text>")
@node
class Header(Node):
    """A line of the controller's file system: &ACCESS, &REL …"""

    text: str


@node
class Module(Node):
    """One file; ``called`` are the routines that it calls, in upper case."""

    headers: tuple[Header, ...]
    content: Program | DataList
    called: frozenset[str] = frozenset()
