"""Reads instructions and their operands from assembly text."""

from __future__ import annotations

from collections.abc import Mapping

from grammar.semantics.types import BOOL
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.symbols import Symbols, constant_word, looked_up, part_offset
from interp.bytecode.assembly.syntax import Key, Line, key
from interp.bytecode.instruction_set.table import shape
from interp.bytecode.program import Instruction, Mode, Slot
from interp.values.faults import FAULTS
from support.lazy_dataclass import dataclass

_FAULTS = {slug: kind.code for slug, kind in FAULTS.items()}


@dataclass(frozen=True, slots=True)
class Operands:
    """Reads the instructions of one code object.

    ``targets`` maps its labels to instructions; ``frame`` has the positions of parameters and
    locals.
    """

    _symbols: Symbols
    _targets: Mapping[str, int]
    _frame: Mapping[Key, Slot]

    def instruction(self, line: Line) -> Instruction:
        """Return the instruction in a line."""
        name = line.take("word", "an instruction")
        if name not in Op.__members__:
            raise line.error(f"there is no instruction {name}")
        operands: list[int] = []
        for kind in shape(name).operands:
            if name == "PUSH_ENUM" and kind == "count":
                operands.append(self._symbols.constant(line, operands[0]))
            else:
                operands.append(self._operand(line, kind))
        line.done()
        return Instruction(Op[name], tuple(operands))

    def _operand(self, line: Line, kind: str) -> int:
        """Return an operand given by name or as a number."""
        if line.found("#"):
            return line.integer()
        match kind:
            case "real":
                return line.real()
            case "target":
                return looked_up(line, line.take("word", "a label"), self._targets, "label")
            case "type":
                return self._symbols.type_number(line)
            case "code":
                return self._symbols.code_number(line)
            case "text" | "ask" | "builtin":
                return self._symbols.labelled(line, kind)
            case "fault":
                slug = line.take("word", "a fault")
                return looked_up(line, slug, _FAULTS, "fault")
        return line.integer() if line.has("int") else self._named_place(line, kind)

    def _named_place(self, line: Line, kind: str) -> int:
        match kind:
            case "bool":
                return constant_word(line, BOOL)
            case "char":
                return _letter(line)
            case "local":
                return self._local(line)
            case "data":
                return self._symbols.data_place(line)
        return line.integer()

    def _local(self, line: Line) -> int:
        label = line.label()
        slot = self._frame.get(key(label))
        if slot is None:
            raise line.error(f"there is no parameter or local {label[0]}")
        if slot.variable.mode is not Mode.IN:
            return slot.offset
        return slot.offset + part_offset(line, self._symbols.types[slot.variable.type])


def _letter(line: Line) -> int:
    letter = line.string()
    if len(letter) != 1:
        raise line.error("one letter is needed")
    return ord(letter)
