"""The grammar in force, KRL.g4, as data."""

from __future__ import annotations

import hashlib

from grammar._generated import krl_grammar as generated
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar


def krl_grammar() -> Grammar:
    """Return the grammar in ``KRL.g4``.

    It comes from the generated module ``_generated/krl_grammar.py`` if that was made from the file
    as it is now, because every command needs the grammar at its start and Lark takes long to build
    a parser. Otherwise the file is parsed. Raises `grammar.notation.model.GrammarError` if the file
    is no grammar.
    """
    source = GRAMMAR.read_bytes().replace(b"\r\n", b"\n")
    if hashlib.sha256(source).hexdigest() == generated.SHA256:
        return generated.grammar()
    from grammar.notation.g4 import read_file  # brings Lark

    return read_file(GRAMMAR)
