"""Metamorphic testing: programs run before and after changes that must not be observable.

A law needs no expectation: it says what two runs have in common, whatever they do. So it can find
defects that all executors share.
"""
