"""Forms: the text of a rule that reads all lines, or all contents of brackets, of one kind.

``PAIR A``, ``PAIR A LEFT B`` and ``PAIR ON`` have the form ``PAIR (NAME (LEFT NAME)? | ON)``.

`symbol_reader` reads tokens as symbols: words, signs, and operands as `operand_rules` finds them in
a grammar. `writer` writes a form from lines of symbols. Its steps are `operand_splits`, `lists`,
`marks`, `chain`, `operand_cover` and `chain_text`, in this order. `samples` gives lines that a rule
reads, so that a form can extend it; `loose` tells which forms are too wide.
"""
