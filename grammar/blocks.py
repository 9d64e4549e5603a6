"""The blocks of KRL by their keywords: what opens, divides and closes them.

This is knowledge of the language that no grammar has to have: a program that cannot be read has no
tree, and a grammar may have no rule yet for a block. Which statements lie in a block that was read
follows from its node (`grammar.syntax.walk.bodies`).
"""

from __future__ import annotations

from collections.abc import Mapping

from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Block:
    """A block: the words that its lines begin with.

    ``branches`` begin a further branch, ``members`` stand in no other block. ``depth`` is how much
    deeper than the closing line the line before it is indented.
    """

    opener: str
    closer: str
    branches: tuple[str, ...] = ()
    members: tuple[str, ...] = ()
    depth: int = 1

    @property
    def words(self) -> frozenset[str]:
        """The words of lines that only make sense in this block, or end it."""
        return frozenset({self.closer, *self.branches, *self.members})


#: By the word that opens the block.
BLOCKS: Mapping[str, Block] = {
    block.opener: block
    for block in (
        Block("DEF", "END"),
        Block("DEFFCT", "ENDFCT"),
        Block("DEFDAT", "ENDDAT", depth=0),
        Block("IF", "ENDIF", branches=("ELSE",)),
        Block("FOR", "ENDFOR"),
        Block("WHILE", "ENDWHILE"),
        Block("REPEAT", "UNTIL"),
        Block("LOOP", "ENDLOOP"),
        Block("SWITCH", "ENDSWITCH", branches=("CASE", "DEFAULT"), depth=2),
        Block("SPLINE", "ENDSPLINE", members=("SPL", "SLIN", "SCIRC")),
        Block("PTP_SPLINE", "ENDSPLINE", members=("SPTP",)),
    )
}
#: The words that open a block that a word closes.
CLOSERS: Mapping[str, tuple[str, ...]] = {
    closer: tuple(block.opener for block in BLOCKS.values() if block.closer == closer)
    for closer in dict.fromkeys(block.closer for block in BLOCKS.values())
}
#: The word that opens a block that a word divides.
BRANCHES: Mapping[str, str] = {
    branch: block.opener for block in BLOCKS.values() for branch in block.branches
}
#: The words that open a block that lies in no other one.
OUTERMOST = frozenset({"DEF", "DEFFCT", "DEFDAT"})
#: The words of lines that declare a routine with its parameters.
SIGNATURES = frozenset({"DEF", "DEFFCT", "EXT", "EXTFCT"})
#: What may stand before the word that opens a block.
PREFIXES = frozenset({"GLOBAL"})
