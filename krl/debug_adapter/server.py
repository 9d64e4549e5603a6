"""Transport of the debug adapter: standard input and output, or a port."""

import contextlib
import os
import socket
import sys
from pathlib import Path
from typing import BinaryIO, cast

import typer

from krl.debug_adapter.adapter import Adapter
from krl.debug_adapter.connection import Connection
from krl.running.run_options import RunOptions


def serve(file: Path | None, options: RunOptions, port: int | None) -> None:
    """Serve the client on standard input and output, or those on a port one after another.

    Only this machine can reach the port.
    """
    if port is None:
        _serve_standard(file, options)
        return
    with socket.create_server(("127.0.0.1", port)) as server:
        typer.echo(f"listening on 127.0.0.1:{server.getsockname()[1]}", err=True)
        while True:
            client, _ = server.accept()
            with contextlib.suppress(ConnectionError), client, client.makefile("rwb") as stream:
                Adapter(_connection(stream), file, options).serve()


def _serve_standard(file: Path | None, options: RunOptions) -> None:
    # Only messages may be written to standard output.
    with (
        os.fdopen(os.dup(sys.stdout.fileno()), "wb") as out,
        contextlib.redirect_stdout(sys.stderr),
    ):
        Adapter(Connection(cast(BinaryIO, sys.stdin.buffer), out), file, options).serve()


def _connection(stream: object) -> Connection:
    both = cast(BinaryIO, stream)
    return Connection(both, both)
