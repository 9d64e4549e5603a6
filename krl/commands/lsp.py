"""`krl lsp`: the language server, for editors."""

import contextlib
import logging
import os
import sys
from typing import BinaryIO, cast

from krl.errors import FINE, InputError
from krl.extras import expected_extras

_LARGEST = 64_000_000
_LONGEST_LINE = 1_000


def lsp(
    verbose: bool = False,
) -> int:
    """Serve an editor over standard input and output: findings, hover, definitions, formatting.

    Speaks the Language Server Protocol; docs/editors.md explains the set-up of editors.

    Options:
        verbose: Log requests and replies to stderr.
    """
    logging.basicConfig(stream=sys.stderr, level=logging.INFO if verbose else logging.CRITICAL)
    with expected_extras():
        from krl.language_server.server import server
    ours = server()
    # the server closes its output, and nothing else may be written to it
    with (
        os.fdopen(os.dup(sys.stdout.fileno()), "wb") as out,
        contextlib.redirect_stdout(sys.stderr),
    ):
        ours.start_io(cast(BinaryIO, Bounded(sys.stdin.buffer)), out)
    return FINE


class Bounded:
    """Standard input of the server with limits, as the stated length of a message may be false."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream

    def readline(self) -> bytes:
        """Return a line of the header of a message."""
        line = self._stream.readline(_LONGEST_LINE)
        if len(line) == _LONGEST_LINE:
            raise InputError(f"a line of more than {_LONGEST_LINE:,} bytes before a message")
        return line

    def read(self, size: int) -> bytes:
        """Return a message."""
        if size > _LARGEST:
            raise InputError(f"a message of {size:,} bytes; the largest may have {_LARGEST:,}")
        return self._stream.read(size)
