"""Forms: the text of a rule that reads all lines, or all contents of brackets, of one kind.

`writer` writes them from lines of symbols. Its steps are `operand_splits`, `lists`, `marks`,
`chain`, `operand_cover` and `chain_text`, in this order. `samples` turns a rule into such lines.
"""
