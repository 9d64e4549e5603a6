"""The grammar in force is what KRL.g4 holds, whether that was generated or is read."""

from pathlib import Path

import pytest

from grammar.notation import krl_grammar as module
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.lexer import lexer_of
from grammar.syntax.build import read_module


def test_generated_data_are_what_is_read() -> None:
    """Nothing is lost, spans and texts included."""
    assert repr(read_file(GRAMMAR)) == repr(module.krl_grammar())


def test_a_changed_grammar_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who edits KRL.g4 works with the edit at once, before anything is generated."""
    changed = tmp_path / "KRL.g4"
    changed.write_bytes(GRAMMAR.read_bytes() + b"NEWS : 'NEWS' ;\n")
    monkeypatch.setattr(module, "GRAMMAR", changed)
    assert "NEWS" == module.krl_grammar().rules[-1].name


def test_every_keyword_can_name_a_constant_of_an_enumeration() -> None:
    """A new one belongs in the rule ``keyword``, or programs with such a constant are lost."""
    lexer = lexer_of(module.krl_grammar())
    words = [word for kind, word in enumerate(lexer.display) if lexer.is_keyword(kind)]
    unread = [w for w in words if isinstance(read_module(f"DEF A()\n  X = #{w}\nEND\n"), list)]
    assert (len(words) > 100, unread) == (True, [])
