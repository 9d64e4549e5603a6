"""Syntax failures as diagnostics, with the probable mistake and a fix; `findings` makes them.

The recogniser finds the first token that no program can have there, and all tokens that could come
instead. Frequent mistakes are recognised by their tokens: `blocks`, `words`, `signs`, `statements`
and `corrections` hold one function a kind of mistake. For any other failure `unexpected` reports
the expected tokens.
"""
