"""The reference parser: ANTLR's generated one, asked only whether it accepts a text.

It reads 0.1 MB/s, so the survey uses `grammar.parser.recognizer` instead. A text that only one of
the two accepts shows a defect in one of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from antlr4 import CommonTokenStream, InputStream
from antlr4.error.ErrorListener import ErrorListener
from antlr4.error.Errors import ParseCancellationException
from antlr4.error.ErrorStrategy import BailErrorStrategy


@dataclass(frozen=True, slots=True)
class Refusal:
    """Where ANTLR stopped: line from 1, column from 0, and its message."""

    line: int
    column: int
    message: str


class _FirstError(ErrorListener):
    """An error listener that keeps the first error of lexer and parser."""

    def __init__(self) -> None:
        super().__init__()
        self.found: Refusal | None = None

    def syntaxError(  # noqa: N802 - ANTLR's signature
        self, recognizer: Any, symbol: Any, line: int, column: int, message: str, error: Any
    ) -> None:
        del recognizer, symbol, error
        if self.found is None:
            self.found = Refusal(line, column, message)


def refusal(text: str) -> Refusal | None:
    """Return why ANTLR rejects the text as a KRL module, or ``None`` if it accepts."""
    # deferred: building ANTLR's tables costs a tenth of a second that few commands need
    from grammar._generated.KRLLexer import KRLLexer
    from grammar._generated.KRLParser import KRLParser

    return refusal_by(KRLLexer, KRLParser, "module", text)


def refusal_by(
    lexer_of: Callable[[InputStream], Any],
    parser_of: Callable[[CommonTokenStream], Any],
    rule: str,
    text: str,
) -> Refusal | None:
    """Return why a generated parser rejects a text as ``rule``, or ``None`` if it accepts."""
    errors = _FirstError()
    lexer = lexer_of(InputStream(text))
    lexer.removeErrorListeners()
    lexer.addErrorListener(errors)
    tokens = CommonTokenStream(lexer)
    parser = parser_of(tokens)
    parser.removeErrorListeners()
    parser.buildParseTrees = False
    parser._errHandler = BailErrorStrategy()
    try:
        getattr(parser, rule)()
    except ParseCancellationException as cancelled:
        token: Any = getattr(cancelled.args[0], "offendingToken", None) or tokens.LT(1)
        return errors.found or Refusal(token.line, token.column, f"unexpected {token.text!r}")
    return errors.found


def accepts(text: str) -> bool:
    """Return whether ANTLR accepts the text as a KRL module."""
    return refusal(text) is None
