"""The reference: ANTLR's generated parser, asked only whether it accepts.

Slow (0.1 MB/s) and therefore not what the survey runs on; a disagreement between it and
`grammar.parser.recognizer` is a defect of one of the two.
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
    """Keeps the first error; the lexer reports here what it cannot match."""

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
    """Why ANTLR refuses the text as a KRL module, or ``None`` where it accepts."""
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
    """Why a parser that ANTLR made refuses a text by one of its rules, or ``None``."""
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
    """Whether ANTLR accepts the text as a KRL module."""
    return refusal(text) is None
