"""The entry point of `krl`; `krl.commands.app` lists the commands."""

import gc
import os
import sys
from collections.abc import Sequence

from krl.hidden_packages import hiding_package


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `krl` with `arguments` (default: those of the process) and return its exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    if hiding := hiding_package():
        sys.stderr.write(f"krl: {hiding}\n")
        return 2
    from krl import errors  # imports packages that could be hidden, so not at the top
    from krl.commands.app import app

    if "_KRL_COMPLETE" in os.environ:  # the shell asks what could be typed
        app()(prog_name="krl")
    status = errors.run(app(*given), given)
    if arguments is None:
        gc.freeze()  # else the end of the process visits all that a command keeps
    return status
