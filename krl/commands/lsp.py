"""`krl lsp`: the language server, for editors."""

import logging
import sys
from typing import Annotated

import typer

from krl.door import FINE, Unusable

__all__ = ["lsp"]


def lsp(
    verbose: Annotated[
        bool, typer.Option("--verbose", help="Tell on stderr what is asked and answered.")
    ] = False,
) -> int:
    """Serve an editor over standard input and output: findings, hover, definitions, formatting.

    Speaks the Language Server Protocol; docs/editors.md says how to set an editor up.
    """
    logging.basicConfig(stream=sys.stderr, level=logging.INFO if verbose else logging.CRITICAL)
    try:
        from krl.language.server import server
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in {"pygls", "lsprotocol"}:
            raise
        raise Unusable(
            f"the server needs {error.name}, which is not installed: "
            "pip install 'krl-workbench[lsp]'"
        ) from error
    server().start_io()
    return FINE
