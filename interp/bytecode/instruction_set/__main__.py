"""Writes what is generated from the instruction set, or checks that it is up to date."""

from __future__ import annotations

import sys

from interp.bytecode.instruction_set.generator import products
from support.files.generated_files import main

if __name__ == "__main__":
    sys.exit(main("interp.bytecode.instruction_set", products))
