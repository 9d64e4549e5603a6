"""Generating the parser of a new grammar, and testing it on the ledger's examples.

ANTLR's parser is the reference. If it and our recogniser treat an example differently, they
disagree about the grammar, and the parser is not kept.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

from grammar.notation.generate import check, generate
from grammar.notation.model import Grammar
from grammar.parser import antlr_reference
from recovery.ledger.construct import Construct

#: Generates the parser of a grammar file in a folder, like `grammar.notation.generate.generate`.
Generator = Callable[[Path, Path], None]

_MODULES = ("grammar._generated.KRLLexer", "grammar._generated.KRLParser")


def parser_of(
    grammar: Grammar, kept: Path, examples: Iterable[Construct], generator: Generator = generate
) -> tuple[Mapping[str, bytes], list[tuple[str, str]]]:
    """Return the files of the generated parser by name, and its errors on the examples.

    Returns nothing if the parser in the folder ``kept`` already is that of this grammar. Raises
    `grammar.notation.generate.GenerationError`.
    """
    with tempfile.TemporaryDirectory() as scratch:
        source, folder = Path(scratch, "KRL.g4"), Path(scratch, "generated")
        source.write_bytes(grammar.text.encode())
        if check(source, kept) is None:
            return {}, []
        generator(source, folder)
        files = {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()}
        with _parser_in(folder):
            return files, list(disagreements(examples))


def disagreements(constructs: Iterable[Construct]) -> Iterator[tuple[str, str]]:
    """Yield the examples on which ANTLR's parser is wrong, as construct ID and message."""
    for construct in constructs:
        for number, text in enumerate(construct.accept, 1):
            refusal = antlr_reference.refusal(text)
            if refusal:
                where = f"line {refusal.line}: {refusal.message}"
                yield construct.id, f"examples.accept: ANTLR refuses number {number}, {where}"
        for number, text in enumerate(construct.reject, 1):
            if antlr_reference.accepts(text):
                yield construct.id, f"examples.reject: ANTLR accepts number {number}"


@contextmanager
def _parser_in(folder: Path) -> Iterator[None]:
    """Make `grammar.parser.antlr_reference` use the parser in a folder within the context."""
    ours = {name: sys.modules.pop(name) for name in _MODULES if name in sys.modules}
    try:
        for name in _MODULES:  # by hand: an editable install knows its own place for these names
            file = folder / f"{name.rpartition('.')[2]}.py"
            spec = spec_from_file_location(name, file)
            assert spec is not None
            assert spec.loader is not None
            module = sys.modules[name] = module_from_spec(spec)
            spec.loader.exec_module(module)
        yield
    finally:
        for name in _MODULES:
            sys.modules.pop(name, None)
        sys.modules.update(ours)
