"""Writes what is generated from the instruction set, or checks that it is up to date."""

from __future__ import annotations

import argparse
import sys

from interp.bytecode.instruction_set.generator import outdated, products


def main() -> int:
    """Entry point; exit status 0 fine, 1 out of date."""
    parser = argparse.ArgumentParser(
        prog="python -m interp.bytecode.instruction_set", description=__doc__
    )
    choice = parser.add_mutually_exclusive_group(required=True)
    choice.add_argument("--write", action="store_true", help="write what follows from the table")
    choice.add_argument("--check", action="store_true", help="say what is out of date")
    if parser.parse_args().write:
        for path, text in products().items():
            path.write_text(text, encoding="utf-8", newline="\n")
        return 0
    for name in (names := outdated()):
        sys.stdout.write(
            f"{name} is out of date: run python -m interp.bytecode.instruction_set --write\n"
        )
    return 1 if names else 0


if __name__ == "__main__":
    sys.exit(main())
