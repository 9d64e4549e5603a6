"""The entry point of `krl`; `krl.commands.app` says which commands there are."""

import os
import sys
from collections.abc import Sequence

from krl.hidden_packages import hiding_package


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `krl` with `arguments` (those of the process by default) and return its exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    if hiding := hiding_package():
        sys.stderr.write(f"krl: {hiding}\n")
        return 2
    from krl import errors  # what could be hidden is imported below
    from krl.commands.app import app

    if "_KRL_COMPLETE" in os.environ:  # the shell asks what could be typed
        app()(prog_name="krl")
    return errors.run(app(*given), given)
