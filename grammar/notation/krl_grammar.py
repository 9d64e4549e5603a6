"""The grammar in force, KRL.g4, as data."""

from __future__ import annotations

import hashlib

from grammar._generated import krl_grammar as generated
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar


def krl_grammar() -> Grammar:
    """What KRL.g4 holds: as it was generated, or read anew where the file has changed since.

    Every command needs it when it starts, and to make a reader takes longer than to read. Raises
    `grammar.notation.model.GrammarError` where the file is no grammar.
    """
    source = GRAMMAR.read_bytes().replace(b"\r\n", b"\n")
    if hashlib.sha256(source).hexdigest() == generated.SHA256:
        return generated.grammar()
    from grammar.notation.g4 import read_file  # brings Lark

    return read_file(GRAMMAR)
